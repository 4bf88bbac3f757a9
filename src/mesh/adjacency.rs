//! Adjacency without a manifold assumption: triangles around a vertex, triangles at an edge.

use super::Mesh;
use crate::parallel;

/// The triangles at every vertex, in ascending order; a triangle that repeats a vertex is listed once there.
#[derive(Clone, Debug)]
pub struct VertexTriangles {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl VertexTriangles {
    /// Collects them; O(vertices + triangles).
    pub fn of(mesh: &Mesh) -> Self {
        let mut starts = vec![0_u32; mesh.positions().len() + 1];
        for &corners in mesh.triangles() {
            for v in distinct(corners) {
                starts[v as usize + 1] += 1;
            }
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut triangles = vec![0_u32; *starts.last().unwrap_or(&0) as usize];
        for (t, &corners) in mesh.triangles().iter().enumerate() {
            for v in distinct(corners) {
                triangles[next[v as usize] as usize] = t as u32;
                next[v as usize] += 1;
            }
        }
        Self { starts, triangles }
    }

    /// The triangles at `vertex`, ascending.
    ///
    /// # Panics
    /// Where there is no such vertex.
    pub fn at(&self, vertex: u32) -> &[u32] {
        &self.triangles
            [self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize]
    }
}

/// The different vertices of a triangle.
fn distinct([a, b, c]: [u32; 3]) -> impl Iterator<Item = u32> {
    [
        Some(a),
        (b != a).then_some(b),
        (c != a && c != b).then_some(c),
    ]
    .into_iter()
    .flatten()
}

/// An edge: its two vertices, the smaller first.
pub type Edge = [u32; 2];

/// Every edge of a mesh with the triangles at it, in ascending order of the vertices.
#[derive(Clone, Debug)]
pub struct Edges {
    edges: Vec<Edge>,
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Edges {
    /// Collects them; O(n log n). Edges that join a vertex to itself (in degenerate triangles) are left out.
    pub fn of(mesh: &Mesh) -> Self {
        let mut sides: Vec<(Edge, u32)> = Vec::with_capacity(3 * mesh.triangles().len());
        for (t, &[a, b, c]) in mesh.triangles().iter().enumerate() {
            for [u, w] in [[a, b], [b, c], [c, a]] {
                if u != w {
                    sides.push(([u.min(w), u.max(w)], t as u32));
                }
            }
        }
        parallel::sort_by(&mut sides, Ord::cmp);
        sides.dedup();
        let mut edges: Vec<Edge> = Vec::with_capacity(sides.len() / 2);
        let mut starts = Vec::with_capacity(sides.len() / 2 + 1);
        let mut triangles = Vec::with_capacity(sides.len());
        for (edge, t) in sides {
            if edges.last() != Some(&edge) {
                edges.push(edge);
                starts.push(triangles.len() as u32);
            }
            triangles.push(t);
        }
        starts.push(triangles.len() as u32);
        Self {
            edges,
            starts,
            triangles,
        }
    }

    /// Number of edges.
    pub fn len(&self) -> usize {
        self.edges.len()
    }

    /// True where there is no edge.
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// Every edge with the triangles at it: one at a boundary, two inside, more where the mesh is not manifold.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (Edge, &[u32])> {
        self.edges.iter().enumerate().map(|(i, &edge)| {
            (
                edge,
                &self.triangles[self.starts[i] as usize..self.starts[i + 1] as usize],
            )
        })
    }

    /// The triangles at an edge; empty where there is no such edge.
    pub fn triangles(&self, edge: Edge) -> &[u32] {
        match self.edges.binary_search(&edge) {
            Ok(i) => &self.triangles[self.starts[i] as usize..self.starts[i + 1] as usize],
            Err(_) => &[],
        }
    }

    /// Number of edges with exactly one triangle.
    pub fn boundary_count(&self) -> usize {
        self.iter()
            .filter(|(_, triangles)| triangles.len() == 1)
            .count()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn three_triangles_at_one_edge_are_all_found_there() {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_Y];
        let mesh =
            Mesh::from_triangles(positions, vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]]).expect("valid");
        let edges = Edges::of(&mesh);
        assert_eq!(edges.len(), 7);
        assert_eq!(edges.triangles([0, 1]), [0, 1, 2]);
        assert_eq!(edges.boundary_count(), 6);
        assert_eq!(VertexTriangles::of(&mesh).at(0), [0, 1, 2]);
        assert_eq!(VertexTriangles::of(&mesh).at(3), [1]);
    }

    #[test]
    fn a_triangle_that_repeats_a_vertex_is_listed_once_there() {
        let mesh =
            Mesh::from_triangles(vec![DVec3::ZERO, DVec3::X], vec![[0, 0, 1]]).expect("valid");
        assert_eq!(VertexTriangles::of(&mesh).at(0), [0]);
        assert_eq!(Edges::of(&mesh).triangles([0, 1]), [0]);
    }
}
