//! The star of a vertex: the faces that a move of it changes, the directions it may take, and its new attributes.
//!
//! A vertex inside a sheet or on a boundary may go anywhere its faces let it. One on a feature (a seam, a border of
//! materials) moves along its normal only: no cost tells where textures lie, so nothing would judge a sideways
//! move. Locked vertices, those at edges with more than two faces, and those where sheets merely touch stay.
//!
//! Attributes stay where they are on the surface: each channel that has one value at the vertex takes the value at the
//! foot of the new position on the old faces, so that a texture does not slide; a channel with several values at the
//! vertex keeps them. Buffers are reused.

use glam::DVec3;

use super::{
    LiveMesh, Patch, PatchFace, Refusal, Rules,
    edge_star::normal,
    legality::{self, STAR_LIMIT},
    pinch,
    wedge::{self, Blend},
};
use crate::{
    mesh::ChannelKind,
    num::{Each, math},
};

/// Directions in which a vertex may move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Freedom {
    /// Nowhere.
    #[default]
    Fixed,
    /// Along the normal.
    Normal,
    /// Anywhere.
    Free,
}

/// A vertex and its faces.
#[derive(Clone, Debug, Default)]
pub struct Star {
    /// The vertex.
    pub vertex: u32,
    /// Its position.
    pub point: DVec3,
    /// Its faces, ascending ids.
    pub faces: Vec<PatchFace>,
    /// Its neighbours and the number of faces at the edge to each, ascending ids.
    pub neighbors: Vec<(u32, u32)>,
    /// Directions in which it may move.
    pub freedom: Freedom,
    sides: Vec<u32>,
    values: Vec<f64>,
}

impl Star {
    /// Collects the star of `vertex`.
    ///
    /// O(faces log faces) for a usual vertex; allocates only while buffers grow.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn gather(&mut self, live: &LiveMesh, vertex: u32) {
        self.vertex = vertex;
        self.point = live.position(vertex);
        self.faces.clear();
        self.neighbors.clear();
        self.freedom = Freedom::Fixed;
        let valence = live.valence(vertex);
        if valence == 0 || valence > STAR_LIMIT || live.is_locked(vertex) {
            return;
        }
        let faces = live.triangles_at(vertex).map(|id| live.patch_face(id));
        self.faces.extend(faces);
        self.faces.sort_unstable_by_key(|f| f.id);
        self.sides.clear();
        let corners = self.faces.iter().flat_map(|f| f.corners);
        self.sides.extend(corners.filter(|&v| v != vertex));
        self.sides.sort_unstable();
        let runs = self.sides.chunk_by(|a, b| a == b);
        self.neighbors
            .extend(runs.map(|run| (run[0], run.len() as u32)));
        if self.neighbors.iter().any(|&(_, faces)| faces > 2) || self.is_pinched() {
            return;
        }
        self.freedom = if self.is_on_feature(live) {
            Freedom::Normal
        } else {
            Freedom::Free
        };
    }

    /// Mean length of the edges at the vertex; 0 for a vertex without faces.
    pub fn mean_edge(&self, live: &LiveMesh) -> f64 {
        let lengths = self.neighbors.iter();
        let sum: f64 = lengths
            .map(|&(v, _)| math::length(live.position(v) - self.point))
            .sum();
        sum / self.neighbors.len().max(1) as f64
    }

    /// Unit normal, weighted by areas; `None` where the faces cancel.
    pub fn normal(&self, live: &LiveMesh) -> Option<DVec3> {
        let normals = self.faces.iter();
        let sum = normals
            .map(|f| normal(f.corners.each(|v| live.position(v))))
            .fold(DVec3::ZERO, |sum, n| sum + n);
        math::unit(sum)
    }

    /// Rounds a position to the file's precision and tests the faces there, as for a collapse: none may become
    /// degenerate or turn too far.
    ///
    /// # Errors
    /// The rule that forbids it: [`Refusal::Locked`], [`Refusal::Unplaced`], [`Refusal::Degenerate`] or
    /// [`Refusal::Flip`], and [`Refusal::Mirror`] where one would turn over in the texture.
    pub fn admit(&self, live: &LiveMesh, to: DVec3, rules: Rules) -> Result<DVec3, Refusal> {
        if self.freedom == Freedom::Fixed {
            return Err(Refusal::Locked);
        }
        let to = live.round(to).ok_or(Refusal::Unplaced)?;
        for face in &self.faces {
            let before = face.corners.each(|v| live.position(v));
            let after = face.corners.each(|v| {
                if v == self.vertex {
                    to
                } else {
                    live.position(v)
                }
            });
            legality::turn(before, normal(before), after, rules)?;
        }
        if self.turns_texture(live, to) {
            return Err(Refusal::Mirror);
        }
        Ok(to)
    }

    /// True where a face would turn over in the texture with the vertex at `to`; see [`Star::carry`].
    fn turns_texture(&self, live: &LiveMesh, to: DVec3) -> bool {
        let rows = live.rows();
        let textures = rows.channels().iter().copied();
        let mut textures = textures
            .filter(|c| matches!(c.kind, ChannelKind::TexCoord(_)))
            .peekable();
        if textures.peek().is_none() {
            return false;
        }
        let Some((foot, weights)) = self.foot(live, to) else {
            return false;
        };
        let apexes = || {
            self.faces
                .iter()
                .filter_map(|f| Some((f, f.corner(self.vertex)?)))
        };
        textures.any(|channel| {
            let mut wedges = apexes().map(|(f, at)| f.wedges[at]);
            let Some(first) = wedges.next() else {
                return false;
            };
            if !wedges.all(|w| rows.same(channel, w, first)) {
                return false;
            }
            let corners = |face: &PatchFace| {
                face.wedges.each(|w| {
                    let value = rows.value(channel, w);
                    [value[0], value[1]]
                })
            };
            let [a, b, c] = corners(&foot);
            let mix = |k: usize| (weights[0] * a[k] + weights[1] * b[k]) + weights[2] * c[k];
            apexes().any(|(face, at)| {
                let before = corners(face);
                let mut after = before;
                after[at] = [mix(0), mix(1)];
                wedge::double_area(before) * wedge::double_area(after) < 0.0
            })
        })
    }

    /// Fills `patch` with the move to `to`, which was admitted.
    pub fn patch(&mut self, live: &LiveMesh, to: DVec3, patch: &mut Patch) {
        patch.set_move(live, self.vertex, to);
        if live.rows().stride() > 0 {
            self.carry(live, to, patch);
        }
    }

    /// True where the faces do not hang together through edges: two sheets that touch in a point.
    fn is_pinched(&self) -> bool {
        pinch::is_pinched(self.faces.iter().map(|f| {
            let apex = f.corner(self.vertex).unwrap_or(0);
            [f.corners[(apex + 1) % 3], f.corners[(apex + 2) % 3]]
        }))
    }

    fn is_on_feature(&self, live: &LiveMesh) -> bool {
        if !live.may_have_features() {
            return false;
        }
        let inside = self.neighbors.iter().filter(|&&(_, faces)| faces == 2);
        let mut inside = inside.map(|&(v, _)| v);
        inside.any(|v| {
            let at = |f: &PatchFace| Some([f.corner(self.vertex)?, f.corner(v)?]);
            let mut two = self.faces.iter().filter_map(|f| Some((f, at(f)?)));
            let (Some((f, f_at)), Some((g, g_at))) = (two.next(), two.next()) else {
                return false;
            };
            let faces = [(f.id, f.wedges), (g.id, g.wedges)];
            wedge::differ(live, faces, [f_at, g_at], wedge::makes_features)
        })
    }

    /// Interpolates the attributes of the vertex at the foot of its new position.
    fn carry(&mut self, live: &LiveMesh, to: DVec3, patch: &mut Patch) {
        let rows = live.rows();
        let faces = self.faces.iter();
        let apexes = faces.filter_map(|f| Some((f, f.corner(self.vertex)?)));
        let Some((face, weights)) = self.foot(live, to) else {
            return;
        };
        let Some(first) = apexes.clone().next().map(|(f, at)| f.wedges[at]) else {
            return;
        };
        let stride = rows.stride();
        for (added, (old, apex)) in patch.added.iter_mut().zip(apexes.clone()) {
            let own = old.wedges[apex];
            self.values.clear();
            self.values.extend_from_slice(rows.row(own));
            for &channel in rows.channels() {
                let mut others = apexes.clone().map(|(f, at)| f.wedges[at]);
                if !others.all(|w| rows.same(channel, w, first)) {
                    continue;
                }
                let corners = face.wedges.each(|w| rows.value(channel, w));
                if corners.iter().any(|c| c[0].is_nan()) {
                    continue;
                }
                let into = &mut self.values[channel.offset..][..channel.kind.width()];
                let blend = Blend {
                    values: corners,
                    weights,
                };
                // Opposite normals cancel: keep the vertex's own rather than none.
                blend.write(
                    channel.kind,
                    live.precision(),
                    rows.value(channel, own),
                    into,
                );
            }
            if wedge::same_bits(&self.values, rows.row(own)) {
                continue;
            }
            let end = patch.rows.len() / stride;
            let mut known = patch.rows.chunks_exact(stride);
            let at = known.position(|r| wedge::same_bits(r, &self.values));
            if at.is_none() {
                patch.rows.extend_from_slice(&self.values);
            }
            added.wedges[apex] = rows.count() + at.unwrap_or(end) as u32;
        }
    }

    /// The face nearest to a point, and the barycentric weights of the nearest point on it.
    fn foot(&self, live: &LiveMesh, point: DVec3) -> Option<(PatchFace, [f64; 3])> {
        let mut best: Option<(f64, PatchFace, [f64; 3])> = None;
        for face in &self.faces {
            let points = face.corners.each(|v| live.position(v));
            let weights = nearest(points, point);
            let [a, b, c] = points;
            let d = ((a * weights[0] + b * weights[1]) + c * weights[2]) - point;
            let distance = d.dot(d);
            if best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, *face, weights));
            }
        }
        best.map(|(_, face, weights)| (face, weights))
    }
}

/// Barycentric weights of the point of a triangle that is nearest to `p` (Ericson 2005, section 5.1.5).
fn nearest([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let t = d1 / (d1 - d3);
        return [1.0 - t, t, 0.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let t = d2 / (d2 - d6);
        return [1.0 - t, 0.0, t];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - t, t];
    }
    let sum = (va + vb) + vc;
    let (v, w) = (vb / sum, vc / sum);
    if v.is_finite() && w.is_finite() {
        [(1.0 - v) - w, v, w]
    } else {
        [1.0, 0.0, 0.0]
    }
}
