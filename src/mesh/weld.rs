//! Welding: vertices at exactly the same place become one.
//!
//! Exact only: places that differ in the last bit stay apart, because what "close" means is not ours to guess.

use super::{Mesh, group_equal::group_equal};

/// A mesh in which no two vertices share a place, with the number of vertices that went.
#[derive(Clone, Debug, PartialEq)]
pub struct Welded {
    /// The mesh.
    pub mesh: Mesh,
    /// Vertices that were merged into an earlier one.
    pub merged: usize,
    /// For every vertex before, its vertex in `mesh`.
    pub vertices: Vec<u32>,
}

/// Merges vertices with bit-equal positions (`-0` equals `+0`) into the first of each. The vertices that stay keep
/// their order and bits, the triangles their order and number (some may now repeat a vertex), attributes and
/// materials are untouched. O(n log n).
///
/// # Panics
/// Never: a valid mesh with fewer vertices is valid.
#[must_use]
pub fn weld(mesh: Mesh) -> Welded {
    // Adding +0 turns -0 into +0 and changes nothing else.
    let places: Vec<[f64; 3]> = mesh
        .positions()
        .iter()
        .map(|p| [p.x + 0.0, p.y + 0.0, p.z + 0.0])
        .collect();
    let united = group_equal(places.len(), &|a, b| {
        let (a, b) = (&places[a], &places[b]);
        a[0].total_cmp(&b[0])
            .then(a[1].total_cmp(&b[1]))
            .then(a[2].total_cmp(&b[2]))
    });
    let merged = places.len() - united.firsts.len();
    if merged == 0 {
        return Welded {
            mesh,
            merged,
            vertices: united.groups,
        };
    }
    let mut parts = mesh.into_parts();
    parts.positions = united.firsts.iter().map(|&i| parts.positions[i]).collect();
    for corner in parts.triangles.iter_mut().flatten() {
        *corner = united.groups[*corner as usize];
    }
    Welded {
        mesh: Mesh::new(parts).expect("fewer vertices of a valid mesh"),
        merged,
        vertices: united.groups,
    }
}
