//! The report of an image-driven run.

use super::{Comparison, PolishCounters};
use crate::simplify::{Outcome, Report};

/// The report of an image-driven run: nothing of it where the memoryless method's mesh is returned, but for the
/// comparison that decided so.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImageReport {
    /// Root mean square of the luma differences over the driving views, in levels. Never a measure of quality: the run
    /// has minimised it.
    pub error_rms: Option<f64>,
    /// The moves and flips of polishing, where there was any.
    pub polish: Option<PolishCounters>,
    /// The comparison with the memoryless method, where the two were close.
    pub comparison: Option<Comparison>,
}

impl Outcome {
    fn image(&self) -> Option<&ImageReport> {
        match &self.report {
            Report::Image(report) => Some(report),
            _ => None,
        }
    }

    /// Root mean square of the luma differences over the driving views; see [`ImageReport::error_rms`].
    #[must_use]
    pub fn error_rms(&self) -> Option<f64> {
        self.image()?.error_rms
    }

    /// The moves and flips of polishing, where there was any.
    #[must_use]
    pub fn polish(&self) -> Option<&PolishCounters> {
        self.image()?.polish.as_ref()
    }

    /// The comparison with the memoryless method, where the two were close.
    #[must_use]
    pub fn comparison(&self) -> Option<Comparison> {
        self.image()?.comparison
    }
}
