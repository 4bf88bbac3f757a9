//! The mesh that shrinks: faces, corner lists and edges with stable ids, in frame units.
//!
//! Flat `u32` arrays; the faces and edges at a vertex are short lists in a pool. Lists have no meaningful order;
//! whoever sums over them sorts by id first ([`EdgeStar`](super::EdgeStar) does). Nothing is assumed about manifoldness: an
//! edge counts its faces.

mod incidence;
mod shares;

use glam::DVec3;

use self::{incidence::IncidenceLists, shares::Shares};
use super::{
    PatchFace,
    pinch::Forest,
    wedge::{ChartScales, WedgeRows},
};
use crate::{
    mesh::{Materials, Mesh},
    num::{Each, Frame, Precision},
};

/// No vertex, face, wedge, edge or corner.
pub const NONE: u32 = u32::MAX;

/// Edges at one vertex up to which they are searched for another vertex without counting those at the other.
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

/// A mesh under surgery. Triangle and vertex ids are those of the mesh it was made from, for ever.
#[derive(Clone, Debug, Default)]
pub struct LiveMesh {
    pub(super) frame: Frame,
    pub(super) precision: Precision,
    pub(super) positions: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
    live: usize,
    faces_at: IncidenceLists<u32>,
    edges: Vec<EdgeRecord>,
    free_edges: Vec<u32>,
    edges_at: IncidenceLists<Incident>,
    pub(super) locked: Vec<bool>,
    /// The weight of every vertex, where any is above 0; see [`super::weights`].
    pub(super) weights: Vec<f32>,
    /// Vertices of pieces that may vanish; empty where there are none.
    expendable: Vec<bool>,
    /// Vertices whose faces are not all here, where there are any; see [`super::tiles`].
    frozen: Vec<bool>,
    pub(super) rows: WedgeRows,
    pub(super) wedges: Vec<[u32; 3]>,
    pub(super) charts: ChartScales,
    pub(super) materials: Materials,
    /// Number of triangles that are left of every material.
    of_material: Vec<u32>,
    /// The targets of the meshes of a document, where each has its own.
    shares: Shares,
    may_have_features: bool,
}

impl LiveMesh {
    /// A live copy of `mesh` (file units, canonical order) in units of `frame`.
    ///
    /// Triangles that repeat a vertex have no area and no edges to collapse: they are dead from the start. O(n).
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
        live.charts = ChartScales::of(mesh, &live.rows, &live.positions);
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
        self.of_material = vec![0; self.materials.names.len()];
        self.faces = vec![[NONE; 3]; faces.len()];
        self.live = 0;
        self.faces_at = IncidenceLists::with_room(&valences);
        self.edges_at = IncidenceLists::with_room(&valences);
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
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// The precision of the file.
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// `p` as the file can store it, in frame units; `None` where it is not finite there.
    pub fn round(&self, p: DVec3) -> Option<DVec3> {
        self.frame.round(p, self.precision)
    }

    /// Number of triangles that are left.
    pub fn triangle_count(&self) -> usize {
        self.live
    }

    /// Number of triangle ids, dead ones included.
    pub fn triangle_ids(&self) -> u32 {
        self.faces.len() as u32
    }

    /// Number of vertex ids, unused ones included.
    pub fn vertex_ids(&self) -> u32 {
        self.positions.len() as u32
    }

    /// Number of edge ids, unused ones included.
    pub fn edge_ids(&self) -> u32 {
        self.edges.len() as u32
    }

    /// Position of a vertex in frame units; of a vertex that is gone, its last one.
    ///
    /// # Panics
    /// Where there is no such vertex.
    #[inline]
    pub fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// All positions in frame units, by vertex id.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The vertices of a triangle; `None` where it is dead.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[inline]
    pub fn triangle(&self, id: u32) -> Option<[u32; 3]> {
        let corners = self.faces[id as usize];
        (corners[0] != NONE).then_some(corners)
    }

    /// The corner positions of a triangle in frame units; `None` where it is dead.
    ///
    /// # Panics
    /// Where there is no such triangle.
    pub fn points(&self, id: u32) -> Option<[DVec3; 3]> {
        Some(self.triangle(id)?.each(|v| self.position(v)))
    }

    /// The wedges of a triangle; [`NONE`] each where there are no attributes.
    ///
    /// # Panics
    /// Where there is no such triangle.
    pub fn wedges(&self, id: u32) -> [u32; 3] {
        if self.wedges.is_empty() {
            [NONE; 3]
        } else {
            self.wedges[id as usize]
        }
    }

    /// The material of a triangle, as [`Materials::of`].
    pub fn material(&self, id: u32) -> u32 {
        self.materials.of(id as usize)
    }

    /// True where nothing would be left of a material without these triangles.
    pub(super) fn takes_last_of_material(&self, gone: impl Iterator<Item = u32> + Clone) -> bool {
        if self.of_material.is_empty() {
            return false;
        }
        let mut each = gone.clone().map(|id| self.material(id));
        each.any(|material| {
            let left = self.of_material.get(material as usize);
            let same = || gone.clone().filter(|&id| self.material(id) == material);
            left.is_some_and(|&left| same().count() >= left as usize)
        })
    }

    /// Number of materials that have a triangle.
    pub fn used_materials(&self) -> usize {
        self.of_material.iter().filter(|&&count| count > 0).count()
    }

    /// The values of all wedges.
    pub fn rows(&self) -> &WedgeRows {
        &self.rows
    }

    /// Number of wedges, unused ones included.
    pub fn wedge_count(&self) -> u32 {
        self.rows.count()
    }

    /// True where texture coordinates, colours or materials can make an edge a feature.
    pub fn may_have_features(&self) -> bool {
        self.may_have_features
    }

    /// True where the vertex must stay where it is.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn is_locked(&self, vertex: u32) -> bool {
        self.locked[vertex as usize]
    }

    /// True where an edge must not be collapsed because some of the faces around it are elsewhere.
    #[inline]
    pub(super) fn is_frozen(&self, edge: u32) -> bool {
        let ends = self.edges[edge as usize].ends;
        !self.frozen.is_empty() && ends.iter().any(|&v| self.frozen[v as usize])
    }

    /// Locks or unlocks a vertex. A locked vertex keeps its position and survives every collapse as a place.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn set_locked(&mut self, vertex: u32, locked: bool) {
        self.locked[vertex as usize] = locked;
    }

    /// True where the vertex belongs to a piece that may vanish.
    pub fn is_expendable(&self, vertex: u32) -> bool {
        self.expendable.get(vertex as usize).is_some_and(|&e| e)
    }

    /// Number of pieces: triangles that share vertices. O(n).
    pub fn pieces(&self) -> usize {
        let mut forest = self.forest();
        let mut roots = vec![false; self.positions.len()];
        for corners in self.faces.iter().filter(|f| f[0] != NONE) {
            roots[forest.root(corners[0] as usize)] = true;
        }
        roots.into_iter().filter(|&root| root).count()
    }

    /// Lets the pieces vanish of which no triangle is in `seen`, by triangle id, and returns the number of all pieces and
    /// of those. O(n).
    pub fn expend_unseen(&mut self, seen: &[bool]) -> [usize; 2] {
        let mut forest = self.forest();
        let mut pieces = vec![None; self.positions.len()];
        for t in (0..self.faces.len()).filter(|&t| self.faces[t][0] != NONE) {
            let root = forest.root(self.faces[t][0] as usize);
            *pieces[root].get_or_insert(false) |= seen[t];
        }
        let is_unseen = |v: usize, forest: &mut Forest| pieces[forest.root(v)] == Some(false);
        self.expendable = (0..pieces.len())
            .map(|v| is_unseen(v, &mut forest))
            .collect();
        let all = pieces.iter().flatten();
        [all.clone().count(), all.filter(|&&seen| !seen).count()]
    }

    /// Lets the same pieces vanish from `other`, made of the same vertices.
    #[must_use]
    pub fn lend_expendable(&self, other: Self) -> Self {
        Self {
            expendable: self.expendable.clone(),
            ..other
        }
    }

    /// The vertices by their pieces.
    fn forest(&self) -> Forest {
        let mut forest = Forest::of(self.positions.len());
        for [a, b, c] in self.faces.iter().copied().filter(|f| f[0] != NONE) {
            forest.unite(a as usize, b as usize);
            forest.unite(a as usize, c as usize);
        }
        forest
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
    pub fn valence(&self, vertex: u32) -> usize {
        self.faces_at.of(vertex).len()
    }

    /// True where a vertex has as many edges as faces, as inside a surface; at a boundary it has one edge more.
    ///
    /// # Panics
    /// Where there is no such vertex.
    #[inline]
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
    pub fn edge(&self, id: u32) -> Option<[u32; 2]> {
        let ends = self.edges[id as usize].ends;
        (ends[0] != NONE).then_some(ends)
    }

    /// Number of faces at an edge: 1 at a boundary, 2 inside, more where the mesh is not manifold.
    ///
    /// # Panics
    /// Where there is no such id.
    pub fn faces_at_edge(&self, id: u32) -> u32 {
        self.edges[id as usize].faces
    }

    /// The edge between two vertices; `None` also where there is no such vertex.
    pub fn find_edge(&self, a: u32, b: u32) -> Option<u32> {
        let (mut list, mut other) = (self.edges_at.get(a)?, b);
        if list.len() > FEW {
            // A hub may have a million edges.
            let shorter = self.edges_at.get(b)?;
            if shorter.len() < list.len() {
                (list, other) = (shorter, a);
            }
        }
        let incident = list.iter().find(|i| i.other == other);
        incident.map(|i| i.edge)
    }

    /// Face `id` as it is now, for a patch.
    ///
    /// # Panics
    /// Where there is no such triangle.
    pub fn patch_face(&self, id: u32) -> PatchFace {
        PatchFace {
            id,
            corners: self.faces[id as usize],
            wedges: self.wedges(id),
        }
    }
}

/// # Upkeep of the incidence lists, face by face
impl LiveMesh {
    pub(super) fn link_face(&mut self, id: u32, corners: [u32; 3]) {
        self.faces[id as usize] = corners;
        for v in corners {
            self.faces_at.push(v, id);
        }
        self.live += 1;
        if let Some(count) = self
            .of_material
            .get_mut(self.materials.of(id as usize) as usize)
        {
            *count += 1;
        }
        self.shares.count(self.materials.of(id as usize), true);
    }

    /// Gives a face other corners.
    pub(super) fn relink_face(&mut self, id: u32, old: [u32; 3], new: [u32; 3]) {
        self.faces[id as usize] = new;
        for (old, new) in old.into_iter().zip(new).filter(|(old, new)| old != new) {
            self.faces_at.remove(old, id);
            self.faces_at.push(new, id);
        }
    }

    pub(super) fn unlink_face(&mut self, id: u32) {
        for v in self.faces[id as usize] {
            self.faces_at.remove(v, id);
        }
        self.faces[id as usize] = [NONE; 3];
        self.live -= 1;
        if let Some(count) = self
            .of_material
            .get_mut(self.materials.of(id as usize) as usize)
        {
            *count -= 1;
        }
        self.shares.count(self.materials.of(id as usize), false);
    }

    pub(super) fn add_side(&mut self, a: u32, b: u32, created: &mut Vec<u32>) {
        if let Some(e) = self.find_edge(a, b) {
            self.edges[e as usize].faces += 1;
            return;
        }
        let ends = [a.min(b), a.max(b)];
        let record = EdgeRecord { ends, faces: 1 };
        let id = self.free_edges.pop().unwrap_or(self.edges.len() as u32);
        match self.edges.get_mut(id as usize) {
            Some(free) => *free = record,
            None => self.edges.push(record),
        }
        for (v, other) in [(a, b), (b, a)] {
            self.edges_at.push(v, Incident { other, edge: id });
        }
        created.push(id);
    }

    pub(super) fn remove_side(&mut self, a: u32, b: u32, deleted: &mut Vec<u32>) {
        let Some(id) = self.find_edge(a, b) else {
            return;
        };
        self.edges[id as usize].faces -= 1;
        if self.edges[id as usize].faces > 0 {
            return;
        }
        for (v, other) in [(a, b), (b, a)] {
            self.edges_at.remove(v, Incident { other, edge: id });
        }
        self.edges[id as usize].ends = [NONE; 2];
        self.free_edges.push(id);
        deleted.push(id);
    }
}
