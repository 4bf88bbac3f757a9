//! Large triangles in pieces: each is seen or hidden on its own.
//!
//! Zhang & Turk 2002, section 4: a vertex in the middle of every edge longer than l, triangles split by how many of
//! their edges have one, repeated until no edge is longer. Whether an edge is split, and where, depends on the positions
//! of its ends alone, so neighbours agree and no T-vertex appears, shared vertices or not. Lengths in frame units.
//! Limit: 2^24 pieces; beyond it the measurement is refused.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::{
    Error, Result,
    geometry::double_area,
    num::{Each, math},
    raster::Scene,
};

/// Most pieces that are measured.
const PIECE_LIMIT: usize = 1 << 24;

/// Triangles to measure, in the order of the faces they are part of.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    /// The pieces with ids from 0; the positions of the mesh come first.
    pub(super) scene: Scene,
    /// First piece of every face, and the number of pieces; empty where every face is its own piece.
    starts: Vec<u32>,
    /// Area of every piece; empty where every face is its own piece.
    areas: Vec<f64>,
}

impl Pieces {
    /// The triangles in pieces whose edges are no longer than `limit`; as they are where it is `None`.
    pub(super) fn new(
        positions: Vec<DVec3>,
        triangles: &[[u32; 3]],
        limit: Option<f64>,
    ) -> Result<Self> {
        let mut division = Division {
            positions,
            triangles: triangles.to_vec(),
            starts: Vec::new(),
        };
        if let Some(limit) = limit {
            if division.fewest_pieces(limit) > PIECE_LIMIT as f64 {
                return Err(too_many());
            }
            while division.split(limit * limit)? {}
        }
        let Division {
            positions,
            triangles,
            starts,
        } = division;
        let area = |t: &[u32; 3]| 0.5 * double_area(t.each(|v| positions[v as usize]));
        let areas = match starts.is_empty() {
            true => Vec::new(),
            false => triangles.iter().map(area).collect(),
        };
        let ids = (0..triangles.len() as u32).collect();
        Ok(Self {
            scene: Scene::new(positions, triangles, ids),
            starts,
            areas,
        })
    }

    /// The pieces of a face.
    #[inline]
    pub(super) fn of(&self, face: usize) -> std::ops::Range<usize> {
        pieces_of(&self.starts, face)
    }

    /// True where every face is its own piece.
    pub(super) fn are_whole(&self) -> bool {
        self.starts.is_empty()
    }

    /// The area of a piece; only where faces are in pieces.
    #[inline]
    pub(super) fn area(&self, piece: usize) -> f64 {
        self.areas[piece]
    }
}

/// The pieces of a face; itself where no face has others.
#[inline]
fn pieces_of(starts: &[u32], face: usize) -> std::ops::Range<usize> {
    if starts.is_empty() {
        return face..face + 1;
    }
    starts[face] as usize..starts[face + 1] as usize
}

/// Triangles while they are divided.
struct Division {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    starts: Vec<u32>,
}

fn too_many() -> Error {
    Error::Unsupported(format!(
        "the triangles are so large or long that they make more than {PIECE_LIMIT} pieces; try a larger edge limit, \
         smaller ID buffers, or whole triangles"
    ))
}

impl Division {
    /// A lower bound of the number of pieces: none is larger than an equilateral triangle, or longer, than `limit`.
    fn fewest_pieces(&self, limit: f64) -> f64 {
        let largest = 0.433 * limit * limit;
        let fewest = |t: &[u32; 3]| {
            let [a, b, c] = t.each(|v| self.positions[v as usize]);
            let by_area = 0.5 * double_area([a, b, c]) / largest;
            let by_length = math::length(b - a) / limit;
            f64::max(1.0, f64::max(by_area, by_length))
        };
        self.triangles.iter().map(fewest).sum()
    }

    /// Splits every edge whose squared length exceeds `limit` once; false where there is none.
    fn split(&mut self, limit: f64) -> Result<bool> {
        let long = |positions: &[DVec3], a: u32, b: u32| {
            let edge = positions[b as usize] - positions[a as usize];
            edge.dot(edge) > limit
        };
        let any = |&[a, b, c]: &[u32; 3]| {
            let mut edges = [[a, b], [b, c], [c, a]].into_iter();
            edges.any(|[a, b]| long(&self.positions, a, b))
        };
        if !self.triangles.iter().any(any) {
            return Ok(false);
        }
        let faces = match self.starts.len() {
            0 => self.triangles.len(),
            count => count - 1,
        };
        let mut middles: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut finer = Vec::with_capacity(2 * self.triangles.len());
        let mut starts = Vec::with_capacity(faces + 1);
        for face in 0..faces {
            starts.push(finer.len() as u32);
            for &corners in &self.triangles[pieces_of(&self.starts, face)] {
                let positions = &mut self.positions;
                let mut middle = |a: u32, b: u32| {
                    if !long(positions, a, b) {
                        return None;
                    }
                    Some(*middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                        positions.push((positions[a as usize] + positions[b as usize]) * 0.5);
                        positions.len() as u32 - 1
                    }))
                };
                let [a, b, c] = corners;
                let marks = [middle(a, b), middle(b, c), middle(c, a)];
                divide(corners, marks, &self.positions, &mut finer);
            }
            if finer.len() > PIECE_LIMIT {
                return Err(too_many());
            }
        }
        starts.push(finer.len() as u32);
        self.triangles = finer;
        self.starts = starts;
        Ok(true)
    }
}

/// The pieces of a triangle whose edges ab, bc and ca have the given middles, orientation kept.
fn divide(
    [a, b, c]: [u32; 3],
    marks: [Option<u32>; 3],
    positions: &[DVec3],
    into: &mut Vec<[u32; 3]>,
) {
    match marks {
        [None, None, None] => into.push([a, b, c]),
        [Some(m), Some(n), Some(o)] => {
            into.extend([[a, m, o], [m, b, n], [o, n, c], [m, n, o]]);
        }
        [Some(m), None, None] => into.extend([[a, m, c], [m, b, c]]),
        [None, Some(m), None] => into.extend([[b, m, a], [m, c, a]]),
        [None, None, Some(m)] => into.extend([[c, m, b], [m, a, b]]),
        [Some(m), None, Some(o)] => cut_corner([a, b, c], [m, o], positions, into),
        [Some(m), Some(n), None] => cut_corner([b, c, a], [n, m], positions, into),
        [None, Some(n), Some(o)] => cut_corner([c, a, b], [o, n], positions, into),
    }
}

/// Both edges at `a` have a middle: m on ab, o on ca. The rest is cut along its shorter diagonal.
fn cut_corner(
    [a, b, c]: [u32; 3],
    [m, o]: [u32; 2],
    positions: &[DVec3],
    into: &mut Vec<[u32; 3]>,
) {
    let squared = |p: u32, q: u32| {
        let edge = positions[q as usize] - positions[p as usize];
        edge.dot(edge)
    };
    into.push([a, m, o]);
    if squared(m, c) <= squared(o, b) {
        into.extend([[m, b, c], [m, c, o]]);
    } else {
        into.extend([[m, b, o], [o, b, c]]);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::mesh::{Edges, Mesh, generate};

    fn pieces(mesh: &Mesh, limit: f64) -> Pieces {
        let positions = mesh.positions().to_vec();
        Pieces::new(positions, mesh.triangles(), Some(limit)).expect("few pieces")
    }

    fn area(corners: [DVec3; 3]) -> f64 {
        let [a, b, c] = corners;
        (b - a).cross(c - a).length() / 2.0
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

        #[test]
        fn no_piece_is_too_long_lost_turned_or_leaves_a_gap(limit in 0.08..3.0_f64, shape in 0..4) {
            let mesh = match shape {
                0 => generate::cube(),
                1 => generate::tetrahedron(),
                2 => generate::torus(1.0, 0.4, 7, 5),
                _ => generate::shells(2, 1),
            };
            let made = pieces(&mesh, limit);
            let scene = &made.scene;
            let mut next = 0;
            for face in 0..mesh.triangles().len() {
                let normal = crate::geometry::area_normal;
                let whole = mesh.corners(face);
                let mut sum = 0.0;
                let range = made.of(face);
                prop_assert_eq!(range.start, next);
                next = range.end;
                for piece in range {
                    let corners = scene.triangles()[piece].map(|v| scene.positions()[v as usize]);
                    for i in 0..3 {
                        let length = (corners[i] - corners[(i + 1) % 3]).length();
                        prop_assert!(length <= limit * (1.0 + 1e-12), "{}", length);
                    }
                    prop_assert!(normal(corners).dot(normal(whole)) > 0.0);
                    sum += area(corners);
                }
                prop_assert!((sum / area(whole) - 1.0).abs() < 1e-9, "face {}", face);
            }
            prop_assert_eq!(next, scene.triangle_count());
            // Without T-vertices a closed mesh stays closed.
            let parts = Mesh::from_triangles(scene.positions().to_vec(), scene.triangles().to_vec());
            let parts = parts.expect("valid");
            let edges = Edges::of(&parts);
            prop_assert!(edges.iter().all(|(_, triangles)| triangles.len() == 2));
        }
    }

    #[test]
    fn a_mesh_without_long_edges_is_its_own_pieces() {
        let mesh = generate::icosphere(2);
        let made = pieces(&mesh, 1.0);
        assert!(made.are_whole());
        assert_eq!(made.scene.triangles(), mesh.triangles());
        assert_eq!(made.of(7), 7..8);
    }
}
