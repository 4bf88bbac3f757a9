//! How deep a picture is, in small squares: what lies behind all of a square is not seen there.

use super::{Region, stacks::Shown};

/// Samples in a row and column of a square, as a power of two. Squares of 8 hide a third of the triangles that nobody
/// sees, those of 4 half of them.
const SQUARE: u32 = 2;

/// The greatest visible depth of every square, its upper half.
#[derive(Clone, Debug)]
pub(super) struct Deepest {
    columns: usize,
    depths: Vec<u16>,
}

impl Deepest {
    /// Of a picture of which nothing is known.
    pub(super) fn new(image: Region) -> Self {
        let squares = |length: usize| length.div_ceil(1 << SQUARE);
        let columns = squares(image.width());
        Self {
            columns,
            depths: vec![u16::MAX; columns * squares(image.height())],
        }
    }

    /// True where everything that is seen in the squares of a region is nearer than a depth; the region must be in the
    /// picture.
    #[inline]
    pub(super) fn hides(&self, region: Region, depth: u32) -> bool {
        if region.is_empty() {
            return true;
        }
        let depth = (depth >> 16) as u16;
        let square = |v: i32| (v >> SQUARE) as usize;
        let columns = square(region.x0)..square(region.x1 - 1) + 1;
        (square(region.y0)..=square(region.y1 - 1)).all(|row| {
            let row = &self.depths[row * self.columns..][columns.clone()];
            row.iter().all(|&deepest| depth > deepest)
        })
    }

    /// Measures the squares that meet a region of the picture, which shows what `shown` says.
    pub(super) fn measure(&mut self, region: Region, image: Region, shown: &[Shown]) {
        let square = |v: i32| (v >> SQUARE) as usize;
        let samples = |at: usize, end: usize| at << SQUARE..((at + 1) << SQUARE).min(end);
        for row in square(region.y0)..=square(region.y1 - 1) {
            for column in square(region.x0)..=square(region.x1 - 1) {
                let columns = samples(column, image.width());
                let rows = samples(row, image.height());
                let depths = rows.flat_map(|y| {
                    let row = &shown[y * image.width()..][columns.clone()];
                    row.iter().map(|s| s.upper_depth())
                });
                self.depths[row * self.columns + column] = depths.fold(0, u16::max);
            }
        }
    }
}
