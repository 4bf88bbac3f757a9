//! Faults of a mesh, and what else is remarkable about it.
//!
//! Everything is told of the mesh as given: a mesh whose vertices are not welded is all boundary. Connected means
//! sharing a vertex. A fan is a set of triangles around a vertex that hang together by edges at that vertex; boundary
//! loops are followed fan by fan, so two holes that touch in a point count as two.

use std::fmt::Write;

use serde::Serialize;

use super::{
    Edge, Edges, Mesh, VertexTriangles, compare_rows, connectivity::Connectivity, group_equal,
};
use crate::{
    geometry::double_area,
    num::{Each, Frame},
};

/// One kind of finding: how often it occurs and the first places where it does.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// Occurrences.
    pub count: usize,
    /// The first of them, at most [`Finding::EXAMPLES`]: triangle or vertex numbers, or the two vertices of an edge.
    pub examples: Vec<Vec<u32>>,
}

impl Finding {
    /// Largest number of examples.
    pub const EXAMPLES: usize = 5;

    pub(super) fn add(&mut self, example: &[u32]) {
        if self.count < Self::EXAMPLES {
            self.examples.push(example.to_vec());
        }
        self.count += 1;
    }
}

/// The smallest and largest corner of a box, in file units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bounds {
    /// Smallest coordinates.
    pub low: [f64; 3],
    /// Largest coordinates.
    pub high: [f64; 3],
}

/// Everything [`Findings::of`] looks for. Counts are of the mesh as given.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Findings {
    /// The verdict: there are triangles, and none of the problems below.
    pub clean: bool,
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Number of edges.
    pub edges: usize,
    /// Sets of triangles that hang together by vertices.
    pub components: usize,
    /// Edges with one triangle.
    pub boundary_edges: usize,
    /// Closed chains of boundary edges.
    pub boundary_loops: usize,
    /// Edges between triangles whose attributes differ there: texture seams, creases.
    pub seam_edges: usize,
    /// Names of the materials.
    pub materials: Vec<String>,
    /// Bounding box of the vertices in use; `None` without triangles.
    pub bounds: Option<Bounds>,
    /// Sum of the triangle areas in square file units.
    pub area: f64,
    /// Remark: vertices that no triangle names.
    pub unreferenced_vertices: Finding,
    /// Remark: vertices at exactly the place of an earlier one; loading welds them.
    pub duplicate_positions: Finding,
    /// Problem: triangles that repeat a vertex.
    pub degenerate_triangles: Finding,
    /// Problem: triangles of no area with three different vertices.
    pub zero_area_triangles: Finding,
    /// Problem: triangles with the vertices of an earlier one.
    pub duplicate_triangles: Finding,
    /// Problem: edges with more than two triangles.
    pub non_manifold_edges: Finding,
    /// Problem: vertices whose triangles form several fans.
    pub non_manifold_vertices: Finding,
    /// Problem: edges whose two triangles run through it in the same direction.
    pub misoriented_edges: Finding,
}

impl Findings {
    /// Examines `mesh`. O(n log n); triangles that repeat a vertex are counted and otherwise left aside.
    pub fn of(mesh: &Mesh) -> Self {
        let edges = Edges::of(mesh);
        let around = VertexTriangles::of(mesh);
        let topology = Connectivity::of(mesh, &edges, &around);
        let surface = Surface::of(mesh);
        let (non_manifold_edges, misoriented_edges, seam_edges) = edge_findings(mesh, &edges);
        let mut unreferenced_vertices = Finding::default();
        for v in 0..mesh.positions().len() as u32 {
            if around.at(v).is_empty() {
                unreferenced_vertices.add(&[v]);
            }
        }
        let mut found = Self {
            clean: false,
            vertices: mesh.positions().len(),
            triangles: mesh.triangles().len(),
            edges: edges.len(),
            components: topology.components,
            boundary_edges: edges.boundary_count(),
            boundary_loops: topology.boundary_loops,
            seam_edges,
            materials: mesh.materials().names.clone(),
            bounds: mesh.bounds().map(|(low, high)| Bounds {
                low: low.to_array(),
                high: high.to_array(),
            }),
            area: surface.area,
            unreferenced_vertices,
            duplicate_positions: duplicate_positions(mesh),
            degenerate_triangles: surface.degenerate,
            zero_area_triangles: surface.zero_area,
            duplicate_triangles: duplicate_triangles(mesh),
            non_manifold_edges,
            non_manifold_vertices: topology.non_manifold_vertices,
            misoriented_edges,
        };
        found.clean = found.triangles > 0 && found.problems().is_empty();
        found
    }

    /// The problems, each with its name; remarks are not among them. Empty where the mesh is clean.
    pub fn problems(&self) -> Vec<(&'static str, &Finding)> {
        [
            ("triangles that repeat a vertex", &self.degenerate_triangles),
            ("triangles without area", &self.zero_area_triangles),
            ("duplicate triangles", &self.duplicate_triangles),
            (
                "edges with more than two triangles",
                &self.non_manifold_edges,
            ),
            (
                "vertices where several fans meet",
                &self.non_manifold_vertices,
            ),
            (
                "edges between triangles of opposite orientation",
                &self.misoriented_edges,
            ),
        ]
        .into_iter()
        .filter(|(_, finding)| finding.count > 0)
        .collect()
    }

    /// The findings as lines of text, the verdict last.
    pub fn report(&self) -> String {
        let mut text = format!(
            "vertices            {}\ntriangles           {}\nedges               {}\ncomponents          {}\n\
             boundary edges      {} in {} loops\nseam edges          {}\n",
            self.vertices,
            self.triangles,
            self.edges,
            self.components,
            self.boundary_edges,
            self.boundary_loops,
            self.seam_edges
        );
        // Writing to a String cannot fail.
        if !self.materials.is_empty() {
            let _ = writeln!(text, "materials           {}", self.materials.join(", "));
        }
        if let Some(Bounds { low, high }) = self.bounds {
            let _ = writeln!(text, "bounding box        {low:?} to {high:?}");
        }
        let _ = writeln!(text, "area                {}", self.area);
        for (name, finding) in [
            ("unreferenced vertices", &self.unreferenced_vertices),
            (
                "vertices at the place of another",
                &self.duplicate_positions,
            ),
        ] {
            if finding.count > 0 {
                line(&mut text, "remark", name, finding);
            }
        }
        for (name, finding) in self.problems() {
            line(&mut text, "problem", name, finding);
        }
        text.push_str(if self.triangles == 0 {
            "problem: no triangles\n"
        } else if self.clean {
            "clean\n"
        } else {
            "not clean\n"
        });
        text
    }
}

fn line(text: &mut String, rank: &str, name: &str, finding: &Finding) {
    let examples: Vec<String> = finding
        .examples
        .iter()
        .map(|ids| ids.iter().map(u32::to_string).collect::<Vec<_>>().join("-"))
        .collect();
    let more = if finding.count > examples.len() {
        ", ..."
    } else {
        ""
    };
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "{rank}: {} {name}: {}{more}",
        finding.count,
        examples.join(", ")
    );
}

/// Area, and the triangles that have none.
struct Surface {
    area: f64,
    degenerate: Finding,
    zero_area: Finding,
}

impl Surface {
    fn of(mesh: &Mesh) -> Self {
        // In a frame of size 1 the squares neither overflow nor vanish.
        let frame = mesh.bounds().map_or_else(Frame::default, |(low, high)| {
            Frame::for_size(high.abs().max_element().max(low.abs().max_element()))
        });
        let (mut area, mut degenerate, mut zero_area) =
            (0.0, Finding::default(), Finding::default());
        for (t, &[a, b, c]) in mesh.triangles().iter().enumerate() {
            if a == b || b == c || c == a {
                degenerate.add(&[t as u32]);
                continue;
            }
            let doubled = double_area(mesh.corners(t).each(|p| frame.enter(p)));
            if doubled == 0.0 {
                zero_area.add(&[t as u32]);
            }
            area += doubled * 0.5;
        }
        Self {
            area: frame.leave_length(area, 2),
            degenerate,
            zero_area,
        }
    }
}

fn duplicate_positions(mesh: &Mesh) -> Finding {
    let place = |v: usize| {
        let p = mesh.positions()[v];
        // -0 is the same place as +0.
        [p.x + 0.0, p.y + 0.0, p.z + 0.0]
    };
    let united = group_equal(mesh.positions().len(), &|a, b| {
        compare_rows(&place(a), &place(b))
    });
    repeats(&united.groups, &united.firsts)
}

fn duplicate_triangles(mesh: &Mesh) -> Finding {
    let sets: Vec<[u32; 3]> = mesh
        .triangles()
        .iter()
        .map(|&corners| {
            let mut set = corners;
            set.sort_unstable();
            set
        })
        .collect();
    let united = group_equal(sets.len(), &|a, b| sets[a].cmp(&sets[b]));
    let mut finding = Finding::default();
    for (t, &group) in united.groups.iter().enumerate() {
        let [a, b, c] = sets[t];
        if united.firsts[group as usize] != t && a != b && b != c {
            finding.add(&[t as u32]);
        }
    }
    finding
}

/// The items that are not the first of their group.
fn repeats(groups: &[u32], firsts: &[usize]) -> Finding {
    let mut finding = Finding::default();
    for (i, &group) in groups.iter().enumerate() {
        if firsts[group as usize] != i {
            finding.add(&[i as u32]);
        }
    }
    finding
}

/// Non-manifold edges, edges between triangles of opposite orientation, and the number of seam edges.
fn edge_findings(mesh: &Mesh, edges: &Edges) -> (Finding, Finding, usize) {
    let (mut non_manifold, mut misoriented, mut seams) =
        (Finding::default(), Finding::default(), 0);
    for (edge, triangles) in edges.iter() {
        if triangles.len() > 2 {
            non_manifold.add(&edge);
        }
        if let [s, t] = *triangles
            && forward(mesh, edge, s) == forward(mesh, edge, t)
        {
            misoriented.add(&edge);
        }
        if !mesh.attributes().is_empty()
            && triangles
                .windows(2)
                .any(|pair| differ_at(mesh, edge, pair[0], pair[1]))
        {
            seams += 1;
        }
    }
    (non_manifold, misoriented, seams)
}

/// Whether a triangle runs through an edge from its smaller to its larger vertex.
fn forward(mesh: &Mesh, [u, w]: Edge, triangle: u32) -> bool {
    let [a, b, c] = mesh.triangles()[triangle as usize];
    [[a, b], [b, c], [c, a]].contains(&[u, w])
}

/// Whether two triangles have other attributes than each other at either end of an edge.
fn differ_at(mesh: &Mesh, edge: Edge, s: u32, t: u32) -> bool {
    let attributes = mesh.attributes();
    let wedge = |triangle: u32, vertex: u32| {
        let corner = mesh.triangles()[triangle as usize]
            .iter()
            .position(|&v| v == vertex)
            .unwrap_or(0);
        attributes.corners()[triangle as usize][corner]
    };
    edge.iter().any(|&v| {
        let (a, b) = (wedge(s, v), wedge(t, v));
        a != b && compare_rows(attributes.row(a), attributes.row(b)).is_ne()
    })
}
