//! Going back and forth in a recorded run: coarser by its records, finer by an undo log.

use super::{Changes, Entry, History, LiveMesh, Move, Patch, PatchFace, Ring};
use crate::{
    Error, Result,
    mesh::{Mesh, content_digest},
};

/// What it takes to undo a record.
#[derive(Clone, Copy, Debug)]
struct Undo {
    faces_end: usize,
    moved: Option<Move>,
    row_values: usize,
}

/// A mesh that moves along a history in both directions.
#[derive(Clone, Debug)]
pub struct Replay<'a> {
    live: LiveMesh,
    history: &'a History,
    undo: Vec<Undo>,
    faces: Vec<PatchFace>,
    ring: Ring,
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
            ring: Ring::default(),
            patch: Patch::default(),
            changes: Changes::default(),
        })
    }

    /// The mesh where it is now.
    #[must_use]
    pub fn live(&self) -> &LiveMesh {
        &self.live
    }

    /// Number of records that are applied.
    #[must_use]
    pub fn applied(&self) -> usize {
        self.undo.len()
    }

    /// Goes to the level that a direct run to `triangles` would have ended with: the first with no more triangles
    /// than that, or the last there is. Time: proportional to the records in between.
    ///
    /// # Errors
    /// [`Error::Input`] where a record does not fit the mesh.
    pub fn seek(&mut self, triangles: usize) -> Result<()> {
        while self.live.triangle_count() > triangles && self.forward()? {}
        while let Some(undo) = self.undo.last() {
            let start = self.faces_start();
            let removed = &self.faces[start..undo.faces_end];
            let dead = removed
                .iter()
                .filter(|f| self.live.triangle(f.id).is_none());
            if self.live.triangle_count() + dead.count() > triangles {
                break;
            }
            self.back();
        }
        Ok(())
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
        self.live.apply(&self.patch, &mut self.changes);
        self.faces.extend_from_slice(&self.patch.removed);
        self.undo.push(Undo {
            faces_end: self.faces.len(),
            moved: self.patch.moved,
            row_values,
        });
        Ok(true)
    }

    /// Takes the last record back; false at the input.
    pub fn back(&mut self) -> bool {
        let start = self.faces_start();
        let Some(undo) = self.undo.pop() else {
            return false;
        };
        let removed = &self.faces[start..undo.faces_end];
        self.live
            .revert(removed, undo.moved, undo.row_values, &mut self.changes);
        self.faces.truncate(start);
        true
    }

    fn faces_start(&self) -> usize {
        let before = self.undo.len().checked_sub(2);
        before.map_or(0, |i| self.undo[i].faces_end)
    }

    /// Makes the patch of a record, or says what is wrong with it.
    fn prepare(&mut self, entry: &Entry<'_>) -> Result<(), String> {
        let live = &self.live;
        let (keep, gone) = (entry.collapse.keep, entry.collapse.gone);
        let edge = (gone < live.vertex_ids())
            .then(|| live.find_edge(keep, gone))
            .flatten()
            .ok_or_else(|| format!("collapses ({keep}, {gone}), which is no edge"))?;
        self.ring.gather(live, edge);
        let to = live
            .round(live.frame().enter(entry.collapse.to))
            .ok_or("moves a vertex out of range")?;
        self.ring.patch(live, to, &mut self.patch);
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
            if let Some(k) = face.corners.iter().position(|&v| v == keep) {
                face.wedges[k] = wedge;
            }
        }
        self.patch.rows.clear();
        self.patch.rows.extend_from_slice(entry.rows);
        Ok(())
    }
}
