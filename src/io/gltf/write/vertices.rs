//! The vertices of a primitive: a place and a row of attribute values each, those of the source under one number with
//! the equal ones of the mesh.

use crate::{
    io::gltf::surface::PartSurface,
    mesh::{Channel, ChannelKind, Mesh, compare_rows, group_equal},
    num::Each,
};

/// A channel of the source, of the mesh, or of both.
pub(super) struct Column {
    pub kind: ChannelKind,
    pub channel: Option<Channel>,
    /// Where its values begin in a row of the source.
    source: Option<usize>,
    /// Where its values begin in a key.
    pub offset: usize,
}

/// The source and what the mesh has left of it.
pub(super) struct Vertices {
    pub columns: Vec<Column>,
    /// Place and row, one after the other, of every vertex of the source, then of every corner of the mesh that differs.
    keys: Vec<f64>,
    stride: usize,
    /// The first key of every group of equal ones.
    firsts: Vec<usize>,
    sources: usize,
    /// Triangles as groups.
    pub before: Vec<[u32; 3]>,
    pub after: Vec<[u32; 3]>,
}

impl Vertices {
    /// The vertices of a source, and of the triangles of the mesh that are left of it. O(n log n).
    pub(super) fn new(surface: &PartSurface, mesh: &Mesh, triangles: &[u32]) -> Self {
        let wedge = |t: u32, c: usize| {
            let corners = mesh.attributes().corners().get(t as usize);
            corners.map_or(0, |corners| corners[c])
        };
        let corners: Vec<(u32, u32)> = triangles
            .iter()
            .flat_map(|&t| [0, 1, 2].each(|c| (mesh.triangles()[t as usize][c], wedge(t, c))))
            .collect();
        let used = group_equal(corners.len(), &|a, b| corners[a].cmp(&corners[b]));
        let wedges: Vec<u32> = used.firsts.iter().map(|&i| corners[i].1).collect();
        let columns = columns(surface, mesh, &wedges);
        let stride = columns.iter().fold(3, |sum, c| sum + c.kind.width());
        let sources = surface.positions.len();
        let mut keys = Vec::with_capacity((sources + used.firsts.len()) * stride);
        let of_row = |v: usize, column: &Column| {
            let first = v * row_stride(surface) + column.source?;
            surface.rows.get(first..first + column.kind.width())
        };
        for (v, p) in surface.positions.iter().enumerate() {
            // Welding makes +0 of -0.
            keys.extend(p.to_array().each(|x| x + 0.0));
            for column in &columns {
                push(&mut keys, column.kind, of_row(v, column));
            }
        }
        for &i in &used.firsts {
            let (v, wedge) = corners[i];
            keys.extend(mesh.positions()[v as usize].to_array().each(|x| x + 0.0));
            for column in &columns {
                let channel = column.channel;
                push(
                    &mut keys,
                    column.kind,
                    channel.map(|c| mesh.attributes().value(c, wedge)),
                );
            }
        }
        let key = |i: usize| &keys[i * stride..][..stride];
        let united = group_equal(sources + used.firsts.len(), &|a, b| {
            compare_rows(key(a), key(b))
        });
        let before = surface.triangles.iter();
        let before = before.map(|t| t.each(|v| united.groups[v as usize]));
        let (after, _) = used.groups.as_chunks::<3>();
        let after = after.iter();
        let after = after.map(|t| t.each(|p| united.groups[sources + p as usize]));
        Self {
            before: before.collect(),
            after: after.collect(),
            firsts: united.firsts,
            columns,
            keys,
            stride,
            sources,
        }
    }

    /// Whether the mesh has the very triangles of the source, in any order. A triangle of which two corners are at one
    /// place does not count: reading drops it.
    pub(super) fn are_unchanged(&self) -> bool {
        let place = |group: u32| &self.key(group)[..3];
        let sorted = |triangles: &[[u32; 3]]| {
            let mut sorted: Vec<[u32; 3]> = Vec::with_capacity(triangles.len());
            for &t in triangles {
                let [a, b, c] = t.each(place);
                if [(a, b), (b, c), (c, a)]
                    .iter()
                    .all(|(a, b)| compare_rows(a, b).is_ne())
                {
                    let mut turned = t;
                    turned.rotate_left((0..3).min_by_key(|&c| t[c]).unwrap_or(0));
                    sorted.push(turned);
                }
            }
            sorted.sort_unstable();
            sorted
        };
        sorted(&self.before) == sorted(&self.after)
    }

    /// Place and row of a group.
    pub(super) fn key(&self, group: u32) -> &[f64] {
        &self.keys[self.firsts[group as usize] * self.stride..][..self.stride]
    }

    /// The vertex of the source in a group.
    pub(super) fn source(&self, group: u32) -> Option<usize> {
        Some(self.firsts[group as usize]).filter(|&first| first < self.sources)
    }
}

fn row_stride(surface: &PartSurface) -> usize {
    surface.kinds.iter().map(|k| k.width()).sum()
}

/// Appends a value; NaN where there is none.
fn push(keys: &mut Vec<f64>, kind: ChannelKind, value: Option<&[f64]>) {
    match value {
        Some(value) => keys.extend_from_slice(value),
        None => keys.resize(keys.len() + kind.width(), f64::NAN),
    }
}

/// The channels that have a value here: those of the source in its order, then those that only the mesh has.
fn columns(surface: &PartSurface, mesh: &Mesh, wedges: &[u32]) -> Vec<Column> {
    let attributes = mesh.attributes();
    let mut found: Vec<(ChannelKind, Option<usize>)> = Vec::new();
    let mut first = 0;
    for &kind in &surface.kinds {
        found.push((kind, Some(first)));
        first += kind.width();
    }
    for channel in attributes.channels() {
        if !surface.kinds.contains(&channel.kind) {
            found.push((channel.kind, None));
        }
    }
    let mut offset = 3;
    let mut columns = Vec::new();
    for (kind, source) in found {
        let channel = attributes.channel(kind);
        let in_source = source.is_some_and(|first| {
            let values = surface.rows.iter().skip(first).step_by(row_stride(surface));
            values.into_iter().any(|x| !x.is_nan())
        });
        let in_mesh = |c: Channel| wedges.iter().any(|&w| !attributes.value(c, w)[0].is_nan());
        if in_source || channel.is_some_and(in_mesh) {
            columns.push(Column {
                kind,
                channel,
                source,
                offset,
            });
            offset += kind.width();
        }
    }
    columns
}
