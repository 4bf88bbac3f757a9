//! Writes STL, text and binary. Facet normals are computed; a triangle without area gets the normal 0.

use glam::DVec3;

use crate::{
    Error, Result,
    io::decimal,
    mesh::Mesh,
    num::{Frame, Precision, math},
};

pub(in crate::rooms::io) fn encode(mesh: &Mesh, text: bool) -> Result<(Vec<u8>, Vec<String>)> {
    let notes = notes(mesh);
    for (v, &p) in mesh.positions().iter().enumerate() {
        if !Precision::F32.round_vector(p).is_finite() {
            return Err(Error::Unsupported(format!(
                "STL stores 32-bit floats, which cannot hold vertex {v} at ({}, {}, {}); write .ply or .obj",
                p.x, p.y, p.z
            )));
        }
    }
    // The binary header must not begin with `solid`.
    let mut bytes = if text {
        b"solid lodmark\n".to_vec()
    } else {
        let mut header = b"STL written by lodmark".to_vec();
        header.resize(80, b' ');
        header.extend_from_slice(&(mesh.triangles().len() as u32).to_le_bytes());
        header
    };
    for t in 0..mesh.triangles().len() {
        let corners = mesh.corners(t);
        let rows = [normal(corners), corners[0], corners[1], corners[2]];
        if text {
            for (row, lead) in
                rows.iter()
                    .zip(["facet normal", "outer loop\nvertex", "vertex", "vertex"])
            {
                bytes.extend_from_slice(lead.as_bytes());
                for x in row.to_array() {
                    bytes.push(b' ');
                    decimal::push(&mut bytes, x, Precision::F32);
                }
                bytes.push(b'\n');
            }
            bytes.extend_from_slice(b"endloop\nendfacet\n");
        } else {
            for x in rows.iter().flat_map(DVec3::to_array) {
                bytes.extend_from_slice(&(x as f32).to_le_bytes());
            }
            bytes.extend_from_slice(&[0, 0]);
        }
    }
    if text {
        bytes.extend_from_slice(b"endsolid lodmark\n");
    }
    Ok((bytes, notes))
}

fn notes(mesh: &Mesh) -> Vec<String> {
    let mut notes = Vec::new();
    if mesh.precision() == Precision::F64 {
        notes.push(
            "STL stores 32-bit floats: the coordinates are rounded; .ply and .obj keep them".into(),
        );
    }
    if !mesh.attributes().is_empty() {
        notes.push(
            "STL cannot keep normals, texture coordinates and colours; .ply and .obj can".into(),
        );
    }
    if !mesh.materials().names.is_empty() {
        notes.push("STL cannot keep materials; .obj can".into());
    }
    notes
}

/// The unit normal of a triangle; 0 where it has none.
fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    // In a frame of size 1 the products neither overflow nor vanish.
    let (u, v) = (b * 0.5 - a * 0.5, c * 0.5 - a * 0.5);
    let frame = Frame::for_size(u.abs().max_element().max(v.abs().max_element()));
    math::unit(frame.enter(u).cross(frame.enter(v))).unwrap_or(DVec3::ZERO)
}
