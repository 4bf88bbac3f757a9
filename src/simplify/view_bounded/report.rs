//! The report of view-bounded simplification.

use crate::{
    bound::correspondence::Correspondence,
    simplify::{Outcome, Report},
};

/// The report of view-bounded simplification.
#[derive(Clone, Debug)]
pub struct ViewBoundedReport {
    /// Where every point of the input went, by triangles of the input and of the result.
    pub correspondence: Correspondence,
}

impl Outcome {
    /// Where every point of the input went, by triangles of the input and of [`Outcome::mesh`]; only for methods that
    /// keep account of it.
    #[must_use]
    pub fn correspondence(&self) -> Option<&Correspondence> {
        match &self.report {
            Report::ViewBounded(report) => Some(&report.correspondence),
            _ => None,
        }
    }
}
