//! The faces of a simplified mesh, with what their normals are made of.
//!
//! A *slot* is a corner of a face: three times its number, plus the place of the corner where the one with the smallest
//! vertex comes first. So no result depends on the corner that a triangle starts at.

use glam::DVec3;

use crate::{
    geometry::area_normal,
    mesh::{Channel, ChannelKind, Mesh},
    num::{Each, Frame, math::unit},
    parallel,
};

/// A face in units of the frame, its corners in the order of its slots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    /// Vertices of the mesh.
    pub vertices: [u32; 3],
    /// Places of the vertices.
    pub points: [DVec3; 3],
    /// The corner of the triangle that comes first.
    pub first: u8,
    /// The normal, twice as long as the area is large; zero where the area cannot be told from none.
    pub normal: DVec3,
    /// The carried normals, made unit; zero where a corner has none.
    pub carried: [DVec3; 3],
    /// Whether all carried normals are unit as they are stored.
    pub is_unit: bool,
    /// Number of the material.
    pub material: u32,
    /// Whether its part of the original has normals at all.
    pub has_normals: bool,
}

/// The faces of a simplified mesh.
#[derive(Clone, Debug)]
pub(super) struct Faces(pub(super) Vec<Face>);

/// The largest distance of a unit normal's squared length from 1: normals are stored in bytes, too.
const UNIT: f64 = 1e-3;

impl Faces {
    /// The faces of `simplified`; which parts have normals is for the original to say.
    pub(super) fn of(original: &Mesh, simplified: &Mesh, frame: Frame) -> Self {
        let parts = parts_with_normals(original);
        let channel = simplified.attributes().channel(ChannelKind::Normal);
        let face = |t: usize| {
            let (vertices, first) = from_smallest(simplified.triangles()[t]);
            let points = vertices.each(|v| frame.enter(simplified.positions()[v as usize]));
            let material = simplified.materials().of(t);
            let normals = normals_of(simplified, channel, t, first);
            let is_unit = |n: DVec3| (n.dot(n) - 1.0).abs() <= UNIT;
            Face {
                vertices,
                points,
                first: first as u8,
                normal: sound_normal(points),
                carried: normals.each(|n| unit(n).unwrap_or(DVec3::ZERO)),
                is_unit: normals.iter().all(|&n| is_unit(n)),
                material,
                has_normals: parts[part(material, parts.len())],
            }
        };
        Self(parallel::map(simplified.triangles().len(), face))
    }

    /// The direction of the face of a slot; zero where it has no area.
    pub(super) fn direction(&self, slot: usize) -> DVec3 {
        unit(self.0[slot / 3].normal).unwrap_or(DVec3::ZERO)
    }

    /// The carried normal of a slot; zero where it has none.
    pub(super) fn carried(&self, slot: usize) -> DVec3 {
        self.0[slot / 3].carried[slot % 3]
    }

    /// The slot of a face at a vertex that it has.
    pub(super) fn slot(&self, t: usize, vertex: u32) -> usize {
        let found = self.0[t].vertices.iter().position(|&v| v == vertex);
        3 * t + found.unwrap_or(0)
    }

    /// Whether the faces of both slots have an area and normals.
    pub(super) fn are_shown(&self, a: usize, b: usize) -> bool {
        let is_shown = |slot: usize| {
            let face = &self.0[slot / 3];
            face.has_normals && face.normal != DVec3::ZERO
        };
        is_shown(a) && is_shown(b)
    }
}

/// A triangle from its smallest vertex on, and the corner that has it.
pub(super) fn from_smallest(triangle: [u32; 3]) -> ([u32; 3], usize) {
    let [a, b, c] = triangle;
    if a <= b && a <= c {
        (triangle, 0)
    } else if b <= c {
        ([b, c, a], 1)
    } else {
        ([c, a, b], 2)
    }
}

/// The stored normals of a triangle from corner `first` on; NaN where there are none.
pub(super) fn normals_of(
    mesh: &Mesh,
    channel: Option<Channel>,
    triangle: usize,
    first: usize,
) -> [DVec3; 3] {
    let Some(channel) = channel else {
        return [DVec3::NAN; 3];
    };
    let wedges = mesh.attributes().corners()[triangle];
    [0, 1, 2].each(|k| {
        let value = mesh.attributes().value(channel, wedges[(first + k) % 3]);
        DVec3::new(value[0], value[1], value[2])
    })
}

/// The area normal of a triangle, or zero where rounding decides its direction: its height is below 2^-40 of its longest
/// side.
fn sound_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    const SLIVER: f64 = 9e-13;
    let normal = area_normal([a, b, c]);
    let longest = [b - a, c - b, a - c]
        .iter()
        .fold(0.0, |most: f64, side| most.max(side.dot(*side)));
    if normal.dot(normal) > (SLIVER * longest) * (SLIVER * longest) {
        normal
    } else {
        DVec3::ZERO
    }
}

/// By part, one for each material and one for triangles without: whether any corner has a normal.
fn parts_with_normals(mesh: &Mesh) -> Vec<bool> {
    let mut parts = vec![false; mesh.materials().names.len() + 1];
    let count = parts.len();
    let channel = mesh.attributes().channel(ChannelKind::Normal);
    for t in 0..mesh.triangles().len() {
        let some = normals_of(mesh, channel, t, 0).iter().any(|n| !n.is_nan());
        parts[part(mesh.materials().of(t), count)] |= some;
    }
    parts
}

/// The part of a material among `count`, of which the last is of triangles without.
fn part(material: u32, count: usize) -> usize {
    (material as usize).min(count - 1)
}
