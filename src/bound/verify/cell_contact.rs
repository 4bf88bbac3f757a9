//! Contact of a view cell with a surface: a viewer who stands on a point of it sees that point in every direction, so
//! that the angle to its replacement may be any up to pi.

use glam::DVec3;

use crate::num::{Each, math::length};

/// Distance from the contact at which points are measured, in displacements: near enough for angles next to 90 degrees.
const NEAR: f64 = 1e-6;

/// The weights of a point of a triangle, and a viewpoint in the hull of one to four that is there up to rounding; `None`
/// where there is none. Both are where they are said to be even where a needle makes them lie apart.
fn contact(triangle: [DVec3; 3], viewers: &[DVec3]) -> Option<([f64; 3], DVec3)> {
    let [a, b, c] = triangle;
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let norm = normal.dot(normal);
    let of = |p: DVec3| {
        let r = p - a;
        let v = r.cross(ac).dot(normal) / norm;
        let w = ab.cross(r).dot(normal) / norm;
        [1.0 - v - w, v, w]
    };
    let point = if viewers.len() > 3 {
        middle_inside(triangle, viewers)?
    } else {
        // Where the viewpoints cross the plane: a point or a segment, cut where it leaves the triangle.
        let height = |p: DVec3| (p - a).dot(normal);
        let size = [ab, ac].each(length).into_iter().fold(0.0, f64::max);
        let flat = |p: DVec3| height(p).abs() <= 1e-14 * size * length(normal);
        let mut ends: Vec<DVec3> = viewers.iter().copied().filter(|&v| flat(v)).collect();
        for (i, &v) in viewers.iter().enumerate() {
            for &w in &viewers[i + 1..] {
                let (h, k) = (height(v), height(w));
                if (h < 0.0) != (k < 0.0) && !flat(v) && !flat(w) {
                    ends.push(v + (w - v) * (h / (h - k)));
                }
            }
        }
        let (first, last) = (*ends.first()?, *ends.last()?);
        let (from, to) = (of(first), of(last));
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        for k in 0..3 {
            if from[k] < 0.0 && to[k] < 0.0 {
                return None;
            }
            let t = from[k] / (from[k] - to[k]);
            if from[k] < 0.0 {
                low = low.max(t);
            } else if to[k] < 0.0 {
                high = high.min(t);
            }
        }
        if low > high {
            return None;
        }
        first + (last - first) * (0.5 * (low + high))
    };
    let weights = of(point);
    let inside = weights.iter().all(|w| w.is_finite() && *w >= -1e-12);
    let sum: f64 = weights.iter().map(|w| w.max(0.0)).sum();
    inside.then(|| (weights.each(|w| w.max(0.0) / sum), point))
}

/// A point of a tetrahedron in the middle of what a triangle has inside.
fn middle_inside(triangle: [DVec3; 3], viewers: &[DVec3]) -> Option<DVec3> {
    let mut left = triangle.to_vec();
    for k in 0..4 {
        let [apex, a, b, c] = [0, 1, 2, 3].each(|i| viewers[(k + i) % 4]);
        let normal = (b - a).cross(c - a);
        let up = (apex - a).dot(normal);
        if up == 0.0 {
            return None;
        }
        let depth = |p: DVec3| (p - a).dot(normal) * up;
        let mut cut = Vec::with_capacity(left.len() + 1);
        for (i, &p) in left.iter().enumerate() {
            let q = left[(i + 1) % left.len()];
            let (d, e) = (depth(p), depth(q));
            if d >= 0.0 {
                cut.push(p);
            }
            if (d < 0.0) != (e < 0.0) {
                cut.push(p + (q - p) * (d / (d - e)));
            }
        }
        left = cut;
    }
    let sum = left.iter().fold(DVec3::ZERO, |sum, &p| sum + p);
    let middle = sum / left.len() as f64;
    let mut shares = [0.0; 4];
    for (k, share) in shares.iter_mut().enumerate() {
        let [apex, a, b, c] = [0, 1, 2, 3].each(|i| viewers[(k + i) % 4]);
        let normal = (b - a).cross(c - a);
        *share = ((middle - a).dot(normal) / (apex - a).dot(normal)).max(0.0);
    }
    let all: f64 = shares.iter().sum();
    let hull = shares.iter().zip(viewers);
    let point = hull.fold(DVec3::ZERO, |sum, (&share, &v)| sum + v * (share / all));
    (!left.is_empty() && point.is_finite()).then_some(point)
}

/// Points next to the contact of a triangle with viewpoints, what stands for them, and the viewpoint there.
pub(super) fn sights_at_contact(
    corners: [[DVec3; 2]; 3],
    viewers: &[DVec3],
) -> impl Iterator<Item = ([DVec3; 2], DVec3)> {
    let found = contact(corners.map(|[p, _]| p), viewers);
    found.into_iter().flat_map(move |(weights, viewpoint)| {
        let mixed = |k: usize| {
            corners[0][k] * weights[0] + corners[1][k] * weights[1] + corners[2][k] * weights[2]
        };
        let at = [mixed(0), mixed(1)];
        let step = length(at[1] - at[0]) * NEAR;
        [at].into_iter()
            .chain(corners.each(|corner| {
                let t = (step / length(corner[0] - at[0])).min(1.0);
                [0, 1].each(|k| at[k] + (corner[k] - at[k]) * t)
            }))
            .map(move |pair| (pair, viewpoint))
    })
}
