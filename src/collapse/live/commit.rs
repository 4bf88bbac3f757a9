//! Commits of patches, and their way back.

use super::LiveMesh;
use crate::collapse::{Move, Patch, PatchFace};

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
                self.faces[old.id as usize] = new.corners;
                for k in 0..3 {
                    if old.corners[k] != new.corners[k] {
                        self.faces_at.remove(old.corners[k], old.id);
                        self.faces_at.push(new.corners[k], old.id);
                    }
                }
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
