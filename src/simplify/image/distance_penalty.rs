//! The distance of faces from the original surface, as a penalty that keeps pictures from buying looks with distance.
//!
//! Pictures with few samples let a vertex drift along the line of sight, and what no picture shows is free for them. So
//! shares are weighed: a change should gain a larger share of the image error than a weight times the share of the
//! deviation that it adds. Deviation: the area of a face times the mean distance of its centroid and the midpoints of
//! its sides from the original. Units: frame units cubed. Not in the papers.

use glam::DVec3;

use crate::{
    collapse::{LiveMesh, Patch, Star},
    geometry::{TriangleTree, double_area},
    num::{
        Each,
        math::{length, sqrt},
    },
    parallel,
};

/// Share of the least squares' trace that holds a vertex where it is: sideways in a flat place nothing else does.
const HOLD: f64 = 0.02;

/// Weight of the vertex itself in its fit, against 1 for the centroid of a face and a half for a midpoint.
const TIP: f64 = 0.3;

/// The original surface, and the distance of the whole mesh from it.
#[derive(Debug)]
pub struct DistancePenalty<'a> {
    original: &'a TriangleTree,
    total: f64,
    weight: f64,
}

impl<'a> DistancePenalty<'a> {
    /// `original` in the frame of `live`; `None` without weight. O(n log n).
    pub fn new(original: &'a TriangleTree, live: &LiveMesh, weight: f64) -> Option<Self> {
        if weight <= 0.0 {
            return None;
        }
        let mut deviation = Self {
            original,
            total: 0.0,
            weight,
        };
        let faces = parallel::filter_map(live.triangle_ids() as usize, |t| {
            Some(deviation.of(live.points(t as u32)?, &mut 0))
        });
        deviation.total = faces.iter().sum();
        Some(deviation)
    }

    /// The price of a unit of volume between the surfaces, in the unit of the image error `sum`; 0 where the mesh lies
    /// in the original.
    pub fn price(&self, sum: f64) -> f64 {
        if self.total > 0.0 {
            self.weight * sum / self.total
        } else {
            0.0
        }
    }

    /// The deviation of the faces that a patch, not yet committed, takes away.
    pub fn before(&self, live: &LiveMesh, patch: &Patch) -> f64 {
        self.sum(patch.removed.iter().map(|f| patch.before(live, f)))
    }

    /// The deviation of the faces that a patch, not yet committed, brings.
    pub fn after(&self, live: &LiveMesh, patch: &Patch) -> f64 {
        self.sum(patch.added.iter().map(|f| patch.after(live, f)))
    }

    /// A change that adds `cost` to the image error `sum` and `added` to the deviation, on one scale: negative where it is
    /// worth it. In the unit of `sum` times frame units cubed.
    pub fn balance(&self, cost: i64, sum: f64, added: f64) -> f64 {
        cost as f64 * self.total + self.weight * sum * added
    }

    /// The move of a star's vertex that brings it near the original with all of its faces: the least squares of the
    /// distances of the faces' samples from the planes that touch the original where it is nearest to them (Gauss and
    /// Newton's step). `None` where it has no faces with an area. O(faces log n).
    pub fn fit(&self, live: &LiveMesh, star: &Star) -> Option<DVec3> {
        let mut squares = Squares::default();
        let mut near = 0;
        for face in &star.faces {
            let k = face.corner(star.vertex)?;
            let tip = star.point;
            let [left, right] = [1, 2].each(|i| live.position(face.corners[(k + i) % 3]));
            let normal = (left - tip).cross(right - tip);
            let area = length(normal);
            if area <= 0.0 {
                continue;
            }
            // A sample, its share of the vertex's motion, and its weight.
            let samples = [
                (((tip + left) + right) / 3.0, 1.0 / 3.0, 1.0),
                ((tip + left) * 0.5, 0.5, 0.5),
                ((tip + right) * 0.5, 0.5, 0.5),
                (tip, 1.0, TIP),
            ];
            for (sample, share, counts) in samples {
                let (foot, index) = self.original.nearest(sample, near);
                near = index;
                let way = foot - sample;
                let distance = length(way);
                let direction = if distance > 0.0 {
                    way / distance
                } else {
                    normal / area
                };
                squares.add(direction * share, distance, area * counts);
            }
        }
        squares.solve()
    }

    fn sum(&self, faces: impl Iterator<Item = [DVec3; 3]>) -> f64 {
        let mut near = 0;
        faces.map(|points| self.of(points, &mut near)).sum()
    }

    /// `near` is a guess of the nearest triangle, and becomes one for the next face.
    fn of(&self, [a, b, c]: [DVec3; 3], near: &mut u32) -> f64 {
        let area = 0.5 * double_area([a, b, c]);
        let points = [
            ((a + b) + c) / 3.0,
            (a + b) * 0.5,
            (b + c) * 0.5,
            (c + a) * 0.5,
        ];
        let distances = points.each(|p| {
            let (squared, index) = self.original.squared_distance(p, *near);
            *near = index;
            sqrt(squared)
        });
        area * 0.25 * distances.iter().sum::<f64>()
    }
}

/// The sum of `weight (row . x - value)^2` over rows, as normal equations.
#[derive(Clone, Copy, Debug, Default)]
struct Squares {
    xx: DVec3,
    /// Products of y with z, z with x, and x with y.
    mixed: DVec3,
    right: DVec3,
}

impl Squares {
    fn add(&mut self, row: DVec3, value: f64, weight: f64) {
        self.xx += row * row * weight;
        self.mixed += DVec3::new(row.y * row.z, row.z * row.x, row.x * row.y) * weight;
        self.right += row * (value * weight);
    }

    /// Where the sum is least, held at the origin by a share of the trace.
    fn solve(&self) -> Option<DVec3> {
        let held = self.xx + DVec3::splat(HOLD * (self.xx.x + self.xx.y + self.xx.z));
        let DVec3 {
            x: yz,
            y: zx,
            z: xy,
        } = self.mixed;
        let rows = [
            DVec3::new(held.x, xy, zx),
            DVec3::new(xy, held.y, yz),
            DVec3::new(zx, yz, held.z),
        ];
        let minors = [
            rows[1].cross(rows[2]),
            rows[2].cross(rows[0]),
            rows[0].cross(rows[1]),
        ];
        let determinant = rows[0].dot(minors[0]);
        let numerator =
            minors[0] * self.right.x + minors[1] * self.right.y + minors[2] * self.right.z;
        let at = numerator / determinant;
        at.is_finite().then_some(at)
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

    fn square() -> TriangleTree {
        let flat = LiveMesh::new(&tent(0.0), Frame::default());
        let square: Vec<_> = (0..4).filter_map(|t| flat.points(t)).collect();
        TriangleTree::new(square).expect("triangles")
    }

    #[test]
    fn only_a_gain_that_outweighs_the_added_distance_pays() {
        let live = LiveMesh::new(&tent(0.125), Frame::default());
        let square = square();
        assert!(DistancePenalty::new(&square, &live, 0.0).is_none());
        let deviation = DistancePenalty::new(&square, &live, 0.5).expect("a weight");
        // Of every face: a third of the height at the centroid, halves at two midpoints, none at the third.
        let area = 0.5 * 2.0 * length(DVec3::new(0.0, 1.0, 0.125));
        let expected = 4.0 * area * 0.25 * (0.125 / 3.0 + 0.0625 + 0.0625);
        assert!((deviation.total - expected).abs() < 1e-12);
        assert!((deviation.price(100.0) - 50.0 / expected).abs() < 1e-9);
        let mut patch = Patch::default();
        let mut pays = |height: f64, cost: i64| {
            patch.set_move(&live, 0, DVec3::new(0.0, 0.0, height));
            let added = deviation.after(&live, &patch) - deviation.before(&live, &patch);
            deviation.balance(cost, 100.0, added) < 0.0
        };
        // Twice as high is a little more than twice the deviation: half of a share of a good 1.
        assert!(!pays(0.25, -45));
        assert!(pays(0.25, -60));
        assert!(pays(0.05, -1), "closer is free");
        assert!(pays(-0.05, -1), "on the other side as well");
        assert!(pays(0.0, 45), "and may cost something");
        assert!(!pays(0.0, 55));
    }

    #[test]
    fn a_vertex_that_fits_comes_down_to_the_surface_and_stays_where_its_faces_lie_in_it() {
        let square = square();
        for height in [-0.25, 0.0, 0.125] {
            let live = LiveMesh::new(&tent(height), Frame::default());
            let deviation = DistancePenalty::new(&square, &live, 1.0).expect("a weight");
            let mut star = Star::default();
            star.gather(&live, 0);
            let fit = deviation.fit(&live, &star).expect("faces");
            // Held by 2 % of the trace, which is all in the normal direction here.
            assert!(
                (fit - DVec3::new(0.0, 0.0, -height / 1.02)).length() < 1e-12,
                "{fit}"
            );
        }
    }
}
