//! Surveys as bytes: partial results on their way between machines, and the weights of a measured mesh.
//!
//! Little-endian: magic `LODMVISI`, format version (`u32`), version of this crate and resolved options as JSON (each
//! a `u32` length and UTF-8), SHA-256 of the mesh's content, ranges of views (`u32` count, then first and one past the
//! last), triangles (`u64`); for every triangle the views that see it (`u32`), then for every triangle the front
//! weights (seen and all, `u64` each), then, where two-sided, the back weights; SHA-256 of all that. The reader trusts
//! nothing; it needs memory in proportion to the bytes.

use std::{ops::Range, path::Path};

use super::{
    MeasureOptions, PartialVisibility,
    counts::{Counts, WEIGHT_LIMIT, Weights},
};
use crate::{
    Result,
    encode::sealed_file::{SealedFormat, SealedReader, push_text, seal},
};

const SURVEY: SealedFormat = SealedFormat {
    magic: *b"LODMVISI",
    version: 1,
    name: "survey",
    written_by: "visibility --partial or merge-visibility",
    advice: "; copy it again, or measure again",
};

impl PartialVisibility {
    /// The file: equal surveys give equal bytes.
    ///
    /// # Panics
    /// Never: options are plain numbers and names.
    pub fn to_bytes(&self) -> Vec<u8> {
        let options = serde_json::to_string(&self.options).expect("plain numbers and names");
        let counts = &self.counts;
        let mut out = SURVEY.begin(512 + 36 * counts.views.len());
        push_text(&mut out, &self.version);
        push_text(&mut out, &options);
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
        seal(out)
    }

    /// Reads a file's bytes; `path` is for messages.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) where the bytes are no survey, cut short, damaged, or count more than there is;
    /// [`Error::Unsupported`](crate::Error::Unsupported) where a newer version wrote them.
    pub fn from_bytes(bytes: &[u8], path: impl AsRef<Path>) -> Result<Self> {
        let mut reader = SURVEY.open(bytes, path.as_ref())?;
        let version = reader.text()?;
        let options: MeasureOptions = serde_json::from_str(&reader.text()?)
            .map_err(|e| reader.bad(&format!("the options cannot be read: {e}")))?;
        let checked = options.check();
        checked.map_err(|e| reader.bad(&format!("the options make no sense: {e}")))?;
        let digest = reader.array()?;
        let ranges = ranges(&mut reader, options.cameras())?;
        let views = ranges.iter().map(|r| r.end - r.start).sum();
        let counts = counts(&mut reader, options.two_sided, views)?;
        Ok(Self {
            version,
            digest,
            options,
            ranges,
            counts,
        })
    }
}

/// Reads the ranges of views.
fn ranges(reader: &mut SealedReader<'_>, cameras: u32) -> Result<Vec<Range<u32>>> {
    let count = reader.u32()?;
    let mut ranges: Vec<Range<u32>> = Vec::new();
    for _ in 0..count {
        let range = reader.u32()?..reader.u32()?;
        let apart = ranges.last().is_none_or(|last| last.end < range.start);
        if !apart || range.start >= range.end || range.end > cameras {
            return Err(reader.bad(&format!(
                "views {}..{} of {cameras}; expected ranges that ascend and do not touch",
                range.start, range.end
            )));
        }
        ranges.push(range);
    }
    if ranges.is_empty() {
        return Err(reader.bad("no views; expected at least one"));
    }
    Ok(ranges)
}

/// Reads what the views have counted.
fn counts(reader: &mut SealedReader<'_>, two_sided: bool, views: u32) -> Result<Counts> {
    let triangles = reader.u64()?;
    let sides = if two_sided { 2 } else { 1 };
    let expected = u128::from(triangles) * (4 + 16 * sides);
    if triangles == 0 || expected != reader.remaining() as u128 {
        return Err(reader.bad(&format!(
            "{triangles} triangles need {expected} bytes, and {} are there",
            reader.remaining()
        )));
    }
    let mut counts = Counts::default();
    for t in 0..triangles {
        let seen = reader.u32()?;
        if seen > views {
            return Err(reader.bad(&format!("triangle {t} is seen by {seen} of {views} views")));
        }
        counts.views.push(seen);
    }
    for side in 0..sides {
        for t in 0..triangles {
            let weights = Weights {
                seen: reader.u64()?,
                all: reader.u64()?,
            };
            if weights.seen > weights.all || weights.all > u64::from(views) * WEIGHT_LIMIT {
                return Err(reader.bad(&format!(
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
