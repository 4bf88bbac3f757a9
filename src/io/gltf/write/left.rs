//! The vertices that are left of a part, with the values that its primitive gets.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat3, DVec3};

use super::vertices::{Column, Vertices};
use crate::{io::gltf::surface::PartSurface, mesh::ChannelKind, num::math};

/// The rest of a part after a run: its vertices in the order of their first use.
pub(super) struct Left {
    pub groups: Vec<u32>,
    /// The vertex of the source, where it is one.
    pub sources: Vec<Option<usize>>,
    /// A triangle at every vertex, for its normal.
    triangle_of: Vec<[u32; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

impl Left {
    pub(super) fn of(vertices: &Vertices, mirrored: bool) -> Self {
        let mut left = Self {
            groups: Vec::new(),
            sources: Vec::new(),
            triangle_of: Vec::new(),
            triangles: Vec::with_capacity(vertices.after.len()),
        };
        let mut numbers = BTreeMap::new();
        for &groups in &vertices.after {
            let mut corners = [0; 3];
            for (corner, group) in corners.iter_mut().zip(groups) {
                *corner = *numbers.entry(group).or_insert_with(|| {
                    left.groups.push(group);
                    left.sources.push(vertices.source(group));
                    left.triangle_of.push(groups);
                    left.groups.len() as u32 - 1
                });
            }
            if mirrored {
                corners.swap(1, 2);
            }
            left.triangles.push(corners);
        }
        left
    }

    /// One triangle without area at a vertex of the source.
    pub(super) fn point(vertices: &Vertices, group: u32) -> Self {
        Self {
            groups: vec![group],
            sources: vec![vertices.source(group)],
            triangle_of: vec![[group; 3]],
            triangles: vec![[0; 3]],
        }
    }

    pub(super) fn places(
        &self,
        surface: &PartSurface,
        vertices: &Vertices,
        back: &Back,
    ) -> Vec<f64> {
        let place = |(&group, source): (&u32, &Option<usize>)| match source {
            Some(vertex) => surface.local[*vertex].map(f64::from),
            None => {
                let key = vertices.key(group);
                let p = DVec3::new(key[0], key[1], key[2]);
                back.inverse.transform_point3(p).to_array()
            }
        };
        self.groups
            .iter()
            .zip(&self.sources)
            .flat_map(place)
            .collect()
    }

    /// The values of a channel at every vertex, as the primitive has them.
    pub(super) fn rows(&self, column: &Column, vertices: &Vertices, back: &Back) -> Vec<f64> {
        let width = column.kind.width();
        let mut rows = Vec::with_capacity(self.groups.len() * width);
        for (&group, triangle) in self.groups.iter().zip(&self.triangle_of) {
            let value = &vertices.key(group)[column.offset..][..width];
            let at = rows.len();
            if value[0].is_nan() {
                let corner = |c: usize| {
                    let key = vertices.key(triangle[c]);
                    DVec3::new(key[0], key[1], key[2])
                };
                let normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
                rows.extend_from_slice(&absent(column.kind, normal)[..width]);
            } else {
                rows.extend_from_slice(value);
            }
            back.turn(column.kind, &mut rows[at..]);
        }
        rows
    }
}

/// A value in place of one that is absent, where the primitive has others.
fn absent(kind: ChannelKind, normal: DVec3) -> [f64; 8] {
    let mut value = [0.0; 8];
    match kind {
        ChannelKind::Normal => {
            let unit = math::unit(normal).unwrap_or(DVec3::Z);
            value[..3].copy_from_slice(&unit.to_array());
        }
        ChannelKind::Tangent => (value[0], value[3]) = (1.0, 1.0),
        ChannelKind::Skin(_) => value[4] = 1.0,
        ChannelKind::Color | ChannelKind::ColorAlpha => value.fill(1.0),
        _ => {}
    }
    value
}

/// From the coordinates of the mesh to those of a primitive.
pub(super) struct Back {
    inverse: DAffine3,
    /// Of the placement, for normals.
    transpose: DMat3,
    pub mirrored: bool,
}

impl Back {
    pub(super) fn of(placement: DAffine3) -> Self {
        Self {
            inverse: placement.inverse(),
            transpose: placement.matrix3.transpose(),
            mirrored: placement.matrix3.determinant() < 0.0,
        }
    }

    /// Turns a value of the mesh into that of the primitive.
    fn turn(&self, kind: ChannelKind, value: &mut [f64]) {
        let direction = match kind {
            ChannelKind::Normal | ChannelKind::Tangent | ChannelKind::Delta(_) => {
                DVec3::new(value[0], value[1], value[2])
            }
            _ => return,
        };
        let is_normal = match kind {
            ChannelKind::Delta(number) => number % 3 == 1,
            _ => kind == ChannelKind::Normal,
        };
        let linear = if is_normal {
            self.transpose
        } else {
            self.inverse.matrix3
        };
        let mut turned = linear * direction;
        if !matches!(kind, ChannelKind::Delta(_)) {
            turned = math::unit(turned).unwrap_or(direction);
        }
        value[..3].copy_from_slice(&turned.to_array());
        if kind == ChannelKind::Tangent && self.mirrored {
            value[3] = -value[3];
        }
    }
}
