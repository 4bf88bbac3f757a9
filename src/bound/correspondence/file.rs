//! A correspondence as bytes, for programs that check it or carry textures over: `lodmark simplify --method view-bounded
//! --bound-out FILE` writes it, `lodmark verify --bound FILE` and `lodmark bound --correspondence FILE` read it.
//!
//! Little-endian: magic `LODMCORR`, format version (u32, 1), SHA-256 of the original and of the simplified surface,
//! number of triangles of both (u32 each), number of pieces (u64); then for every original triangle, in order, the
//! number of its pieces (u32) and the pieces: triangle of the simplified mesh (u32), number of corners (u32, at least
//! 3), and per corner four u32 in units of 2^-31: the weights of the second and third corner of the original triangle,
//! and of the simplified one. At the end is the SHA-256 of all that. A piece is mapped linearly on the triangles from
//! its first corner. The digest of a surface is that of the coordinates of all corners of its triangles, in order, as
//! doubles: the same for a mesh and any file of it. The original is the mesh in canonical order, as `simplify` works on
//! it; the simplified one has the order of its file.

use std::io::{Result, Write};

use sha2::{Digest, Sha256};

use super::{Correspondence, Piece};
use crate::mesh::Mesh;

pub(super) const MAGIC: &[u8; 8] = b"LODMCORR";
pub(super) const FORMAT: u32 = 1;

impl Correspondence {
    /// Writes the file of a correspondence from `original` (in canonical order) to `simplified`, whose triangles are the
    /// faces of it.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, original: &Mesh, simplified: &Mesh, out: &mut dyn Write) -> Result<()> {
        let mut out = Summed {
            out,
            sum: Sha256::new(),
        };
        out.put(MAGIC)?;
        out.put(&FORMAT.to_le_bytes())?;
        for mesh in [original, simplified] {
            out.put(&surface_digest(mesh))?;
        }
        for mesh in [original, simplified] {
            out.put(&(mesh.triangles().len() as u32).to_le_bytes())?;
        }
        let by_original = self.by_original();
        let total = by_original.iter().map(|of| of.len() as u64).sum::<u64>();
        out.put(&total.to_le_bytes())?;
        let mut bytes = Vec::new();
        for pieces in &by_original {
            bytes.clear();
            bytes.extend((pieces.len() as u32).to_le_bytes());
            for (face, piece) in pieces {
                bytes.extend(face.to_le_bytes());
                bytes.extend((piece.corners.len() as u32).to_le_bytes());
                for corner in piece.corners {
                    let weights = [corner.source.bits(), corner.target.bits()];
                    for weight in weights.into_iter().flatten() {
                        bytes.extend(weight.to_le_bytes());
                    }
                }
            }
            out.put(&bytes)?;
        }
        let Summed { out, sum } = out;
        out.write_all(&sum.finalize())
    }

    /// The pieces of every original triangle with the faces they go to, by ascending faces.
    fn by_original(&self) -> Vec<Vec<(u32, Piece<'_>)>> {
        let mut all: Vec<Vec<(u32, Piece<'_>)>> = vec![Vec::new(); self.triangle_count()];
        for face in 0..self.face_count() as u32 {
            for piece in self.pieces(face) {
                all[piece.triangle as usize].push((face, piece));
            }
        }
        all
    }
}

/// SHA-256 of the coordinates of all corners of all triangles, in order.
pub(super) fn surface_digest(mesh: &Mesh) -> [u8; 32] {
    let mut sum = Sha256::new();
    for t in 0..mesh.triangles().len() {
        for p in mesh.corners(t) {
            for x in p.to_array() {
                // Files do not all tell the zeros apart.
                sum.update((x + 0.0).to_le_bytes());
            }
        }
    }
    sum.finalize().into()
}

/// Sums what it writes.
struct Summed<'a> {
    out: &'a mut dyn Write,
    sum: Sha256,
}

impl Summed<'_> {
    fn put(&mut self, bytes: &[u8]) -> Result<()> {
        self.sum.update(bytes);
        self.out.write_all(bytes)
    }
}
