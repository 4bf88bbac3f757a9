//! Rows of attributes with other normals, or without.

use glam::DVec3;

use super::face::Faces;
use crate::{
    Error, Result,
    mesh::{Attributes, ChannelKind, Mesh, MeshParts, compare_rows, group_equal},
    num::{Precision, math::unit},
};

/// The mesh with these normals by slot; corners without one keep their rows. All other channels of a row stay, but
/// tangents turn with the normal.
pub(super) fn with_normals(mesh: Mesh, faces: &Faces, normals: &[Option<DVec3>]) -> Result<Mesh> {
    let attributes = mesh.attributes();
    let Some(channel) = attributes.channel(ChannelKind::Normal) else {
        return Ok(mesh);
    };
    let tangents = attributes.channel(ChannelKind::Tangent);
    let precision = mesh.precision();
    // By corner of the mesh: its wedge and its new normal, NaN where the row stays.
    let mut corners = vec![(0_u32, [f64::NAN; 3]); normals.len()];
    for (slot, &normal) in normals.iter().enumerate() {
        let t = slot / 3;
        let k = (usize::from(faces.0[t].first) + slot % 3) % 3;
        let value = normal.map_or([f64::NAN; 3], |n| rounded(n, precision));
        corners[3 * t + k] = (attributes.corners()[t][k], value);
    }
    let united = group_equal(corners.len(), &|a, b| {
        let ((v, m), (w, n)) = (&corners[a], &corners[b]);
        v.cmp(w).then_with(|| compare_rows(m, n))
    });
    let mut values = Vec::with_capacity(united.firsts.len() * attributes.stride());
    for &corner in &united.firsts {
        let (wedge, normal) = corners[corner];
        let start = values.len();
        values.extend_from_slice(attributes.row(wedge));
        let row: &mut [f64] = &mut values[start..];
        if normal[0].is_nan() || compare_rows(&row[channel.offset..][..3], &normal).is_eq() {
            continue;
        }
        row[channel.offset..][..3].copy_from_slice(&normal);
        if let Some(tangents) = tangents {
            turn(&mut row[tangents.offset..][..3], normal, precision);
        }
    }
    let kinds: Vec<ChannelKind> = attributes.channels().iter().map(|c| c.kind).collect();
    let (wedges, _) = united.groups.as_chunks::<3>();
    let attributes = Attributes::new(&kinds, values, wedges.to_vec()).map_err(Error::internal)?;
    remade(mesh, attributes)
}

/// The mesh without normals, tangents and what morph targets add to them.
pub(super) fn without_normals(mesh: Mesh) -> Result<Mesh> {
    let attributes = mesh.attributes();
    let stays = |kind: ChannelKind| match kind {
        ChannelKind::Normal | ChannelKind::Tangent => false,
        ChannelKind::Delta(number) => number.is_multiple_of(3),
        _ => true,
    };
    let channels = attributes.channels().iter();
    let channels: Vec<_> = channels.copied().filter(|c| stays(c.kind)).collect();
    let kinds: Vec<ChannelKind> = channels.iter().map(|c| c.kind).collect();
    let mut values = Vec::new();
    for wedge in 0..attributes.wedge_count() as u32 {
        for &channel in &channels {
            values.extend_from_slice(attributes.value(channel, wedge));
        }
    }
    let corners = attributes.corners().to_vec();
    let attributes = Attributes::new(&kinds, values, corners).map_err(Error::internal)?;
    remade(mesh, attributes)
}

fn remade(mesh: Mesh, attributes: Attributes) -> Result<Mesh> {
    let parts = MeshParts {
        attributes,
        ..mesh.into_parts()
    };
    Mesh::new(parts).map_err(Error::internal)
}

/// The number of different pairs of vertex and row. O(n log n).
pub(in crate::rooms::simplify) fn stored_vertices(mesh: &Mesh) -> usize {
    let attributes = mesh.attributes();
    let rows = group_equal(attributes.wedge_count(), &|a, b| {
        compare_rows(attributes.row(a as u32), attributes.row(b as u32))
    });
    let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(3 * mesh.triangles().len());
    for (t, vertices) in mesh.triangles().iter().enumerate() {
        for (k, &v) in vertices.iter().enumerate() {
            let wedge = attributes.corners().get(t).map(|wedges| wedges[k]);
            pairs.push((v, wedge.map_or(0, |w| rows.groups[w as usize])));
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs.len()
}

/// A direction as a mesh stores it; zero is positive.
fn rounded(direction: DVec3, precision: Precision) -> [f64; 3] {
    let rounded = precision.round_vector(direction) + DVec3::ZERO;
    rounded.to_array()
}

/// Turns a tangent into the plane across a normal; one that has no direction there stays.
fn turn(tangent: &mut [f64], normal: [f64; 3], precision: Precision) {
    let (t, n) = (
        DVec3::new(tangent[0], tangent[1], tangent[2]),
        DVec3::from_array(normal),
    );
    if let Some(turned) = unit(t - n * n.dot(t)) {
        tangent.copy_from_slice(&rounded(turned, precision));
    }
}
