//! An independent judge of stored normals: pictures by a depth buffer of its own, lit from the eye, as viewers draw them.

use glam::DVec3;
use lodmark::{
    mesh::{ChannelKind, Mesh},
    num::math::sqrt,
};

/// Width and height of a picture.
const SIZE: usize = 384;

/// A picture without perspective: by pixel, depth and luma; infinite where there is nothing.
struct Picture(Vec<(f64, f64)>);

/// The directions of the 24 corners of a small rhombicuboctahedron.
fn directions() -> Vec<DVec3> {
    let far = 1.0 + sqrt(2.0);
    let mut found = Vec::new();
    for bits in 0..8 {
        let sign = |axis: u32| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 };
        for long in 0..3 {
            let mut corner = DVec3::new(sign(0), sign(1), sign(2));
            corner[long] *= far;
            found.push(corner.normalize());
        }
    }
    found
}

/// The normals of a triangle's corners, as they are stored; that of the face where there are none.
fn normals(mesh: &Mesh, t: usize, face: DVec3) -> [DVec3; 3] {
    let attributes = mesh.attributes();
    let Some(channel) = attributes.channel(ChannelKind::Normal) else {
        return [face; 3];
    };
    attributes.corners()[t].map(|wedge| {
        let stored = DVec3::from_slice(attributes.value(channel, wedge));
        if stored.is_nan() { face } else { stored }
    })
}

fn draw(mesh: &Mesh, toward: DVec3, centre: DVec3, radius: f64) -> Picture {
    let right = toward.cross(DVec3::new(0.3, 0.5, 0.8)).normalize();
    let up = toward.cross(right);
    let scale = SIZE as f64 / (2.0 * radius);
    let mut picture = vec![(f64::NEG_INFINITY, 127.5); SIZE * SIZE];
    for t in 0..mesh.triangles().len() {
        let corners = mesh.corners(t).map(|p| p - centre);
        let face = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let stored = normals(mesh, t, face);
        let p = corners.map(|p| {
            let on = |axis: DVec3| (p.dot(axis) + radius) * scale;
            DVec3::new(on(right), on(up), p.dot(toward))
        });
        let cross =
            |a: DVec3, b: DVec3, x: f64, y: f64| (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        let area = cross(p[0], p[1], p[2].x, p[2].y);
        let range = |of: fn(DVec3) -> f64| {
            let [a, b, c] = p.map(of);
            let low = (a.min(b).min(c) - 0.5).ceil().max(0.0) as usize;
            let high = (a.max(b).max(c) - 0.5).floor().min(SIZE as f64 - 1.0);
            low..(high + 1.0).max(0.0) as usize
        };
        for row in range(|p| p.y) {
            for column in range(|p| p.x) {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let b = [1, 2, 0].map(|i| cross(p[i], p[(i + 1) % 3], x, y) / area);
                if !b.iter().all(|&b| b >= 0.0) {
                    continue;
                }
                let depth = (0..3).map(|i| b[i] * p[i].z).sum();
                let pixel = &mut picture[row * SIZE + column];
                if depth > pixel.0 {
                    let normal: DVec3 = (0..3).map(|i| stored[i] * b[i]).sum();
                    *pixel = (depth, 255.0 * normal.normalize_or_zero().dot(toward).abs());
                }
            }
        }
    }
    Picture(picture)
}

/// Root mean square of the differences in luma between pictures of two meshes, over the pixels that both cover, and over
/// those that either does.
pub(crate) fn lit_errors(reference: &Mesh, candidate: &Mesh) -> [f64; 2] {
    let (low, high) = reference.bounds().expect("triangles");
    let (centre, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
    let mut sums = [(0.0, 0.0); 2];
    for toward in directions() {
        let [one, other] = [reference, candidate].map(|mesh| draw(mesh, toward, centre, radius));
        for (a, b) in one.0.iter().zip(&other.0) {
            let covered = [a, b].map(|pixel| pixel.0.is_finite());
            let squared = (a.1 - b.1) * (a.1 - b.1);
            for (sum, counts) in sums
                .iter_mut()
                .zip([covered[0] && covered[1], covered[0] || covered[1]])
            {
                if counts {
                    *sum = (sum.0 + squared, sum.1 + 1.0);
                }
            }
        }
    }
    sums.map(|(sum, count): (f64, f64)| sqrt(sum / count))
}
