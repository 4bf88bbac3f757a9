//! Distances and orientation by brute force: what judges the crate uses none of its code for them.

use glam::DVec3;
use lodmark::{bound::planar::Aperture, mesh::Mesh};

pub(crate) fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// An angle between 0 and a right one.
pub(crate) fn aperture(radians: f64) -> Aperture {
    Aperture::radians(radians).expect("below a right angle")
}

/// The angle between two points seen from `v`, by its own formula: twice the angle whose tangent is a ratio of lengths
/// (Kahan).
pub(crate) fn angle_between(v: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (a, b) = ((a - v).normalize(), (b - v).normalize());
    2.0 * libm::atan2((a - b).length(), (a + b).length())
}

/// The mean of points by weights of any sum.
pub(crate) fn mixture(points: &[DVec3], weights: &[f64]) -> DVec3 {
    let sum: f64 = weights.iter().sum();
    let all = points.iter().zip(weights);
    all.map(|(&p, &w)| p * (w / sum)).sum()
}

/// A mesh of triangles whose corners are all among the positions.
pub(crate) fn mesh_of(
    positions: impl Into<Vec<DVec3>>,
    triangles: impl Into<Vec<[u32; 3]>>,
) -> Mesh {
    Mesh::from_triangles(positions.into(), triangles.into()).expect("valid")
}

/// A square of size 2 around the origin, counter-clockwise from above.
pub(crate) fn square() -> [DVec3; 4] {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| at(x, y, 0.0))
}

/// The corners of every triangle.
pub(crate) fn faces(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    let corners = |t: &[u32; 3]| t.map(|v| mesh.positions()[v as usize]);
    mesh.triangles().iter().map(corners).collect()
}

/// A mesh with one vertex somewhere else.
pub(crate) fn moved(mesh: &Mesh, vertex: usize, by: DVec3) -> Mesh {
    let mut positions = mesh.positions().to_vec();
    positions[vertex] += by;
    mesh_of(positions, mesh.triangles())
}

/// The distance from a point to a triangle: the least over its face and sides, all of them.
pub(crate) fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let segment = |x: DVec3, y: DVec3| {
        let d = y - x;
        let t = if d.length_squared() > 0.0 {
            ((p - x).dot(d) / d.length_squared()).clamp(0.0, 1.0)
        } else {
            0.0
        };
        (x + d * t - p).length()
    };
    let edges = segment(a, b).min(segment(b, c)).min(segment(c, a));
    let n = (b - a).cross(c - a);
    let inside = |x: DVec3, y: DVec3| (y - x).cross(p - x).dot(n) >= 0.0;
    if n.length_squared() > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        edges.min((p - a).dot(n).abs() / n.length())
    } else {
        edges
    }
}

/// The distance from a point to the nearest of many triangles.
pub(crate) fn distance_to_all(p: DVec3, all: &[[DVec3; 3]]) -> f64 {
    all.iter()
        .map(|&t| distance(p, t))
        .fold(f64::INFINITY, f64::min)
}

/// The distance from a point to a triangle by descent over barycentric samples: no closed form, and never too small.
pub(crate) fn distance_by_descent(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let (mut s, mut t, mut step, mut best) = (1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, f64::INFINITY);
    for _ in 0..40 {
        let (s0, t0) = (s, t);
        for (i, j) in [
            (0, 0),
            (1, 0),
            (-1, 0),
            (0, 1),
            (0, -1),
            (1, -1),
            (-1, 1),
            (1, 1),
            (-1, -1),
        ] {
            let x = (s0 + step * f64::from(i)).clamp(0.0, 1.0);
            let y = (t0 + step * f64::from(j)).clamp(0.0, 1.0 - x);
            let d = (a + (b - a) * x + (c - a) * y - p).length();
            if d < best {
                (best, s, t) = (d, x, y);
            }
        }
        step *= 0.7;
    }
    best
}

/// Points of a triangle: a lattice, corners and sides included.
pub(crate) fn lattice([a, b, c]: [DVec3; 3], steps: u32) -> impl Iterator<Item = DVec3> {
    let share = move |i: u32| f64::from(i) / f64::from(steps);
    (0..=steps).flat_map(move |i| {
        (0..=steps - i).map(move |j| a + (b - a) * share(i) + (c - a) * share(j))
    })
}
