//! Hierarchical z: the greatest visible depth of small squares of a picture. A triangle behind all of a square is not
//! seen there.

use super::fragment_lists::Shown;
use crate::raster::PixelRect;

/// Samples in a row and column of a square, as a power of two. Squares of 8 hide a third of the triangles that nobody
/// sees, those of 4 half of them.
const SQUARE: u32 = 2;

/// The greatest visible depth of every square, its upper half.
#[derive(Clone, Debug)]
pub(super) struct HiZ {
    columns: usize,
    depths: Vec<u16>,
}

impl HiZ {
    /// Of a picture of which nothing is known.
    pub(super) fn new(image: PixelRect) -> Self {
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
    pub(super) fn hides(&self, region: PixelRect, depth: u32) -> bool {
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
    pub(super) fn measure(&mut self, region: PixelRect, image: PixelRect, shown: &[Shown]) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::SampleKey;
    use crate::raster::unrender::layers::fragment_lists::FragmentLists;

    #[test]
    fn only_what_is_behind_every_sample_of_its_squares_is_hidden() {
        let image = PixelRect::image(10, 7); // squares at the right and below are cut off
        let nothing = SampleKey::new(u32::MAX, 0);
        let mut lists = FragmentLists::new(70, 0, &[], 4, nothing);
        let mut hi_z = HiZ::new(image);
        let depth = |at: usize| (at as u32 * 7 % 70 + 1) << 16 | 5;
        for at in 0..70 {
            assert!(!hi_z.hides(image, u32::MAX), "the background is deepest");
            lists.insert(at, 0, SampleKey::new(depth(at), 0));
            hi_z.measure(image, image, lists.shown());
        }
        for (x0, y0) in (0..70).map(|at| (at % 10, at / 10)) {
            for (x1, y1) in [(x0 + 1, y0 + 1), (10, y0 + 1), (x0 + 1, 7), (10, 7)] {
                let region = PixelRect { x0, y0, x1, y1 };
                let near =
                    |v: i32, from: i32, to: i32| v >> 2 >= from >> 2 && v >> 2 <= (to - 1) >> 2;
                let squares = (0..70).filter(|at| near(at % 10, x0, x1) && near(at / 10, y0, y1));
                let most = squares
                    .map(|at| depth(at as usize) >> 16)
                    .max()
                    .expect("one");
                assert!(
                    !hi_z.hides(region, most << 16 | 0xffff),
                    "as deep, to 16 bits"
                );
                assert!(hi_z.hides(region, (most + 1) << 16));
            }
        }
        assert!(hi_z.hides(PixelRect::EMPTY, 0));
    }
}
