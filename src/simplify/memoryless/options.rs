//! Options of the memoryless method.

use serde::{Deserialize, Serialize};

/// The first constraint of an edge whose neighbourhood has boundary edges; without, both are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ConstraintOrder {
    /// Volume, then boundary, as published.
    Paper,
    /// Boundary, then volume.
    #[default]
    Cgal,
}

/// Options of the method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct MemorylessOptions {
    /// The first constraint.
    pub lt_order: ConstraintOrder,
    /// Weight of the swept volumes against the swept boundary areas, in [0, 1]; the areas have one minus it.
    pub volume_weight: f64,
}

impl Default for MemorylessOptions {
    fn default() -> Self {
        Self {
            lt_order: ConstraintOrder::default(),
            volume_weight: 0.5,
        }
    }
}
