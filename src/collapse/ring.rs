//! Everything around an edge: the triangles that touch either end, each once, and what the rules need to know.
//!
//! `T(e)` of Lindstrom & Turk 1998. Faces ascend by id, other vertices by id, boundary edges follow the faces: a sum
//! over any of them has one written order, whatever the lists of the [`LiveMesh`] look like. Buffers are reused.

use glam::DVec3;

use super::{LiveMesh, NONE, Patch, PatchFace, patch::Move, wedge};

/// Where the rules let the new vertex be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Anywhere.
    Free,
    /// Only at this end of the edge (an index into [`Ring::ends`]).
    At(usize),
}

/// A face of the ring.
#[derive(Clone, Copy, Debug)]
pub struct RingFace {
    /// Triangle id.
    pub id: u32,
    /// Its vertices.
    pub corners: [u32; 3],
    /// Their positions.
    pub points: [DVec3; 3],
    /// `(p1 - p0) x (p2 - p0)`: twice its area along its normal.
    pub normal: DVec3,
    /// Which corner each end of the edge is; 3 for an end that is none.
    pub at: [u8; 2],
    /// False where the collapse removes it: both ends are corners, or an earlier face gets the same vertices.
    pub survives: bool,
}

impl RingFace {
    /// True where both ends of the edge are corners.
    #[inline]
    #[must_use]
    pub fn has_both(&self) -> bool {
        self.at[0] < 3 && self.at[1] < 3
    }

    /// The corner that becomes the new vertex; of a face with both ends, the one at the first.
    #[inline]
    #[must_use]
    pub fn apex(&self) -> usize {
        usize::from(if self.at[0] < 3 {
            self.at[0]
        } else {
            self.at[1]
        })
    }

    /// Its corners with the new vertex at `position`; meaningful where it survives.
    #[inline]
    #[must_use]
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
    /// Number of faces at the edges to the first and to the second end; 0 where there is no such edge.
    pub faces: [u32; 2],
    /// True where it forms a face with both ends.
    pub beside: bool,
    /// Whether the edges to the ends are features.
    pub feature: [bool; 2],
}

/// An edge with one face, at either end of the ring's edge or the ring's edge itself; directed as in its face.
#[derive(Clone, Copy, Debug)]
pub struct BoundaryEdge {
    /// Start and end vertex.
    pub ends: [u32; 2],
    /// Position of the start.
    pub from: DVec3,
    /// Position of the end.
    pub to: DVec3,
}

/// Everything around an edge `(u, w)`, `u < w`.
#[derive(Clone, Debug, Default)]
pub struct Ring {
    /// Id of the edge.
    pub edge: u32,
    /// `[u, w]`; the new vertex takes the id `u`.
    pub ends: [u32; 2],
    /// Their positions.
    pub points: [DVec3; 2],
    /// `T(e)`, ascending ids.
    pub faces: Vec<RingFace>,
    /// The link, ascending ids.
    pub spokes: Vec<Spoke>,
    /// Boundary edges at either end, in the order of their faces.
    pub boundary: Vec<BoundaryEdge>,
    /// Number of faces at the edge.
    pub edge_faces: u32,
    /// True where the edge is a feature: more than two faces, or attributes or materials differ across it.
    pub edge_feature: bool,
    /// Number of feature edges at each end, the edge itself included.
    pub feature_degree: [u32; 2],
    sides: Vec<u64>,
}

impl Ring {
    /// Collects the ring of an edge; false where the edge id is not in use.
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
        self.points = ends.map(|v| live.position(v));
        self.gather_faces(live);
        self.gather_spokes(live);
        self.gather_boundary();
        self.mark_duplicates();
        self.gather_features(live);
        true
    }

    /// `|u - w|^2`.
    #[must_use]
    pub fn length2(&self) -> f64 {
        let d = self.points[1] - self.points[0];
        d.dot(d)
    }

    /// Midpoint of the edge.
    #[must_use]
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
                let corners = face.corners.map(|v| if v == w { u } else { v });
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

    fn gather_faces(&mut self, live: &LiveMesh) {
        let [u, w] = self.ends;
        self.sides.clear();
        self.sides.extend(live.triangles_at(u).map(u64::from));
        self.sides.extend(live.triangles_at(w).map(u64::from));
        self.sides.sort_unstable();
        self.sides.dedup();
        self.faces.clear();
        self.edge_faces = 0;
        for &id in &self.sides {
            let corners = live.patch_face(id as u32).corners;
            let points = corners.map(|v| live.position(v));
            let at = [u, w].map(|end| corners.iter().position(|&v| v == end).unwrap_or(3) as u8);
            let face = RingFace {
                id: id as u32,
                corners,
                points,
                normal: normal(points),
                at,
                survives: at[0] == 3 || at[1] == 3,
            };
            self.edge_faces += u32::from(face.has_both());
            self.faces.push(face);
        }
    }

    fn gather_spokes(&mut self, live: &LiveMesh) {
        let [u, w] = self.ends;
        self.sides.clear();
        for face in &self.faces {
            for v in face.corners {
                if v != u && v != w {
                    for (end, &at) in face.at.iter().enumerate() {
                        if at < 3 {
                            self.sides.push(u64::from(v) << 1 | end as u64);
                        }
                    }
                }
            }
        }
        self.sides.sort_unstable();
        self.spokes.clear();
        for &side in &self.sides {
            let (vertex, end) = ((side >> 1) as u32, (side & 1) as usize);
            if self.spokes.last().is_none_or(|s| s.vertex != vertex) {
                self.spokes.push(Spoke {
                    vertex,
                    point: live.position(vertex),
                    faces: [0; 2],
                    beside: false,
                    feature: [false; 2],
                });
            }
            if let Some(spoke) = self.spokes.last_mut() {
                spoke.faces[end] += 1;
            }
        }
        for i in 0..self.faces.len() {
            if self.faces[i].has_both() {
                for v in self.faces[i].corners {
                    if let Some(s) = self.spoke_index(v) {
                        self.spokes[s].beside = true;
                    }
                }
            }
        }
    }

    fn spoke_index(&self, vertex: u32) -> Option<usize> {
        self.spokes.binary_search_by_key(&vertex, |s| s.vertex).ok()
    }

    fn gather_boundary(&mut self) {
        self.boundary.clear();
        if self.edge_faces != 1 && !self.spokes.iter().any(|s| s.faces.contains(&1)) {
            return;
        }
        let [u, w] = self.ends;
        for face in &self.faces {
            for k in 0..3 {
                let (a, b) = (face.corners[k], face.corners[(k + 1) % 3]);
                let count = match (a == u || a == w, b == u || b == w) {
                    (true, true) => self.edge_faces,
                    (true, false) => self.faces_at(b, usize::from(a == w)),
                    (false, true) => self.faces_at(a, usize::from(b == w)),
                    (false, false) => continue,
                };
                if count == 1 {
                    self.boundary.push(BoundaryEdge {
                        ends: [a, b],
                        from: face.points[k],
                        to: face.points[(k + 1) % 3],
                    });
                }
            }
        }
    }

    fn faces_at(&self, vertex: u32, end: usize) -> u32 {
        self.spoke_index(vertex)
            .map_or(0, |s| self.spokes[s].faces[end])
    }

    /// Faces that get the vertices of an earlier face, which was another face before, do not survive.
    fn mark_duplicates(&mut self) {
        let common = |s: &Spoke| s.faces[0] > 0 && s.faces[1] > 0;
        if self.spokes.iter().filter(|s| common(s)).count() < 2 {
            return;
        }
        let link = |face: &RingFace| {
            let apex = face.apex();
            let (a, b) = (face.corners[(apex + 1) % 3], face.corners[(apex + 2) % 3]);
            [a.min(b), a.max(b)]
        };
        for i in 1..self.faces.len() {
            let face = self.faces[i];
            let earlier = |f: &RingFace| {
                f.survives && (f.at[0] < 3) != (face.at[0] < 3) && link(f) == link(&face)
            };
            if face.survives && self.faces[..i].iter().any(earlier) {
                self.faces[i].survives = false;
            }
        }
    }

    fn gather_features(&mut self, live: &LiveMesh) {
        self.edge_feature = self.edge_faces > 2;
        self.feature_degree = [0; 2];
        let complex =
            self.edge_feature || self.spokes.iter().any(|s| s.faces[0] > 2 || s.faces[1] > 2);
        if !complex && !live.may_have_features() {
            return;
        }
        let [u, w] = self.ends;
        self.edge_feature |= wedge::is_feature(live, &self.faces, [u, w]);
        for i in 0..self.spokes.len() {
            for (end, v) in self.ends.into_iter().enumerate() {
                let spoke = self.spokes[i];
                let feature = spoke.faces[end] > 2
                    || (spoke.faces[end] == 2
                        && wedge::is_feature(live, &self.faces, [v, spoke.vertex]));
                self.spokes[i].feature[end] = feature;
                self.feature_degree[end] += u32::from(feature);
            }
        }
        for degree in &mut self.feature_degree {
            *degree += u32::from(self.edge_feature);
        }
    }

    /// Number of edges at an end that have not exactly two faces, the edge itself included.
    #[must_use]
    pub fn singular_degree(&self, end: usize) -> u32 {
        let spokes = self.spokes.iter();
        let singular = spokes.filter(|s| s.faces[end] != 0 && s.faces[end] != 2);
        singular.count() as u32 + u32::from(self.edge_faces != 2)
    }

    /// True where the faces at an end do not hang together through edges: two sheets that touch in a point.
    #[must_use]
    pub fn is_pinched(&self, end: usize) -> bool {
        let mut reached: u64 = 0;
        let at_end = |f: &RingFace| f.at[end] < 3;
        let count = self.faces.iter().filter(|f| at_end(f)).count();
        if count > 64 {
            return self.is_pinched_wide(end);
        }
        // Face i of the end reaches face j through a vertex other than the end itself.
        let of_end = || self.faces.iter().filter(|f| at_end(f)).enumerate();
        let mut front: u64 = 1;
        while front != 0 {
            reached |= front;
            let mut next = 0;
            for (i, f) in of_end() {
                if front >> i & 1 == 1 {
                    for (j, g) in of_end() {
                        if reached >> j & 1 == 0 && touch(f, g, self.ends[end]) {
                            next |= 1 << j;
                        }
                    }
                }
            }
            front = next & !reached;
        }
        (reached.count_ones() as usize) < count
    }

    fn is_pinched_wide(&self, end: usize) -> bool {
        let faces: Vec<&RingFace> = self.faces.iter().filter(|f| f.at[end] < 3).collect();
        let mut reached = vec![false; faces.len()];
        let mut stack = vec![0];
        reached[0] = true;
        while let Some(i) = stack.pop() {
            for j in 0..faces.len() {
                if !reached[j] && touch(faces[i], faces[j], self.ends[end]) {
                    reached[j] = true;
                    stack.push(j);
                }
            }
        }
        reached.contains(&false)
    }
}

/// True where two faces at `center` share another vertex, hence an edge.
fn touch(f: &RingFace, g: &RingFace, center: u32) -> bool {
    f.corners
        .iter()
        .any(|&v| v != center && v != NONE && g.corners.contains(&v))
}

/// Twice the area of a triangle along its normal.
#[inline]
#[must_use]
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}
