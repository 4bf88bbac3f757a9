//! Options of visibility-guided simplification.

use serde::{Deserialize, Serialize};

use super::super::quadric::QuadricOptions;
use crate::visibility;

/// Weight of `Q` beside `Q_v`: enough to order what nobody sees, and no more than a visibility of 0.001.
pub const TIE_WEIGHT: f64 = 1e-6;

/// Options of the method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct VisibilityOptions {
    /// The planes of faces and boundaries.
    pub quadric: QuadricOptions,
    /// Weight of the cost without visibility beside the cost with it, in [0, 1].
    pub tie_weight: f64,
    /// Measurement of the visibility of the input's triangles.
    pub measure: visibility::MeasureOptions,
}

impl Default for VisibilityOptions {
    fn default() -> Self {
        Self {
            quadric: QuadricOptions::default(),
            tie_weight: TIE_WEIGHT,
            measure: visibility::MeasureOptions::default(),
        }
    }
}
