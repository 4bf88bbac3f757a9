//! A run within an angle for all viewers in a cell.

use super::{ViewBounded, ViewBoundedOptions, ViewBoundedReport};
use crate::{
    Error, Result,
    bound::correspondence::Correspondence,
    collapse::{Rules, Schedule},
    mesh::Mesh,
    simplify::{
        Outcome, Report,
        memoryless::volume_rules,
        methods::{ErrorLimit, MethodRun},
        run::Run,
    },
};

impl MethodRun for ViewBoundedOptions {
    fn check(&self) -> Result<()> {
        if !(0.0..90.0).contains(&self.error_deg) {
            return Err(Error::Usage(format!(
                "the angle is {} degrees; expected at least 0 and less than 90",
                self.error_deg
            )));
        }
        self.placement.check()
    }

    fn rules(&self) -> Rules {
        volume_rules()
    }

    fn schedule(&self) -> Schedule {
        Schedule::Semi
    }

    fn error(&self) -> ErrorLimit {
        ErrorLimit::Own
    }

    fn report_of_copy(&self, mesh: &Mesh) -> Report {
        let all = (0..mesh.triangles().len()).map(|t| mesh.corners(t));
        let correspondence = Correspondence::identity(all.collect());
        Report::ViewBounded(ViewBoundedReport { correspondence })
    }

    fn run(&self, mut run: Run<'_>) -> Result<Outcome> {
        let mut method = ViewBounded::new(&run.live, self, run.progress)?;
        let before = run.phase_start();
        let stop = run.phase("view-bounded", &mut method, run.least(), before)?;
        let correspondence = method.into_correspondence(&run.live)?;
        let report = ViewBoundedReport { correspondence };
        run.finish(stop, Report::ViewBounded(report))
    }
}
