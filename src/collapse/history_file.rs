//! Histories as bytes.
//!
//! Little-endian: magic `LODMHIST`, format version, header (version of this crate, SHA-256 of the input's content,
//! resolved options as JSON, precision, frame, values per wedge), records, SHA-256 of all that. A record is its kind (1
//! collapse, 2 move, 3 flip), its vertices, for kinds 1 and 2 the new position in file units with the file's precision
//! and, where there are attributes, the wedges. The reader trusts nothing: see [`History::from_bytes`].

use std::path::Path;

use glam::DVec3;

use super::{
    History,
    history::{Header, Record},
};
use crate::{
    Error, Result,
    encode::sealed_file::{SealedFormat, SealedReader, push_text, seal},
    num::{Frame, Precision},
};

const HISTORY: SealedFormat = SealedFormat {
    magic: *b"LODMHIST",
    version: 1,
    name: "history",
    written_by: "simplify --history",
    advice: "",
};
const COLLAPSE: u8 = 1;
const MOVE: u8 = 2;
const FLIP: u8 = 3;

impl History {
    /// The file.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let h = &self.header;
        let mut out = HISTORY.begin(256 + h.options.len() + 33 * self.records.len());
        push_text(&mut out, &h.version);
        push_text(&mut out, &h.options);
        out.extend(h.input);
        out.push(u8::from(h.precision == Precision::F64));
        out.extend(h.frame.exponent.to_le_bytes());
        out.extend(h.stride.to_le_bytes());
        out.extend((self.records.len() as u64).to_le_bytes());
        for entry in (0..self.records.len()).filter_map(|index| self.entry(index)) {
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
        seal(out)
    }

    /// Reads a file's bytes; `path` is for messages.
    ///
    /// Memory is at most a small multiple of `bytes`, whatever they say.
    ///
    /// # Errors
    /// [`Error::Input`] where the bytes are no history, cut short or damaged; [`Error::Unsupported`] where a newer
    /// version wrote them.
    pub fn from_bytes(bytes: &[u8], path: impl AsRef<Path>) -> Result<Self> {
        let mut reader = HISTORY.open(bytes, path.as_ref())?;
        let version = reader.text()?;
        let options = reader.text()?;
        let input = reader.array()?;
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
        if reader.remaining() > 0 {
            return Err(reader.bad("bytes after the last record"));
        }
        Ok(history)
    }

    fn read_record(&mut self, reader: &mut SealedReader<'_>) -> Result<()> {
        let kind = reader.u8()?;
        let record = match kind {
            COLLAPSE => {
                let [keep, gone] = edge(reader)?;
                let to = position(reader, self.header.precision)?;
                Record::Collapse { keep, gone, to }
            }
            MOVE => Record::Move {
                vertex: reader.u32()?,
                to: position(reader, self.header.precision)?,
            },
            FLIP => Record::Flip {
                edge: edge(reader)?,
            },
            _ => {
                return Err(Error::Unsupported(format!(
                    "{}: record kind {kind}; this version knows kinds {COLLAPSE} to {FLIP}",
                    reader.path().display()
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
        self.push(record);
        Ok(())
    }
}

/// Reads two ascending vertex ids.
fn edge(reader: &mut SealedReader<'_>) -> Result<[u32; 2]> {
    let (a, b) = (reader.u32()?, reader.u32()?);
    if a < b {
        Ok([a, b])
    } else {
        Err(reader.bad(&format!("the edge ({a}, {b}); expected ascending ids")))
    }
}

/// Reads a finite position.
fn position(reader: &mut SealedReader<'_>, precision: Precision) -> Result<DVec3> {
    let mut to = [0.0; 3];
    for x in &mut to {
        *x = match precision {
            Precision::F32 => f64::from(f32::from_bits(reader.u32()?)),
            Precision::F64 => f64::from_bits(reader.u64()?),
        };
    }
    let to = DVec3::from_array(to);
    if to.is_finite() {
        Ok(to)
    } else {
        Err(reader.bad(&format!("the position {to}; expected finite numbers")))
    }
}
