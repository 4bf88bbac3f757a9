//! Charts: faces that hang together in texture space, and how long a unit of theirs is on the surface.

use glam::DVec3;

use super::WedgeRows;
use crate::{
    collapse::{LiveMesh, pinch::Forest},
    mesh::{Channel, ChannelKind, Mesh},
    num::math,
};

/// By set of texture coordinates and triangle, kappa of Lindstrom & Turk 2000 (section 4.1.1): the mean edge of its
/// chart on the surface, in frame units, over the mean edge in texture space; 1 where the chart has no extent there.
#[derive(Clone, Debug, Default)]
pub(in crate::rooms::collapse) struct ChartScales(Vec<(ChannelKind, Vec<f32>)>);

impl ChartScales {
    /// The scales of a mesh whose vertices lie at `positions` in frame units; O(n log n), nothing where it has no
    /// texture coordinates.
    pub(in crate::rooms::collapse) fn of(
        mesh: &Mesh,
        rows: &WedgeRows,
        positions: &[DVec3],
    ) -> Self {
        let sets = rows.channels().iter().copied();
        let mut sets = sets
            .filter(|c| matches!(c.kind, ChannelKind::TexCoord(_)))
            .peekable();
        if sets.peek().is_none() {
            return Self::default();
        }
        let edges = Edges::of(mesh);
        let scales = |set: Channel| edges.scales(mesh, rows, set, positions);
        Self(sets.map(|set| (set.kind, scales(set))).collect())
    }

    /// The scale of the chart that a triangle belonged to at first.
    pub(super) fn of_triangle(&self, kind: ChannelKind, triangle: u32) -> f64 {
        let set = self.0.iter().find(|(k, _)| *k == kind);
        let scale = set.and_then(|(_, scales)| scales.get(triangle as usize));
        scale.map_or(1.0, |&s| f64::from(s))
    }
}

impl LiveMesh {
    /// The length on the surface, in frame units, of a unit of a set of texture coordinates in the chart that a triangle
    /// belonged to at first.
    pub fn texture_scale(&self, set: ChannelKind, triangle: u32) -> f64 {
        self.charts.of_triangle(set, triangle)
    }
}

/// The sides of all triangles, those of one edge next to each other.
struct Edges(Vec<([u32; 2], u32, u8)>);

impl Edges {
    fn of(mesh: &Mesh) -> Self {
        let mut sides = Vec::new();
        for (t, corners) in mesh.triangles().iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                sides.push(([a.min(b), a.max(b)], t as u32, k as u8));
            }
        }
        sides.sort_unstable();
        Self(sides)
    }

    fn scales(&self, mesh: &Mesh, rows: &WedgeRows, set: Channel, positions: &[DVec3]) -> Vec<f32> {
        let triangles = mesh.triangles();
        let wedges = mesh.attributes().corners();
        let mut charts = Forest::of(triangles.len());
        // The wedges of a side, that at the smaller vertex first.
        let ends = |t: u32, k: u8| {
            let (t, k) = (t as usize, usize::from(k));
            let next = (k + 1) % 3;
            if triangles[t][k] <= triangles[t][next] {
                [wedges[t][k], wedges[t][next]]
            } else {
                [wedges[t][next], wedges[t][k]]
            }
        };
        for edge in self.0.chunk_by(|a, b| a.0 == b.0) {
            for pair in edge.windows(2) {
                let (a, b) = (ends(pair[0].1, pair[0].2), ends(pair[1].1, pair[1].2));
                if (0..2).all(|end| rows.same(set, a[end], b[end])) {
                    charts.unite(pair[0].1 as usize, pair[1].1 as usize);
                }
            }
        }
        // Sums over the sides of each chart: lengths on the surface and in texture space, and the number of each.
        let mut sums = vec![[0.0_f64; 4]; triangles.len()];
        for t in 0..triangles.len() {
            let sum = &mut sums[charts.root(t)];
            for k in 0..3 {
                let [a, b] = [k, (k + 1) % 3].map(|k| positions[triangles[t][k] as usize]);
                let [c, d] = [k, (k + 1) % 3].map(|k| rows.value(set, wedges[t][k]));
                let (s, u) = (d[0] - c[0], d[1] - c[1]);
                let texture = math::sqrt(s * s + u * u);
                sum[0] += math::length(b - a);
                sum[1] += 1.0;
                if texture > 0.0 {
                    sum[2] += texture;
                    sum[3] += 1.0;
                }
            }
        }
        let scale = |t: usize, charts: &mut Forest| {
            let [length, sides, texture, texture_sides] = sums[charts.root(t)];
            let scale = ((length / sides) / (texture / texture_sides)) as f32;
            if scale.is_normal() { scale } else { 1.0 }
        };
        (0..triangles.len())
            .map(|t| scale(t, &mut charts))
            .collect()
    }
}
