//! The seam between the [`Engine`](super::Engine) and a method of simplification.

use std::any::Any;

use super::{Admitted, LiveMesh, Patch, Refusal, Site, legality::STAR_LIMIT, wedge::WedgeValues};

/// A collapse as a method proposes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposal {
    /// Place of the new vertex.
    pub position: Admitted,
    /// First key of the order of collapses, an exact integer that may be negative; 0 for methods that need none.
    pub primary: i64,
    /// Second key; decides where first keys are equal.
    pub secondary: f64,
}

/// Accuracy of an evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evaluation {
    /// To the last bit: the edge may be collapsed.
    Exact,
    /// Keys that are only about right, for a fraction of the time: the edge waits under them until it comes to the
    /// front of the queue, and is evaluated exactly there.
    Rough,
}

/// Constants by which the engine schedules the evaluations of a method; the same during a whole run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Most faces around an edge that may collapse, at most [`STAR_LIMIT`]: fewer where evaluations are dear or would
    /// be refused anyway.
    pub star_limit: usize,
    /// Evaluate an edge roughly before it comes to the front of the queue.
    pub rough_first: bool,
    /// Number of edges that wait under an estimate and are evaluated together, on all threads, when the first of them
    /// comes to the front; 1 where evaluations are too short to be shared.
    pub look_ahead: usize,
    /// Fewest evaluations of a batch that are worth sharing among threads one by one.
    pub shared_batch: usize,
    /// Evaluations that are worth a task of their own. Batches of at most this many stay on one thread.
    pub evaluations_per_task: usize,
}

impl Default for Plan {
    /// For short evaluations.
    fn default() -> Self {
        Self {
            star_limit: STAR_LIMIT,
            rough_first: false,
            look_ahead: 1,
            shared_batch: usize::MAX,
            evaluations_per_task: 512,
        }
    }
}

/// Verdict of a method on a collapse that is about to be committed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Review {
    /// Commit it.
    Commit,
    /// The proposal no longer holds, because of a change that did not touch the edge's star: evaluate the edge again.
    Outdated,
    /// It would exceed the method's error limit: end the run before it.
    LimitReached,
}

/// Costs from sums that a method keeps, without a visit to an edge's star.
///
/// An edge waits in the queue under its estimate and is proposed only when that comes to the front; so estimates decide
/// the order in which edges are evaluated, and proposals which are collapsed. Only for methods whose first key is
/// always 0.
pub trait Estimates: Sync {
    /// The second key of an edge's collapse if no rule forbade its best place; `None` where the sums do not tell.
    fn estimate(&self, live: &LiveMesh, edge: u32) -> Option<f64>;

    /// True where the last commit may have lowered the estimate of an edge that does not end at the new vertex; one that
    /// rose is noticed in time at the front of the queue.
    fn may_fall(&self, live: &LiveMesh, edge: u32) -> bool;
}

/// A method of simplification: it places new vertices and prices collapses.
///
/// A method may place by another one, but nothing stands between a method and the engine: what is asked of a run besides
/// (to end at a cost, to measure ranks, to keep a record) the [`Engine`](super::Engine) and its
/// [`Observer`](super::Observer) do. So there is no wrapper that could forget to forward.
pub trait Method: Send + Sync {
    /// Places the new vertex of the site's edge and prices the collapse. Called in parallel, with a scratch per thread.
    ///
    /// # Errors
    /// The rule that forbids it, from [`Site::admit`]; [`Refusal::Unplaced`]; or a reason of the method's own.
    fn propose(&self, site: &Site<'_>, scratch: &mut MethodScratch) -> Result<Proposal, Refusal>;

    /// Follows a commit; `live` already has the patch. Old and new corner positions: [`Patch::before`],
    /// [`Patch::after`].
    fn committed(&mut self, live: &LiveMesh, patch: &Patch);

    /// Constants of the schedule.
    fn plan(&self) -> Plan {
        Plan::default()
    }

    /// The costs that can be had without an evaluation, for methods that keep sums.
    fn estimates(&self) -> Option<&dyn Estimates> {
        None
    }

    /// The values of new wedges, for methods that place texture coordinates and colours as well.
    fn wedge_values(&self) -> Option<&dyn WedgeValues> {
        None
    }

    /// Judges the patch that is about to be committed. The proposal's costs were right when it was evaluated.
    fn review(&mut self, live: &LiveMesh, patch: &Patch) -> Review {
        let _ = (live, patch);
        Review::Commit
    }
}

/// Buffers that the evaluations of one thread reuse. They never influence a result.
#[derive(Debug, Default)]
pub struct MethodScratch {
    buffers: Option<Box<dyn Any + Send>>,
    alone: bool,
}

impl MethodScratch {
    /// For evaluations that nothing else runs beside: such an evaluation may use other threads itself.
    pub fn alone() -> Self {
        Self {
            alone: true,
            buffers: None,
        }
    }

    /// The buffers of type `T`, made by `fresh` the first time; it is told whether evaluations run alone.
    ///
    /// # Panics
    /// Never.
    pub fn of<T: Any + Send>(&mut self, fresh: impl FnOnce(bool) -> T) -> &mut T {
        if !self.buffers.as_ref().is_some_and(|b| (**b).is::<T>()) {
            self.buffers = Some(Box::new(fresh(self.alone)));
        }
        let buffers = self.buffers.as_mut().and_then(|b| b.downcast_mut());
        buffers.expect("of this type since the lines above")
    }
}
