//! Whether seams have to give way before a run begins.
//!
//! A run that keeps every seam until no edge may collapse any more has by then spent all that the surface between them
//! could bear. So the memoryless method tries first how far the seams let it go, on a copy; where that is not as far as
//! the target, seams give way from the start of the run, each for what it is worth ([`Site::seam_loss`]).
//!
//! [`Site::seam_loss`]: crate::collapse::Site::seam_loss

use super::{
    memoryless::{Memoryless, MemorylessOptions},
    run::Run,
};
use crate::{
    Progress, Result,
    collapse::{Concession, Engine, Stop, Topology},
};

impl Run<'_> {
    /// Lets seams give way from the start where the target cannot be met otherwise. About the time of a memoryless run
    /// for a mesh with seams, none for others.
    pub(super) fn settle_seams(&mut self) -> Result<()> {
        let rules = self.options.rules;
        let open = rules.topology == Topology::Auto && rules.concession == Concession::None;
        let (Some(target), true) = (self.target, open && self.live.may_have_features()) else {
            return Ok(());
        };
        let live = self.live.clone();
        let mut method = Memoryless::new(&live, MemorylessOptions::default());
        let mut engine = Engine::new(live, rules, self.options.schedule);
        let stop = engine.run(&mut method, target, &mut (), &Rehearsal(self.progress))?;
        if matches!(stop, Stop::NoLegalCollapse { .. }) {
            self.options.rules.concession = Concession::Seams;
        }
        Ok(())
    }
}

/// Reports the work of a rehearsal under its own name.
struct Rehearsal<'a>(&'a dyn Progress);

impl Progress for Rehearsal<'_> {
    fn report(&self, _: &str, done: u64, total: u64) {
        self.0.report("try seams", done, total);
    }

    fn interrupted(&self) -> bool {
        self.0.interrupted()
    }
}
