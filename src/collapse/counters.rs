//! The account of a run: why it ended, and counts of its work.

use serde::Serialize;

use super::Refusals;

/// Reason why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "reason")]
#[non_exhaustive]
pub enum Stop {
    /// There are no more triangles than wanted.
    TargetReached,
    /// The next collapse would exceed the error that is allowed.
    ErrorLimit,
    /// No edge may be collapsed any more.
    NoLegalCollapse {
        /// Number of the edges left that each reason blocks.
        refusals: Refusals,
    },
    /// The pieces that are seen alone are more than wanted, a triangle of each; what is seen goes before the target.
    VisiblePieces {
        /// Number of the pieces that a view sees.
        pieces: usize,
    },
    /// The input already had no more triangles than wanted; it is returned as it is.
    TargetAboveInput,
}

/// Counts of the work of a run. The same for every number of threads.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Counters {
    /// Collapses committed.
    pub collapses: u64,
    /// Those of them that broke a seam: it lost its course, and the area beside it another chart's look.
    #[serde(skip_serializing_if = "is_zero")]
    pub seams_broken: u64,
    /// Edges evaluated, those of rank measurements not counted.
    pub evaluations: u64,
    /// Costs of edges that were estimated, from sums or roughly.
    #[serde(skip_serializing_if = "is_zero")]
    pub estimates: u64,
    /// Edges an eager queue would have evaluated for the same collapses.
    pub evaluations_if_eager: u64,
    /// Evaluations that each reason refused.
    pub refusals: Refusals,
    /// Where rank measurement is on: for every measured collapse, the share of legal edges that were truly cheaper,
    /// in [0, 1).
    pub ranks: Vec<f64>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants a reference")]
fn is_zero(count: &u64) -> bool {
    *count == 0
}

impl Counters {
    /// Adds the counts of another run, its ranks excepted.
    pub(super) fn add(&mut self, other: &Self) {
        self.collapses += other.collapses;
        self.seams_broken += other.seams_broken;
        self.evaluations += other.evaluations;
        self.estimates += other.estimates;
        self.evaluations_if_eager += other.evaluations_if_eager;
        self.refusals.add_all(&other.refusals);
    }
}
