//! A local change of a mesh: faces that go, faces that come, and at most one vertex that moves.
//!
//! Collapses, moves, flips and removals are all patches. A face that changes is in both lists under the same id.
//! Ids are those after the commit, so that a candidate is rendered under the keys it would have.

use glam::DVec3;

use super::{LiveMesh, wedge::Scratch};

/// A face of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchFace {
    /// Triangle id.
    pub id: u32,
    /// Its vertices, in its own order.
    pub corners: [u32; 3],
    /// Its wedges; [`super::NONE`] each where the mesh has no attributes.
    pub wedges: [u32; 3],
}

/// A vertex that changes its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// Its id.
    pub vertex: u32,
    /// Position before, in frame units.
    pub from: DVec3,
    /// Position after, in frame units, already rounded to the output's precision.
    pub to: DVec3,
}

/// A local change of a [`LiveMesh`]. Buffers are reused: fill one with [`Site::patch`](super::Site::patch).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patch {
    /// Faces as they are before, ascending ids; a face that only changes is also in `added`.
    pub removed: Vec<PatchFace>,
    /// Faces as they are after, ascending ids. Each id is also in `removed` (a collapse never makes a new id).
    pub added: Vec<PatchFace>,
    /// The vertex that moves, if one does.
    pub moved: Option<Move>,
    /// The vertex that no face uses afterwards because it became `moved.vertex`. Its old position stays readable.
    pub gone: Option<u32>,
    /// Rows of values of new wedges, one after the other; the first has the id [`LiveMesh::wedge_count`] had before.
    pub rows: Vec<f64>,
    pub(super) scratch: Scratch,
}

impl Patch {
    /// Forgets everything but the buffers.
    pub fn clear(&mut self) {
        self.removed.clear();
        self.added.clear();
        self.moved = None;
        self.gone = None;
        self.rows.clear();
    }

    /// Corner positions of one of the `removed` faces, before or after the commit.
    #[must_use]
    pub fn before(&self, live: &LiveMesh, face: &PatchFace) -> [DVec3; 3] {
        face.corners.map(|v| match self.moved {
            Some(m) if m.vertex == v => m.from,
            _ => live.position(v),
        })
    }

    /// Corner positions of one of the `added` faces, before or after the commit.
    #[must_use]
    pub fn after(&self, live: &LiveMesh, face: &PatchFace) -> [DVec3; 3] {
        face.corners.map(|v| match self.moved {
            Some(m) if m.vertex == v => m.to,
            _ => live.position(v),
        })
    }
}
