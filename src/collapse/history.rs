//! The record of a run: enough to rebuild every level between the input and the result, bit for bit.
//!
//! A record names the ids and values a [`Patch`] cannot derive from the mesh before it: a collapse, a move or a flip.

use glam::DVec3;

use super::{LiveMesh, Observer, Patch};
use crate::{
    mesh::{Mesh, content_digest},
    num::{Frame, Precision},
};

/// The run that a history belongs to.
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

/// Ids and values of a patch; everything else follows from the mesh before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Record {
    /// The edge `(keep, gone)` collapses: `gone` becomes `keep`, which moves.
    Collapse {
        /// The smaller vertex id; the new vertex has it.
        keep: u32,
        /// The larger one.
        gone: u32,
        /// The new position in file units.
        to: DVec3,
    },
    /// A vertex moves.
    Move {
        /// Its id.
        vertex: u32,
        /// The new position in file units.
        to: DVec3,
    },
    /// An edge flips, as [`Patch::set_flip`] does it.
    Flip {
        /// Its ends, the smaller id first.
        edge: [u32; 2],
    },
}

/// A record and where its part of the other arrays ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stored {
    pub(super) record: Record,
    pub(super) corners_end: usize,
    pub(super) rows_end: usize,
}

/// A recorded run.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    pub(super) header: Header,
    pub(super) records: Vec<Stored>,
    pub(super) corners: Vec<u32>,
    pub(super) rows: Vec<f64>,
}

/// Everything of a record.
#[derive(Clone, Copy, Debug)]
pub struct Entry<'a> {
    /// Ids and values of its patch.
    pub record: Record,
    /// The wedge of the vertex that moved in every face that has it afterwards, by ascending face id; empty without
    /// attributes, and for a flip.
    pub corners: &'a [u32],
    /// Rows of the wedges it appends.
    pub rows: &'a [f64],
}

impl History {
    /// The run it belongs to.
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
        let Stored {
            record,
            corners_end,
            rows_end,
        } = *self.records.get(index)?;
        let before = index.checked_sub(1).map(|i| self.records[i]);
        let (corner, row) = before.map_or((0, 0), |r| (r.corners_end, r.rows_end));
        Some(Entry {
            record,
            corners: &self.corners[corner..corners_end],
            rows: &self.rows[row..rows_end],
        })
    }
}

impl History {
    /// Adds a record whose part of the other arrays ends where they end.
    pub(super) fn push(&mut self, record: Record) {
        self.records.push(Stored {
            record,
            corners_end: self.corners.len(),
            rows_end: self.rows.len(),
        });
    }
}

/// Writes a history while an engine runs.
#[derive(Clone, Debug)]
pub struct Recorder {
    history: History,
}

impl Recorder {
    /// An empty history of a run on `mesh` in `frame`.
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

    /// The history, with the resolved options of the run (JSON).
    pub fn finish(self, options: String) -> History {
        let mut history = self.history;
        history.header.options = options;
        history
    }
}

impl Observer for Recorder {
    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        let history = &mut self.history;
        let to = patch.moved.map(|m| (m.vertex, live.frame().leave(m.to)));
        let record = match (to, patch.gone) {
            (Some((keep, to)), Some(gone)) => Record::Collapse { keep, gone, to },
            (Some((vertex, to)), None) => Record::Move { vertex, to },
            (None, _) => match patch.flipped() {
                Some(edge) => Record::Flip { edge },
                None => return,
            },
        };
        if let (Some((vertex, _)), true) = (to, history.header.stride > 0) {
            for face in &patch.added {
                let wedge = face.corner(vertex).map(|k| face.wedges[k]);
                history.corners.extend(wedge);
            }
            history.rows.extend_from_slice(&patch.rows);
        }
        history.push(record);
    }

    fn collapsed_in_tile(&mut self, live: &LiveMesh, keep: u32, gone: u32, to: DVec3) {
        let to = live.frame().leave(to);
        self.history.push(Record::Collapse { keep, gone, to });
    }
}
