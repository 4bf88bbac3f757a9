//! Tori: plain, interlocking, and the textured one of Lindstrom & Turk 2000, section 5.4.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{Surface, attributes, finish};
use crate::{
    mesh::{ChannelKind, Mesh, MeshParts},
    num::{Each, Precision, math},
};

/// Largest number of segments in one direction.
const SEGMENT_LIMIT: u32 = 2_048;

/// Full turns of the ellipse on its way around the circle.
const SPINS: f64 = 2.0;

/// A torus around the z axis: a circle of radius `minor` swept around one of radius `major`, with `around` segments
/// along the large circle and `across` along the small one (3 to 2,048 each).
///
/// # Panics
/// Where a radius is not finite in `f32`.
pub fn torus(major: f64, minor: f64, around: u32, across: u32) -> Mesh {
    round_surface(major, minor, around, across).into_mesh()
}

/// Two tori like links of a chain, neither touching the other.
pub fn interlocking_tori(around: u32, across: u32) -> Mesh {
    let link = round_surface(1.0, 0.3, around, across);
    let mut surface = Surface::default();
    surface.add(&link, |p| DVec3::new(p.x - 0.5, p.y, p.z));
    surface.add(&link, |p| DVec3::new(p.x + 0.5, -p.z, p.y));
    surface.into_mesh()
}

/// An ellipse swept around a circle while it spins, with texture coordinates along both: a strongly non-linear
/// parameterization with a seam in either direction.
///
/// The paper gives no numbers; here the circle has radius 1, the ellipse half-axes 0.45 and 0.2, and it makes two full
/// turns. `around` and `across` as in [`torus`]; wedges outnumber vertices by `around + across + 1`.
pub fn textured_torus(around: u32, across: u32) -> Mesh {
    let [n, m] = [around, across].each(|s| s.clamp(3, SEGMENT_LIMIT));
    let surface = swept(n, m, 1.0, |theta, phi| {
        let (x, y) = (0.45 * math::cos(phi), 0.2 * math::sin(phi));
        let (c, s) = (math::cos(SPINS * theta), math::sin(SPINS * theta));
        [x * c - y * s, x * s + y * c]
    });
    let mut values = Vec::new();
    for i in 0..=n {
        for j in 0..=m {
            let uv = [f64::from(i) / f64::from(n), f64::from(j) / f64::from(m)];
            values.extend(uv.each(|x| Precision::F32.round(x)));
        }
    }
    let wedges = quads(n, m, |i, j| i * (m + 1) + j);
    let attributes = attributes(&[ChannelKind::TexCoord(0)], values, wedges);
    finish(MeshParts {
        positions: surface.positions,
        triangles: surface.triangles,
        attributes,
        ..MeshParts::default()
    })
}

pub(super) fn round_surface(major: f64, minor: f64, around: u32, across: u32) -> Surface {
    let [n, m] = [around, across].each(|s| s.clamp(3, SEGMENT_LIMIT));
    swept(n, m, major, |_, phi| {
        [minor * math::cos(phi), minor * math::sin(phi)]
    })
}

/// A closed curve swept around the z axis: `profile` gives its point (outward, up) at two angles.
pub(super) fn swept(n: u32, m: u32, major: f64, profile: impl Fn(f64, f64) -> [f64; 2]) -> Surface {
    let mut positions = Vec::with_capacity(n as usize * m as usize);
    for i in 0..n {
        let theta = TAU * (f64::from(i) / f64::from(n));
        let (c, s) = (math::cos(theta), math::sin(theta));
        for j in 0..m {
            let [outward, up] = profile(theta, TAU * (f64::from(j) / f64::from(m)));
            let radius = major + outward;
            positions.push(DVec3::new(radius * c, radius * s, up));
        }
    }
    Surface {
        positions,
        triangles: quads(n, m, |i, j| i % n * m + j % m),
    }
}

/// Two triangles for every cell of an `n` by `m` grid whose points have the numbers `at(i, j)`.
fn quads(n: u32, m: u32, at: impl Fn(u32, u32) -> u32) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(2 * n as usize * m as usize);
    for i in 0..n {
        for j in 0..m {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}
