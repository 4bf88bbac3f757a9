//! The identity of a mesh: a hash of its content.

use sha2::{Digest, Sha256};

use crate::{
    mesh::{ChannelKind, Mesh},
    num::Precision,
};

/// SHA-256 of everything a mesh says: positions, triangles, attributes, materials, in their order.
///
/// Numbers are little-endian, lists start with their length as `u64`; positions and values are `f64` bits.
#[must_use]
pub fn content_sha256(mesh: &Mesh) -> [u8; 32] {
    let mut sha = Sha256::new();
    let length = |sha: &mut Sha256, n: usize| sha.update((n as u64).to_le_bytes());
    sha.update([u8::from(mesh.precision() == Precision::F64)]);
    length(&mut sha, mesh.positions().len());
    for p in mesh.positions() {
        for x in p.to_array() {
            sha.update(x.to_bits().to_le_bytes());
        }
    }
    let triples = |sha: &mut Sha256, triples: &[[u32; 3]]| {
        length(sha, triples.len());
        for i in triples.iter().flatten() {
            sha.update(i.to_le_bytes());
        }
    };
    triples(&mut sha, mesh.triangles());
    let attributes = mesh.attributes();
    length(&mut sha, attributes.channels().len());
    for channel in attributes.channels() {
        let code = match channel.kind {
            ChannelKind::Normal => [0, 0],
            ChannelKind::TexCoord(set) => [1, set],
            ChannelKind::Color => [2, 0],
            ChannelKind::ColorAlpha => [3, 0],
        };
        sha.update(code);
    }
    length(&mut sha, attributes.values().len());
    for x in attributes.values() {
        sha.update(x.to_bits().to_le_bytes());
    }
    triples(&mut sha, attributes.corners());
    let materials = mesh.materials();
    for names in [&materials.names, &materials.libraries] {
        length(&mut sha, names.len());
        for name in names {
            length(&mut sha, name.len());
            sha.update(name.as_bytes());
        }
    }
    length(&mut sha, materials.of_triangle.len());
    for m in &materials.of_triangle {
        sha.update(m.to_le_bytes());
    }
    sha.finalize().into()
}
