//! The file of a correspondence, read as triangles and what stands for them: see `file` for the format.
//!
//! The file is held against its own counts and checksums, against both meshes, and against the area of
//! every original triangle, which that of its pieces is to the last unit. That pieces leave no gap is checked by the
//! verifier, which reads the file for itself.

use std::path::Path;

use glam::DVec3;
use sha2::{Digest, Sha256};

use super::file::{FORMAT, MAGIC, surface_digest};
use crate::{Error, Result, bound::surface::Pair, mesh::Mesh, num::Each};

/// Magic, format, two digests, two counts, number of pieces.
const HEADER: usize = 8 + 4 + 64 + 8 + 8;
const CHECKSUM: usize = 32;
/// The weight 1 in units of the file.
const ONE: u32 = 1 << 31;
/// The triangles that the pieces of a correspondence consist of, by ascending original triangles: what `measure` of
/// [`surface`](crate::bound::surface) takes as a given map. `None` where the file belongs to another original.
///
/// `original` in canonical order, `simplified` in the order of its file, both in file units; `path` is for messages.
/// Memory and time are at most proportional to `bytes`.
///
/// # Errors
/// [`Error::Input`] where the bytes are no such file, damaged, for another simplified mesh, or leave out part of a
/// triangle; [`Error::Unsupported`] where a newer version wrote them.
pub fn pairs(
    bytes: &[u8],
    path: impl AsRef<Path>,
    original: &Mesh,
    simplified: &Mesh,
) -> Result<Option<Vec<Pair>>> {
    let path = path.as_ref();
    let bad = |what: &str| Error::input(path, what.to_string());
    if bytes.len() < HEADER + CHECKSUM || !bytes.starts_with(MAGIC) {
        return Err(bad(
            "is no correspondence; expected a file that `lodmark simplify --bound-out` wrote",
        ));
    }
    let (content, checksum) = bytes.split_at(bytes.len() - CHECKSUM);
    let mut reader = Reader(&content[MAGIC.len()..]);
    let format = reader.number(path)?;
    if format != FORMAT {
        return Err(Error::Unsupported(format!(
            "{}: a correspondence of format {format}; this version reads format {FORMAT}",
            path.display()
        )));
    }
    if Sha256::digest(content)[..] != *checksum {
        return Err(bad("is damaged: its checksum does not fit"));
    }
    let digests = [reader.digest(path)?, reader.digest(path)?];
    let counts = [reader.number(path)?, reader.number(path)?];
    let _pieces = [reader.number(path)?, reader.number(path)?];
    let belongs = |i: usize, mesh: &Mesh| {
        counts[i] as usize == mesh.triangles().len() && digests[i] == surface_digest(mesh)
    };
    if !belongs(1, simplified) {
        return Err(bad("belongs to another simplified mesh"));
    }
    if !belongs(0, original) {
        return Ok(None);
    }
    let mut pairs = Vec::new();
    for triangle in 0..counts[0] {
        let mut area = 0_i128;
        for _ in 0..reader.number(path)? {
            area += reader.piece(path, triangle, [original, simplified], &mut pairs)?;
        }
        // Twice the area in units of 2^-62.
        if area != i128::from(ONE) * i128::from(ONE) {
            return Err(bad(&format!(
                "its pieces do not have the area of triangle {triangle}"
            )));
        }
    }
    if reader.0.is_empty() {
        Ok(Some(pairs))
    } else {
        Err(bad("goes on after its last piece"))
    }
}

/// Little-endian numbers, front to back.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self, path: &Path) -> Result<[u8; N]> {
        let (taken, rest) = self
            .0
            .split_first_chunk()
            .ok_or_else(|| Error::input(path, "ends in the middle of a piece"))?;
        self.0 = rest;
        Ok(*taken)
    }

    fn number(&mut self, path: &Path) -> Result<u32> {
        self.take(path).map(u32::from_le_bytes)
    }

    fn digest(&mut self, path: &Path) -> Result<[u8; 32]> {
        self.take(path)
    }

    /// Adds the triangles of the next piece, from its first corner on; the answer is twice its area in its original
    /// triangle.
    fn piece(
        &mut self,
        path: &Path,
        triangle: u32,
        [original, simplified]: [&Mesh; 2],
        pairs: &mut Vec<Pair>,
    ) -> Result<i128> {
        let bad =
            |what: String| Error::input(path, format!("a piece of triangle {triangle} {what}"));
        let (face, corners) = (self.number(path)?, self.number(path)?);
        if face as usize >= simplified.triangles().len() {
            return Err(bad(format!(
                "goes to triangle {face}, which does not exist"
            )));
        }
        if corners < 3 {
            return Err(bad(format!("has {corners} corners; expected at least 3")));
        }
        let ends = [
            original.corners(triangle as usize),
            simplified.corners(face as usize),
        ];
        let mut corner = || -> Result<([i64; 2], [DVec3; 2])> {
            let weights = [
                [self.number(path)?, self.number(path)?],
                [self.number(path)?, self.number(path)?],
            ];
            if weights.iter().any(|&[u, v]| u > ONE || v > ONE - u) {
                return Err(bad("has a corner outside its triangle".into()));
            }
            let place = |i: usize| point(ends[i], weights[i]);
            Ok((weights[0].each(i64::from), [place(0), place(1)]))
        };
        let (first, mut last) = (corner()?, corner()?);
        let mut area = 0;
        for _ in 2..corners {
            let next = corner()?;
            let side = |p: [i64; 2]| [p[0] - first.0[0], p[1] - first.0[1]].each(i128::from);
            let ([a, b], [c, d]) = (side(last.0), side(next.0));
            area += a * d - b * c;
            let corners = [first.1, last.1, next.1];
            pairs.push(Pair {
                from: corners.each(|[from, _]| from),
                to: corners.each(|[_, to]| to),
                triangle,
            });
            last = next;
        }
        Ok(area)
    }
}

/// A corner itself where its weight is 1, to the last bit.
fn point([a, b, c]: [DVec3; 3], [u, v]: [u32; 2]) -> DVec3 {
    let share = |w: u32| f64::from(w) / f64::from(ONE);
    let weights = [share(ONE - u - v), share(u), share(v)];
    (a * weights[0] + b * weights[1]) + c * weights[2]
}
