//! Back from a [`LiveMesh`] to a [`Mesh`]: only what is still used, in the old order.

use super::{LiveMesh, NONE};
use crate::{
    Error, Result,
    mesh::{Attributes, Materials, Mesh, MeshParts},
    num::Each,
};

impl LiveMesh {
    /// Makes a mesh in file units of the triangles that are left: triangles and vertices keep their relative order, and
    /// only referenced vertices and wedges are kept.
    ///
    /// # Errors
    /// [`Error::Internal`], should a promise of [`Mesh`] not hold (a bug).
    pub fn to_mesh(&self) -> Result<Mesh> {
        let ids: Vec<u32> = (0..self.triangle_ids())
            .filter(|&t| self.triangle(t).is_some())
            .collect();
        let corners = ids.iter().map(|&t| self.faces[t as usize]);
        let (triangles, vertices) = compacted(corners, self.positions.len());
        let positions = vertices
            .iter()
            .map(|&v| self.frame.leave(self.position(v)))
            .collect();
        let attributes = if self.wedges.is_empty() {
            Attributes::default()
        } else {
            let corners = ids.iter().map(|&t| self.wedges[t as usize]);
            let (corners, wedges) = compacted(corners, self.wedge_count() as usize);
            let values = wedges
                .iter()
                .flat_map(|&w| self.rows.row(w).iter().copied())
                .collect();
            Attributes::new(&self.rows.kinds(), values, corners).map_err(Error::internal)?
        };
        let of_triangle = if self.materials.of_triangle.is_empty() {
            Vec::new()
        } else {
            ids.iter().map(|&t| self.material(t)).collect()
        };
        Mesh::new(MeshParts {
            positions,
            triangles,
            attributes,
            materials: Materials {
                of_triangle,
                ..self.materials.clone()
            },
            precision: self.precision,
        })
        .map_err(Error::internal)
    }
}

/// Triples renumbered to the indices below `count` that they use, and those indices in ascending order.
fn compacted(
    triples: impl Iterator<Item = [u32; 3]> + Clone,
    count: usize,
) -> (Vec<[u32; 3]>, Vec<u32>) {
    let mut new = vec![NONE; count];
    for v in triples.clone().flatten() {
        new[v as usize] = 0;
    }
    let used: Vec<u32> = (0..count as u32)
        .filter(|&v| new[v as usize] == 0)
        .collect();
    for (i, &v) in used.iter().enumerate() {
        new[v as usize] = i as u32;
    }
    (triples.map(|t| t.each(|v| new[v as usize])).collect(), used)
}
