//! A local change of a mesh: faces that go, faces that come, and at most one vertex that moves; its commit, and its way
//! back.
//!
//! Collapses, moves, flips and removals are all patches. A face that changes is in both lists under the same id.
//! Ids are those after the commit, so that a candidate is rendered under the keys it would have.

use glam::DVec3;

use super::{
    EdgeStar, LiveMesh,
    wedge::{WedgeScratch, WedgeValues, transfer},
};
use crate::num::Each;

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

impl PatchFace {
    /// The corner where a vertex is.
    #[inline]
    pub fn corner(&self, vertex: u32) -> Option<usize> {
        self.corners.iter().position(|&v| v == vertex)
    }
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

/// A local change of a [`LiveMesh`]. Buffers are reused: fill one with [`Site::patch`](super::Site::patch),
/// [`Patch::set_move`] or [`Patch::set_flip`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patch {
    /// Faces as they are before, ascending ids; a face that only changes is also in `added`.
    pub removed: Vec<PatchFace>,
    /// Faces as they are after, ascending ids. Each id is also in `removed` (a collapse never makes a new id).
    pub added: Vec<PatchFace>,
    /// The vertex that moves, if one does.
    pub moved: Option<Move>,
    /// The vertex that no face uses afterwards because it became `moved.vertex`: only of a collapse. Its old position
    /// stays readable.
    pub gone: Option<u32>,
    /// Rows of values of new wedges, one after the other; the first has the id [`LiveMesh::wedge_count`] had before.
    pub rows: Vec<f64>,
    pub(super) scratch: WedgeScratch,
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

    /// Becomes the move of a vertex to `to` (frame units, rounded to the file's precision). Its wedges stay as they are;
    /// see [`Star::patch`](super::Star::patch) for a move that keeps textures in place.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn set_move(&mut self, live: &LiveMesh, vertex: u32, to: DVec3) {
        self.clear();
        let faces = live.triangles_at(vertex).map(|id| live.patch_face(id));
        self.removed.extend(faces);
        self.removed.sort_unstable_by_key(|f| f.id);
        self.added.extend_from_slice(&self.removed);
        self.moved = Some(Move {
            vertex,
            from: live.position(vertex),
            to,
        });
    }

    /// Becomes the flip of the edge between two vertices: of its two faces, `(x, y, c)` and `(y, x, d)`, the one
    /// becomes `(x, d, c)` and the other `(y, c, d)`, in place. False, and meaningless, where the edge has not exactly
    /// two faces that run along it in opposite directions, or there is an edge `(c, d)` already.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn set_flip(&mut self, live: &LiveMesh, ends: [u32; 2]) -> bool {
        self.clear();
        let at = live.triangles_at(ends[0]);
        self.removed.extend(
            at.filter_map(|id| live.triangle(id).map(|corners| (id, corners)))
                .filter(|(_, corners)| corners.contains(&ends[1]))
                .map(|(id, _)| live.patch_face(id)),
        );
        self.removed.sort_unstable_by_key(|f| f.id);
        let &[f, g] = self.removed.as_slice() else {
            return false;
        };
        // The corner of each face that does not belong to the edge.
        let apex = |face: &PatchFace| face.corners.iter().position(|v| !ends.contains(v));
        let (Some(i), Some(j)) = (apex(&f), apex(&g)) else {
            return false;
        };
        let (c, d) = (f.corners[i], g.corners[j]);
        let opposite = f.corners[(i + 1) % 3] == g.corners[(j + 2) % 3];
        if c == d || !opposite || live.find_edge(c, d).is_some() {
            return false;
        }
        for (mut face, apex, other, from) in [(f, i, g, j), (g, j, f, i)] {
            let second = (apex + 2) % 3;
            face.corners[second] = other.corners[from];
            face.wedges[second] = other.wedges[from];
            self.added.push(face);
        }
        true
    }

    /// The patch that takes back one that moves or flips: faces and position as before. Rows that it appended stay unused.
    pub fn reversed(&self) -> Self {
        Self {
            removed: self.added.clone(),
            added: self.removed.clone(),
            moved: self.moved.map(|m| Move {
                from: m.to,
                to: m.from,
                ..m
            }),
            ..Self::default()
        }
    }

    /// The edge that this patch flips, the smaller end first; `None` where it is no flip.
    pub fn flipped(&self) -> Option<[u32; 2]> {
        let ([f, g], [new_f, new_g], None) = (&self.removed[..], &self.added[..], self.moved)
        else {
            return None;
        };
        let lost = |old: &PatchFace, new: &PatchFace| {
            let mut corners = old.corners.into_iter();
            corners.find(|v| !new.corners.contains(v))
        };
        let (a, b) = (lost(f, new_f)?, lost(g, new_g)?);
        Some([a.min(b), a.max(b)])
    }

    /// Corner positions of one of the `removed` faces, before or after the commit.
    pub fn before(&self, live: &LiveMesh, face: &PatchFace) -> [DVec3; 3] {
        face.corners.each(|v| match self.moved {
            Some(m) if m.vertex == v => m.from,
            _ => live.position(v),
        })
    }

    /// Corner positions of one of the `added` faces, before or after the commit.
    pub fn after(&self, live: &LiveMesh, face: &PatchFace) -> [DVec3; 3] {
        face.corners.each(|v| match self.moved {
            Some(m) if m.vertex == v => m.to,
            _ => live.position(v),
        })
    }
}

impl EdgeStar {
    /// Fills `patch` with the collapse of the edge to `position`.
    ///
    /// Wedges of the new vertex: see [`super::wedge`]. Allocates only while buffers grow.
    pub fn patch(&self, live: &LiveMesh, position: DVec3, patch: &mut Patch) {
        self.patch_by(live, position, None, patch);
    }

    /// Fills `patch` as [`EdgeStar::patch`] does, with the values of wedges by a method that gives some.
    pub fn patch_by(
        &self,
        live: &LiveMesh,
        position: DVec3,
        values: Option<&dyn WedgeValues>,
        patch: &mut Patch,
    ) {
        patch.clear();
        let [u, w] = self.ends;
        for face in &self.faces {
            let old = live.patch_face(face.id);
            patch.removed.push(old);
            if face.survives {
                let corners = face.corners.each(|v| if v == w { u } else { v });
                patch.added.push(PatchFace { corners, ..old });
            }
        }
        patch.moved = Some(Move {
            vertex: u,
            from: self.points[0],
            to: position,
        });
        patch.gone = Some(w);
        transfer(live, self, (position, values), patch);
    }
}

/// Edges that a patch made and unmade; the queue follows them.
#[derive(Clone, Debug, Default)]
pub struct Changes {
    /// New edge ids. An id may be one that an *earlier* patch deleted.
    pub created: Vec<u32>,
    /// Edge ids that are no longer in use.
    pub deleted: Vec<u32>,
}

impl LiveMesh {
    /// Commits a patch. `changes` is cleared and then says which edges it made and unmade.
    ///
    /// The patch must have been made for this mesh in this state.
    pub fn apply(&mut self, patch: &Patch, changes: &mut Changes) {
        changes.created.clear();
        changes.deleted.clear();
        // Sides are added before others are removed: an edge that stays never loses its id.
        pair(&patch.removed, &patch.added, |old, new| {
            let Some(new) = new else { return };
            for k in 0..3 {
                let side = [new.corners[k], new.corners[(k + 1) % 3]];
                if old.is_none_or(|o| [o.corners[k], o.corners[(k + 1) % 3]] != side) {
                    self.add_side(side[0], side[1], &mut changes.created);
                }
            }
        });
        pair(&patch.removed, &patch.added, |old, new| {
            let Some(old) = old else { return };
            for k in 0..3 {
                let side = [old.corners[k], old.corners[(k + 1) % 3]];
                if new.is_none_or(|n| [n.corners[k], n.corners[(k + 1) % 3]] != side) {
                    self.remove_side(side[0], side[1], &mut changes.deleted);
                }
            }
        });
        pair(&patch.removed, &patch.added, |old, new| match (old, new) {
            (Some(old), None) => self.unlink_face(old.id),
            (None, Some(new)) => self.link_face(new.id, new.corners),
            (Some(old), Some(new)) => {
                self.relink_face(old.id, old.corners, new.corners);
            }
            (None, None) => {}
        });
        if !self.wedges.is_empty() {
            for face in &patch.added {
                self.wedges[face.id as usize] = face.wedges;
            }
        }
        self.rows.append(&patch.rows);
        if let Some(moved) = patch.moved {
            self.positions[moved.vertex as usize] = moved.to;
            if let Some(gone) = patch.gone {
                self.locked[moved.vertex as usize] |= self.locked[gone as usize];
                self.take_weight(moved.vertex, gone);
            }
        }
    }

    /// Takes back the patch committed last of those not yet taken back: `removed`, `moved` and the number of values in
    /// `rows` are that patch's. Faces, positions and wedges are then as before; locks stay as they are.
    pub fn revert(
        &mut self,
        removed: &[PatchFace],
        moved: Option<Move>,
        row_values: usize,
        changes: &mut Changes,
    ) {
        let current = removed.iter().filter(|f| self.triangle(f.id).is_some());
        let back = Patch {
            removed: current.map(|f| self.patch_face(f.id)).collect(),
            added: removed.to_vec(),
            moved: moved.map(|m| Move {
                vertex: m.vertex,
                from: m.to,
                to: m.from,
            }),
            ..Patch::default()
        };
        self.apply(&back, changes);
        self.rows.truncate(row_values);
    }
}

/// Calls `visit` for every id in either of two lists of ascending ids.
fn pair(
    removed: &[PatchFace],
    added: &[PatchFace],
    mut visit: impl FnMut(Option<&PatchFace>, Option<&PatchFace>),
) {
    let (mut i, mut j) = (0, 0);
    while i < removed.len() || j < added.len() {
        let old = removed
            .get(i)
            .filter(|o| added.get(j).is_none_or(|n| o.id <= n.id));
        let new = added
            .get(j)
            .filter(|n| removed.get(i).is_none_or(|o| n.id <= o.id));
        i += usize::from(old.is_some());
        j += usize::from(new.is_some());
        visit(old, new);
    }
}
