//! Options of view-bounded simplification.

use serde::{Deserialize, Serialize};

use super::super::memoryless::MemorylessOptions;
use crate::bound::view_cell::ViewCell;

/// Options of the method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ViewBoundedOptions {
    /// The viewpoints, in the units of the mesh.
    pub cell: ViewCell,
    /// Largest angle between an original point and the point that replaces it, in degrees; from 0 to below 90.
    pub error_deg: f64,
    /// Placement of new vertices.
    pub placement: MemorylessOptions,
}

impl ViewBoundedOptions {
    /// The bound `error_deg` (degrees) for the viewers in `cell` (units of the mesh), with default placement.
    #[must_use]
    pub fn new(cell: ViewCell, error_deg: f64) -> Self {
        Self {
            cell,
            error_deg,
            placement: MemorylessOptions::default(),
        }
    }
}
