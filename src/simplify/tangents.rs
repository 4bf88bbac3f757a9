//! Stored tangents of a simplified mesh: those that the collapses carried, or new ones by MikkTSpace (M. S. Mikkelsen,
//! "Simulation of Wrinkled Surfaces Revisited", 2008), by which painters of normal maps bake them.
//!
//! New ones follow from the positions, the normals and the first texture coordinates of the result, part by part: triangles
//! of one material, or of one primitive of a document. The fourth value is the sign of the bitangent: `normal x tangent`
//! times it points where the picture of the texture goes up. That is where v grows in OBJ and PLY, and where it falls in
//! glTF; so it is -1 where the texture is mirrored. The crate that computes in 32-bit floats takes its square root and its
//! arc cosine from `num::math`.

use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::normals::stored_vertices;
use crate::{
    Error, Result,
    mesh::{Attributes, Channel, ChannelKind, Mesh, MeshParts, compare_rows, group_equal},
    num::{Each, Frame, math},
    view::frame_of,
};

/// The largest distance of a tangent's squared length from 1; one that has no direction is 0.
const UNIT: f64 = 1e-3;

/// The way in which a simplified mesh gets its stored tangents.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Tangents {
    /// As the collapses carried them, turned with their normals; none where IN has none
    #[default]
    Carry,
    /// By MikkTSpace, wherever the result has texture coordinates and normals
    Recompute,
}

impl Tangents {
    /// True for [`Tangents::Carry`].
    pub(super) fn are_carried(&self) -> bool {
        *self == Self::Carry
    }

    /// The way that makes a difference to this mesh: [`Tangents::Carry`] where nothing can be computed.
    pub(super) fn of(self, mesh: &Mesh) -> Self {
        match Sources::of(mesh.attributes()) {
            Some(_) => self,
            None => Self::Carry,
        }
    }
}

/// The account of tangents that were computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct TangentsReport {
    /// Triangles that got tangents.
    pub triangles: usize,
    /// Triangles that have no texture coordinates, no normals, or corners that 32-bit floats do not tell apart: what they
    /// have of tangents is the carried ones.
    pub triangles_without: usize,
    /// Vertices of the result as files with one row of attributes per vertex store them.
    pub stored_vertices: usize,
}

/// The channels that tangents are made of.
#[derive(Clone, Copy)]
struct Sources {
    normals: Channel,
    texture: Channel,
}

impl Sources {
    fn of(attributes: &Attributes) -> Option<Self> {
        Some(Self {
            normals: attributes.channel(ChannelKind::Normal)?,
            texture: attributes.channel(ChannelKind::TexCoord(0))?,
        })
    }
}

/// Gives a mesh its tangents; the account of them where they are not the carried ones. Vertices, triangles and all other
/// values stay; corners whose tangents differ no longer share a wedge. O(n log n).
///
/// # Errors
/// [`Error::Internal`], should the mesh no longer be one (a bug).
pub fn settle(mesh: Mesh, tangents: Tangents) -> Result<(Mesh, Option<TangentsReport>)> {
    let sources = Sources::of(mesh.attributes()).filter(|_| tangents == Tangents::Recompute);
    let Some(sources) = sources else {
        return Ok((mesh, None));
    };
    let frame = frame_of(&mesh);
    let mut order: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
    let material = |t: u32| mesh.materials().of(t as usize);
    order.sort_by_key(|&t| material(t));
    let mut found = vec![[f64::NAN; 4]; 3 * order.len()];
    let mut triangles = 0;
    for part in order.chunk_by(|&a, &b| material(a) == material(b)) {
        let mut surface = Surface::of(&mesh, sources, frame, part);
        // No error is defined.
        let _ = generate_tangents(&mut surface);
        triangles += surface.triangles.len();
        surface.take(&mut found);
    }
    let triangles_without = order.len() - triangles;
    let mesh = with_tangents(mesh, &found)?;
    let report = TangentsReport {
        triangles,
        triangles_without,
        stored_vertices: stored_vertices(&mesh),
    };
    Ok((mesh, Some(report)))
}

/// A corner as the algorithm sees it, and the tangent that it finds.
#[derive(Clone, Copy, Default)]
struct Corner {
    position: [f32; 3],
    normal: [f32; 3],
    texture: [f32; 2],
    tangent: Option<[f32; 4]>,
}

/// The triangles of a part that have texture coordinates and normals.
struct Surface {
    triangles: Vec<u32>,
    corners: Vec<[Corner; 3]>,
    /// 1 where v grows upwards in the picture, -1 where it falls.
    up: f64,
}

impl Surface {
    fn of(mesh: &Mesh, sources: Sources, frame: Frame, part: &[u32]) -> Self {
        let mut surface = Self {
            triangles: Vec::with_capacity(part.len()),
            corners: Vec::with_capacity(part.len()),
            up: if mesh.materials().asset.is_some() {
                -1.0
            } else {
                1.0
            },
        };
        let attributes = mesh.attributes();
        for &t in part {
            let wedges = attributes.corners()[t as usize];
            let corners = [0, 1, 2].each(|k| {
                let at = mesh.triangles()[t as usize][k] as usize;
                let normal = attributes.value(sources.normals, wedges[k]);
                let texture = attributes.value(sources.texture, wedges[k]);
                Corner {
                    // Scaled by a power of two, so that no square overflows; -0 becomes +0.
                    position: frame
                        .enter(mesh.positions()[at])
                        .to_array()
                        .each(|x| x as f32 + 0.0),
                    normal: [0, 1, 2].each(|i| normal[i] as f32),
                    texture: [0, 1].each(|i| texture[i] as f32),
                    tangent: None,
                }
            });
            let is_whole = |c: &Corner| {
                let mut numbers = c.normal.iter().chain(&c.texture);
                numbers.all(|x| x.is_finite())
            };
            // Each one whose corners meet would cost a search of all others.
            let [a, b, c] = corners.each(|corner| corner.position.each(f32::to_bits));
            let is_point = a == b || b == c || c == a;
            if !is_point && corners.iter().all(is_whole) {
                surface.triangles.push(t);
                surface.corners.push(corners);
            }
        }
        surface
    }

    /// Puts the tangents in their places by corner of the mesh.
    fn take(&self, found: &mut [[f64; 4]]) {
        for (&t, corners) in self.triangles.iter().zip(&self.corners) {
            for (corner, into) in corners.iter().zip(&mut found[3 * t as usize..]) {
                *into = self.tangent(corner);
            }
        }
    }

    /// The tangent of a corner; across its normal, whichever way, where the texture has no direction there.
    fn tangent(&self, corner: &Corner) -> [f64; 4] {
        if let Some([x, y, z, sign]) = corner.tangent.map(|t| t.each(f64::from)) {
            let length2 = (x * x + y * y) + z * z;
            if (length2 - 1.0).abs() <= UNIT {
                return [x, y, z, sign * self.up];
            }
        }
        let [x, y, z] = corner.normal.each(f64::from);
        let normal = DVec3::new(x, y, z);
        let [x, y, z] = [x, y, z].each(f64::abs);
        let axis = if x <= y && x <= z {
            DVec3::X
        } else if y <= z {
            DVec3::Y
        } else {
            DVec3::Z
        };
        let across = math::unit(normal.cross(axis)).unwrap_or(DVec3::X);
        let [x, y, z] = across.to_array().each(|x| f64::from(x as f32));
        [x, y, z, 1.0]
    }
}

/// Roots and arcs with the same bits on every platform.
struct Exact;

impl Ops for Exact {
    fn sqrt(x: f32) -> f32 {
        // Twice rounded is once rounded here: 53 bits are more than twice 24, and 2.
        math::sqrt(f64::from(x)) as f32
    }

    fn acos(x: f32) -> f32 {
        math::acos(f64::from(x)) as f32
    }
}

impl Geometry<Exact> for Surface {
    fn num_faces(&self) -> usize {
        self.corners.len()
    }

    fn num_vertices_of_face(&self, _: usize) -> usize {
        3
    }

    fn position(&self, face: usize, vert: usize) -> [f32; 3] {
        self.corners[face][vert].position
    }

    fn normal(&self, face: usize, vert: usize) -> [f32; 3] {
        self.corners[face][vert].normal
    }

    fn tex_coord(&self, face: usize, vert: usize) -> [f32; 2] {
        self.corners[face][vert].texture
    }

    fn set_tangent(&mut self, found: Option<TangentSpace>, face: usize, vert: usize) {
        self.corners[face][vert].tangent = found.map(|space| space.tangent_encoded());
    }
}

/// The mesh with these tangents by corner; NaN stands for what the corner has.
fn with_tangents(mesh: Mesh, found: &[[f64; 4]]) -> Result<Mesh> {
    let attributes = mesh.attributes();
    let wedges = attributes.corners().as_flattened();
    let united = group_equal(found.len(), &|a, b| {
        let by_wedge = wedges[a].cmp(&wedges[b]);
        by_wedge.then_with(|| compare_rows(&found[a], &found[b]))
    });
    let mut kinds: Vec<ChannelKind> = attributes.channels().iter().map(|c| c.kind).collect();
    let own = attributes.channel(ChannelKind::Tangent);
    let offset = own.map_or(attributes.stride(), |channel| channel.offset);
    if own.is_none() {
        kinds.push(ChannelKind::Tangent);
    }
    let mut values = Vec::new();
    for &corner in &united.firsts {
        let start = values.len();
        values.extend_from_slice(attributes.row(wedges[corner]));
        if own.is_none() {
            values.extend([f64::NAN; 4]);
        }
        let tangent = found[corner];
        if !tangent[0].is_nan() {
            values[start + offset..][..4].copy_from_slice(&tangent);
        }
    }
    let (corners, _) = united.groups.as_chunks::<3>();
    let attributes = Attributes::new(&kinds, values, corners.to_vec()).map_err(Error::internal)?;
    let parts = MeshParts {
        attributes,
        ..mesh.into_parts()
    };
    Mesh::new(parts).map_err(Error::internal)
}
