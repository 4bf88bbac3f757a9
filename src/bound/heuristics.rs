//! Claims that usual tests make about a simplification, to be held against the bound of [`surface`](super::surface).
//!
//! Eisemann & Décoret 2007, sections 2 and 5: tests of vertices or of edges bound nothing, because a point inside a face
//! can be nearer to the viewer than all its vertices (Figure 16), or leave its validity region while they stay in theirs
//! (Figure 11). Both tests are given all they could wish for: exact angles, and every viewpoint of the cell.

use glam::DVec3;
use serde::Serialize;

use super::{point::error, surface::Replacement, view_cell::ViewCell};
use crate::{
    mesh::{Edge, Edges, Mesh},
    num::Each,
    parallel,
};

/// Angles in radians that tests would have called the error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Claims {
    /// The largest angle between a vertex of the original and the point that stands for it.
    pub vertices: f64,
    /// The largest angle, over vertices of the original that are gone, under which the shortest-seen edge at the vertex
    /// is seen: the threshold at which a test of edge lengths lets all of them go.
    pub edges: f64,
}

/// Computes the claims of the tests about `low` as a simplification of `reference`, in the same units.
///
/// A vertex is gone where no vertex of `low` has its position to the last bit. Cost: that of an exact error for each
/// vertex and edge.
pub fn claims(
    reference: &Mesh,
    low: &Mesh,
    replacement: &dyn Replacement,
    cell: &ViewCell,
) -> Claims {
    let positions = reference.positions();
    let angle = |a: DVec3, b: DVec3| error(cell, a, b).radians;
    let moved = parallel::map_slice(positions, |&p| {
        let to = replacement.propose([p; 3]).map_or(p, |[to, ..]| to);
        angle(p, to)
    });
    let mut kept: Vec<[u64; 3]> = low.positions().iter().map(|&p| bits(p)).collect();
    kept.sort_unstable();
    let gone = |v: u32| kept.binary_search(&bits(positions[v as usize])).is_err();
    let edges: Vec<Edge> = Edges::of(reference).iter().map(|(edge, _)| edge).collect();
    let seen = parallel::map_slice(&edges, |&[a, b]| {
        angle(positions[a as usize], positions[b as usize])
    });
    let mut least = vec![f64::INFINITY; positions.len()];
    for (&[a, b], &angle) in edges.iter().zip(&seen) {
        for v in [a, b] {
            let least = &mut least[v as usize];
            *least = least.min(angle);
        }
    }
    let gone_edges = (0..positions.len() as u32)
        .filter(|&v| least[v as usize].is_finite() && gone(v))
        .map(|v| least[v as usize]);
    Claims {
        vertices: moved.into_iter().fold(0.0, f64::max),
        edges: gone_edges.fold(0.0, f64::max),
    }
}

/// Both zeros are one.
fn bits(p: DVec3) -> [u64; 3] {
    p.to_array().each(|x| (x + 0.0).to_bits())
}
