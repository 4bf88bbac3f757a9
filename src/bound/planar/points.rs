//! Extents of many points at once: columns in, columns out, so that the compiler can work on several at a time.
//!
//! Each extent has the bits of [`segment_extent`](super::segment_extent) for the same point and direction.

use glam::DVec2;

use super::{Aperture, ViewerSegment, point::extent_in_frame};
use crate::{Error, Result};

/// Points and the unit directions they may move in, one column each, all of one length.
#[derive(Clone, Copy, Debug)]
pub struct Rays<'a> {
    /// First coordinates of the points.
    pub x: &'a [f64],
    /// Second coordinates of the points.
    pub y: &'a [f64],
    /// First components of the directions.
    pub dx: &'a [f64],
    /// Second components of the directions.
    pub dy: &'a [f64],
}

/// Writes how far every point may move into `lengths` and where its max viewpoint is into `viewpoints`: the abscissa
/// in the cell's frame ([`ViewerSegment::viewpoint`]), NaN where no distance is too far.
///
/// # Errors
/// [`Error::Usage`] if the columns are not all of one length.
pub fn segment_extents(
    cell: &ViewerSegment,
    rays: Rays<'_>,
    aperture: Aperture,
    lengths: &mut [f64],
    viewpoints: &mut [f64],
) -> Result<()> {
    let count = rays.x.len();
    let columns = [rays.y, rays.dx, rays.dy, lengths, viewpoints].map(|column| column.len());
    if columns.iter().any(|&n| n != count) {
        return Err(Error::Usage(format!(
            "columns of {count} points must all have {count} entries, not {columns:?}"
        )));
    }
    let (sin, cos, ends, cell) = (aperture.sin(), aperture.cos(), cell.ends(), *cell);
    let points = rays.x.iter().zip(rays.y);
    let directions = rays.dx.iter().zip(rays.dy);
    let out = lengths.iter_mut().zip(viewpoints);
    for (((&x, &y), (&dx, &dy)), (length, viewpoint)) in points.zip(directions).zip(out) {
        let (point, direction) = (DVec2::new(x, y), DVec2::new(dx, dy));
        let (point, direction) = (cell.enter(point), cell.turn(direction));
        (*length, *viewpoint) = extent_in_frame(ends, point, direction, sin, cos);
    }
    Ok(())
}
