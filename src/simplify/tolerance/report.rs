//! The report of simplification within a distance.

use serde::Serialize;

use crate::simplify::{Outcome, Report};

/// The bound that holds for a result: proved, not sampled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Guarantee {
    /// No point of the result is farther than this from the original, in file units.
    pub distance: f64,
    /// The same as a fraction of the diagonal of the original's bounding box; `None` where that is 0.
    pub of_diagonal: Option<f64>,
    /// True where no point of the original is farther from the result, either.
    pub two_sided: bool,
}

impl Outcome {
    /// The proved bound on the distance from the original; only for the method that keeps one.
    #[must_use]
    pub fn guarantee(&self) -> Option<Guarantee> {
        match &self.report {
            Report::Tolerance(guarantee) => Some(*guarantee),
            _ => None,
        }
    }
}
