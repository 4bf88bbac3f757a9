//! What a method of simplification is to the [`Engine`](super::Engine): it places the new vertex and prices it.

use glam::DVec3;

use super::{
    Anchor, LiveMesh, Patch, Refusal, Ring, Rules,
    legality::{self, RING_LIMIT},
    ring_unfolded,
};

/// A position that was rounded to the file's precision and then passed every rule at its [`Site`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Admitted(DVec3);

impl Admitted {
    /// The position in frame units.
    #[must_use]
    pub fn position(self) -> DVec3 {
        self.0
    }
}

/// An edge that may be collapsed, as a method sees it.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    /// The mesh.
    pub live: &'a LiveMesh,
    /// What lies around the edge.
    pub ring: &'a Ring,
    /// Where the rules let the new vertex be.
    pub anchor: Anchor,
    /// The rules.
    pub rules: Rules,
}

impl<'a> Site<'a> {
    /// The site of a ring.
    ///
    /// # Errors
    /// The rule that forbids this collapse wherever the new vertex lies.
    pub fn new(live: &'a LiveMesh, ring: &'a Ring, rules: Rules) -> Result<Self, Refusal> {
        Ok(Self {
            live,
            ring,
            anchor: legality::anchor(live, ring, rules)?,
            rules,
        })
    }

    /// The one position the rules leave, or `None` where the method chooses.
    #[must_use]
    pub fn fixed(&self) -> Option<DVec3> {
        match self.anchor {
            Anchor::Free => None,
            Anchor::At(end) => Some(self.ring.points[end]),
        }
    }

    /// Rounds a position to the file's precision and tests it. Judge costs at what this returns.
    ///
    /// # Errors
    /// The rule that forbids it. A position away from the anchor is [`Refusal::Locked`].
    pub fn admit(&self, position: DVec3) -> Result<Admitted, Refusal> {
        let position = self.live.round(position).ok_or(Refusal::Unplaced)?;
        if self.fixed().is_some_and(|p| p != position) {
            return Err(Refusal::Locked);
        }
        legality::shape(self.ring, position, self.rules)?;
        ring_unfolded(self.live, self.ring, position, self.rules)?;
        Ok(Admitted(position))
    }

    /// Fills `patch` with the collapse to `position`: what to render for this candidate, under its final ids.
    pub fn patch(&self, position: Admitted, patch: &mut Patch) {
        self.ring.patch(self.live, position.0, patch);
    }
}

/// A collapse as a method proposes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposal {
    /// Where the new vertex lies.
    pub position: Admitted,
    /// First key: change of the image error, and what the method charges for geometry beside it; 0 for methods without
    /// images. May be negative.
    pub image: i64,
    /// Second key: the geometric cost; keeps hidden parts, whose image cost is 0, in shape.
    pub geometric: f64,
}

/// A method of simplification.
///
/// `&self` and a scratch per thread, because candidates are evaluated in parallel.
pub trait Method: Sync {
    /// Buffers that evaluations reuse. They never influence a result.
    type Scratch: Send;

    /// Fresh buffers for a thread.
    fn scratch(&self) -> Self::Scratch;

    /// Buffers for evaluations that nothing else runs beside: such an evaluation may use other threads itself.
    fn lone_scratch(&self) -> Self::Scratch {
        self.scratch()
    }

    /// Places the new vertex of the site's edge and prices the collapse.
    ///
    /// # Errors
    /// The rule that forbids it: from [`Site::admit`], or [`Refusal::Unplaced`] or [`Refusal::Method`].
    fn propose(&self, site: &Site<'_>, scratch: &mut Self::Scratch) -> Result<Proposal, Refusal>;

    /// What the collapse of an edge would cost if no rule forbade its best place: the second key, from sums that the
    /// method keeps, without a look at the ring. `None` where the method has no such sums or they do not tell.
    ///
    /// Where it is given, an edge waits in the queue under its estimate and is proposed only when that comes to the
    /// front; so estimates decide the order in which edges are looked at, and proposals what is collapsed. Only for
    /// methods whose first key is always 0.
    fn estimate(&self, live: &LiveMesh, edge: u32) -> Option<f64> {
        let _ = (live, edge);
        None
    }

    /// Whether [`Method::glance`] is to be asked before [`Method::propose`].
    fn glances(&self) -> bool {
        false
    }

    /// A proposal whose keys are only about right, for a fraction of the time.
    ///
    /// Where the method glances, an edge waits in the queue under such keys, and is proposed only when they come to the
    /// front.
    ///
    /// # Errors
    /// As [`Method::propose`].
    fn glance(&self, site: &Site<'_>, scratch: &mut Self::Scratch) -> Result<Proposal, Refusal> {
        self.propose(site, scratch)
    }

    /// Whether the estimate of an edge that does not end at the new vertex may have fallen by the last commit; one that
    /// rose is noticed in time at the front of the queue.
    fn may_fall(&self, live: &LiveMesh, edge: u32) -> bool {
        let _ = (live, edge);
        true
    }

    /// Most faces around an edge that may collapse, at most [`RING_LIMIT`]: fewer where evaluations are dear or would be
    /// refused anyway. Always the same number.
    fn ring_limit(&self) -> usize {
        RING_LIMIT
    }

    /// Called with the patch that is about to be committed: false ends the run at the method's error limit, before
    /// the limit is exceeded. The proposal may be stale (its costs were right when it was evaluated).
    fn within_limit(&mut self, live: &LiveMesh, patch: &Patch, proposal: &Proposal) -> bool {
        let _ = (live, patch, proposal);
        true
    }

    /// Called before [`Method::within_limit`] with the patch that is about to be committed: false where the proposal no
    /// longer holds because of a change that did not touch its ring. The edge is then proposed again.
    fn confirm(&mut self, live: &LiveMesh, patch: &Patch, proposal: &Proposal) -> bool {
        let _ = (live, patch, proposal);
        true
    }

    /// How many edges that wait under an estimate are evaluated together when the first of them comes to the front, on
    /// all threads; 1 for methods whose evaluations are too short to be shared.
    fn looks_ahead(&self) -> usize {
        1
    }

    /// Called after every commit; `live` already has the patch. Old and new corner positions:
    /// [`Patch::before`], [`Patch::after`].
    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        let _ = (live, patch);
    }

    /// Fewest evaluations of a batch that are worth sharing among threads one by one.
    fn shared_batch(&self) -> usize {
        usize::MAX
    }

    /// How many evaluations are worth a task of their own. Batches of at most this many stay on one thread.
    fn evaluations_per_task(&self) -> usize {
        512
    }
}
