//! Views: the minimum bounding sphere, camera placement, view sets, the view file.

mod file;
mod framing;
mod sets;
mod sphere;

use glam::DVec3;
use lodmark::{
    Error,
    mesh::{Mesh, MeshParts},
    num::{Frame, Precision, fixed::SubpixelBits, math::sqrt},
    view::{
        Cull, Eye, Interpolation, Light, Projection, Shading, Specular, Sphere, View, ViewSet,
        ViewsName, Window, frame_of, resolve, sets as named_sets,
    },
};
use proptest::prelude::*;

fn fine(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<DVec3>> {
    prop::collection::vec([-1.0..1.0, -1.0..1.0, -1.0..1.0], count)
        .prop_map(|v| v.into_iter().map(DVec3::from_array).collect())
}

fn clip(view: &View, p: DVec3) -> [f64; 4] {
    view.matrix
        .map(|[a, b, c, d]| ((a * p.x + b * p.y) + c * p.z) + d)
}

/// The same values, 0 and -0 alike.
fn same(a: [f64; 4], b: [f64; 4]) -> bool {
    a.iter()
        .zip(b)
        .all(|(&a, b)| a.total_cmp(&b).is_eq() || a.abs() + b.abs() <= 0.0)
}

fn unit_sphere() -> Sphere {
    Sphere {
        center: DVec3::ZERO,
        radius: 1.0,
    }
}
