//! Collecting an edge star from the lists of a live mesh.

use super::{BoundaryEdge, EdgeStar, Spoke, StarFace, normal};
use crate::{
    collapse::{LiveMesh, wedge},
    num::Each,
};

/// Most faces of a star that are compared one by one; more are sorted, so that the faces around a hub do not cost
/// their square.
const FEW: usize = 48;

/// A spoke while it is collected.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Link {
    vertex: u32,
    faces: [u32; 2],
    beside: bool,
}

impl EdgeStar {
    pub(super) fn gather_faces(&mut self, live: &LiveMesh) {
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

    pub(super) fn gather_spokes(&mut self, live: &LiveMesh) {
        let [u, w] = self.ends;
        let many = self.faces.len() > FEW;
        self.links.clear();
        for face in &self.faces {
            let beside = face.has_both();
            for v in face.corners {
                if v == u || v == w {
                    continue;
                }
                // A link has a handful of vertices: looking through it is faster than sorting all sides.
                let mut links = self.links.iter();
                let known = links.position(|l| !many && l.vertex == v);
                let at = known.unwrap_or_else(|| {
                    self.links.push(Link {
                        vertex: v,
                        ..Link::default()
                    });
                    self.links.len() - 1
                });
                let link = &mut self.links[at];
                link.faces[0] += u32::from(face.at[0] < 3);
                link.faces[1] += u32::from(face.at[1] < 3);
                link.beside |= beside;
            }
        }
        self.links.sort_unstable_by_key(|l| l.vertex);
        self.links.dedup_by(|link, into| {
            let same = link.vertex == into.vertex;
            if same {
                into.faces = [0, 1].each(|end| into.faces[end] + link.faces[end]);
                into.beside |= link.beside;
            }
            same
        });
        let beside = self.links.iter().filter(|l| l.beside).count();
        let crowded = |l: &Link| l.faces[0] > 2 || l.faces[1] > 2;
        if self.edge_faces as usize > beside || self.links.iter().any(crowded) {
            self.count_different();
        }
        self.spokes.clear();
        self.spokes.extend(self.links.iter().map(|l| Spoke {
            vertex: l.vertex,
            point: live.position(l.vertex),
            faces: l.faces,
            beside: l.beside,
            feature: [false; 2],
        }));
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
        for link in &mut self.links {
            link.faces = [0; 2];
        }
        self.keys.clear();
        let faces = self.faces.iter().enumerate();
        self.keys.extend(faces.map(|(i, f)| (sorted(f), i)));
        self.keys.sort_unstable();
        self.keys.dedup_by_key(|(corners, _)| *corners);
        for &(corners, i) in &self.keys {
            let face = &self.faces[i];
            self.edge_faces += u32::from(face.has_both());
            for v in corners {
                if let Some(at) = find(&self.links, v) {
                    self.links[at].faces[0] += u32::from(face.at[0] < 3);
                    self.links[at].faces[1] += u32::from(face.at[1] < 3);
                }
            }
        }
    }

    fn spoke_index(&self, vertex: u32) -> Option<usize> {
        self.spokes.binary_search_by_key(&vertex, |s| s.vertex).ok()
    }

    pub(super) fn gather_boundary(&mut self) {
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
    pub(super) fn mark_duplicates(&mut self) {
        let common = |v: u32| {
            let link = find(&self.links, v).map(|at| self.links[at]);
            link.is_some_and(|l| l.faces[0] > 0 && l.faces[1] > 0)
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
        let faces = self.faces.iter().enumerate();
        let staying = faces.filter(|(_, f)| f.survives);
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

    pub(super) fn gather_features(&mut self, live: &LiveMesh) {
        self.edge_feature = self.edge_faces > 2;
        self.feature_degree = [0; 2];
        let complex =
            self.edge_feature || self.spokes.iter().any(|s| s.faces[0] > 2 || s.faces[1] > 2);
        if !complex && !live.may_have_features() {
            return;
        }
        let [u, w] = self.ends;
        self.edge_feature |= wedge::is_feature(live, self.faces.iter(), [u, w]);
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
        for degree in &mut self.feature_degree {
            *degree += u32::from(self.edge_feature);
        }
    }
}

fn find(links: &[Link], vertex: u32) -> Option<usize> {
    links.binary_search_by_key(&vertex, |l| l.vertex).ok()
}
