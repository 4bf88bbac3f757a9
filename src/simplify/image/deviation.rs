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
pub struct Deviation<'a> {
    original: &'a Proximity,
    total: f64,
    weight: f64,
}

impl<'a> Deviation<'a> {
    /// `original` in the frame of `live`; `None` without weight. O(n log n).
    #[must_use]
    pub fn new(original: &'a Proximity, live: &LiveMesh, weight: f64) -> Option<Self> {
        if weight <= 0.0 {
            return None;
        }
        let mut deviation = Self {
            original,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{mesh::Mesh, num::Frame};

    /// A square of side 2 with a vertex in its middle, which is `height` above it.
    fn tent(height: f64) -> Mesh {
        let positions = vec![
            DVec3::new(0.0, 0.0, height),
            DVec3::new(-1.0, -1.0, 0.0),
            DVec3::new(1.0, -1.0, 0.0),
            DVec3::new(1.0, 1.0, 0.0),
            DVec3::new(-1.0, 1.0, 0.0),
        ];
        let triangles = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
        Mesh::from_triangles(positions, triangles).expect("valid")
    }

    #[test]
    fn only_a_gain_that_outweighs_the_added_distance_pays() {
        let flat = LiveMesh::new(&tent(0.0), Frame::default());
        let square: Vec<_> = (0..4).filter_map(|t| flat.points(t)).collect();
        let live = LiveMesh::new(&tent(0.125), Frame::default());
        let square = Proximity::new(square).expect("triangles");
        assert!(Deviation::new(&square, &live, 0.0).is_none());
        let deviation = Deviation::new(&square, &live, 0.5).expect("a weight");
        // Of every face: a third of the height at the centroid, halves at two midpoints, none at the third.
        let area = 0.5 * 2.0 * length(DVec3::new(0.0, 1.0, 0.125));
        let expected = 4.0 * area * 0.25 * (0.125 / 3.0 + 0.0625 + 0.0625);
        assert!((deviation.total - expected).abs() < 1e-12);
        let mut patch = Patch::default();
        let mut pays = |height: f64, gain: f64| {
            patch.set_move(&live, 0, DVec3::new(0.0, 0.0, height));
            deviation.pays(&live, &patch, gain, 100.0)
        };
        // Twice as high is a little more than twice the deviation: half of a share of a good 1.
        assert!(!pays(0.25, 45.0));
        assert!(pays(0.25, 60.0));
        assert!(pays(0.05, 1e-9), "closer is free");
        assert!(pays(-0.05, 1e-9), "on the other side as well");
    }
}
