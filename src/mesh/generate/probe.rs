//! A small scene with everything that rasterizers get wrong, for self-checks and cross-checks.

use glam::DVec3;

use super::{
    Height, Pcg32, Surface,
    grid::grid_surface,
    sphere::{spherical_surface, tetrahedral_surface},
    torus::round_surface,
};
use crate::{mesh::Mesh, num::Each};

/// Fewer than 500 triangles within 1.5 of the origin: a sphere half hidden behind an open sheet and pierced by a
/// tetrahedron, a ring, a fan of slivers, faces that occur twice (also reversed, also with vertices of their own),
/// degenerate triangles, and a cloud of random ones.
pub fn probe() -> Mesh {
    let mut scene = Surface::default();
    let sphere = spherical_surface(1);
    scene.add(&sphere, |p| p * 0.5);
    // Interpenetration: the corners of the tetrahedron leave the sphere.
    scene.add(&tetrahedral_surface(), |p| p * 0.45);
    // Occlusion and an open boundary.
    let sheet = grid_surface(4, 4, Height::Polynomial);
    let placed = |p: DVec3| DVec3::new(p.x * 0.5 + 0.4, p.y * 0.5, p.z * 0.5 + 0.7);
    scene.add(&sheet, placed);
    let ring = round_surface(0.8, 0.06, 12, 5);
    scene.add(&ring, |p| DVec3::new(p.z, p.x, p.y));
    slivers(&mut scene);
    // Equal depth: the same faces again, reversed, and from vertices of their own.
    let twice: Vec<[u32; 3]> = scene.triangles[..4].to_vec();
    scene.triangles.extend(&twice);
    let turned = twice.iter().map(|&[a, b, c]| [a, c, b]);
    scene.triangles.extend(turned);
    scene.add(&sheet, placed);
    // No area: a point, an edge, three corners in a line.
    let line = scene.positions.len() as u32;
    let points = [0.0, 0.5, 1.0].each(|t| DVec3::new(t, 0.75, -t));
    scene.positions.extend(points);
    let degenerate = [[0, 0, 0], [0, 1, 1], [0, 1, 2]];
    let degenerate = degenerate.each(|t: [u32; 3]| t.each(|v| v + line));
    scene.triangles.extend(degenerate);
    cloud(&mut scene);
    scene.into_mesh()
}

/// A fan of triangles around one vertex, 700 to 1,100 times as long as wide.
fn slivers(scene: &mut Surface) {
    let hub = scene.positions.len() as u32;
    scene.positions.push(DVec3::new(-1.2, -0.8, 0.4));
    for k in 0..=24 {
        let t = f64::from(k);
        let (x, y) = (1.0 - 0.002 * t, -0.9 + 0.000_05 * t * t);
        scene.positions.push(DVec3::new(x, y, 0.4 - 0.002 * t));
    }
    let fan = (1..=24).map(|k| [hub, hub + k, hub + k + 1]);
    scene.triangles.extend(fan);
}

/// Random triangles through the whole scene.
fn cloud(scene: &mut Surface) {
    let mut random = Pcg32::new(2000, 2007);
    for _ in 0..40 {
        let mut vector = |size: f64| {
            let [x, y, z] = [(); 3].each(|()| size * (2.0 * random.unit() - 1.0));
            DVec3::new(x, y, z)
        };
        let center = vector(0.7);
        let first = scene.positions.len() as u32;
        let corners = [(); 3].each(|()| center + vector(0.12));
        scene.positions.extend(corners);
        scene.triangles.push([first, first + 1, first + 2]);
    }
}
