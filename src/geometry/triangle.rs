//! A triangle: its normal and area, and its point closest to another one.
//!
//! Every Voronoi region (face, three edges, three vertices) and every degenerate triangle (segment, point) gives the
//! right distance: the candidates of the three edges are right whatever the triangle is, and the face's candidate is
//! a convex combination of the corners wherever it is admitted, so it never lies outside and never comes too close.
//! `f64` with `+ - * /` in one written order; the corners are ordered by coordinates first, so the result has the
//! same bits for every order of the corners. Accurate to a few ulps of the coordinates.

use std::cmp::Ordering;

use glam::DVec3;

use super::Box3;
use crate::num::math::length;

/// The normal of a triangle, twice as long as its area is large.
#[inline]
pub fn area_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Twice the area of a triangle.
#[inline]
pub fn double_area(corners: [DVec3; 3]) -> f64 {
    length(area_normal(corners))
}

/// Weights of the corners, which sum to `3k`, in the centroid of part `index` of `k * k` congruent parts of a triangle, in
/// rows parallel to the side opposite to the first corner: row `r` has `r + 1` parts that stand like the triangle and `r`
/// turned ones between them.
pub fn part_weights(k: u32, index: u64) -> [u64; 3] {
    let row = index.isqrt();
    let within = index - row * row;
    let (column, turned) = (within / 2, within % 2);
    let of_c = 3 * column + 1 + turned;
    let of_a = 3 * (u64::from(k) - row) - 2 + turned;
    [of_a, 3 * u64::from(k) - of_a - of_c, of_c]
}

/// The coordinate axis that is farthest from a direction.
pub fn axis_across(direction: DVec3) -> DVec3 {
    let size = direction.abs();
    if size.x <= size.y && size.x <= size.z {
        DVec3::X
    } else if size.y <= size.z {
        DVec3::Y
    } else {
        DVec3::Z
    }
}

/// Squared length, in the order in which [`Box3::squared_distance`] sums as well: the tree needs that.
#[inline]
fn squared(v: DVec3) -> f64 {
    (v.x * v.x + v.y * v.y) + v.z * v.z
}

/// A triangle with its corners in ascending order of (x, y, z).
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    corners: [DVec3; 3],
    /// True where ordering the corners turned the other side up.
    turned: bool,
}

impl Triangle {
    /// Orders the corners.
    pub fn new(mut corners: [DVec3; 3]) -> Self {
        let mut turned = false;
        // Three exchanges sort three corners, and each turns the triangle over.
        for i in [0, 1, 0] {
            if order(corners[i], corners[i + 1]).is_gt() {
                corners.swap(i, i + 1);
                turned = !turned;
            }
        }
        Self { corners, turned }
    }

    /// The normal, twice as long as the area is large, of the side that the corners as given go around
    /// counter-clockwise.
    pub fn area_normal(&self) -> DVec3 {
        let normal = area_normal(self.corners);
        if self.turned { -normal } else { normal }
    }

    /// The corners, in ascending order of their coordinates.
    pub fn corners(&self) -> [DVec3; 3] {
        self.corners
    }

    /// The smallest box around it.
    #[inline]
    pub fn bounds(&self) -> Box3 {
        Box3::of_triangle(self.corners)
    }

    /// Twice the area.
    pub fn double_area(&self) -> f64 {
        double_area(self.corners)
    }

    /// The closest point, inside the bounding box of the corners, and its squared distance.
    #[inline]
    pub fn closest(&self, p: DVec3) -> (DVec3, f64) {
        let [a, b, c] = self.corners;
        let (ab, ac, ap) = (b - a, c - a, p - a);
        let normal = ab.cross(ac);
        let norm = normal.dot(normal);
        // Barycentric coordinates of the projection; NaN or infinite where the triangle has no area.
        let v = ap.cross(ac).dot(normal) / norm;
        let w = ab.cross(ap).dot(normal) / norm;
        let u = 1.0 - v - w;
        if u >= 0.0 && v >= 0.0 && w >= 0.0 {
            let face = self.admit(p, a + (ab * v + ac * w));
            // Well inside and no sliver: the edges cannot be closer by more than rounding.
            let sturdy = norm > 1e-6 * (squared(ab) * squared(ac));
            if sturdy && u > 1e-3 && v > 1e-3 && w > 1e-3 {
                return face;
            }
            return nearer(face, self.closest_on_edges(p));
        }
        self.closest_on_edges(p)
    }

    fn closest_on_edges(&self, p: DVec3) -> (DVec3, f64) {
        let [a, b, c] = self.corners;
        let on = |from, to| self.admit(p, closest_on_segment(p, from, to));
        nearer(nearer(on(a, b), on(a, c)), on(b, c))
    }

    /// Moves a candidate that rounding pushed out of the bounding box back in: box distances are then lower bounds
    /// of triangle distances exactly, not up to rounding.
    #[inline]
    fn admit(&self, p: DVec3, candidate: DVec3) -> (DVec3, f64) {
        let Box3 { low, high } = self.bounds();
        let q = candidate.max(low).min(high);
        (q, squared(p - q))
    }
}

/// By x, then y, then z.
fn order(a: DVec3, b: DVec3) -> Ordering {
    a.x.total_cmp(&b.x)
        .then(a.y.total_cmp(&b.y))
        .then(a.z.total_cmp(&b.z))
}

/// The first of two candidates unless the second is closer.
#[inline]
fn nearer(first: (DVec3, f64), second: (DVec3, f64)) -> (DVec3, f64) {
    if second.1 < first.1 { second } else { first }
}

#[inline]
fn closest_on_segment(p: DVec3, a: DVec3, b: DVec3) -> DVec3 {
    let ab = b - a;
    let (along, norm) = ((p - a).dot(ab), squared(ab));
    // `norm` is 0 for a segment without length: then both comparisons settle it.
    if along <= 0.0 {
        a
    } else if along >= norm {
        b
    } else {
        a + ab * (along / norm)
    }
}

/// The point of a triangle closest to `p`, and its squared distance: both in the units of the positions, which should
/// have magnitudes around 1 ([`Frame`](crate::num::Frame)): squares of squares must neither overflow nor vanish.
pub fn closest_point(p: DVec3, corners: [DVec3; 3]) -> (DVec3, f64) {
    Triangle::new(corners).closest(p)
}
