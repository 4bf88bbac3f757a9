//! Visibility: the measure against brute force and analytic values, surveys in parts, hidden parts.

mod measure;
mod products;
mod survey;

use glam::DVec3;
use lodmark::{
    mesh::{Mesh, generate},
    visibility::MeasureOptions,
};

/// A measurement that takes a moment only.
fn small(octahedron: u32, size: u32) -> MeasureOptions {
    MeasureOptions {
        octahedron,
        size,
        ..MeasureOptions::default()
    }
}

/// A sphere in a sphere: from outside only the outer one is seen.
fn nested(subdivisions: u32) -> (Mesh, Vec<bool>) {
    let mesh = generate::shells(2, subdivisions);
    let center = mesh.positions().iter().sum::<DVec3>() / mesh.positions().len() as f64;
    let distance = |t: usize| (mesh.corners(t)[0] - center).length();
    let count = mesh.triangles().len();
    let largest = (0..count).map(distance).fold(0.0, f64::max);
    let outer = (0..count).map(|t| distance(t) > 0.9 * largest).collect();
    (mesh, outer)
}
