//! The indexed triangle mesh.

use std::sync::Arc;

use glam::DVec3;

use super::{Asset, Attributes, canonical, weld};
use crate::{
    Error, Result,
    num::{Each, Frame, Precision},
    parallel,
};

/// Triangles whose bounds one task finds.
const BOUNDS_CHUNK: usize = 1 << 15;

/// Materials: a name per triangle, and the files that define them. Empty where the file has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Materials {
    /// Names, in the order in which the file first uses them.
    pub names: Vec<String>,
    /// Index into `names` for every triangle, or [`Materials::NONE`]; empty where no triangle has a material.
    pub of_triangle: Vec<u32>,
    /// Material libraries (`mtllib`) that the file names.
    pub libraries: Vec<String>,
    /// The document that defines them, where the file is one: a writer of its format gives back all that is in it.
    pub asset: Option<Arc<Asset>>,
}

impl Materials {
    /// The index of a triangle without a material.
    pub const NONE: u32 = u32::MAX;

    /// The material of a triangle: an index into `names`, or [`Materials::NONE`].
    #[must_use]
    pub fn of(&self, triangle: usize) -> u32 {
        self.of_triangle
            .get(triangle)
            .copied()
            .unwrap_or(Self::NONE)
    }

    /// Number of times that a scene shows a triangle: that of its part in a document, 1 elsewhere.
    #[must_use]
    pub fn instances(&self, triangle: usize) -> usize {
        let name = self.names.get(self.of(triangle) as usize);
        let asset = self.asset.as_ref().zip(name);
        let part = asset.and_then(|(asset, name)| asset.parts.iter().find(|p| p.name == *name));
        part.map_or(1, |p| p.instances)
    }
}

/// Everything a [`Mesh`] is made of, before it is validated.
#[derive(Clone, Debug, Default)]
pub struct MeshParts {
    /// Positions in file units.
    pub positions: Vec<DVec3>,
    /// Vertices of every triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Corner attributes; empty, or with one entry per triangle.
    pub attributes: Attributes,
    /// Materials; empty, or with one entry per triangle.
    pub materials: Materials,
    /// The precision the coordinates are stored with.
    pub precision: Precision,
}

/// An indexed triangle mesh: validated, immutable, in file units.
///
/// Holds: every index names a vertex, every coordinate is finite and representable in [`Mesh::precision`], there are
/// fewer than 2^31 vertices and triangles, attributes and materials cover every triangle or none. It may still be
/// non-manifold, open, degenerate, unreferenced in part, or empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    attributes: Attributes,
    materials: Materials,
    precision: Precision,
}

impl Mesh {
    /// Largest number of vertices or triangles: ids must fit in 31 bits.
    pub const LIMIT: usize = (1 << 31) - 1;

    /// Validates `parts`. Coordinates are rounded to `parts.precision`.
    ///
    /// # Errors
    /// [`Error::Input`] that names the first violation of what [`Mesh`] promises.
    pub fn new(mut parts: MeshParts) -> Result<Self> {
        let (vertices, triangles) = (parts.positions.len(), parts.triangles.len());
        if vertices > Self::LIMIT || triangles > Self::LIMIT {
            return Err(Error::content(format!(
                "{vertices} vertices and {triangles} triangles; at most {} of each",
                Self::LIMIT
            )));
        }
        for (i, p) in parts.positions.iter_mut().enumerate() {
            let rounded = parts.precision.round_vector(*p);
            if !rounded.is_finite() {
                return Err(Error::content(format!(
                    "vertex {i} is ({}, {}, {}); expected finite coordinates",
                    p.x, p.y, p.z
                )));
            }
            *p = rounded;
        }
        for (t, corners) in parts.triangles.iter().enumerate() {
            if let Some(v) = corners.iter().find(|&&v| v as usize >= vertices) {
                return Err(Error::content(format!(
                    "triangle {t} names vertex {v}, but there are {vertices}"
                )));
            }
        }
        for (what, count) in [
            ("attributes", parts.attributes.corners().len()),
            ("materials", parts.materials.of_triangle.len()),
        ] {
            if count != 0 && count != triangles {
                return Err(Error::content(format!(
                    "{what} cover {count} of {triangles} triangles; expected all or none"
                )));
            }
        }
        let names = parts.materials.names.len();
        if let Some(m) = parts
            .materials
            .of_triangle
            .iter()
            .find(|&&m| m != Materials::NONE && m as usize >= names)
        {
            return Err(Error::content(format!(
                "a triangle names material {m}, but there are {names}"
            )));
        }
        let MeshParts {
            positions,
            triangles,
            attributes,
            materials,
            precision,
        } = parts;
        Ok(Self {
            positions,
            triangles,
            attributes,
            materials,
            precision,
        })
    }

    /// A mesh from arrays as engines keep them: x, y, z of every vertex, and three vertices of every triangle,
    /// counter-clockwise seen from outside. Welded and in canonical order as the methods want it: vertices at bit-equal
    /// places are one, triangles that repeat a vertex and vertices without triangles are gone.
    ///
    /// ```
    /// use lodmark::Mesh;
    ///
    /// let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    /// let mesh = Mesh::from_slices(&corners, &[0, 1, 2])?;
    /// assert_eq!(mesh.triangles().len(), 1);
    /// assert!(Mesh::from_slices(&corners, &[0, 1, 3]).is_err());
    /// # Ok::<(), lodmark::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] where a slice does not hold threes, a coordinate is infinite or NaN, or a triangle names a vertex
    /// that does not exist.
    pub fn from_slices(positions: &[f32], triangles: &[u32]) -> Result<Self> {
        let ((points, []), (corners, [])) =
            (positions.as_chunks::<3>(), triangles.as_chunks::<3>())
        else {
            return Err(Error::content(format!(
                "{} coordinates and {} corners; expected three of each vertex and triangle",
                positions.len(),
                triangles.len()
            )));
        };
        let points = points.iter().map(|p| DVec3::from_array(p.each(f64::from)));
        let stored = Self::from_triangles(points.collect(), corners.to_vec())?;
        Ok(canonical(&weld(stored).mesh).mesh)
    }

    /// A mesh without attributes, as it is, for coordinates that carry `f32` precision.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn from_triangles(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self> {
        Self::new(MeshParts {
            positions,
            triangles,
            ..MeshParts::default()
        })
    }

    /// The parts, to make another mesh of them.
    #[must_use]
    pub fn into_parts(self) -> MeshParts {
        let Self {
            positions,
            triangles,
            attributes,
            materials,
            precision,
        } = self;
        MeshParts {
            positions,
            triangles,
            attributes,
            materials,
            precision,
        }
    }

    /// Positions in file units.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Vertices of every triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Corner attributes.
    #[must_use]
    pub fn attributes(&self) -> &Attributes {
        &self.attributes
    }

    /// Materials.
    #[must_use]
    pub fn materials(&self) -> &Materials {
        &self.materials
    }

    /// The precision coordinates are stored with.
    #[must_use]
    pub fn precision(&self) -> Precision {
        self.precision
    }

    /// The corner positions of a triangle.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[must_use]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].each(|v| self.positions[v as usize])
    }

    /// Smallest and largest corner of the bounding box of the vertices that triangles use; `None` without triangles.
    #[must_use]
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let of_some = |triangles: &[[u32; 3]]| {
            let mut corners = triangles
                .iter()
                .flatten()
                .map(|&v| self.positions[v as usize]);
            let first = corners.next()?;
            Some(corners.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
        };
        let chunks = self.triangles.len().div_ceil(BOUNDS_CHUNK);
        let boxes = parallel::filter_map(chunks, |i| {
            let end = self.triangles.len().min((i + 1) * BOUNDS_CHUNK);
            of_some(&self.triangles[i * BOUNDS_CHUNK..end])
        });
        let boxes = boxes.into_iter();
        boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }

    /// The mesh inside a [`FramedMesh`](super::FramedMesh), the only one whose coordinates its precision may not hold.
    pub(super) fn in_frame(&self, frame: Frame) -> Self {
        Self {
            positions: self.positions.iter().map(|&p| frame.enter(p)).collect(),
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner() -> Vec<DVec3> {
        vec![DVec3::ZERO, DVec3::X, DVec3::Y]
    }

    #[test]
    fn an_index_beyond_the_last_vertex_is_refused_with_its_triangle() {
        let refused = Mesh::from_triangles(corner(), vec![[0, 1, 2], [0, 1, 3]]);
        let message = refused.map_err(Error::message);
        assert_eq!(
            message,
            Err("triangle 1 names vertex 3, but there are 3".into())
        );
    }

    #[test]
    fn a_coordinate_that_f32_cannot_hold_is_refused() {
        let mut positions = corner();
        positions[1].x = 1e300;
        assert!(Mesh::from_triangles(positions, vec![[0, 1, 2]]).is_err());
    }

    #[test]
    fn attributes_for_some_triangles_only_are_refused() {
        let attributes = Attributes::new(
            &[super::super::ChannelKind::TexCoord(0)],
            vec![0.0, 0.0],
            vec![[0, 0, 0]],
        );
        let parts = MeshParts {
            positions: corner(),
            triangles: vec![[0, 1, 2]; 2],
            attributes: attributes.expect("one wedge"),
            ..MeshParts::default()
        };
        assert_eq!(
            Mesh::new(parts).map_err(Error::message),
            Err("attributes cover 1 of 2 triangles; expected all or none".into())
        );
    }
}
