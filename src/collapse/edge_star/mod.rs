//! The star of an edge: the triangles that touch either end, each once, and the properties that rules test.
//!
//! `T(e)` of Lindstrom & Turk 1998. Faces ascend by id, other vertices by id, boundary edges follow the faces: a sum
//! over any of them has one written order, whatever the lists of the [`LiveMesh`] look like. Buffers are reused.

mod gather;

use glam::DVec3;

use self::gather::Link;
use super::{LiveMesh, Patch, PatchFace, patch::Move, pinch, wedge};
pub(super) use crate::geometry::area_normal as normal;
use crate::num::Each;

/// Places that the rules leave to the new vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Anywhere.
    Free,
    /// Only at this end of the edge (an index into [`EdgeStar::ends`]).
    At(usize),
}

/// A face of the star.
#[derive(Clone, Copy, Debug)]
pub struct StarFace {
    /// Triangle id.
    pub id: u32,
    /// Its vertices.
    pub corners: [u32; 3],
    /// Their positions.
    pub points: [DVec3; 3],
    /// `(p1 - p0) x (p2 - p0)`: twice its area along its normal.
    pub normal: DVec3,
    /// Corner that each end of the edge is; 3 for an end that is none.
    pub at: [u8; 2],
    /// False where the collapse removes it: both ends are corners, or an earlier face gets the same vertices.
    pub survives: bool,
}

impl StarFace {
    /// True where both ends of the edge are corners.
    #[inline]
    pub fn has_both(&self) -> bool {
        self.at[0] < 3 && self.at[1] < 3
    }

    /// The corner that becomes the new vertex; of a face with both ends, the one at the first.
    #[inline]
    pub fn apex(&self) -> usize {
        usize::from(if self.at[0] < 3 {
            self.at[0]
        } else {
            self.at[1]
        })
    }

    /// Its corners with the new vertex at `position`; meaningful where it survives.
    #[inline]
    pub fn points_after(&self, position: DVec3) -> [DVec3; 3] {
        let mut points = self.points;
        points[self.apex()] = position;
        points
    }
}

/// A vertex of the link: a neighbour of either end.
#[derive(Clone, Copy, Debug)]
pub struct Spoke {
    /// Its id.
    pub vertex: u32,
    /// Its position.
    pub point: DVec3,
    /// Number of different faces at the edges to the first and to the second end; 0 where there is no such edge.
    pub faces: [u32; 2],
    /// True where it forms a face with both ends.
    pub beside: bool,
    /// Features among the edges to the ends.
    pub feature: [bool; 2],
}

/// An edge with one face, at either end of the star's edge or the star's edge itself; directed as in its face.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryEdge {
    /// Start and end vertex.
    pub ends: [u32; 2],
    /// Position of the start.
    pub from: DVec3,
    /// Position of the end.
    pub to: DVec3,
}

/// The faces at the ends of an edge `(u, w)`, `u < w`, and their other vertices.
#[derive(Clone, Debug, Default)]
pub struct EdgeStar {
    /// Id of the edge.
    pub edge: u32,
    /// `[u, w]`; the new vertex takes the id `u`.
    pub ends: [u32; 2],
    /// Their positions.
    pub points: [DVec3; 2],
    /// `T(e)`, ascending ids.
    pub faces: Vec<StarFace>,
    /// The link, ascending ids.
    pub spokes: Vec<Spoke>,
    /// Boundary edges at either end, in the order of their faces.
    pub boundary: Vec<BoundaryEdge>,
    /// Number of different faces at the edge; faces with the same three vertices count once.
    pub edge_faces: u32,
    /// True where the edge is a feature: more than two faces, or attributes or materials differ across it.
    pub edge_feature: bool,
    /// Number of feature edges at each end, the edge itself included.
    pub feature_degree: [u32; 2],
    ids: Vec<u32>,
    /// Ascending vertices once they are collected.
    links: Vec<Link>,
    /// Faces by some of their vertices.
    keys: Vec<([u32; 3], usize)>,
}

impl EdgeStar {
    /// Collects the star of an edge; false where the edge id is not in use.
    ///
    /// O(faces log faces); allocates only while buffers grow.
    ///
    /// # Panics
    /// Where there is no such edge id.
    pub fn gather(&mut self, live: &LiveMesh, edge: u32) -> bool {
        let Some(ends) = live.edge(edge) else {
            return false;
        };
        self.edge = edge;
        self.ends = ends;
        self.points = ends.each(|v| live.position(v));
        self.gather_faces(live);
        self.gather_spokes(live);
        self.gather_boundary();
        self.mark_duplicates();
        self.gather_features(live);
        true
    }

    /// `|u - w|^2`.
    pub fn length2(&self) -> f64 {
        let d = self.points[1] - self.points[0];
        d.dot(d)
    }

    /// Midpoint of the edge.
    pub fn midpoint(&self) -> DVec3 {
        (self.points[0] + self.points[1]) * 0.5
    }

    /// Fills `patch` with the collapse of the edge to `position`.
    ///
    /// Wedges of the new vertex: see [`wedge`]. Allocates only while buffers grow.
    pub fn patch(&self, live: &LiveMesh, position: DVec3, patch: &mut Patch) {
        patch.clear();
        let [u, w] = self.ends;
        for face in &self.faces {
            let old = PatchFace {
                id: face.id,
                corners: face.corners,
                wedges: live.wedges(face.id),
            };
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
        wedge::transfer(live, self, position, patch);
    }

    /// Number of edges at an end that have not exactly two faces, the edge itself included.
    pub fn singular_degree(&self, end: usize) -> u32 {
        let spokes = self.spokes.iter();
        let singular = spokes.filter(|s| s.faces[end] != 0 && s.faces[end] != 2);
        singular.count() as u32 + u32::from(self.edge_faces != 2)
    }

    /// True where the faces at an end do not hang together through edges: two sheets that touch in a point.
    ///
    /// O(faces) for the usual fan, O(faces log faces) around a hub.
    pub fn is_pinched(&self, end: usize) -> bool {
        let faces = self.faces.iter().filter(|f| f.at[end] < 3);
        pinch::is_pinched(faces.map(|f| {
            let apex = usize::from(f.at[end]);
            [f.corners[(apex + 1) % 3], f.corners[(apex + 2) % 3]]
        }))
    }
}
