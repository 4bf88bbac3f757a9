//! Angles between points as seen from viewpoints, and viewpoints in a cell, for the verifier alone.

use glam::DVec3;

use crate::{
    bound::view_cell::{Shape, ViewCell},
    num::math::{atan2, length},
};

/// Half the side of the part of an endless cell that viewpoints are taken from, in sizes of the original, and in sizes
/// and distances together: displacements of some size are seen larger from there than from anywhere beyond.
const REACH: [f64; 2] = [4.0, 3.0];

/// The square of the tangent of the angle between `p` and `s` seen from `v`; infinite from a right angle on, and where
/// numbers are too large or small to tell.
#[inline]
pub(super) fn tangent2(p: DVec3, s: DVec3, v: DVec3) -> f64 {
    let (r, d) = (p - v, s - p);
    let across = r.cross(d);
    let across = across.dot(across);
    let along = r.dot(s - v);
    if d.dot(d) == 0.0 {
        return 0.0;
    }
    let square = across / (along * along);
    if along > 0.0 && !square.is_nan() {
        square
    } else {
        f64::INFINITY
    }
}

/// The angle in radians; 0 for equal points, pi where one of two is the viewpoint: it lies in all directions.
pub(super) fn angle(p: DVec3, s: DVec3, v: DVec3) -> f64 {
    let (r, d) = (p - v, s - p);
    if d.dot(d) > 0.0 && (p == v || s == v) {
        std::f64::consts::PI
    } else if d.dot(d) > 0.0 {
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
    /// Simplices that together are the cell, or that part of it.
    pub(super) parts: Vec<Vec<DVec3>>,
    /// Only a part of an endless cell: viewpoints from here on, from the foot of the original's centre, are left out.
    pub(super) end: Option<f64>,
    centre: DVec3,
    /// A point of the boundary of a half-space and the direction out of it.
    half_space: Option<[DVec3; 2]>,
}

impl Viewpoints {
    /// For an original with the given centre and size.
    pub(super) fn new(cell: &ViewCell, centre: DVec3, size: f64) -> Self {
        let fan = |corners: &[DVec3]| -> Vec<[DVec3; 3]> {
            (2..corners.len())
                .map(|i| [corners[0], corners[i - 1], corners[i]])
                .collect()
        };
        let reach = |foot: DVec3| (REACH[0] * size).max(REACH[1] * (length(centre - foot) + size));
        let square = |point: DVec3, normal: DVec3| -> Vec<DVec3> {
            let foot = centre - normal * (centre - point).dot(normal);
            let side = if normal.x.abs() < 0.8 {
                DVec3::X
            } else {
                DVec3::Y
            };
            let a = normal.cross(side).normalize_or_zero() * reach(foot);
            let b = normal.cross(a);
            vec![foot - a - b, foot + a - b, foot + a + b, foot - a + b]
        };
        let mut solid = false;
        let (corners, faces, end): (Vec<DVec3>, Vec<[DVec3; 3]>, _) = match cell.shape() {
            Shape::Point(at) => (vec![*at], vec![[*at; 3]], None),
            Shape::Segment([a, b]) => (vec![*a, *b], vec![[*a, *b, *b]], None),
            Shape::Polygon { corners, .. } => (corners.clone(), fan(corners), None),
            Shape::Polyhedron { corners, faces, .. } => {
                solid = true;
                let face = |f: &Vec<u32>| -> Vec<DVec3> {
                    f.iter().map(|&v| corners[v as usize]).collect()
                };
                let all = faces.iter().flat_map(|f| fan(&face(f))).collect();
                (corners.clone(), all, None)
            }
            Shape::Line { point, direction } => {
                let foot = *point + *direction * (centre - *point).dot(*direction);
                let way = *direction * reach(foot);
                let ends = [foot - way, foot + way];
                (
                    ends.to_vec(),
                    vec![[ends[0], ends[1], ends[1]]],
                    Some(reach(foot)),
                )
            }
            Shape::Plane { point, normal } | Shape::HalfSpace { point, normal } => {
                let corners = square(*point, *normal);
                let faces = fan(&corners);
                let foot = (corners[0] + corners[2]) * 0.5;
                (corners, faces, Some(reach(foot)))
            }
        };
        let parts = match (corners.len(), solid) {
            (1 | 2, _) => vec![corners.clone()],
            (_, false) => faces.iter().map(|f| f.to_vec()).collect(),
            // Convex: tetrahedra from one corner.
            (_, true) => faces
                .iter()
                .filter(|f| !f.contains(&corners[0]))
                .map(|&[a, b, c]| vec![corners[0], a, b, c])
                .collect(),
        };
        Self {
            corners,
            faces,
            solid,
            parts,
            end,
            centre,
            half_space: match cell.shape() {
                Shape::HalfSpace { point, normal } => Some([*point, *normal]),
                _ => None,
            },
        }
    }

    /// No viewpoint that is left out sees one of `points` and what stands for it, at most `moved` away, under an angle
    /// with a larger tangent. All others that are not in [`Self::parts`] are inside a half-space, and see no more than
    /// those as long as the points are outside of it: the viewpoints that see more are connected with the points.
    pub(super) fn beyond(&self, points: impl Iterator<Item = DVec3> + Clone, moved: f64) -> f64 {
        if moved <= 0.0 {
            return 0.0;
        }
        if points.clone().any(|p| self.holds(p)) {
            return f64::INFINITY;
        }
        let Some(end) = self.end else { return 0.0 };
        let far = points.fold(0.0_f64, |far, p| far.max(length(p - self.centre)));
        let rest = end - far - moved;
        if rest > 0.0 {
            moved / rest
        } else {
            f64::INFINITY
        }
    }

    /// True for a point in a half-space: a viewer may be there.
    pub(super) fn holds(&self, p: DVec3) -> bool {
        self.half_space
            .is_some_and(|[at, out]| (p - at).dot(out) <= 0.0)
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
