//! The mesh that shrinks: faces, corner lists and edges with stable ids, in frame units.
//!
//! Flat `u32` arrays; the faces and edges at a vertex are short lists in a pool. Lists have no meaningful order;
//! whoever sums over them sorts by id first ([`Ring`](super::Ring) does). Nothing is assumed about manifoldness: an
//! edge counts its faces.

mod links;

use glam::DVec3;

use super::{Move, Patch, PatchFace, lists::Lists, wedge::WedgeRows};
use crate::{
    mesh::{Materials, Mesh},
    num::{Frame, Precision},
};

/// No vertex, face, wedge, edge or corner.
pub const NONE: u32 = u32::MAX;

/// Edges at one end of an edge that are looked through without a look at the other end.
const FEW: usize = 32;

/// An edge: its ends and its number of faces.
#[derive(Clone, Copy, Debug)]
struct EdgeRecord {
    ends: [u32; 2],
    faces: u32,
}

/// An edge as one of its ends sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Incident {
    other: u32,
    edge: u32,
}

/// Edges that a patch made and unmade; the queue follows them.
#[derive(Clone, Debug, Default)]
pub struct Changes {
    /// New edge ids. An id may be one that an *earlier* patch deleted.
    pub created: Vec<u32>,
    /// Edge ids that are no longer in use.
    pub deleted: Vec<u32>,
}

/// A mesh under surgery. Triangle and vertex ids are those of the mesh it was made from, for ever.
#[derive(Clone, Debug, Default)]
pub struct LiveMesh {
    pub(super) frame: Frame,
    pub(super) precision: Precision,
    pub(super) positions: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
    live: usize,
    faces_at: Lists<u32>,
    edges: Vec<EdgeRecord>,
    free_edges: Vec<u32>,
    edges_at: Lists<Incident>,
    locked: Vec<bool>,
    /// Vertices whose faces are not all here, where there are any; see [`super::tiles`].
    frozen: Vec<bool>,
    pub(super) rows: WedgeRows,
    pub(super) wedges: Vec<[u32; 3]>,
    pub(super) materials: Materials,
    may_have_features: bool,
}

impl LiveMesh {
    /// A live copy of `mesh` (file units, canonical order) in units of `frame`.
    ///
    /// Triangles that repeat a vertex have no area and no edges to collapse: they are dead from the start. O(n).
    #[must_use]
    pub fn new(mesh: &Mesh, frame: Frame) -> Self {
        let mut live = Self {
            frame,
            precision: mesh.precision(),
            positions: mesh.positions().iter().map(|&p| frame.enter(p)).collect(),
            locked: vec![false; mesh.positions().len()],
            rows: WedgeRows::of(mesh.attributes()),
            wedges: mesh.attributes().corners().to_vec(),
            materials: mesh.materials().clone(),
            ..Self::default()
        };
        let materials = &mesh.materials().of_triangle;
        live.may_have_features =
            live.rows.has_feature_channels() || materials.windows(2).any(|m| m[0] != m[1]);
        live.link(mesh.triangles().to_vec());
        live
    }

    /// A part of `whole`, without attributes, materials and locks: some of its vertices and faces under new ids. Edges
    /// at `frozen` vertices are never collapsed.
    pub(super) fn part(
        whole: &Self,
        positions: Vec<DVec3>,
        faces: Vec<[u32; 3]>,
        frozen: Vec<bool>,
    ) -> Self {
        let mut live = Self {
            frame: whole.frame,
            precision: whole.precision,
            locked: vec![false; positions.len()],
            positions,
            frozen,
            ..Self::default()
        };
        live.link(faces);
        live
    }

    /// Takes over faces and positions from parts, and finds all adjacency anew; faces of [`NONE`] are dead. O(n).
    pub(super) fn link(&mut self, faces: Vec<[u32; 3]>) {
        let mut valences = vec![0; self.positions.len()];
        let mut count = 0;
        for &[a, b, c] in &faces {
            if a != b && b != c && c != a {
                count += 1;
                for v in [a, b, c] {
                    valences[v as usize] += 1;
                }
            }
        }
        self.faces = vec![[NONE; 3]; faces.len()];
        self.live = 0;
        self.faces_at = Lists::with_room(&valences);
        self.edges_at = Lists::with_room(&valences);
        self.edges = Vec::with_capacity(count / 2 * 3 + 64);
        self.free_edges.clear();
        let mut created = Vec::new();
        for (t, corners) in faces.into_iter().enumerate() {
            let [a, b, c] = corners;
            if a != b && b != c && c != a {
                self.link_face(t as u32, corners);
                for k in 0..3 {
                    self.add_side(corners[k], corners[(k + 1) % 3], &mut created);
                }
                created.clear();
            }
        }
    }

    /// From frame units to file units.
    #[must_use]
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// The precision of the file.
    #[must_use]
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// `p` as the file can store it, in frame units; `None` where it is not finite there.
    #[must_use]
    pub fn round(&self, p: DVec3) -> Option<DVec3> {
        self.frame.round(p, self.precision)
    }

    /// Number of triangles that are left.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.live
    }

    /// Number of triangle ids, dead ones included.
    #[must_use]
    pub fn triangle_ids(&self) -> u32 {
        self.faces.len() as u32
    }

    /// Number of vertex ids, unused ones included.
    #[must_use]
    pub fn vertex_ids(&self) -> u32 {
        self.positions.len() as u32
    }

    /// Number of edge ids, unused ones included.
    #[must_use]
    pub fn edge_ids(&self) -> u32 {
        self.edges.len() as u32
    }

    /// Position of a vertex in frame units; of a vertex that is gone, its last one.
    ///
    /// # Panics
    /// Where there is no such vertex.
    #[inline]
    #[must_use]
    pub fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// All positions in frame units, by vertex id.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The vertices of a triangle; `None` where it is dead.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[inline]
    #[must_use]
    pub fn triangle(&self, id: u32) -> Option<[u32; 3]> {
        let corners = self.faces[id as usize];
        (corners[0] != NONE).then_some(corners)
    }

    /// The corner positions of a triangle in frame units; `None` where it is dead.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[must_use]
    pub fn points(&self, id: u32) -> Option<[DVec3; 3]> {
        Some(self.triangle(id)?.map(|v| self.position(v)))
    }

    /// The wedges of a triangle; [`NONE`] each where there are no attributes.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[must_use]
    pub fn wedges(&self, id: u32) -> [u32; 3] {
        if self.wedges.is_empty() {
            [NONE; 3]
        } else {
            self.wedges[id as usize]
        }
    }

    /// The material of a triangle, as [`Materials::of`].
    #[must_use]
    pub fn material(&self, id: u32) -> u32 {
        self.materials.of(id as usize)
    }

    /// The values of all wedges.
    #[must_use]
    pub fn rows(&self) -> &WedgeRows {
        &self.rows
    }

    /// Number of wedges, unused ones included.
    #[must_use]
    pub fn wedge_count(&self) -> u32 {
        self.rows.count()
    }

    /// True where texture coordinates, colours or materials can make an edge a feature.
    #[must_use]
    pub fn may_have_features(&self) -> bool {
        self.may_have_features
    }

    /// True where the vertex must stay where it is.
    ///
    /// # Panics
    /// Where there is no such vertex.
    #[must_use]
    pub fn is_locked(&self, vertex: u32) -> bool {
        self.locked[vertex as usize]
    }

    /// True where an edge must not be collapsed because some of the faces around it are elsewhere.
    #[inline]
    pub(super) fn is_frozen(&self, edge: u32) -> bool {
        let ends = self.edges[edge as usize].ends;
        !self.frozen.is_empty() && ends.iter().any(|&v| self.frozen[v as usize])
    }

    /// True where nothing but positions and triangles matters: no attributes, no borders of materials, no locks.
    pub(super) fn is_plain(&self) -> bool {
        !self.may_have_features && self.wedges.is_empty() && !self.locked.contains(&true)
    }

    /// Locks or unlocks a vertex. A locked vertex keeps its position and survives every collapse as a place.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn set_locked(&mut self, vertex: u32, locked: bool) {
        self.locked[vertex as usize] = locked;
    }

    /// The triangles at a vertex, in no particular order.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn triangles_at(&self, vertex: u32) -> impl Iterator<Item = u32> {
        self.faces_at.of(vertex).iter().copied()
    }

    /// Number of triangles at a vertex.
    ///
    /// # Panics
    /// Where there is no such vertex.
    #[inline]
    #[must_use]
    pub fn valence(&self, vertex: u32) -> usize {
        self.faces_at.of(vertex).len()
    }

    /// True where a vertex has as many edges as faces, as inside a surface; at a boundary it has one edge more.
    ///
    /// # Panics
    /// Where there is no such vertex.
    #[inline]
    #[must_use]
    pub fn has_closed_fan(&self, vertex: u32) -> bool {
        self.faces_at.of(vertex).len() == self.edges_at.of(vertex).len()
    }

    /// The edges at a vertex, in no particular order.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn edges_at(&self, vertex: u32) -> impl Iterator<Item = u32> {
        self.edges_at.of(vertex).iter().map(|i| i.edge)
    }

    /// The ends of an edge, the smaller first; `None` where the id is not in use.
    ///
    /// # Panics
    /// Where there is no such id.
    #[inline]
    #[must_use]
    pub fn edge(&self, id: u32) -> Option<[u32; 2]> {
        let ends = self.edges[id as usize].ends;
        (ends[0] != NONE).then_some(ends)
    }

    /// Number of faces at an edge: 1 at a boundary, 2 inside, more where the mesh is not manifold.
    ///
    /// # Panics
    /// Where there is no such id.
    #[must_use]
    pub fn faces_at_edge(&self, id: u32) -> u32 {
        self.edges[id as usize].faces
    }

    /// The edge between two vertices.
    ///
    /// # Panics
    /// Where there is no such vertex.
    #[must_use]
    pub fn find_edge(&self, a: u32, b: u32) -> Option<u32> {
        let mut at = (self.edges_at.of(a), b);
        if at.0.len() > FEW {
            // A hub may have a million edges.
            let others = self.edges_at.of(b);
            if others.len() < at.0.len() {
                at = (others, a);
            }
        }
        let incident = at.0.iter().find(|i| i.other == at.1);
        incident.map(|i| i.edge)
    }

    /// Face `id` as it is now, for a patch.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[must_use]
    pub fn patch_face(&self, id: u32) -> PatchFace {
        PatchFace {
            id,
            corners: self.faces[id as usize],
            wedges: self.wedges(id),
        }
    }

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
