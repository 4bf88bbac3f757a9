//! Histories as bytes.
//!
//! Little-endian: magic `LODMHIST`, format version, header (version of this crate, SHA-256 of the input's content,
//! resolved options as JSON, precision, frame, values per wedge), records, SHA-256 of all that. A record is its kind (1
//! collapse, 2 move, 3 flip), its vertices, for kinds 1 and 2 the new position in file units with the file's precision
//! and, where there are attributes, the wedges. The reader trusts nothing: see [`History::from_bytes`].

use std::path::Path;

use glam::DVec3;
use sha2::{Digest, Sha256};

use super::{
    History,
    history::{Header, Record, Stored},
};
use crate::{
    Error, Result,
    num::{Frame, Precision},
};

const MAGIC: &[u8; 8] = b"LODMHIST";
const FORMAT: u32 = 1;
const COLLAPSE: u8 = 1;
const MOVE: u8 = 2;
const FLIP: u8 = 3;

impl History {
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
            let (kind, vertices, to) = match entry.record {
                Record::Collapse { keep, gone, to } => (COLLAPSE, vec![keep, gone], Some(to)),
                Record::Move { vertex, to } => (MOVE, vec![vertex], Some(to)),
                Record::Flip { edge } => (FLIP, edge.to_vec(), None),
            };
            out.push(kind);
            out.extend(vertices.iter().flat_map(|v| v.to_le_bytes()));
            for x in to.iter().flat_map(|p| p.to_array()) {
                match h.precision {
                    Precision::F32 => out.extend((x as f32).to_le_bytes()),
                    Precision::F64 => out.extend(x.to_le_bytes()),
                }
            }
            if h.stride > 0 && to.is_some() {
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
        let record = match kind {
            COLLAPSE => {
                let [keep, gone] = reader.edge()?;
                let to = reader.position(self.header.precision)?;
                Record::Collapse { keep, gone, to }
            }
            MOVE => Record::Move {
                vertex: reader.u32()?,
                to: reader.position(self.header.precision)?,
            },
            FLIP => Record::Flip {
                edge: reader.edge()?,
            },
            _ => {
                return Err(Error::Unsupported(format!(
                    "{}: record kind {kind}; this version knows kinds {COLLAPSE} to {FLIP}",
                    reader.path.display()
                )));
            }
        };
        if self.header.stride > 0 && kind != FLIP {
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
        self.records.push(Stored {
            record,
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

    /// Two ascending vertex ids.
    fn edge(&mut self) -> Result<[u32; 2]> {
        let (a, b) = (self.u32()?, self.u32()?);
        if a < b {
            Ok([a, b])
        } else {
            Err(self.bad(&format!("the edge ({a}, {b}); expected ascending ids")))
        }
    }

    fn position(&mut self, precision: Precision) -> Result<DVec3> {
        let mut to = [0.0; 3];
        for x in &mut to {
            *x = match precision {
                Precision::F32 => f64::from(f32::from_bits(self.u32()?)),
                Precision::F64 => f64::from_bits(self.u64()?),
            };
        }
        let to = DVec3::from_array(to);
        if to.is_finite() {
            Ok(to)
        } else {
            Err(self.bad(&format!("the position {to}; expected finite numbers")))
        }
    }

    fn text(&mut self) -> Result<String> {
        let length = self.u32()? as usize;
        let bytes = self.take(length)?.to_vec();
        String::from_utf8(bytes).map_err(|_| self.bad("a text is not UTF-8"))
    }
}
