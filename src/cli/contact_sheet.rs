//! Pictures of a command side by side, each above its label.

use crate::{
    Result,
    encode::sheet::{Ink, Style, Tile, sheet},
    raster::Grid,
};

/// Puts labelled pictures on one sheet, row by row, `columns` in a row.
pub(super) fn contact_sheet<P: Ink>(
    pictures: &[(Grid<P>, String)],
    columns: u32,
) -> Result<Grid<P>> {
    let tiles: Vec<Tile<'_, P>> = pictures
        .iter()
        .map(|(picture, label)| Tile { picture, label })
        .collect();
    sheet(&tiles, columns, Style::default())
}
