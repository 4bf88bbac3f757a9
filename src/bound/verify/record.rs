//! The file of a correspondence, read by the verifier for itself. Nothing in it is trusted: counts are held against the
//! bytes that are there, numbers against their ranges, and a checksum against everything.
//!
//! Format: as `simplify --bound-out` documents it (`bound::correspondence`).

use std::path::Path;

use sha2::{Digest, Sha256};

use crate::{Error, Result, mesh::Mesh};

const MAGIC: &[u8] = b"LODMCORR";
const FORMAT: u32 = 1;
/// Corners of a piece: twice what is ever written.
const MOST_CORNERS: u32 = 4096;
/// Magic, format, two digests, two counts, number of pieces.
const HEADER: usize = 8 + 4 + 64 + 8 + 8;
/// The weight 1.
pub(super) const ONE: u32 = 1 << 31;

/// A map of the parts of an original to the parts of a simplified mesh that stand for them.
#[derive(Clone, Debug)]
pub struct Record {
    digests: [[u8; 32]; 2],
    targets: u32,
    /// First piece of every original triangle, and their number.
    pub(super) starts: Vec<u32>,
    /// Target and first corner of every piece; one more for the end.
    pieces: Vec<[u32; 2]>,
    /// Weights in the original and in the target.
    corners: Vec<[u32; 4]>,
}

impl Record {
    /// Reads a file's bytes; `path` is for messages. Memory is at most a small multiple of `bytes`.
    ///
    /// # Errors
    /// [`Error::Input`] where the bytes are no such file, cut short, damaged or out of range; [`Error::Unsupported`]
    /// where a newer version wrote them.
    pub fn from_bytes(bytes: &[u8], path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let bad = |what: &str| Error::input(path, what.to_string());
        if !bytes.starts_with(MAGIC) || bytes.len() < HEADER + 32 {
            return Err(bad(
                "not a correspondence; expected a file that simplify --bound-out wrote",
            ));
        }
        let mut rest = Numbers(&bytes[MAGIC.len()..bytes.len() - 32]);
        let short = || bad("ends in the middle of a piece");
        let format = rest.next().ok_or_else(short)?;
        if format != FORMAT {
            return Err(Error::Unsupported(format!(
                "{}: correspondence format {format}; this version reads format {FORMAT}",
                path.display()
            )));
        }
        if Sha256::digest(&bytes[..bytes.len() - 32])[..] != bytes[bytes.len() - 32..] {
            return Err(bad(
                "cut short or damaged: the checksum at the end does not fit",
            ));
        }
        let mut digests = [[0; 32]; 2];
        for digest in &mut digests {
            digest.copy_from_slice(rest.bytes(32).ok_or_else(short)?);
        }
        let (triangles, targets) = (
            rest.next().ok_or_else(short)?,
            rest.next().ok_or_else(short)?,
        );
        let (low, high) = (
            rest.next().ok_or_else(short)?,
            rest.next().ok_or_else(short)?,
        );
        if high != 0 || u64::from(low) * 56 > bytes.len() as u64 {
            return Err(bad("names more pieces than the file can hold"));
        }
        if u64::from(triangles) * 4 > bytes.len() as u64 {
            return Err(bad("names more triangles than the file can hold"));
        }
        let mut record = Self {
            digests,
            targets,
            starts: Vec::with_capacity(triangles as usize + 1),
            pieces: Vec::with_capacity(low as usize + 1),
            corners: Vec::new(),
        };
        for triangle in 0..triangles {
            record.starts.push(record.pieces.len() as u32);
            for _ in 0..rest.next().ok_or_else(short)? {
                record.read_piece(&mut rest, triangle, path)?;
            }
        }
        record.starts.push(record.pieces.len() as u32);
        if !rest.0.is_empty() || record.pieces.len() != low as usize {
            return Err(bad("has another number of pieces than it says"));
        }
        record.pieces.push([0, record.corners.len() as u32]);
        Ok(record)
    }

    fn read_piece(&mut self, rest: &mut Numbers<'_>, triangle: u32, path: &Path) -> Result<()> {
        let bad = |what: &str| {
            Error::input(
                path,
                format!("a piece of original triangle {triangle} {what}"),
            )
        };
        let (Some(target), Some(corners)) = (rest.next(), rest.next()) else {
            return Err(bad("is cut short"));
        };
        if target >= self.targets {
            return Err(bad(&format!(
                "goes to triangle {target}; expected one below {}",
                self.targets
            )));
        }
        if !(3..=MOST_CORNERS).contains(&corners)
            || self.corners.len() + corners as usize > u32::MAX as usize
        {
            return Err(bad(&format!(
                "has {corners} corners; expected 3 to {MOST_CORNERS}"
            )));
        }
        self.pieces.push([target, self.corners.len() as u32]);
        for _ in 0..corners {
            let mut weights = [0; 4];
            for weight in &mut weights {
                *weight = rest.next().ok_or_else(|| bad("is cut short"))?;
            }
            let outside = |u: u32, v: u32| u64::from(u) + u64::from(v) > u64::from(ONE);
            if outside(weights[0], weights[1]) || outside(weights[2], weights[3]) {
                return Err(bad("has a corner outside its triangle"));
            }
            self.corners.push(weights);
        }
        Ok(())
    }

    /// True where the correspondence starts from this very mesh, in this order.
    #[must_use]
    pub fn is_from(&self, original: &Mesh) -> bool {
        original.triangles().len() + 1 == self.starts.len()
            && self.digests[0] == surface_digest(original)
    }

    /// True where the correspondence leads to this very mesh, in this order.
    #[must_use]
    pub fn is_to(&self, simplified: &Mesh) -> bool {
        simplified.triangles().len() == self.targets as usize
            && self.digests[1] == surface_digest(simplified)
    }

    /// Number of pieces.
    #[must_use]
    pub fn piece_count(&self) -> usize {
        self.pieces.len() - 1
    }

    /// Target and corners of a piece.
    pub(super) fn piece(&self, index: u32) -> (u32, &[[u32; 4]]) {
        let [[target, start], [_, end]] =
            [self.pieces[index as usize], self.pieces[index as usize + 1]];
        (target, &self.corners[start as usize..end as usize])
    }

    /// The pieces of an original triangle.
    pub(super) fn of(&self, triangle: u32) -> std::ops::Range<u32> {
        self.starts[triangle as usize]..self.starts[triangle as usize + 1]
    }
}

/// Little-endian numbers of a file, front to back.
struct Numbers<'a>(&'a [u8]);

impl<'a> Numbers<'a> {
    fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(taken)
    }

    fn next(&mut self) -> Option<u32> {
        let four = self.bytes(4)?;
        Some(u32::from_le_bytes([four[0], four[1], four[2], four[3]]))
    }
}

fn surface_digest(mesh: &Mesh) -> [u8; 32] {
    let mut bytes = Vec::with_capacity(72);
    let mut sum = Sha256::new();
    for corners in mesh.triangles() {
        bytes.clear();
        for &v in corners {
            for x in mesh.positions()[v as usize].to_array() {
                // Both zeros are one number here.
                let x = if x.abs() > 0.0 { x } else { 0.0 };
                bytes.extend_from_slice(&x.to_le_bytes());
            }
        }
        sum.update(&bytes);
    }
    sum.finalize().into()
}
