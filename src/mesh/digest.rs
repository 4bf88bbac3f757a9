//! A fingerprint of a mesh's content, to pin results on.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use super::{ChannelKind, Mesh};
use crate::num::Precision;

/// SHA-256 of everything a mesh holds, as 64 lower-case hexadecimal digits. Two meshes have equal digests where all
/// their bits, the order of their parts and their precision are equal. O(n).
///
/// Hashed in this order, numbers in little-endian, every list led by its length as `u64`: the text
/// `lodmark mesh 1`, the bits per coordinate (`u64`), positions (3 `f64` each), triangles (3 `u32` each), channels (kind
/// and set, 2 bytes each), attribute values (`f64`), corners (3 `u32` each), material names (UTF-8), the material of
/// every triangle (`u32`), material libraries (UTF-8).
pub fn content_sha256(mesh: &Mesh) -> String {
    let mut digits = String::with_capacity(64);
    for byte in content_digest(mesh) {
        // Writing to a String cannot fail.
        let _ = write!(digits, "{byte:02x}");
    }
    digits
}

/// The 32 bytes of [`content_sha256`].
pub fn content_digest(mesh: &Mesh) -> [u8; 32] {
    let mut sink = Sink {
        hash: Sha256::new(),
        pending: Vec::with_capacity(BLOCK + 32),
    };
    sink.bytes(b"lodmark mesh 1");
    sink.length(match mesh.precision() {
        Precision::F32 => 32,
        Precision::F64 => 64,
    });
    sink.length(mesh.positions().len());
    for p in mesh.positions() {
        for x in p.to_array() {
            sink.bytes(&x.to_le_bytes());
        }
    }
    sink.triples(mesh.triangles());
    let attributes = mesh.attributes();
    sink.length(attributes.channels().len());
    for channel in attributes.channels() {
        sink.bytes(&match channel.kind {
            ChannelKind::Normal => [0, 0],
            ChannelKind::TexCoord(set) => [1, set],
            ChannelKind::Color => [2, 0],
            ChannelKind::ColorAlpha => [3, 0],
            ChannelKind::Tangent => [4, 0],
            ChannelKind::Skin(set) => [5, set],
            ChannelKind::Custom { number, width } => [5 + width, number],
            ChannelKind::Delta(n) => [16 + (n >> 8) as u8, n as u8],
        });
    }
    sink.length(attributes.values().len());
    for x in attributes.values() {
        sink.bytes(&x.to_le_bytes());
    }
    sink.triples(attributes.corners());
    let materials = mesh.materials();
    sink.texts(&materials.names);
    sink.length(materials.of_triangle.len());
    for &m in &materials.of_triangle {
        sink.bytes(&m.to_le_bytes());
    }
    sink.texts(&materials.libraries);
    sink.finish()
}

/// Bytes handed to the hash at a time: one call per number would take most of the time.
const BLOCK: usize = 1 << 14;

struct Sink {
    hash: Sha256,
    pending: Vec<u8>,
}

impl Sink {
    fn bytes(&mut self, bytes: &[u8]) {
        self.pending.extend_from_slice(bytes);
        if self.pending.len() >= BLOCK {
            self.hash.update(&self.pending);
            self.pending.clear();
        }
    }

    fn length(&mut self, length: usize) {
        self.bytes(&(length as u64).to_le_bytes());
    }

    fn triples(&mut self, triples: &[[u32; 3]]) {
        self.length(triples.len());
        for x in triples.iter().flatten() {
            self.bytes(&x.to_le_bytes());
        }
    }

    fn texts(&mut self, texts: &[String]) {
        self.length(texts.len());
        for text in texts {
            self.length(text.len());
            self.bytes(text.as_bytes());
        }
    }

    fn finish(mut self) -> [u8; 32] {
        self.hash.update(&self.pending);
        self.hash.finalize().into()
    }
}
