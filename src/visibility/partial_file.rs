//! Surveys as bytes: partial results on their way between machines, and the weights of a measured mesh.
//!
//! Little-endian: magic `LODMVISI`, format version (`u32`), version of this crate and resolved options as JSON (each
//! a `u32` length and UTF-8), SHA-256 of the mesh's content, ranges of views (`u32` count, then first and one past the
//! last), triangles (`u64`); for every triangle the views that see it (`u32`), then for every triangle the front
//! weights (seen and all, `u64` each), then, where two-sided, the back weights; SHA-256 of all that. The reader trusts
//! nothing; it needs memory in proportion to the bytes.

use std::{ops::Range, path::Path};

use sha2::{Digest, Sha256};

use super::{
    MeasureOptions, PartialVisibility,
    counts::{Counts, WEIGHT_LIMIT, Weights},
};
use crate::{Error, Result};

const MAGIC: &[u8; 8] = b"LODMVISI";
const FORMAT: u32 = 1;

impl PartialVisibility {
    /// The file: equal surveys give equal bytes.
    ///
    /// # Panics
    /// Never: options are plain numbers and names.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let options = serde_json::to_string(&self.options).expect("plain numbers and names");
        let counts = &self.counts;
        let mut out = Vec::with_capacity(512 + 36 * counts.views.len());
        out.extend(MAGIC);
        out.extend(FORMAT.to_le_bytes());
        for text in [&self.version, &options] {
            out.extend((text.len() as u32).to_le_bytes());
            out.extend(text.as_bytes());
        }
        out.extend(self.digest);
        out.extend((self.ranges.len() as u32).to_le_bytes());
        for range in &self.ranges {
            out.extend(range.start.to_le_bytes());
            out.extend(range.end.to_le_bytes());
        }
        out.extend((counts.views.len() as u64).to_le_bytes());
        for views in &counts.views {
            out.extend(views.to_le_bytes());
        }
        for weights in counts.front.iter().chain(&counts.back) {
            out.extend(weights.seen.to_le_bytes());
            out.extend(weights.all.to_le_bytes());
        }
        let checksum = Sha256::digest(&out);
        out.extend(checksum);
        out
    }

    /// Reads a file's bytes; `path` is for messages.
    ///
    /// # Errors
    /// [`Error::Input`] where the bytes are no survey, cut short, damaged, or count more than there is;
    /// [`Error::Unsupported`] where a newer version wrote them.
    pub fn from_bytes(bytes: &[u8], path: impl AsRef<Path>) -> Result<Self> {
        let mut reader = Reader {
            rest: bytes,
            length: bytes.len(),
            path: path.as_ref(),
        };
        if reader.take(MAGIC.len()).ok() != Some(MAGIC.as_slice()) {
            return Err(reader.bad(
                "not a survey; expected a file that visibility --partial or merge-visibility wrote",
            ));
        }
        let format = reader.u32()?;
        if format != FORMAT {
            return Err(Error::Unsupported(format!(
                "{}: survey format {format}; this version reads format {FORMAT}",
                path.as_ref().display()
            )));
        }
        let body = bytes.len().saturating_sub(32);
        if body < MAGIC.len() + 4 || Sha256::digest(&bytes[..body])[..] != bytes[body..] {
            return Err(reader.bad(
                "cut short or damaged: the checksum at the end does not fit; copy it again, or measure again",
            ));
        }
        reader.rest = &bytes[MAGIC.len() + 4..body];
        let version = reader.text()?;
        let options: MeasureOptions = serde_json::from_str(&reader.text()?)
            .map_err(|e| reader.bad(&format!("the options cannot be read: {e}")))?;
        options
            .check()
            .map_err(|e| reader.bad(&format!("the options make no sense: {e}")))?;
        let mut digest = [0; 32];
        digest.copy_from_slice(reader.take(32)?);
        let ranges = reader.ranges(options.cameras())?;
        let views = ranges.iter().map(|r| r.end - r.start).sum();
        let counts = reader.counts(options.two_sided, views)?;
        Ok(Self {
            version,
            digest,
            options,
            ranges,
            counts,
        })
    }
}

/// Bytes still to be read.
struct Reader<'a> {
    rest: &'a [u8],
    length: usize,
    path: &'a Path,
}

impl<'a> Reader<'a> {
    fn bad(&self, message: &str) -> Error {
        let at = self.length - self.rest.len();
        Error::input(self.path, format!("{message} (near byte {at})"))
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        match self.rest.split_at_checked(count) {
            Some((taken, rest)) => {
                self.rest = rest;
                Ok(taken)
            }
            None => Err(self.bad("cut short")),
        }
    }

    fn u32(&mut self) -> Result<u32> {
        let mut bytes = [0; 4];
        bytes.copy_from_slice(self.take(4)?);
        Ok(u32::from_le_bytes(bytes))
    }

    fn u64(&mut self) -> Result<u64> {
        let mut bytes = [0; 8];
        bytes.copy_from_slice(self.take(8)?);
        Ok(u64::from_le_bytes(bytes))
    }

    fn text(&mut self) -> Result<String> {
        let length = self.u32()? as usize;
        let bytes = self.take(length)?.to_vec();
        String::from_utf8(bytes).map_err(|_| self.bad("a text is not UTF-8"))
    }

    fn ranges(&mut self, cameras: u32) -> Result<Vec<Range<u32>>> {
        let count = self.u32()?;
        let mut ranges: Vec<Range<u32>> = Vec::new();
        for _ in 0..count {
            let range = self.u32()?..self.u32()?;
            let apart = ranges.last().is_none_or(|last| last.end < range.start);
            if !apart || range.start >= range.end || range.end > cameras {
                return Err(self.bad(&format!(
                    "views {}..{} of {cameras}; expected ranges that ascend and do not touch",
                    range.start, range.end
                )));
            }
            ranges.push(range);
        }
        if ranges.is_empty() {
            return Err(self.bad("no views; expected at least one"));
        }
        Ok(ranges)
    }

    fn counts(&mut self, two_sided: bool, views: u32) -> Result<Counts> {
        let triangles = self.u64()?;
        let sides = if two_sided { 2 } else { 1 };
        let expected = u128::from(triangles) * (4 + 16 * sides);
        if triangles == 0 || expected != self.rest.len() as u128 {
            return Err(self.bad(&format!(
                "{triangles} triangles need {expected} bytes, and {} are there",
                self.rest.len()
            )));
        }
        let mut counts = Counts::default();
        for t in 0..triangles {
            let seen = self.u32()?;
            if seen > views {
                return Err(self.bad(&format!("triangle {t} is seen by {seen} of {views} views")));
            }
            counts.views.push(seen);
        }
        for side in 0..sides {
            for t in 0..triangles {
                let weights = Weights {
                    seen: self.u64()?,
                    all: self.u64()?,
                };
                if weights.seen > weights.all || weights.all > u64::from(views) * WEIGHT_LIMIT {
                    return Err(self.bad(&format!(
                        "triangle {t} has weights {} of {} from {views} views",
                        weights.seen, weights.all
                    )));
                }
                if side == 0 {
                    counts.front.push(weights);
                } else {
                    counts.back.push(weights);
                }
            }
        }
        Ok(counts)
    }
}
