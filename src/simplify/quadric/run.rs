//! A run by quadric error metrics.

use super::{QuadricMethod, QuadricOptions};
use crate::{
    Result,
    collapse::{Rules, Schedule},
    simplify::{
        Outcome, Report, memoryless::distance_rules, methods::MethodRun, options::require_within,
        run::Run,
    },
};

impl MethodRun for QuadricOptions {
    fn check(&self) -> Result<()> {
        require_within("boundary-weight", self.boundary_weight, 0.0, 1e12)?;
        if let Some(u) = self.uncertainty {
            require_within("normal uncertainty", u.normal, 0.0, 1.0)?;
            require_within("position uncertainty", u.position, 0.0, 1e6)?;
        }
        Ok(())
    }

    fn rules(&self) -> Rules {
        distance_rules()
    }

    fn schedule(&self) -> Schedule {
        Schedule::Semi
    }

    fn run(&self, run: Run<'_>) -> Result<Outcome> {
        let mut method = QuadricMethod::new(&run.live, self);
        run.collapse("quadric", &mut method, Report::Nothing)
    }
}
