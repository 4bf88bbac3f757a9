//! Options of simplification within a distance.

use serde::{Deserialize, Serialize};

use super::super::memoryless::MemorylessOptions;
use crate::bound::tolerance::Source;

/// The largest distance between the result and the original.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Distance {
    /// As a fraction of the diagonal of the original's bounding box, above 0.
    OfDiagonal(f64),
    /// In file units, above 0.
    Length(f64),
}

/// Options of the method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ToleranceOptions {
    /// The bound.
    pub error: Distance,
    /// Bound only the distance from the result to the original, as the paper does, not that from the original to the
    /// result: small parts may then shrink to almost nothing.
    pub one_sided: bool,
    /// Where ends, midpoint and optimum are refused, try the place of least cost in the tolerance volume, too; the
    /// partition sets of that volume. `None`: no volumes.
    pub volume: Option<Source>,
    /// Bound every collapse by the surface before it as well, with a local bound that grows from 1/32 of the bound (section 3).
    pub growing: bool,
    /// Placement of vertices and order of collapses.
    pub placement: MemorylessOptions,
}

impl ToleranceOptions {
    /// Both directions, without volumes, with the defaults of the memoryless method.
    #[must_use]
    pub fn new(error: Distance) -> Self {
        Self {
            error,
            one_sided: false,
            volume: None,
            growing: false,
            placement: MemorylessOptions::default(),
        }
    }
}
