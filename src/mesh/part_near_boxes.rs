//! The part of a mesh near some boxes.

use std::sync::OnceLock;

use glam::DVec3;

use super::{Mesh, MeshParts};
use crate::{num::Each, parallel};

/// Cells along a side of the grid.
const GRID: usize = 128;

/// Rows of cells that are looked through for one face. A mesh may consist of faces across all of it.
const ROWS: usize = 64;

/// Number of marked cells below every corner of the grid, along all axes.
struct Counts(Vec<u32>);

impl Counts {
    /// Corners along a side.
    const SIDE: usize = GRID + 1;

    fn at(x: usize, y: usize, z: usize) -> usize {
        (z * Self::SIDE + y) * Self::SIDE + x
    }

    fn of(marked: &[bool]) -> Self {
        let mut counts = vec![0_u32; Self::SIDE * Self::SIDE * Self::SIDE];
        for z in 0..GRID {
            for y in 0..GRID {
                let mut row = 0;
                for x in 0..GRID {
                    row += u32::from(marked[(z * GRID + y) * GRID + x]);
                    let at = |y, z| counts[Self::at(x + 1, y, z)];
                    // The last term is a part of either other one.
                    let count = row + at(y, z + 1) + at(y + 1, z) - at(y, z);
                    counts[Self::at(x + 1, y + 1, z + 1)] = count;
                }
            }
        }
        Self(counts)
    }

    /// Number of marked cells from one to another, both included.
    fn within(&self, a: [usize; 3], b: [usize; 3]) -> u32 {
        let below = |x: usize, y: usize, z: usize| self.0[Self::at(x, y, z)];
        let [x, y, z] = b.each(|i| i + 1);
        let layers = |z: usize| {
            (below(x, y, z) + below(a[0], a[1], z)) - (below(a[0], y, z) + below(x, a[1], z))
        };
        layers(z) - layers(a[2])
    }
}

impl Mesh {
    /// The faces that may touch one of the boxes (least and largest corner), of every `stride`-th one (0 is as 1), in
    /// their order, without attributes and with the vertices they need; a grid of 128 cells a side decides, so faces
    /// nearby may come along. O(n), and for every box O(its cells).
    pub fn near(&self, boxes: &[[DVec3; 2]], stride: usize) -> Self {
        let Some((low, high)) = self.bounds() else {
            return Self::default();
        };
        let extent = (high - low).max_element();
        let cell = |p: DVec3| {
            let at = (p - low) * (GRID as f64 / extent);
            at.to_array().each(|x| (x.max(0.0) as usize).min(GRID - 1))
        };
        let row = |a: [usize; 3], b: [usize; 3], y: usize, z: usize| {
            let start = (z * GRID + y) * GRID;
            start + a[0]..start + b[0] + 1
        };
        let mut near = vec![false; GRID * GRID * GRID];
        for &[from, to] in boxes {
            let (a, b) = (cell(from), cell(from.max(to)));
            for z in a[2]..=b[2] {
                for y in a[1]..=b[1] {
                    near[row(a, b, y, z)].fill(true);
                }
            }
        }
        let counts = OnceLock::new();
        let touches = |face: &[u32; 3]| {
            let [p, q, r] = face.each(|v| self.positions()[v as usize]);
            let (a, b) = (cell(p.min(q).min(r)), cell(p.max(q).max(r)));
            if (b[2] - a[2] + 1) * (b[1] - a[1] + 1) > ROWS {
                let counts = counts.get_or_init(|| Counts::of(&near));
                return counts.within(a, b) > 0;
            }
            (a[2]..=b[2]).any(|z| (a[1]..=b[1]).any(|y| near[row(a, b, y, z)].contains(&true)))
        };
        let stride = stride.max(1);
        let faces = parallel::filter_map(self.triangles().len().div_ceil(stride), |i| {
            let face = self.triangles()[i * stride];
            touches(&face).then_some(face)
        });
        let mut renamed = vec![0_u32; self.positions().len()];
        for &v in faces.iter().flatten() {
            renamed[v as usize] = 1;
        }
        let mut positions = Vec::new();
        for (&p, name) in self.positions().iter().zip(&mut renamed) {
            if *name > 0 {
                *name = positions.len() as u32;
                positions.push(p);
            }
        }
        let renamed = |v: u32| renamed[v as usize];
        let faces = faces.into_iter().map(|t| t.each(renamed)).collect();
        let parts = MeshParts {
            positions,
            triangles: faces,
            precision: self.precision(),
            ..MeshParts::default()
        };
        Self::new(parts).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{mesh::generate, num::Precision};

    #[test]
    fn coordinates_that_no_single_precision_holds_are_rounded() {
        let mesh = generate::cube();
        for scale in [1e-44, 1e300] {
            let mesh = Mesh::new(MeshParts {
                positions: mesh.positions().iter().map(|&p| p * scale).collect(),
                triangles: mesh.triangles().to_vec(),
                precision: Precision::F64,
                ..MeshParts::default()
            })
            .expect("finite");
            let (low, high) = mesh.bounds().expect("not empty");
            let part = mesh.near(&[[low, high]], 1);
            assert_eq!(part.positions(), mesh.positions());
        }
    }

    #[test]
    fn a_face_across_the_whole_grid_misses_no_marked_cell_and_finds_none_elsewhere() {
        let mut marked = vec![false; GRID * GRID * GRID];
        let (mut x, mut cells) = (12_345_usize, Vec::new());
        for _ in 0..40 {
            x = (x * 69_069 + 1) % marked.len();
            marked[x] = true;
            cells.push([x % GRID, x / GRID % GRID, x / (GRID * GRID)]);
        }
        let counts = Counts::of(&marked);
        for (i, &p) in cells.iter().enumerate() {
            for &q in &cells[i..] {
                let a = [0, 1, 2].map(|k| p[k].min(q[k]));
                let b = [0, 1, 2].map(|k| p[k].max(q[k]));
                let inside = |c: &&[usize; 3]| (0..3).all(|k| a[k] <= c[k] && c[k] <= b[k]);
                let expected = cells.iter().filter(inside).count();
                assert_eq!(counts.within(a, b) as usize, expected, "{a:?} to {b:?}");
            }
        }
        assert_eq!(counts.within([0; 3], [GRID - 1; 3]), 40);
    }

    #[test]
    fn every_face_that_touches_a_box_is_taken_and_not_all_are() {
        let mesh = generate::interlocking_tori(32, 16);
        let bounds = mesh.bounds().expect("not empty");
        let at = |x: f64, y: f64, z: f64| bounds.0 + (bounds.1 - bounds.0) * DVec3::new(x, y, z);
        for boxes in [
            vec![[at(0.1, 0.2, 0.3), at(0.3, 0.4, 0.5)]],
            vec![
                [at(-1.0, -1.0, -1.0), at(0.1, 2.0, 2.0)],
                [at(0.9, 0.5, 0.5), at(0.95, 0.6, 0.6)],
            ],
        ] {
            let part = mesh.near(&boxes, 1);
            let corners = |m: &Mesh| {
                (0..m.triangles().len())
                    .map(|t| m.corners(t))
                    .collect::<Vec<_>>()
            };
            let (all, some) = (corners(&mesh), corners(&part));
            assert!(some.len() > 4 && some.len() < all.len(), "{}", some.len());
            for face in all {
                let low = face[0].min(face[1]).min(face[2]);
                let high = face[0].max(face[1]).max(face[2]);
                let touches = |b: &[DVec3; 2]| low.cmple(b[1]).all() && high.cmpge(b[0]).all();
                assert!(!boxes.iter().any(touches) || some.contains(&face));
            }
        }
        assert!(mesh.near(&[], 1).triangles().is_empty());
        assert!(
            Mesh::default()
                .near(&[[DVec3::ZERO, DVec3::ONE]], 1)
                .triangles()
                .is_empty()
        );
        let far = [at(8.0, 8.0, 8.0), at(9.0, 9.0, 9.0)];
        assert!(mesh.near(&[far], 1).triangles().len() < 600);
    }
}
