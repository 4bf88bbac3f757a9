//! The cameras around the mesh, and how much each counts.
//!
//! Zhang & Turk 2002, section 4: the vertices of an octahedron whose triangles are split in four k times, orthographic.
//! Deviations, unless told otherwise: the octahedron is turned, because cameras exactly along the sides of a shape tie
//! for visible and hidden at once, and a camera counts by the area it stands for.

use glam::DVec3;

use super::{Alignment, CameraWeights, Options};
use crate::{
    Error, Result,
    num::math,
    view::{
        Projection, Sphere, ViewSet,
        directions::{octahedron, octahedron_faces},
    },
};

/// Real and imaginary parts of the quaternion that turns the octahedron: whole numbers without a common factor, so
/// that the rotation is exact rational arithmetic.
const ROTATION: [f64; 4] = [37.0, 11.0, 7.0, 17.0];

/// The cameras of a measurement.
#[derive(Clone, Debug)]
pub(super) struct Cameras {
    /// Unit vectors from the mesh towards every camera.
    pub(super) towards: Vec<DVec3>,
    /// How much every camera counts; the mean is 1.
    pub(super) weights: Vec<f64>,
    /// Their views onto the sphere.
    pub(super) set: ViewSet,
}

impl Cameras {
    pub(super) fn new(options: &Options, sphere: &Sphere) -> Result<Self> {
        options.check()?;
        let mut towards = octahedron(options.octahedron);
        if options.alignment == Alignment::Generic {
            for direction in &mut towards {
                *direction = turned(*direction);
            }
        }
        let weights = match options.weights {
            CameraWeights::Equal => vec![1.0; towards.len()],
            CameraWeights::Area => area_weights(options.octahedron),
        };
        let set = ViewSet::around(
            sphere,
            &towards,
            options.size,
            options.size,
            Projection::Orthographic,
        )?
        .with_subpixel(options.subpixel_bits);
        if set.views.len() != towards.len() {
            return Err(Error::Internal("a camera without a view".into()));
        }
        Ok(Self {
            towards,
            weights,
            set,
        })
    }
}

/// The direction turned by [`ROTATION`]: v + 2 (w (u x v) + u x (u x v)) / |q|^2.
fn turned(v: DVec3) -> DVec3 {
    let [w, x, y, z] = ROTATION;
    let u = DVec3::new(x, y, z);
    let cross = u.cross(v);
    let squared = w * w + u.dot(u);
    let result = v + (cross * w + u.cross(cross)) * (2.0 / squared);
    math::unit(result).unwrap_or(result)
}

/// The area of every camera's barycentric cell: a third of the spherical triangles around it, divided by the mean.
fn area_weights(k: u32) -> Vec<f64> {
    let (vertices, triangles) = octahedron_faces(k);
    let mut weights = vec![0.0; vertices.len()];
    for corners in triangles {
        let area = solid_angle(corners.map(|v| vertices[v as usize]));
        for v in corners {
            weights[v as usize] += area;
        }
    }
    let scale = weights.len() as f64 / (3.0 * 4.0 * std::f64::consts::PI);
    for weight in &mut weights {
        *weight *= scale;
    }
    weights
}

/// The solid angle of a spherical triangle of unit vectors (Van Oosterom & Strackee 1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    2.0 * math::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
