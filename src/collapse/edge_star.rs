//! The star of an edge: the triangles that touch either end, each once, and the properties that rules test.
//!
//! `T(e)` of Lindstrom & Turk 1998. Faces ascend by id, other vertices by id, boundary edges follow the faces: a sum
//! over any of them has one written order, whatever the lists of the [`LiveMesh`] look like. Buffers are reused.

use glam::DVec3;

use super::{LiveMesh, pinch, wedge};
pub(super) use crate::geometry::area_normal as normal;
use crate::num::Each;

/// Most faces of a star that are compared one by one; more are sorted, so that the faces around a hub do not cost
/// their square.
const FEW: usize = 48;

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

impl Spoke {
    /// Counts a face at the edges to the ends that it has.
    #[inline]
    fn count(&mut self, face: &StarFace) {
        self.faces[0] += u32::from(face.at[0] < 3);
        self.faces[1] += u32::from(face.at[1] < 3);
    }
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
        (self.edge, self.ends) = (edge, ends);
        self.points = ends.each(|v| live.position(v));
        self.gather_faces(live);
        self.gather_spokes();
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

/// # Collecting a star from the lists of a live mesh
impl EdgeStar {
    fn gather_faces(&mut self, live: &LiveMesh) {
        let [u, w] = self.ends;
        self.ids.clear();
        self.ids.extend(live.triangles_at(u));
        self.ids.extend(live.triangles_at(w));
        self.ids.sort_unstable();
        self.ids.dedup();
        self.faces.clear();
        self.edge_faces = 0;
        for &id in &self.ids {
            let Some(corners) = live.triangle(id) else {
                continue;
            };
            let points = corners.each(|v| live.position(v));
            let at = [u, w].each(|end| corners.iter().position(|&v| v == end).unwrap_or(3) as u8);
            let face = StarFace {
                id,
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

    fn gather_spokes(&mut self) {
        let [u, w] = self.ends;
        let many = self.faces.len() > FEW;
        self.spokes.clear();
        for face in &self.faces {
            for (vertex, point) in face.corners.into_iter().zip(face.points) {
                if vertex == u || vertex == w {
                    continue;
                }
                // A link has a handful of vertices: looking through it is faster than sorting all sides.
                let mut spokes = self.spokes.iter();
                let known = spokes.position(|s| !many && s.vertex == vertex);
                let at = known.unwrap_or_else(|| {
                    self.spokes.push(Spoke {
                        vertex,
                        point,
                        faces: [0; 2],
                        beside: false,
                        feature: [false; 2],
                    });
                    self.spokes.len() - 1
                });
                self.spokes[at].count(face);
                self.spokes[at].beside |= face.has_both();
            }
        }
        self.spokes.sort_unstable_by_key(|s| s.vertex);
        self.spokes.dedup_by(|spoke, into| {
            let same = spoke.vertex == into.vertex;
            if same {
                into.faces = [0, 1].each(|end| into.faces[end] + spoke.faces[end]);
                into.beside |= spoke.beside;
            }
            same
        });
        let beside = self.spokes.iter().filter(|s| s.beside).count();
        let crowded = |s: &Spoke| s.faces[0] > 2 || s.faces[1] > 2;
        if self.edge_faces as usize > beside || self.spokes.iter().any(crowded) {
            self.count_different();
        }
    }

    /// Counts again, faces with the same vertices once: a sheet whose every face is there twice (foliage that shows
    /// both sides) is a sheet, not a mesh of non-manifold edges.
    fn count_different(&mut self) {
        let sorted = |f: &StarFace| {
            let mut corners = f.corners;
            corners.sort_unstable();
            corners
        };
        self.edge_faces = 0;
        for spoke in &mut self.spokes {
            spoke.faces = [0; 2];
        }
        self.keys.clear();
        self.keys.extend(self.faces.iter().map(sorted).zip(0..));
        self.keys.sort_unstable();
        self.keys.dedup_by_key(|(corners, _)| *corners);
        for k in 0..self.keys.len() {
            let (corners, i) = self.keys[k];
            self.edge_faces += u32::from(self.faces[i].has_both());
            for v in corners {
                if let Some(at) = self.spoke_index(v) {
                    self.spokes[at].count(&self.faces[i]);
                }
            }
        }
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

    fn spoke_index(&self, vertex: u32) -> Option<usize> {
        self.spokes.binary_search_by_key(&vertex, |s| s.vertex).ok()
    }

    fn faces_at(&self, vertex: u32, end: usize) -> u32 {
        let spoke = self.spoke_index(vertex);
        spoke.map_or(0, |at| self.spokes[at].faces[end])
    }

    /// Faces that get the vertices of an earlier face, which was another face before, do not survive.
    fn mark_duplicates(&mut self) {
        let common = |v: u32| {
            let spoke = self.spoke_index(v).map(|at| self.spokes[at]);
            spoke.is_some_and(|s| s.faces[0] > 0 && s.faces[1] > 0)
        };
        let [u, w] = self.ends;
        let mut suspects = self.faces.iter().filter(|f| {
            let mut others = f.corners.iter().filter(|&&v| v != u && v != w);
            f.survives && others.all(|&v| common(v))
        });
        if suspects.nth(1).is_none() {
            return;
        }
        let link = |face: &StarFace| {
            let apex = face.apex();
            let (a, b) = (face.corners[(apex + 1) % 3], face.corners[(apex + 2) % 3]);
            [a.min(b), a.max(b), 0]
        };
        self.keys.clear();
        let staying = self.faces.iter().enumerate().filter(|(_, f)| f.survives);
        self.keys.extend(staying.map(|(i, f)| (link(f), i)));
        self.keys.sort_unstable();
        for same in self.keys.chunk_by(|a, b| a.0 == b.0) {
            // Whether a face at either end stays.
            let mut stays = [false; 2];
            for &(_, i) in same {
                let end = usize::from(self.faces[i].at[0] == 3);
                self.faces[i].survives = !stays[1 - end];
                stays[end] |= self.faces[i].survives;
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
        self.edge_feature |= wedge::is_feature(live, self.faces.iter(), [u, w]);
        self.feature_degree = [u32::from(self.edge_feature); 2];
        // Faces by each of their vertices, ascending.
        self.keys.clear();
        if self.faces.len() > FEW {
            let faces = self.faces.iter().enumerate();
            let corners = faces.flat_map(|(i, f)| f.corners.each(|v| ([v, 0, 0], i)));
            self.keys.extend(corners);
            self.keys.sort_unstable();
        }
        for i in 0..self.spokes.len() {
            for (end, v) in self.ends.into_iter().enumerate() {
                let spoke = self.spokes[i];
                let is_feature = || {
                    let ends = [v, spoke.vertex];
                    if self.faces.len() <= FEW {
                        return wedge::is_feature(live, self.faces.iter(), ends);
                    }
                    let start = self.keys.partition_point(|k| k.0[0] < spoke.vertex);
                    let at = self.keys[start..].iter();
                    let at = at.take_while(|k| k.0[0] == spoke.vertex);
                    wedge::is_feature(live, at.map(|&(_, i)| &self.faces[i]), ends)
                };
                let feature = spoke.faces[end] > 2 || (spoke.faces[end] == 2 && is_feature());
                self.spokes[i].feature[end] = feature;
                self.feature_degree[end] += u32::from(feature);
            }
        }
    }
}
