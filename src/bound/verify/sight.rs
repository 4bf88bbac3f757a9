//! Angles between points as seen from viewpoints, and viewpoints in a cell, for the verifier alone.

use glam::DVec3;

use crate::{
    bound::cell::{Shape, ViewCell},
    num::math::{atan2, length},
};

/// Half the side of the part of an endless cell that viewpoints are taken from, in sizes of the original.
const REACH: f64 = 4.0;

/// The square of the tangent of the angle between `p` and `s` seen from `v`; infinite from a right angle on.
#[inline]
pub(super) fn tangent2(p: DVec3, s: DVec3, v: DVec3) -> f64 {
    let (r, d) = (p - v, s - p);
    let across = r.cross(d);
    let across = across.dot(across);
    let along = r.dot(s - v);
    if along > 0.0 {
        across / (along * along)
    } else if d.dot(d) > 0.0 {
        f64::INFINITY
    } else {
        0.0
    }
}

/// The angle in radians; 0 for equal points.
pub(super) fn angle(p: DVec3, s: DVec3, v: DVec3) -> f64 {
    let (r, d) = (p - v, s - p);
    if d.dot(d) > 0.0 {
        atan2(length(r.cross(d)), r.dot(s - v))
    } else {
        0.0
    }
}

/// A cell as the verifier looks from it: its corners, and its faces in triangles.
#[derive(Clone, Debug)]
pub(super) struct Viewpoints {
    pub(super) corners: Vec<DVec3>,
    /// Triangles; segments and points repeat a corner.
    faces: Vec<[DVec3; 3]>,
    /// The inside counts as well.
    solid: bool,
    /// Only a part of an endless cell.
    pub(super) partial: bool,
}

impl Viewpoints {
    /// For an original with the given centre and size.
    pub(super) fn new(cell: &ViewCell, centre: DVec3, size: f64) -> Self {
        let fan = |corners: &[DVec3]| -> Vec<[DVec3; 3]> {
            (2..corners.len())
                .map(|i| [corners[0], corners[i - 1], corners[i]])
                .collect()
        };
        let square = |point: DVec3, normal: DVec3| -> Vec<DVec3> {
            let foot = centre - normal * (centre - point).dot(normal);
            let side = if normal.x.abs() < 0.8 {
                DVec3::X
            } else {
                DVec3::Y
            };
            let a = normal.cross(side).normalize_or_zero() * (REACH * size);
            let b = normal.cross(a);
            vec![foot - a - b, foot + a - b, foot + a + b, foot - a + b]
        };
        let mut solid = false;
        let (corners, faces, partial) = match cell.shape() {
            Shape::Point(at) => (vec![*at], vec![[*at; 3]], false),
            Shape::Segment([a, b]) => (vec![*a, *b], vec![[*a, *b, *b]], false),
            Shape::Polygon { corners, .. } => (corners.clone(), fan(corners), false),
            Shape::Polyhedron { corners, faces, .. } => {
                solid = true;
                let face = |f: &Vec<u32>| -> Vec<DVec3> {
                    f.iter().map(|&v| corners[v as usize]).collect()
                };
                let all = faces.iter().flat_map(|f| fan(&face(f))).collect();
                (corners.clone(), all, false)
            }
            Shape::Line { point, direction } => {
                let foot = *point + *direction * (centre - *point).dot(*direction);
                let reach = *direction * (REACH * size);
                let ends = [foot - reach, foot + reach];
                (ends.to_vec(), vec![[ends[0], ends[1], ends[1]]], true)
            }
            Shape::Plane { point, normal } | Shape::HalfSpace { point, normal } => {
                let corners = square(*point, *normal);
                let faces = fan(&corners);
                (corners, faces, true)
            }
        };
        Self {
            corners,
            faces,
            solid,
            partial,
        }
    }

    /// Viewpoint number `k` of a sequence that fills faces, edges and inside.
    pub(super) fn viewpoint(&self, k: u64) -> DVec3 {
        let bits = mixed(k);
        let [a, b, c] = self.faces[(bits % self.faces.len() as u64) as usize];
        let unit = |x: u64| (x >> 11) as f64 / (1_u64 << 53) as f64;
        let (u, v) = (unit(mixed(bits)), unit(mixed(bits ^ 0x5555)));
        let (u, v) = if u + v > 1.0 {
            (1.0 - u, 1.0 - v)
        } else {
            (u, v)
        };
        match bits >> 60 {
            // On an edge, and inside.
            0..4 => a.lerp(b, u),
            4..8 if self.solid => {
                let other = self.corners[(mixed(!bits) % self.corners.len() as u64) as usize];
                other.lerp(a + (b - a) * u + (c - a) * v, unit(mixed(bits ^ 0xAAAA)))
            }
            _ => a + (b - a) * u + (c - a) * v,
        }
    }
}

/// A permutation of the numbers without a pattern (Steele, Lea & Flood 2014).
fn mixed(k: u64) -> u64 {
    let x = k.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let x = (x ^ x >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ x >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ x >> 31
}
