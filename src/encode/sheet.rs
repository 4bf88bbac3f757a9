//! Contact sheets: pictures side by side in a grid, each with a label below.
//!
//! Labels are drawn with a built-in font and cut at the edge of their cell. Lengths are pixels.

use super::{font, png::SIDE_LIMIT};
use crate::{Error, Result, num::Grid};

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

/// A picture and what is written below it.
#[derive(Clone, Copy, Debug)]
pub struct Tile<'a, P> {
    /// The picture.
    pub picture: &'a Grid<P>,
    /// One line of printable ASCII; empty for none. Other characters are drawn as boxes.
    pub label: &'a str,
}

/// Spaces and grey levels of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Space around every picture.
    pub padding: u32,
    /// Side of a dot of the font, at least 1.
    pub dot: u32,
    /// Grey level of the paper.
    pub paper: u8,
    /// Grey level of the labels.
    pub ink: u8,
}

impl Default for Style {
    /// Black on white, 8 pixels of space, dots of one pixel.
    fn default() -> Self {
        Self {
            padding: 8,
            dot: 1,
            paper: 255,
            ink: 0,
        }
    }
}

/// A sheet of tiles, row by row, `columns` in a row (fewer where there are fewer tiles). Cells have the size of the
/// largest picture; pictures stand at the top left of their cells.
///
/// # Errors
/// [`Error::Usage`] without tiles, for 0 columns or dots of size 0, and where a side would exceed 16,384 pixels.
pub fn sheet<P: Ink>(tiles: &[Tile<'_, P>], columns: u32, style: Style) -> Result<Grid<P>> {
    if tiles.is_empty() || columns == 0 || !(1..=SIDE_LIMIT).contains(&style.dot) {
        return Err(Error::Usage(format!(
            "a sheet of {} pictures in {columns} columns with dots of {} pixels; expected at least 1 of each",
            tiles.len(),
            style.dot
        )));
    }
    let widest = |size: fn(&Grid<P>) -> u32| {
        tiles
            .iter()
            .map(|t| u64::from(size(t.picture)))
            .max()
            .unwrap_or(0)
    };
    let (padding, dot) = (u64::from(style.padding), u64::from(style.dot));
    let (width, height) = (widest(Grid::width), widest(Grid::height));
    let label = if tiles.iter().all(|t| t.label.is_empty()) {
        0
    } else {
        (u64::from(font::HEIGHT) + 2) * dot
    };
    let columns = u64::from(columns).min(tiles.len() as u64);
    let rows = (tiles.len() as u64).div_ceil(columns);
    let (cell_width, cell_height) = (width + padding, height + label + padding);
    let (sheet_width, sheet_height) = (
        columns.saturating_mul(cell_width).saturating_add(padding),
        rows.saturating_mul(cell_height).saturating_add(padding),
    );
    let limit = u64::from(SIDE_LIMIT);
    if sheet_width > limit || sheet_height > limit {
        return Err(Error::Usage(format!(
            "a sheet of {sheet_width} x {sheet_height} pixels; expected at most {limit} per side: use fewer or smaller \
             pictures"
        )));
    }
    let mut page = Page {
        plane: Grid::filled(
            sheet_width as u32,
            sheet_height as u32,
            P::grey(style.paper),
        ),
    };
    for (i, tile) in (0_u64..).zip(tiles) {
        let x = (padding + i % columns * cell_width) as u32;
        let y = (padding + i / columns * cell_height) as u32;
        page.picture(x, y, tile.picture);
        let (baseline, end) = (y + height as u32 + 2 * style.dot, x + width as u32);
        page.text(x, baseline, end, tile.label, style);
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
    fn text(&mut self, x: u32, y: u32, end: u32, text: &str, style: Style) {
        let mut left = x;
        for character in text.chars() {
            if left + font::WIDTH * style.dot > end {
                return;
            }
            for row in 0..font::HEIGHT * style.dot {
                for column in 0..font::WIDTH * style.dot {
                    if font::ink(character, column / style.dot, row / style.dot) {
                        self.set(left + column, y + row, P::grey(style.ink));
                    }
                }
            }
            left += (font::WIDTH + 1) * style.dot;
        }
    }
}
