//! How far faces are from the original surface: what keeps polishing from buying looks with distance.
//!
//! Pictures with few samples let a vertex drift along the line of sight. So a change must gain a larger share of the
//! image error than a weight times the share of the deviation that it adds. Deviation: the area of a face times the mean
//! distance of its centroid and the midpoints of its sides from the original. Units: frame units cubed.

use glam::DVec3;

use crate::{
    collapse::{LiveMesh, Patch},
    metric::Proximity,
    num::math::{length, sqrt},
};

/// The original surface, and how far the whole mesh was from it.
#[derive(Debug)]
pub struct Deviation {
    original: Proximity,
    total: f64,
    weight: f64,
}

impl Deviation {
    /// `original` in the frame of `live`; `None` without triangles or without weight. O(n log n).
    #[must_use]
    pub fn new(original: Vec<[DVec3; 3]>, live: &LiveMesh, weight: f64) -> Option<Self> {
        if weight <= 0.0 {
            return None;
        }
        let mut deviation = Self {
            original: Proximity::new(original)?,
            total: 0.0,
            weight,
        };
        let faces = (0..live.triangle_ids()).filter_map(|t| live.points(t));
        deviation.total = faces.map(|points| deviation.of(points)).sum();
        Some(deviation)
    }

    /// True where a patch that lowers the error `sum` by `gain` is worth the deviation that it adds.
    #[must_use]
    pub fn pays(&self, live: &LiveMesh, patch: &Patch, gain: f64, sum: f64) -> bool {
        let before: f64 = patch
            .removed
            .iter()
            .map(|f| self.of(patch.before(live, f)))
            .sum();
        let after: f64 = patch
            .added
            .iter()
            .map(|f| self.of(patch.after(live, f)))
            .sum();
        gain * self.total >= self.weight * (after - before) * sum
    }

    fn of(&self, [a, b, c]: [DVec3; 3]) -> f64 {
        let area = 0.5 * length((b - a).cross(c - a));
        let mut near = 0;
        let points = [
            ((a + b) + c) / 3.0,
            (a + b) * 0.5,
            (b + c) * 0.5,
            (c + a) * 0.5,
        ];
        let distances = points.map(|p| {
            let (squared, index) = self.original.squared_distance(p, near);
            near = index;
            sqrt(squared)
        });
        area * 0.25 * distances.iter().sum::<f64>()
    }
}
