//! Contact sheets: pictures side by side in a grid, each with a label below.
//!
//! Labels are drawn with a built-in font and cut at the edge of their cell. Lengths are pixels.

use std::borrow::Borrow;

use super::{font, png::SIDE_LIMIT};
use crate::{Error, Result, num::Grid};

/// Space around the pictures of a sheet for eyes.
pub const PADDING: u32 = 8;

/// A pixel that a grey level can be drawn into.
pub trait Ink: Copy {
    /// The pixel of a grey level.
    fn grey(level: u8) -> Self;
}

impl Ink for u8 {
    fn grey(level: u8) -> Self {
        level
    }
}

impl Ink for [u8; 3] {
    fn grey(level: u8) -> Self {
        [level; 3]
    }
}

/// Puts pictures on a sheet, row by row, `columns` in a row (fewer where there are fewer pictures), black on white, with
/// `padding` around every picture. Cells have the size of the largest picture; pictures stand at the top left of their
/// cells, each above its label: one line of printable ASCII, empty for none; other characters are drawn as boxes.
///
/// # Errors
/// [`Error::Usage`] without pictures, for 0 columns, and where a side would exceed 16,384 pixels.
pub fn sheet<P: Ink>(
    tiles: &[(impl Borrow<Grid<P>>, impl AsRef<str>)],
    columns: u32,
    padding: u32,
) -> Result<Grid<P>> {
    if tiles.is_empty() || columns == 0 {
        return Err(Error::Usage(format!(
            "a sheet of {} pictures in {columns} columns; expected at least 1 of each",
            tiles.len(),
        )));
    }
    let widest = |size: fn(&Grid<P>) -> u32| {
        let sizes = tiles.iter().map(|(picture, _)| size(picture.borrow()));
        sizes.max().map_or(0, u64::from)
    };
    let (width, height) = (widest(Grid::width), widest(Grid::height));
    let labelled = tiles.iter().any(|(_, label)| !label.as_ref().is_empty());
    let label = if labelled {
        u64::from(font::HEIGHT) + 2
    } else {
        0
    };
    let columns = u64::from(columns).min(tiles.len() as u64);
    let rows = (tiles.len() as u64).div_ceil(columns);
    let padding = u64::from(padding);
    let (cell_width, cell_height) = (width + padding, height + label + padding);
    let sheet_width = columns.saturating_mul(cell_width).saturating_add(padding);
    let sheet_height = rows.saturating_mul(cell_height).saturating_add(padding);
    let limit = u64::from(SIDE_LIMIT);
    if sheet_width > limit || sheet_height > limit {
        return Err(Error::Usage(format!(
            "a sheet of {sheet_width} x {sheet_height} pixels; expected at most {limit} per side: use fewer or smaller \
             pictures"
        )));
    }
    let plane = Grid::filled(sheet_width as u32, sheet_height as u32, P::grey(255));
    let mut page = Page { plane };
    for (i, (picture, label)) in (0_u64..).zip(tiles) {
        let x = (padding + i % columns * cell_width) as u32;
        let y = (padding + i / columns * cell_height) as u32;
        page.picture(x, y, picture.borrow());
        let (baseline, end) = (y + height as u32 + 2, x + width as u32);
        page.text(x, baseline, end, label.as_ref());
    }
    Ok(page.plane)
}

/// A plane that is drawn on; what lies outside is cut off.
struct Page<P> {
    plane: Grid<P>,
}

impl<P: Ink> Page<P> {
    fn set(&mut self, x: u32, y: u32, pixel: P) {
        let (width, height) = (self.plane.width(), self.plane.height());
        if x < width && y < height {
            self.plane.values_mut()[y as usize * width as usize + x as usize] = pixel;
        }
    }

    fn picture(&mut self, x: u32, y: u32, picture: &Grid<P>) {
        for row in 0..picture.height() {
            for column in 0..picture.width() {
                self.set(x + column, y + row, picture.at(column, row));
            }
        }
    }

    /// One line with its top left corner at (x, y); characters that do not fit before column `end` are left out.
    fn text(&mut self, x: u32, y: u32, end: u32, text: &str) {
        let mut left = x;
        for character in text.chars() {
            if left + font::WIDTH > end {
                return;
            }
            for (row, column) in
                (0..font::HEIGHT).flat_map(|r| (0..font::WIDTH).map(move |c| (r, c)))
            {
                if font::ink(character, column, row) {
                    self.set(left + column, y + row, P::grey(0));
                }
            }
            left += font::WIDTH + 1;
        }
    }
}
