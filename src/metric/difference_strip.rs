//! Pictures of a difference: expected, actual and what is between them, side by side.

use super::difference::{Levels, signed_picture};
use crate::{
    Result,
    encode::sheet::{Ink, PADDING, sheet},
    num::Grid,
};

/// Expected, actual and their signed difference (see [`signed_picture`]) side by side, labelled.
///
/// # Errors
/// [`Error::Usage`](crate::Error::Usage) where the sizes differ, `scale` is 0, or the strip would exceed 16,384 pixels.
pub fn difference_strip<P: Ink + Levels>(
    expected: &Grid<P>,
    actual: &Grid<P>,
    scale: u8,
) -> Result<Grid<P>> {
    let difference = signed_picture(expected, actual, scale)?;
    let label = format!("difference x{scale}");
    let tiles = [
        (expected, "expected"),
        (actual, "actual"),
        (&difference, &label),
    ];
    sheet(&tiles, 3, PADDING)
}
