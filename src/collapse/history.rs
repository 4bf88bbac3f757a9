//! The record of a run: enough to rebuild every level between the input and the result, bit for bit.
//!
//! A record names the ids and values a [`Patch`] cannot derive from the mesh before it; kind 1 is a collapse. File
//! (little-endian): magic `LODMHIST`, format version, header (version of this crate, SHA-256 of the input's content,
//! resolved options as JSON, precision, frame, values per wedge), records, SHA-256 of all that. Positions are stored
//! in file units with the file's precision. The reader trusts nothing: see [`History::from_bytes`].

use std::path::Path;

use glam::DVec3;
use sha2::{Digest, Sha256};

use super::{LiveMesh, Observer, Patch};
use crate::{
    Error, Result,
    mesh::{Mesh, content_digest},
    num::{Frame, Precision},
};

const MAGIC: &[u8; 8] = b"LODMHIST";
const FORMAT: u32 = 1;
const COLLAPSE: u8 = 1;

/// What a history belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    /// Version of the crate that recorded it.
    pub version: String,
    /// [`content_digest`] of the input.
    pub input: [u8; 32],
    /// The resolved options, as JSON.
    pub options: String,
    /// The precision of the input's coordinates.
    pub precision: Precision,
    /// The frame that positions were rounded from.
    pub frame: Frame,
    /// Values per wedge.
    pub stride: u32,
}

/// A collapse of the edge `(keep, gone)`: `gone` becomes `keep`, which moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collapse {
    /// The smaller vertex id; the new vertex has it.
    pub keep: u32,
    /// The larger one.
    pub gone: u32,
    /// The new position in file units.
    pub to: DVec3,
    corners_end: usize,
    rows_end: usize,
}

/// A recorded run.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    header: Header,
    records: Vec<Collapse>,
    corners: Vec<u32>,
    rows: Vec<f64>,
}

/// Everything of a record.
#[derive(Clone, Copy, Debug)]
pub struct Entry<'a> {
    /// Ends and position.
    pub collapse: Collapse,
    /// The wedge of the new vertex in every face that stays, by ascending face id; empty without attributes.
    pub corners: &'a [u32],
    /// Rows of the wedges it appends.
    pub rows: &'a [f64],
}

impl History {
    /// What it belongs to.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Number of records.
    #[must_use]
    pub fn len(&self) -> usize {
        self.records.len()
    }

    /// True where nothing was recorded.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// A record; `None` beyond the last.
    #[must_use]
    pub fn entry(&self, index: usize) -> Option<Entry<'_>> {
        let collapse = *self.records.get(index)?;
        let before = index.checked_sub(1).map(|i| self.records[i]);
        let (corner, row) = before.map_or((0, 0), |r| (r.corners_end, r.rows_end));
        Some(Entry {
            collapse,
            corners: &self.corners[corner..collapse.corners_end],
            rows: &self.rows[row..collapse.rows_end],
        })
    }

    /// The file.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let h = &self.header;
        let mut out = Vec::with_capacity(256 + h.options.len() + 33 * self.records.len());
        out.extend(MAGIC);
        out.extend(FORMAT.to_le_bytes());
        for text in [&h.version, &h.options] {
            out.extend((text.len() as u32).to_le_bytes());
            out.extend(text.as_bytes());
        }
        out.extend(h.input);
        out.push(u8::from(h.precision == Precision::F64));
        out.extend(h.frame.exponent.to_le_bytes());
        out.extend(h.stride.to_le_bytes());
        out.extend((self.records.len() as u64).to_le_bytes());
        for index in 0..self.records.len() {
            let Some(entry) = self.entry(index) else {
                break;
            };
            out.push(COLLAPSE);
            out.extend(entry.collapse.keep.to_le_bytes());
            out.extend(entry.collapse.gone.to_le_bytes());
            for x in entry.collapse.to.to_array() {
                match h.precision {
                    Precision::F32 => out.extend((x as f32).to_le_bytes()),
                    Precision::F64 => out.extend(x.to_le_bytes()),
                }
            }
            if h.stride > 0 {
                out.extend((entry.corners.len() as u32).to_le_bytes());
                out.extend(entry.corners.iter().flat_map(|c| c.to_le_bytes()));
                out.extend((entry.rows.len() as u32).to_le_bytes());
                out.extend(entry.rows.iter().flat_map(|v| v.to_le_bytes()));
            }
        }
        let checksum = Sha256::digest(&out);
        out.extend(checksum);
        out
    }

    /// Reads a file's bytes; `path` is for messages.
    ///
    /// Memory is at most a small multiple of `bytes`, whatever they say.
    ///
    /// # Errors
    /// [`Error::Input`] where the bytes are no history, cut short or damaged; [`Error::Unsupported`] where a newer
    /// version wrote them.
    pub fn from_bytes(bytes: &[u8], path: impl AsRef<Path>) -> Result<Self> {
        let mut reader = Reader {
            rest: bytes,
            length: bytes.len(),
            path: path.as_ref(),
        };
        if reader.take(MAGIC.len()).ok() != Some(MAGIC.as_slice()) {
            return Err(reader.bad("not a history; expected a file that simplify --history wrote"));
        }
        let format = reader.u32()?;
        if format != FORMAT {
            return Err(Error::Unsupported(format!(
                "{}: history format {format}; this version reads format {FORMAT}",
                path.as_ref().display()
            )));
        }
        let body = bytes.len().saturating_sub(32);
        if body < MAGIC.len() + 4 || Sha256::digest(&bytes[..body])[..] != bytes[body..] {
            return Err(reader.bad("cut short or damaged: the checksum at the end does not fit"));
        }
        reader.rest = &bytes[MAGIC.len() + 4..body];
        let version = reader.text()?;
        let options = reader.text()?;
        let mut input = [0; 32];
        input.copy_from_slice(reader.take(32)?);
        let precision = match reader.u8()? {
            0 => Precision::F32,
            1 => Precision::F64,
            other => return Err(reader.bad(&format!("precision {other}; expected 0 or 1"))),
        };
        let exponent = reader.u32()?.cast_signed();
        if !(-2200..=2200).contains(&exponent) {
            return Err(reader.bad(&format!("a frame of 2^{exponent} is beyond any double")));
        }
        let mut history = Self {
            header: Header {
                version,
                input,
                options,
                precision,
                frame: Frame { exponent },
                stride: reader.u32()?,
            },
            records: Vec::new(),
            corners: Vec::new(),
            rows: Vec::new(),
        };
        let count = reader.u64()?;
        for _ in 0..count {
            history.read_record(&mut reader)?;
        }
        if !reader.rest.is_empty() {
            return Err(reader.bad("bytes after the last record"));
        }
        Ok(history)
    }

    fn read_record(&mut self, reader: &mut Reader<'_>) -> Result<()> {
        let kind = reader.u8()?;
        if kind != COLLAPSE {
            return Err(Error::Unsupported(format!(
                "{}: record kind {kind}; this version knows kind {COLLAPSE}",
                reader.path.display()
            )));
        }
        let (keep, gone) = (reader.u32()?, reader.u32()?);
        let mut to = [0.0; 3];
        for x in &mut to {
            *x = match self.header.precision {
                Precision::F32 => f64::from(f32::from_bits(reader.u32()?)),
                Precision::F64 => f64::from_bits(reader.u64()?),
            };
        }
        let to = DVec3::from_array(to);
        if keep >= gone || !to.is_finite() {
            return Err(reader.bad(&format!(
                "a collapse of ({keep}, {gone}) to {to}; expected ascending ids and finite numbers"
            )));
        }
        if self.header.stride > 0 {
            for _ in 0..reader.u32()? {
                self.corners.push(reader.u32()?);
            }
            for _ in 0..reader.u32()? {
                let value = f64::from_bits(reader.u64()?);
                if value.is_infinite() {
                    return Err(reader.bad("an attribute value is infinite"));
                }
                self.rows
                    .push(if value.is_nan() { f64::NAN } else { value });
            }
        }
        self.records.push(Collapse {
            keep,
            gone,
            to,
            corners_end: self.corners.len(),
            rows_end: self.rows.len(),
        });
        Ok(())
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

    fn u8(&mut self) -> Result<u8> {
        Ok(self.take(1)?[0])
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
}

/// Writes a history while an engine runs.
#[derive(Clone, Debug)]
pub struct Recorder {
    history: History,
}

impl Recorder {
    /// An empty history of a run on `mesh` in `frame`.
    #[must_use]
    pub fn new(mesh: &Mesh, frame: Frame) -> Self {
        Self {
            history: History {
                header: Header {
                    version: env!("CARGO_PKG_VERSION").into(),
                    input: content_digest(mesh),
                    options: String::new(),
                    precision: mesh.precision(),
                    frame,
                    stride: mesh.attributes().stride() as u32,
                },
                records: Vec::new(),
                corners: Vec::new(),
                rows: Vec::new(),
            },
        }
    }

    /// What was recorded, with the resolved options of the run (JSON).
    #[must_use]
    pub fn finish(self, options: String) -> History {
        let Self { mut history } = self;
        history.header.options = options;
        history
    }
}

impl Observer for Recorder {
    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        let (Some(moved), Some(gone)) = (patch.moved, patch.gone) else {
            return;
        };
        let history = &mut self.history;
        if history.header.stride > 0 {
            for face in &patch.added {
                let apex = face.corners.iter().position(|&v| v == moved.vertex);
                history.corners.extend(apex.map(|k| face.wedges[k]));
            }
            history.rows.extend_from_slice(&patch.rows);
        }
        self.thinned(live, moved.vertex, gone, moved.to);
    }

    fn thinned(&mut self, live: &LiveMesh, keep: u32, gone: u32, to: DVec3) {
        let history = &mut self.history;
        history.records.push(Collapse {
            keep,
            gone,
            to: live.frame().leave(to),
            corners_end: history.corners.len(),
            rows_end: history.rows.len(),
        });
    }
}
