//! Connectivity of a mesh: components, fans around vertices, boundary loops. No manifold assumption.

use super::{Edge, Edges, Finding, Mesh, VertexTriangles};

/// Counts of connected parts.
pub(super) struct Connectivity {
    /// Sets of triangles that share vertices.
    pub components: usize,
    /// Chains of boundary edges, followed fan by fan.
    pub boundary_loops: usize,
    /// Vertices with several fans.
    pub non_manifold_vertices: Finding,
}

impl Connectivity {
    /// Counts the parts. O(n log n), whatever the number of triangles at a vertex.
    pub(super) fn of(mesh: &Mesh, edges: &Edges, around: &VertexTriangles) -> Self {
        let triangles = mesh.triangles();
        let boundary: Vec<Edge> = edges
            .iter()
            .filter(|(_, at)| at.len() == 1)
            .map(|(edge, _)| edge)
            .collect();
        let mut components = Sets::new(triangles.len());
        let mut loops = Sets::new(boundary.len());
        let mut non_manifold_vertices = Finding::default();
        let (mut ends, mut rims) = (Vec::new(), Vec::new());
        for v in 0..mesh.positions().len() as u32 {
            for pair in around.at(v).windows(2) {
                components.unite(pair[0], pair[1]);
            }
            // The other ends of the edges at `v`, each with a triangle there (as an index into this list).
            let here: Vec<u32> = around
                .at(v)
                .iter()
                .copied()
                .filter(|&t| !repeats_a_vertex(triangles[t as usize]))
                .collect();
            ends.clear();
            for (i, &t) in here.iter().enumerate() {
                for end in triangles[t as usize].into_iter().filter(|&end| end != v) {
                    ends.push((end, i as u32));
                }
            }
            ends.sort_unstable();
            let mut fans = Sets::new(here.len());
            for pair in ends.windows(2) {
                if pair[0].0 == pair[1].0 {
                    fans.unite(pair[0].1, pair[1].1);
                }
            }
            if fans.count() > 1 {
                non_manifold_vertices.add(&[v]);
            }
            rims.clear();
            for &(end, i) in &ends {
                if let Ok(edge) = boundary.binary_search(&[v.min(end), v.max(end)]) {
                    rims.push((fans.root(i), edge as u32));
                }
            }
            rims.sort_unstable();
            for pair in rims.windows(2) {
                if pair[0].0 == pair[1].0 {
                    loops.unite(pair[0].1, pair[1].1);
                }
            }
        }
        Self {
            components: components.count(),
            boundary_loops: loops.count(),
            non_manifold_vertices,
        }
    }
}

fn repeats_a_vertex([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// Disjoint sets of `0..n` with path halving; the smallest member is the root.
struct Sets(Vec<u32>);

impl Sets {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn root(&mut self, mut x: u32) -> u32 {
        while self.0[x as usize] != x {
            self.0[x as usize] = self.0[self.0[x as usize] as usize];
            x = self.0[x as usize];
        }
        x
    }

    fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    fn count(&self) -> usize {
        self.0
            .iter()
            .enumerate()
            .filter(|&(i, &parent)| i as u32 == parent)
            .count()
    }
}
