//! The surface of a document: the triangles of its primitives as the default scene places them, with their attributes.

use glam::DVec3;

use super::{
    accessor::{self, Elements},
    attributes::{self, Channels},
    buffers::Views,
    document::{DRACO, Document, Primitive},
    placed, wrong,
};
use crate::{
    Error, Result,
    io::attribute_rows::settle,
    mesh::{Asset, AssetPart, ChannelKind},
    num::Precision,
};

/// A primitive as part of the mesh: the vertices that its triangles use.
#[derive(Default)]
pub(super) struct PartSurface {
    /// The number of every vertex among those that the primitive stores; increasing.
    pub source: Vec<u32>,
    /// Positions as stored, normalized ones divided.
    pub local: Vec<[f32; 3]>,
    /// Positions in the mesh, rounded to 32-bit floats.
    pub positions: Vec<DVec3>,
    /// The channels of all parts of the mesh, in the order that its rows have.
    pub kinds: Vec<ChannelKind>,
    /// A row for every vertex, in the mesh; NaN where the primitive has no such attribute.
    pub rows: Vec<f64>,
    /// Vertices of every triangle, turned as in the mesh.
    pub triangles: Vec<[u32; 3]>,
}

/// Reads a part of the mesh as it was before it became one. O(vertices of the primitive).
///
/// # Errors
/// [`Error::Input`] where accessors do not hold what the primitive needs; [`Error::Unsupported`] for Draco compression.
pub(super) fn part_corners(
    document: &Document,
    views: &Views<'_>,
    asset: &Asset,
    part: usize,
) -> Result<PartSurface> {
    let channels = Channels::of(document, &asset.parts, &asset.customs);
    read(document, views, &channels, &asset.parts[part])
}

/// Reads a part whose channels are known.
pub(super) fn read(
    document: &Document,
    views: &Views<'_>,
    channels: &Channels<'_>,
    part: &AssetPart,
) -> Result<PartSurface> {
    let primitive = attributes::primitive(document, part);
    read_primitive(document, views, channels, part, primitive).map_err(|error| {
        placed(
            error,
            &format!("meshes[{}], primitive {}", part.mesh, part.primitive),
        )
    })
}

fn read_primitive(
    document: &Document,
    views: &Views<'_>,
    channels: &Channels<'_>,
    part: &AssetPart,
    primitive: &Primitive,
) -> Result<PartSurface> {
    let Some(&position) = primitive.attributes.get("POSITION") else {
        return Err(wrong("there is no attribute POSITION"));
    };
    let elements = Elements::open(document, views, position)?;
    if primitive.extensions.draco.is_some() && document.accessors[position].buffer_view.is_none() {
        return Err(Error::Unsupported(DRACO.into()));
    }
    if elements.width() != 3 {
        return Err(wrong(format!(
            "accessors[{position}] has {} components; expected 3 of a position",
            elements.width()
        )));
    }
    let corners = match primitive.indices {
        Some(indices) => accessor::indices(document, views, indices)?,
        None => {
            views.spend(elements.count)?;
            (0..elements.count as u32).collect()
        }
    };
    let mut triangles = unroll(primitive.mode.unwrap_or(4), &corners)?;
    drop(corners);
    if part.placement.matrix3.determinant() < 0.0 {
        triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    let source = compact(&mut triangles, elements.count)?;
    let (mut local, mut positions) = (
        Vec::with_capacity(source.len()),
        Vec::with_capacity(source.len()),
    );
    for &vertex in &source {
        let mut stored = [0.0; 3];
        elements.read(vertex as usize, &mut stored);
        let stored = stored.map(|x| x as f32);
        let point = DVec3::from_array(stored.map(f64::from));
        let there = Precision::F32.round_vector(part.placement.transform_point3(point));
        if !there.is_finite() {
            return Err(wrong(format!(
                "vertex {vertex} is ({}, {}, {}), and ({}, {}, {}) in the scene; expected finite 32-bit floats",
                point.x, point.y, point.z, there.x, there.y, there.z
            )));
        }
        local.push(stored);
        positions.push(there);
    }
    let mut rows = channels.rows(views, primitive, elements.count, &source)?;
    attributes::place(&mut rows, &channels.kinds, &part.placement);
    settle(&mut rows, &channels.kinds, Precision::F32);
    Ok(PartSurface {
        source,
        local,
        positions,
        kinds: channels.kinds.clone(),
        rows,
        triangles,
    })
}

/// The triangles of a primitive whose corners are given; what is left over at the end makes none.
fn unroll(mode: u32, corners: &[u32]) -> Result<Vec<[u32; 3]>> {
    let windows = corners.windows(3);
    Ok(match mode {
        4 => corners.as_chunks::<3>().0.to_vec(),
        5 => (0..)
            .zip(windows)
            .map(|(i, w)| {
                if i % 2 == 0 {
                    [w[0], w[1], w[2]]
                } else {
                    [w[0], w[2], w[1]]
                }
            })
            .collect(),
        6 => {
            let pairs = corners.windows(2).skip(1);
            pairs.map(|pair| [pair[0], pair[1], corners[0]]).collect()
        }
        _ => return Err(wrong(format!("unknown mode {mode}; expected 0 to 6"))),
    })
}

/// Replaces the vertices of triangles by numbers among those that are used, and returns these, increasing.
fn compact(triangles: &mut [[u32; 3]], count: usize) -> Result<Vec<u32>> {
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    match used.last() {
        Some(&last) if last as usize >= count => {
            return Err(wrong(format!(
                "an index is {last}, but there are {count} vertices"
            )));
        }
        _ => {}
    }
    // Most primitives use all their vertices.
    if used.len() < used.last().map_or(0, |&last| last as usize + 1) {
        for vertex in triangles.iter_mut().flatten() {
            let number = used.binary_search(vertex).unwrap_or_default();
            *vertex = number as u32;
        }
    }
    Ok(used)
}
