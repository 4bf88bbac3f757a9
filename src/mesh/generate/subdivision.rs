//! Splitting the triangles of a sphere in four, with the midpoints of edges put back on it.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::{mesh::Edge, num::math};

/// Splits every triangle of a triangulated unit sphere in four. Old vertices keep their numbers; new ones follow in
/// the order in which the triangles first need them.
pub(crate) fn split(vertices: &mut Vec<DVec3>, triangles: &mut Vec<[u32; 3]>) {
    let mut middles: BTreeMap<Edge, u32> = BTreeMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
            let sum = vertices[a as usize] + vertices[b as usize];
            // No edge joins opposite points, so the sum has a direction.
            vertices.push(math::unit(sum).unwrap_or(sum));
            vertices.len() as u32 - 1
        })
    };
    let mut finer = Vec::with_capacity(4 * triangles.len());
    for &[a, b, c] in triangles.iter() {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    *triangles = finer;
}
