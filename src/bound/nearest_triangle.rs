//! The replacement of each point of an original where a simplified mesh alone is given: its nearest triangle.

use glam::DVec3;

use super::surface::{Pair, Replacement};
use crate::{
    geometry::{TriangleTree, closest_point},
    mesh::Mesh,
    num::Each,
};

/// A mesh as the replacement of another one: a part of the original goes to the triangle that is nearest to its
/// centroid, each corner to the point of that triangle which is nearest to the corner. Vertices where there are no
/// triangles.
#[derive(Clone, Debug)]
pub struct NearestTriangle {
    tree: TriangleTree,
}

impl NearestTriangle {
    /// The triangles of a mesh, or its vertices where it has no triangles; `None` where it has neither. O(n log n).
    pub fn new(mesh: &Mesh) -> Option<Self> {
        let corners = originals(mesh).into_iter().map(|pair| pair.from).collect();
        TriangleTree::new(corners).map(|tree| Self { tree })
    }
}

impl Replacement for NearestTriangle {
    fn propose(&self, from: [DVec3; 3]) -> Option<[DVec3; 3]> {
        let [a, b, c] = from;
        let middle = if a == b && b == c {
            a
        } else {
            (a + b + c) / 3.0
        };
        let (_, index) = self.tree.squared_distance(middle, 0);
        let corners = self.tree.corners(index);
        Some(from.each(|p| closest_point(p, corners).0))
    }
}

/// The triangles of a mesh, or its vertices as triangles without a size where it has none (a point cloud); each goes to
/// itself as long as nothing else is proposed.
pub fn originals(mesh: &Mesh) -> Vec<Pair> {
    let pair = |from: [DVec3; 3], triangle: usize| Pair {
        from,
        to: from,
        triangle: triangle as u32,
    };
    let count = mesh.triangles().len();
    if count == 0 {
        let points = mesh.positions().iter().enumerate();
        return points.map(|(i, &p)| pair([p; 3], i)).collect();
    }
    (0..count).map(|t| pair(mesh.corners(t), t)).collect()
}
