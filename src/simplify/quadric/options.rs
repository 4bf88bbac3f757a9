//! Options of quadric error metrics.

use serde::{Deserialize, Serialize};

/// Weight of the plane of a face at each of its corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Weighting {
    /// 1 (the paper of 1997): depends on the tessellation.
    Unit,
    /// The face's area (1998).
    #[default]
    Area,
}

/// Uncertainty of planes (Trettner & Kobbelt 2020); makes every minimum unique.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Uncertainty {
    /// Standard deviation of unit normals.
    pub normal: f64,
    /// Standard deviation of positions, as a fraction of the mean edge length.
    pub position: f64,
}

/// Options of the method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct QuadricOptions {
    /// Weight of the planes of faces.
    pub weighting: Weighting,
    /// Weight of the planes that stand on boundary edges; times the squared length of the edge for area weights.
    pub boundary_weight: f64,
    /// Probabilistic quadrics, or `None` for exact planes.
    pub uncertainty: Option<Uncertainty>,
    /// Distances in space and in texture coordinates and colours (1998), which new vertices get from the same minimum;
    /// not for the visibility-guided method.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub attributes: bool,
}

impl QuadricOptions {
    /// Probabilistic quadrics with CGAL's usual standard deviation of positions, 0.05 of the mean edge length.
    #[must_use]
    pub fn probabilistic() -> Self {
        Self::default().with_uncertainty()
    }

    /// These options with the uncertainty of [`QuadricOptions::probabilistic`].
    #[must_use]
    pub fn with_uncertainty(mut self) -> Self {
        self.uncertainty = Some(Uncertainty {
            normal: 0.05,
            position: 0.05,
        });
        self
    }
}

impl Default for QuadricOptions {
    fn default() -> Self {
        Self {
            weighting: Weighting::default(),
            boundary_weight: 1.0,
            uncertainty: None,
            attributes: false,
        }
    }
}
