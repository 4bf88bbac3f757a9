//! The certificate that triangles lie within a distance of the original surface, everywhere.
//!
//! The distance to one triangle of the original is a convex function: a piece whose three corners are within reach of
//! the *same* triangle is within reach as a whole. A piece for which the triangle nearest to its centroid does not do is
//! cut at a wall of that triangle where the triangle is large, or halved, until pieces are small (1/64 of the bound);
//! then the answer is no. So a yes is a proof, and a no is right but
//! for a margin of some percent of the bound where the surface is at the bound. Pieces wait in a queue, large ones first:
//! a centroid out of reach ends the test early.

use glam::DVec3;

use super::{Facet, Reach, reach::halve};
use crate::{geometry::TriangleTree, num::Each};

/// Pieces that one test looks at, at most.
const PIECES: usize = 1 << 16;

/// A piece of a triangle that is tested, and the guess for its neighbour.
#[derive(Clone, Copy, Debug)]
struct Piece {
    corners: [DVec3; 3],
    near: Option<u32>,
}

/// Buffers of a test.
#[derive(Clone, Debug, Default)]
pub struct PieceQueue(Vec<Piece>);

/// The original surface.
#[derive(Clone, Debug, Default)]
pub struct OriginalSurface {
    tree: Option<TriangleTree<Facet>>,
}

impl OriginalSurface {
    /// The surface of triangles; O(n log n).
    pub fn new(triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        Self {
            tree: TriangleTree::of(triangles.map(Facet::new).collect()),
        }
    }

    /// True where `p` is within reach.
    pub fn reaches(&self, p: DVec3, reach: Reach) -> bool {
        let tree = self.tree.as_ref();
        tree.is_some_and(|tree| tree.nearest_within(p, None, reach.squared).is_some())
    }

    /// True where every point of the triangles is proved to be within reach.
    pub fn holds(
        &self,
        triangles: impl Iterator<Item = [DVec3; 3]>,
        reach: Reach,
        pieces: &mut PieceQueue,
    ) -> bool {
        let queue = &mut pieces.0;
        queue.clear();
        queue.extend(triangles.map(|corners| Piece {
            corners,
            near: None,
        }));
        let Some(tree) = &self.tree else {
            return queue.is_empty();
        };
        let mut next = 0;
        while let Some(&piece) = queue.get(next) {
            next += 1;
            let [a, b, c] = piece.corners;
            let centroid = ((a + b) + c) / 3.0;
            let Some(near) = tree.nearest_within(centroid, piece.near, reach.squared) else {
                return false;
            };
            let facet = tree.item(near);
            if [a, b, c]
                .iter()
                .all(|&p| facet.distance2(p) < reach.squared)
            {
                continue;
            }
            let (longest2, middle, apex) = halve(piece.corners);
            if longest2 <= reach.finest2 || queue.len() >= PIECES {
                return false;
            }
            if longest2 >= reach.large2
                && let Some(cut) = facet.cut(piece.corners, reach.length)
            {
                let parts = cut.parts(piece.corners, cut.between);
                queue.extend(parts.each(|corners| Piece {
                    corners,
                    near: Some(near),
                }));
                continue;
            }
            for replaced in [(apex + 1) % 3, (apex + 2) % 3] {
                let mut corners = piece.corners;
                corners[replaced] = middle;
                queue.push(Piece {
                    corners,
                    near: Some(near),
                });
            }
        }
        true
    }
}
