//! A run within a distance: one phase for every local bound.

use super::{Distance, ToleranceMethod, ToleranceOptions};
use crate::{
    Error, Result,
    collapse::{Rules, Schedule, Stop},
    simplify::{
        Outcome, Report,
        memoryless::volume_rules,
        methods::{ErrorLimit, MethodRun},
        run::Run,
    },
};

impl MethodRun for ToleranceOptions {
    fn check(&self) -> Result<()> {
        let (name, error) = match self.error {
            Distance::OfDiagonal(error) => ("error", error),
            Distance::Length(error) => ("error-abs", error),
        };
        if !(error > 0.0 && error < f64::INFINITY) {
            return Err(Error::Usage(format!(
                "{name} is {error}; expected a distance above 0, for example --error 0.005 for half a percent of the diagonal"
            )));
        }
        self.placement.check()
    }

    fn rules(&self) -> Rules {
        volume_rules()
    }

    fn schedule(&self) -> Schedule {
        Schedule::Eager
    }

    fn error(&self) -> ErrorLimit {
        ErrorLimit::Own
    }

    fn run(&self, mut run: Run<'_>) -> Result<Outcome> {
        run.progress.step("prepare", 0, 0)?;
        let mut method = ToleranceMethod::new(&run.live, *self)?;
        let report = Report::Tolerance(method.guarantee());
        let mut stop = Stop::TargetReached;
        for bound in method.local_bounds() {
            method.set_local_bound(bound);
            let before = run.phase_start();
            stop = run.phase("tolerance", &mut method, run.least(), before)?;
            if stop == Stop::TargetReached {
                break;
            }
        }
        run.finish(stop, report)
    }
}
