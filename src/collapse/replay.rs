//! Going back and forth in a recorded run: coarser by its records, finer by an undo log.
//!
//! A level is the mesh right after a collapse and after the moves and flips recorded before the next one. A run that
//! polishes or unfolds does so after its last collapse: its own level is the result, finer ones are as the collapses left
//! them.

use super::{Changes, EdgeStar, Entry, History, LiveMesh, Move, Patch, PatchFace, Record};
use crate::{
    Error, Result,
    mesh::{Mesh, content_digest},
};

/// State that a record changes, to undo it.
#[derive(Clone, Copy, Debug)]
struct Undo {
    faces_end: usize,
    moved: Option<Move>,
    row_values: usize,
    /// Triangles before the record where it is a collapse.
    triangles_before: Option<usize>,
}

/// A mesh that moves along a history in both directions.
#[derive(Clone, Debug)]
pub struct Replay<'a> {
    live: LiveMesh,
    history: &'a History,
    undo: Vec<Undo>,
    faces: Vec<PatchFace>,
    star: EdgeStar,
    patch: Patch,
    changes: Changes,
}

impl<'a> Replay<'a> {
    /// Starts at the input, which must be the very mesh the history was recorded on.
    ///
    /// # Errors
    /// [`Error::Input`] where it is not.
    pub fn new(mesh: &Mesh, history: &'a History) -> Result<Self> {
        let header = history.header();
        if content_digest(mesh) != header.input {
            return Err(Error::input(
                "-",
                "the history was recorded on another mesh; expected the same file, loaded with the same options",
            ));
        }
        if mesh.attributes().stride() as u32 != header.stride
            || mesh.precision() != header.precision
        {
            return Err(Error::input(
                "-",
                "the history contradicts itself: its attributes are not those of its input",
            ));
        }
        Ok(Self {
            live: LiveMesh::new(mesh, header.frame),
            history,
            undo: Vec::new(),
            faces: Vec::new(),
            star: EdgeStar::default(),
            patch: Patch::default(),
            changes: Changes::default(),
        })
    }

    /// The mesh where it is now.
    pub fn live(&self) -> &LiveMesh {
        &self.live
    }

    /// Number of records that are applied.
    pub fn applied(&self) -> usize {
        self.undo.len()
    }

    /// Goes to a level: the first with no more than `triangles`, or the last there is. Without polishing and unfolding, and
    /// with the same concessions, it is what a direct run to `triangles` would have ended with. Time: proportional to the records in between.
    ///
    /// # Errors
    /// [`Error::Input`] where a record does not fit the mesh.
    pub fn seek(&mut self, triangles: usize) -> Result<()> {
        while self.live.triangle_count() > triangles && self.forward()? {}
        loop {
            let collapses = self.undo.iter().rposition(|u| u.triangles_before.is_some());
            match collapses.and_then(|i| Some((i, self.undo[i].triangles_before?))) {
                Some((i, before)) if before <= triangles => {
                    while self.undo.len() > i {
                        self.back();
                    }
                }
                _ => break,
            }
        }
        while self.polishes_next() {
            self.forward()?;
        }
        Ok(())
    }

    /// True where the next record belongs to the level there is.
    fn polishes_next(&self) -> bool {
        let next = self.history.entry(self.undo.len());
        next.is_some_and(|entry| !matches!(entry.record, Record::Collapse { .. }))
    }

    /// Applies the next record; false at the end.
    ///
    /// # Errors
    /// [`Error::Input`] where it does not fit the mesh.
    pub fn forward(&mut self) -> Result<bool> {
        let Some(entry) = self.history.entry(self.undo.len()) else {
            return Ok(false);
        };
        self.prepare(&entry).map_err(|message| {
            let record = self.undo.len();
            Error::input("-", format!("record {record} of the history {message}"))
        })?;
        let row_values = self.patch.rows.len();
        let collapse = matches!(entry.record, Record::Collapse { .. });
        let triangles_before = collapse.then_some(self.live.triangle_count());
        self.live.apply(&self.patch, &mut self.changes);
        self.faces.extend_from_slice(&self.patch.removed);
        self.undo.push(Undo {
            faces_end: self.faces.len(),
            moved: self.patch.moved,
            row_values,
            triangles_before,
        });
        Ok(true)
    }

    /// Takes the last record back; false at the input.
    pub fn back(&mut self) -> bool {
        let before = self.undo.len().checked_sub(2);
        let start = before.map_or(0, |i| self.undo[i].faces_end);
        let Some(undo) = self.undo.pop() else {
            return false;
        };
        let removed = &self.faces[start..undo.faces_end];
        self.live
            .revert(removed, undo.moved, undo.row_values, &mut self.changes);
        self.faces.truncate(start);
        true
    }

    /// Makes the patch of a record, or says what is wrong with it.
    fn prepare(&mut self, entry: &Entry<'_>) -> Result<(), String> {
        let live = &self.live;
        let known = |v: u32| v < live.vertex_ids();
        let rounded = |to| {
            live.round(live.frame().enter(to))
                .ok_or("moves a vertex out of range")
        };
        let vertex = match entry.record {
            Record::Collapse { keep, gone, to } => {
                let edge = known(gone).then(|| live.find_edge(keep, gone)).flatten();
                let edge =
                    edge.ok_or_else(|| format!("collapses ({keep}, {gone}), which is no edge"))?;
                self.star.gather(live, edge);
                self.star.patch(live, rounded(to)?, &mut self.patch);
                keep
            }
            Record::Move { vertex, to } => {
                if !known(vertex) || live.valence(vertex) == 0 {
                    return Err(format!("moves vertex {vertex}, which is not there"));
                }
                self.patch.set_move(live, vertex, rounded(to)?);
                vertex
            }
            Record::Flip { edge } => {
                if !known(edge[1]) || !self.patch.set_flip(live, edge) {
                    return Err(format!("flips {edge:?}, which is no edge that can be"));
                }
                return Ok(());
            }
        };
        let stride = self.history.header().stride as usize;
        if stride == 0 {
            return Ok(());
        }
        if entry.corners.len() != self.patch.added.len() || !entry.rows.len().is_multiple_of(stride)
        {
            return Err("has wedges for another number of faces".into());
        }
        let wedges = u64::from(live.wedge_count()) + (entry.rows.len() / stride) as u64;
        if let Some(w) = entry.corners.iter().find(|&&w| u64::from(w) >= wedges) {
            return Err(format!("names wedge {w}, but there are {wedges}"));
        }
        for (face, &wedge) in self.patch.added.iter_mut().zip(entry.corners) {
            if let Some(k) = face.corner(vertex) {
                face.wedges[k] = wedge;
            }
        }
        self.patch.rows.clear();
        self.patch.rows.extend_from_slice(entry.rows);
        Ok(())
    }
}
