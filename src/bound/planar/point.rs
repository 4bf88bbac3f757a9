//! The extent of a point: the distance it may move in a direction before a viewer in the cell sees that under more than
//! an angle.
//!
//! Eisemann & Décoret 2007, section 4. Equation 6 is replaced by the law of sines, which needs no square root and no
//! choice of sign (with the printed radicand it is wrong). Equations 7 and 8 hold as printed; equation 9 lacks a factor
//! 2 and its curves are parabolas with their focus at the point. Directions are unit vectors.

use glam::DVec2;

use super::{Aperture, ViewerSegment};
use crate::num::Each;

/// The distance that a point may move along a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The greatest distance at which no viewer sees the change under more than the aperture; infinite where no
    /// distance is too far.
    pub length: f64,
    /// The viewpoint that sets this limit (the paper's max viewpoint); `None` where there is none.
    pub viewpoint: Option<DVec2>,
}

/// Equation 6: how far a point may move along `direction` when seen from a viewpoint that it is `sight` away from
/// (point minus viewpoint, any length).
#[inline(always)]
pub(super) fn reach(sight: DVec2, direction: DVec2, sin: f64, cos: f64) -> f64 {
    let across = (sight.x * direction.y - sight.y * direction.x).abs();
    let along = sight.x * direction.x + sight.y * direction.y;
    let squared = sight.x * sight.x + sight.y * sight.y;
    reach_of(squared, across, along, sin, cos)
}

/// [`reach`] of a sight by its squared length and its parts across (not negative) and along the direction.
#[inline(always)]
pub(super) fn reach_of(squared: f64, across: f64, along: f64, sin: f64, cos: f64) -> f64 {
    let closing = across * cos - along * sin;
    let length = squared * sin / closing;
    // What does not close in from the side moves straight away from the viewer, for ever, or straight at the viewer.
    let straight = if along > 0.0 { f64::INFINITY } else { -along };
    if closing > 0.0 { length } else { straight }
}

/// Distance that `point` may move along the unit vector `direction` for one viewpoint; infinite where no distance is
/// too far, 0 for a point at the viewpoint.
pub fn viewpoint_extent(
    viewpoint: DVec2,
    point: DVec2,
    direction: DVec2,
    aperture: Aperture,
) -> f64 {
    reach(point - viewpoint, direction, aperture.sin(), aperture.cos())
}

/// Where a circle of equal angle touches the line of the cell, for a point at height 1 above it. Both figures grow
/// with the height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent {
    /// Abscissa of the viewpoint minus that of the point (equation 7).
    pub offset: f64,
    /// Distance that this circle allows the point to move (equation 8): never less than [`viewpoint_extent`] there.
    pub length: f64,
}

/// The two circles of the paper's bicircle for a unit direction over a cell on the x-axis, the one of the sign + of
/// equation 7 first; `None` where it touches the line nowhere. The smaller of the lengths is the extent of a point
/// at height 1 for the whole line.
#[inline]
pub fn tangents(direction: DVec2, aperture: Aperture) -> [Option<Tangent>; 2] {
    [1.0, -1.0].each(|sign| {
        let (offset, gap) = tangent(direction, sign, aperture.sin(), aperture.cos());
        (gap > 0.0 && offset.is_finite()).then(|| Tangent {
            offset,
            length: 2.0 * aperture.sin() / gap,
        })
    })
}

/// Equation 7: the abscissa where the circle touches, for height 1, and the denominator of equations 7 and 8.
#[inline(always)]
fn tangent(direction: DVec2, sign: f64, sin: f64, cos: f64) -> (f64, f64) {
    let slope = sin * direction.x + sign * cos * direction.y;
    let gap = sign * cos * direction.x - sin * direction.y + 1.0;
    // tan(x/2) in the one of its two forms that does not cancel.
    let near = gap >= 1.0;
    let numerator = if near { slope } else { 2.0 - gap };
    let denominator = if near { gap } else { slope };
    (numerator / denominator, gap)
}

/// The extent of a point of the cell's frame and the abscissa of its viewpoint, NaN where there is none. `point` may
/// lie on either side of the axis.
#[inline(always)]
pub(super) fn extent_in_frame(
    ends: [f64; 2],
    point: DVec2,
    direction: DVec2,
    sin: f64,
    cos: f64,
) -> (f64, f64) {
    let height = point.y.abs();
    let up = direction.y;
    let direction = DVec2::new(direction.x, if point.y < 0.0 { -up } else { up });
    let mut best = (f64::INFINITY, f64::NAN);
    // Without a branch, so that many points go at a time.
    let either = |better: bool, one: f64, other: f64| if better { one } else { other };
    for x in ends {
        // An end at infinity gives NaN, which is not smaller.
        let length = reach(DVec2::new(point.x - x, height), direction, sin, cos);
        let better = length < best.0;
        best = (either(better, length, best.0), either(better, x, best.1));
    }
    for sign in [1.0, -1.0] {
        let (offset, _) = tangent(direction, sign, sin, cos);
        let shift = offset * height;
        let x = point.x + shift;
        let length = reach(DVec2::new(-shift, height), direction, sin, cos);
        // The comparisons with the ends refuse a tangent at infinity.
        let better = (x >= ends[0]) & (x <= ends[1]) & (length < best.0);
        best = (either(better, length, best.0), either(better, x, best.1));
    }
    best
}

/// Distance that `point` may move along the unit vector `direction` so that no viewer in `cell` sees it move by more
/// than the aperture, with the viewpoint that sets the limit. 0 for a point in the cell.
pub fn segment_extent(
    cell: &ViewerSegment,
    point: DVec2,
    direction: DVec2,
    aperture: Aperture,
) -> Extent {
    let (point, direction) = (cell.enter(point), cell.turn(direction));
    let (sin, cos) = (aperture.sin(), aperture.cos());
    let (length, x) = extent_in_frame(cell.ends(), point, direction, sin, cos);
    Extent {
        length,
        viewpoint: x.is_finite().then(|| cell.viewpoint(x)),
    }
}
