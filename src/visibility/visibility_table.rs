//! The table F(t, v) itself: the visibility diagram of Figure 1 of Zhang & Turk 2002.

use super::{MeasureOptions, PartialVisibility};
use crate::{Error, Progress, Result, mesh::Mesh, raster::Grid};

/// A bit for every view and triangle: whether the view sees it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VisibilityTable {
    packed: Grid<u8>,
    triangles: usize,
}

impl VisibilityTable {
    /// A row for every camera with a bit for every triangle, eight to a byte, the first in the lowest bit;
    /// `numpy.unpackbits(F, axis=1, count=triangles, bitorder="little")` unpacks it. Bits beyond the last triangle are 0.
    pub fn packed(&self) -> &Grid<u8> {
        &self.packed
    }

    /// True where view `camera` sees anything of `triangle`.
    ///
    /// # Panics
    /// For a camera or triangle that there is not.
    pub fn sees(&self, camera: u32, triangle: usize) -> bool {
        let count = self.triangles;
        assert!(triangle < count, "triangle {triangle} of {count}");
        self.packed.at(triangle as u32 / 8, camera) >> (triangle % 8) & 1 == 1
    }
}

impl PartialVisibility {
    /// A survey of all views, with the table: another cameras x triangles / 8 bytes.
    ///
    /// # Errors
    /// As [`measure`](super::measure).
    pub fn with_table(
        mesh: &Mesh,
        options: &MeasureOptions,
        progress: &dyn Progress,
    ) -> Result<(Self, VisibilityTable)> {
        let faces = mesh.triangles().len();
        let mut bytes = Vec::new();
        let views = 0..options.cameras();
        let survey = Self::watched(mesh, options, views, progress, |parts| {
            for view in parts.chunks(faces) {
                let bit = |(i, &part): (usize, &u16)| u8::from(part > 0) << i;
                let byte = |eight: &[u16]| eight.iter().enumerate().map(bit).sum::<u8>();
                bytes.extend(view.chunks(8).map(byte));
            }
        })?;
        let packed = Grid::new(faces.div_ceil(8) as u32, options.cameras(), bytes)
            .ok_or_else(|| Error::Internal("a table without all of its rows".into()))?;
        let table = VisibilityTable {
            packed,
            triangles: faces,
        };
        Ok((survey, table))
    }
}
