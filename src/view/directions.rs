//! Directions of view sets: the vertices of regular and nearly regular polyhedra.
//!
//! Dodecahedron (20) for edge costs and small rhombicuboctahedron (24) for evaluation: Lindstrom & Turk 2000,
//! section 3.2. Octahedron with every triangle split in four k times, midpoints put back on the sphere (6, 18, 66,
//! 258, 1026, 4098 = 4^(k+1) + 2): Zhang & Turk 2002. Unit vectors from the scene towards the viewer.

use glam::DVec3;

use crate::{mesh::generate::subdivision, num::math};

/// The golden ratio and its inverse, and 1 + the square root of 2, rounded to nearest.
const GOLDEN: f64 = 1.618_033_988_749_895;
const GOLDEN_INVERSE: f64 = 0.618_033_988_749_894_8;
const SILVER: f64 = 2.414_213_562_373_095;

/// 2 pi / golden ratio^2 and 2 pi (sqrt 2 - 1), rounded to nearest.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
const SILVER_ANGLE: f64 = 2.602_580_569_572_975_4;

/// Most directions of a spiral.
pub const SPIRAL_LIMIT: u32 = 4_098;

/// Most subdivisions of the octahedron: 4,098 directions.
pub const OCTAHEDRON_LIMIT: u32 = 5;

/// Both signs of every number of `v`, the last number changing fastest; 0 has one sign.
fn with_signs(v: [f64; 3], into: &mut Vec<DVec3>) {
    let signs = |x: f64| {
        if x == 0.0 { vec![x] } else { vec![-x, x] }
    };
    for x in signs(v[0]) {
        for y in signs(v[1]) {
            into.extend(signs(v[2]).into_iter().map(|z| DVec3::new(x, y, z)));
        }
    }
}

fn units(corners: &[[f64; 3]]) -> Vec<DVec3> {
    let mut directions = Vec::new();
    for &corner in corners {
        with_signs(corner, &mut directions);
    }
    directions.into_iter().filter_map(math::unit).collect()
}

/// The 20 vertices of the regular dodecahedron.
#[must_use]
pub fn dodecahedron() -> Vec<DVec3> {
    units(&[
        [1.0, 1.0, 1.0],
        [0.0, GOLDEN_INVERSE, GOLDEN],
        [GOLDEN_INVERSE, GOLDEN, 0.0],
        [GOLDEN, 0.0, GOLDEN_INVERSE],
    ])
}

/// The 24 vertices of the small rhombicuboctahedron.
#[must_use]
pub fn rhombicuboctahedron() -> Vec<DVec3> {
    units(&[[SILVER, 1.0, 1.0], [1.0, SILVER, 1.0], [1.0, 1.0, SILVER]])
}

/// `count` directions spread evenly along a spiral (spherical Fibonacci points; Swinbank & Purser 2006): all stand for
/// nearly the same share of the sphere, and no two look along one axis.
#[must_use]
pub fn spiral(count: u32) -> Vec<DVec3> {
    let point = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let r = math::sqrt(1.0 - z * z);
        let angle = GOLDEN_ANGLE * f64::from(i);
        DVec3::new(r * math::cos(angle), r * math::sin(angle), z)
    };
    (0..count).map(point).collect()
}

/// `directions` turned as a whole; every `round` another way, 0 not at all.
///
/// About z by the golden angle and about x by the share `sqrt(2) - 1` of a circle, `round` times each: no two rounds
/// look from the same side.
#[must_use]
pub fn turned(directions: &[DVec3], round: u32) -> Vec<DVec3> {
    if round == 0 {
        return directions.to_vec();
    }
    let (a, b) = (
        GOLDEN_ANGLE * f64::from(round),
        SILVER_ANGLE * f64::from(round),
    );
    let ((sin_a, cos_a), (sin_b, cos_b)) =
        ((math::sin(a), math::cos(a)), (math::sin(b), math::cos(b)));
    let turn = |d: &DVec3| {
        let (x, y) = (cos_a * d.x - sin_a * d.y, sin_a * d.x + cos_a * d.y);
        DVec3::new(x, cos_b * y - sin_b * d.z, sin_b * y + cos_b * d.z)
    };
    directions.iter().map(turn).collect()
}

/// The vertices of the octahedron subdivided `k` times; those of `k - 1` come first, in the same order.
///
/// `k` above [`OCTAHEDRON_LIMIT`] counts as the limit.
#[must_use]
pub fn octahedron(k: u32) -> Vec<DVec3> {
    octahedron_faces(k).0
}

/// [`octahedron`] with its 8 * 4^k triangles, counter-clockwise seen from outside: what the share of the sphere that
/// a direction stands for is computed from.
#[must_use]
pub fn octahedron_faces(k: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut vertices = vec![
        DVec3::X,
        DVec3::NEG_X,
        DVec3::Y,
        DVec3::NEG_Y,
        DVec3::Z,
        DVec3::NEG_Z,
    ];
    let mut triangles = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    for _ in 0..k.min(OCTAHEDRON_LIMIT) {
        subdivision::split(&mut vertices, &mut triangles);
    }
    (vertices, triangles)
}
