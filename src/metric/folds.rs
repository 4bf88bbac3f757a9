//! Folds and flipped faces: what a shaded picture may hide and a light or a printer shows.
//!
//! An edge is *folded* where the normals of its two faces have a cosine below [`FOLD_COSINE`]: the faces nearly lie on
//! each other. It counts where no folded edge of the reference is within [`REACH`] of its middle. A face is *flipped*
//! where all of the reference's surface around its centroid looks the other way: within [`REACH`], or as far as its
//! nearest point where that is farther. A thin sheet has both sides near, so it hides no face and accuses none.
//! Edges with one face or more than two have no angle; faces without area have no side.

use glam::DVec3;

use super::surface::frame_and_diagonal;
use crate::{
    Progress, Result,
    geometry::{TriangleTree, area_normal},
    mesh::{Edges, FramedMesh, Mesh},
    num::{
        Each,
        math::{length, sqrt},
    },
    parallel,
};

/// Cosine of the normals below which an edge is folded.
pub const FOLD_COSINE: f64 = -0.9;

/// Distance within which the reference's surface counts, as a fraction of its diagonal.
pub const REACH: f64 = 0.01;

/// Folds and flipped faces of a mesh that its reference does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Folds {
    /// Folded edges away from those of the reference.
    pub folded_edges: u64,
    /// Faces that look the other way than the reference around them.
    pub flipped_faces: u64,
}

/// The folds and flipped faces of `candidate` beside `reference`, both welded.
///
/// Independent of threads and orders. O((edges + faces) log faces) in practice.
///
/// # Errors
/// [`crate::Error::Input`] where the reference has no triangles; [`crate::Error::Interrupted`].
pub fn folds(reference: &Mesh, candidate: &Mesh, progress: &dyn Progress) -> Result<Folds> {
    let (frame, diagonal) = frame_and_diagonal(reference)?;
    let (reference, candidate) = (reference.enter_frame(frame), candidate.enter_frame(frame));
    progress.step("folds", 0, 1)?;
    let around = FoldReference::of(&reference, REACH * diagonal);
    let is_new = |&&ends: &&[DVec3; 2]| around.is_new(ends);
    let folded_edges = folded(&candidate).iter().filter(is_new).count() as u64;
    let faces: Vec<[DVec3; 3]> = corners(&candidate).collect();
    let is_flipped = |i: usize| around.is_flipped(faces[i]);
    Ok(Folds {
        folded_edges,
        flipped_faces: parallel::count(faces.len(), &is_flipped),
    })
}

/// The folded edges and the orientation of a reference, which the faults of other meshes are counted beside.
#[derive(Clone, Debug)]
pub struct FoldReference {
    creases: Option<TriangleTree>,
    orientation: Option<Orientation>,
    reach: f64,
}

impl FoldReference {
    /// Those of a mesh, or of a part of it that has all faces within `reach` (a length) of what will be asked about.
    /// O(n log n).
    pub fn of(part: &FramedMesh, reach: f64) -> Self {
        let creases = folded(part).into_iter().map(|[a, b]| [a, b, b]);
        Self {
            creases: TriangleTree::new(creases.collect()),
            orientation: Orientation::of_part(part, reach),
            reach,
        }
    }

    /// True for a folded edge that is away from all folded edges of the reference.
    pub fn is_new(&self, [a, b]: [DVec3; 2]) -> bool {
        let middle = (a + b) * 0.5;
        let creases = self.creases.as_ref();
        let near = creases.map(|c| c.squared_distance(middle, 0).0);
        near.is_none_or(|squared| squared > self.reach * self.reach)
    }

    /// As [`Orientation::is_flipped`]; false where there is no surface.
    pub fn is_flipped(&self, face: [DVec3; 3]) -> bool {
        let orientation = self.orientation.as_ref();
        orientation.is_some_and(|orientation| orientation.is_flipped(face))
    }
}

/// The surface of a reference and the side it shows: what tells whether a face is flipped.
#[derive(Clone, Debug)]
pub struct Orientation {
    surface: TriangleTree,
    reach: f64,
}

impl Orientation {
    /// The orientation of `reference`; `None` without triangles. O(n log n).
    pub fn new(reference: &FramedMesh) -> Option<Self> {
        let (low, high) = reference.in_frame_units().bounds()?;
        Self::of_part(reference, REACH * length(high - low))
    }

    /// As [`Orientation::new`], of a part of a surface that is near for what is within `reach`.
    pub(crate) fn of_part(part: &FramedMesh, reach: f64) -> Option<Self> {
        let surface = TriangleTree::new(corners(part).collect())?;
        Some(Self { surface, reach })
    }

    /// The surface.
    pub fn surface(&self) -> &TriangleTree {
        &self.surface
    }

    /// True where some surface within reach looks as a face does, which is then not flipped; any part of the reference
    /// can say so.
    pub fn agrees(&self, [a, b, c]: [DVec3; 3]) -> bool {
        let centroid = ((a + b) + c) / 3.0;
        let (normal, reach) = (area_normal([a, b, c]), self.reach);
        self.surface.looks_along(centroid, normal, reach * reach)
    }

    /// True where all of the surface around a face looks the other way. Faces without area have no side.
    pub fn is_flipped(&self, [a, b, c]: [DVec3; 3]) -> bool {
        let normal = area_normal([a, b, c]);
        let centroid = ((a + b) + c) / 3.0;
        if normal.dot(normal) <= 0.0 || self.agrees([a, b, c]) {
            return false;
        }
        let looks_along = |reach: f64| self.surface.looks_along(centroid, normal, reach * reach);
        // The nearest surface itself must count, whatever is rounded.
        let nearest = 1.000_001 * sqrt(self.surface.squared_distance(centroid, 0).0);
        nearest <= self.reach || !looks_along(nearest)
    }
}

fn corners(mesh: &FramedMesh) -> impl Iterator<Item = [DVec3; 3]> {
    let positions = mesh.positions();
    let corners = |t: &[u32; 3]| t.each(|v| positions[v as usize]);
    mesh.triangles().iter().map(corners)
}

/// The ends of the folded edges of a mesh.
fn folded(mesh: &FramedMesh) -> Vec<[DVec3; 2]> {
    let positions = mesh.positions();
    let mut found = Vec::new();
    for (edge, faces) in Edges::of(mesh.in_frame_units()).iter() {
        let &[first, second] = faces else {
            continue;
        };
        // The normal of a face as if it ran along the edge from its first end to its second.
        let normal = |face: u32, forward: bool| {
            let t = mesh.triangles()[face as usize];
            let [a, b, c] = t.each(|v| positions[v as usize]);
            let runs = (0..3).any(|k| [t[k], t[(k + 1) % 3]] == edge);
            let normal = area_normal([a, b, c]);
            if runs == forward { normal } else { -normal }
        };
        let (a, b) = (normal(first, true), normal(second, false));
        let (dot, size) = (a.dot(b), length(a) * length(b));
        if size > 0.0 && dot < FOLD_COSINE * size {
            found.push(edge.each(|v| positions[v as usize]));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Silent, mesh::generate};

    fn counted(reference: &Mesh, candidate: &Mesh) -> [u64; 2] {
        let found = folds(reference, candidate, &Silent).expect("triangles");
        [found.folded_edges, found.flipped_faces]
    }

    fn with_triangles(mesh: &Mesh, triangles: Vec<[u32; 3]>) -> Mesh {
        Mesh::from_triangles(mesh.positions().to_vec(), triangles).expect("valid")
    }

    #[test]
    fn a_face_turned_over_is_flipped_and_its_edges_are_no_folds() {
        let sphere = generate::icosphere(3);
        assert_eq!(counted(&sphere, &sphere), [0, 0]);
        let mut triangles = sphere.triangles().to_vec();
        triangles[7].swap(0, 1);
        assert_eq!(
            counted(&sphere, &with_triangles(&sphere, triangles)),
            [0, 1]
        );
        let all: Vec<_> = sphere
            .triangles()
            .iter()
            .map(|&[a, b, c]| [b, a, c])
            .collect();
        let turned = counted(&sphere, &with_triangles(&sphere, all));
        assert_eq!(turned, [0, sphere.triangles().len() as u64]);
    }

    #[test]
    fn a_vertex_pulled_over_its_neighbours_makes_folds_and_flips() {
        let grid = generate::grid(10, 10, generate::Height::Flat);
        let mut positions = grid.positions().to_vec();
        let pulled = positions.len() / 2;
        let step = positions[1] - positions[0];
        positions[pulled] += step * 1.5;
        let folded = Mesh::from_triangles(positions, grid.triangles().to_vec()).expect("valid");
        let [edges, faces] = counted(&grid, &folded);
        assert!(edges > 0 && faces > 0, "{edges} {faces}");
        // What is folded in the reference is no fault of the candidate.
        assert_eq!(counted(&folded, &folded), [0, 0]);
    }

    #[test]
    fn both_sides_of_a_thin_sheet_accuse_no_face() {
        let grid = generate::grid(8, 8, generate::Height::Flat);
        let (low, high) = grid.bounds().expect("triangles");
        let offset = DVec3::Z * (1e-4 * (high - low).length());
        let mut positions = grid.positions().to_vec();
        let count = positions.len() as u32;
        positions.extend(grid.positions().iter().map(|&p| p - offset));
        let mut triangles = grid.triangles().to_vec();
        let below = grid.triangles().iter();
        triangles.extend(below.map(|&[a, b, c]| [b + count, a + count, c + count]));
        let sheet = Mesh::from_triangles(positions, triangles).expect("valid");
        assert_eq!(counted(&sheet, &sheet), [0, 0]);
    }
}
