//! The rules that have to give way, settled before a run begins.
//!
//! A run that keeps every rule until no edge may collapse any more has by then spent all that the surface could bear
//! elsewhere: the last triangles ruin it. So the memoryless method tries first how far the rules let it go, on a copy;
//! where that is not as far as the target, the next rule gives way from the start of the run, each seam for what it is
//! worth ([`Site::seam_loss`]).
//!
//! [`Site::seam_loss`]: crate::collapse::Site::seam_loss

use super::{
    memoryless::{Memoryless, MemorylessOptions},
    run::Run,
};
use crate::{
    Progress, Result,
    collapse::{Concession, Engine, LiveMesh, Rules, Stop, Topology},
    visibility::{MeasureOptions, measure},
};

/// Share of its target down to which a method that orders by more than geometry has to have a way: it leaves others than
/// the rehearsal does.
const MARGIN: f64 = 0.4;

/// Pieces of a mesh without seams, as a share of the target, from which they can stop a run above it.
const PIECES: f64 = 0.25;

impl Run<'_> {
    /// Lets rules give way from the start where the target cannot be met otherwise, in the order of [`Rules::steps`].
    ///
    /// Takes about a memoryless run for each rule that is tried: none for a mesh in few pieces that has no seams.
    pub(super) fn settle_concessions(&mut self) -> Result<()> {
        let rules = self.options.rules;
        if self.options.settled {
            return match rules.concession {
                Concession::None | Concession::Seams => Ok(()),
                _ => self.expend_unseen(),
            };
        }
        self.options.settled = true;
        // Where an error limits the run, that may end it long before a rule does.
        let limited = self.options.error_rms.is_some() || self.options.method.is_bounded();
        let open = rules.topology == Topology::Auto && !limited;
        let Some(target) = self.target.filter(|_| open && self.may_be_stopped()) else {
            return Ok(());
        };
        let reach = if self.options.method.as_run().only_orders() {
            target
        } else {
            (target as f64 * MARGIN) as usize
        };
        let mut left = None;
        for rules in rules.steps().take(3) {
            self.options.rules.concession = rules.concession;
            let live = match (rules.concession, left.take()) {
                // What is left tells as well whether pieces that nobody sees are all that is too much.
                (Concession::UnseenPieces, Some(live)) => {
                    self.expend_unseen()?;
                    self.live.lend_expendable(live)
                }
                _ => self.live.clone(),
            };
            let (stop, live) = self.rehearse(live, rules, reach)?;
            if !matches!(stop, Stop::NoLegalCollapse { .. }) {
                return Ok(());
            }
            left = Some(live);
        }
        self.options.rules.concession = Concession::Topology;
        Ok(())
    }

    /// True where rules can stop the run above its target: seams, or many pieces.
    fn may_be_stopped(&self) -> bool {
        self.live.may_have_features() || self.live.pieces() as f64 > self.least() as f64 * PIECES
    }

    fn rehearse(
        &self,
        mut live: LiveMesh,
        rules: Rules,
        mut reach: usize,
    ) -> Result<(Stop, LiveMesh)> {
        if self.options.per_mesh {
            let share = reach as f64 / self.mesh.triangles().len().max(1) as f64;
            reach = live.set_shares(share).unwrap_or(reach);
        }
        let mut method = Memoryless::new(&live, MemorylessOptions::default());
        let mut engine = Engine::new(live, rules, self.options.schedule);
        let stop = engine.run(&mut method, reach, &mut (), &Rehearsal(self.progress))?;
        Ok((stop, engine.into_parts().0))
    }

    /// Lets the pieces vanish that none of the views around the mesh as it is now sees (Zhang & Turk 2002), unless that
    /// was settled before.
    pub(super) fn expend_unseen(&mut self) -> Result<()> {
        if self.seen_pieces.is_some() {
            return Ok(());
        }
        let pieces = self.live.pieces();
        if pieces < 2 {
            // The only one is seen.
            self.seen_pieces = Some(pieces);
            return Ok(());
        }
        let mesh = self.live.to_mesh()?;
        let visibility = measure(&mesh, &MeasureOptions::default(), self.progress)?;
        let mut of_alive = visibility.triangles().iter().map(|&v| v > 0.0);
        let ids = 0..self.live.triangle_ids();
        let seen: Vec<bool> = ids
            .map(|t| self.live.triangle(t).is_some() && of_alive.next() == Some(true))
            .collect();
        let [pieces, unseen] = self.live.expend_unseen(&seen);
        self.seen_pieces = Some(pieces - unseen);
        Ok(())
    }
}

/// Reports the work of a rehearsal under its own name.
struct Rehearsal<'a>(&'a dyn Progress);

impl Progress for Rehearsal<'_> {
    fn report(&self, _: &str, done: u64, total: u64) {
        self.0.report("rehearse", done, total);
    }

    fn interrupted(&self) -> bool {
        self.0.interrupted()
    }
}
