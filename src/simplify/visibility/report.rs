//! The report of a visibility-guided run.

use crate::simplify::{Outcome, Report};

/// The report of a visibility-guided run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibilityReport {
    /// V(M), the visibility of the input, in [0, 1].
    pub v_mesh: f64,
}

impl Outcome {
    /// V(M), the visibility of the input in [0, 1]; only for the method that is guided by it.
    #[must_use]
    pub fn v_mesh(&self) -> Option<f64> {
        match &self.report {
            Report::Visibility(report) => Some(report.v_mesh),
            _ => None,
        }
    }
}
