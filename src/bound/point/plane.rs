//! The max viewpoints on a plane in space: equation 7, and their like for a given pair of points.
//!
//! The set of viewpoints that see a pair under at least an angle is symmetric about the line through the pair, so it
//! touches a plane on the projection of that line, and the problem is one of two dimensions. Where the line stands
//! across the plane the max viewpoints form a circle, of which one point is given: if the circle meets the border of a
//! polygon the border's own search finds it. Deviation: equation 8 is not used; extents are those of the viewpoint.

use glam::{DVec2, DVec3};

use super::Aperture;
use crate::{
    bound::planar::tangents,
    num::{
        Each,
        math::{length, sqrt, unit},
    },
};

/// Seen from a point on one side of a plane: its foot, its height above the plane, the direction of a projected vector.
struct Section {
    foot: DVec3,
    height: f64,
    /// Unit vector in the plane along the projection of the axis, any one where that is a point.
    along: DVec3,
    /// Parts of the axis along `along` (not negative) and up, away from the plane on the side of the point.
    axis: [f64; 2],
}

impl Section {
    fn new(origin: DVec3, normal: DVec3, point: DVec3, axis: DVec3) -> Self {
        let signed = (point - origin).dot(normal);
        let up = if signed < 0.0 { -normal } else { normal };
        let rise = axis.dot(up);
        // Twice: what the first pass leaves of an axis across the plane is rounding in any direction.
        let flat = axis - up * rise;
        let flat = flat - up * flat.dot(up);
        // Without a projection of its own any direction is as good.
        let along = if length(flat) > 1e-12 * length(axis) {
            unit(flat)
        } else {
            None
        };
        let along = along.unwrap_or_else(|| up.any_orthonormal_vector());
        Self {
            foot: point - normal * signed,
            height: signed.abs(),
            along,
            axis: [length(flat), rise],
        }
    }
}

/// The viewpoints of a plane (a point, a unit normal) that may limit the extent of `point` along the unit vector
/// `direction` most.
pub(super) fn max_viewpoints(
    [origin, normal]: [DVec3; 2],
    point: DVec3,
    direction: DVec3,
    aperture: Aperture,
) -> [Option<DVec3>; 2] {
    let section = Section::new(origin, normal, point, direction);
    let [along, up] = section.axis;
    tangents(DVec2::new(along, up), aperture).each(|tangent| {
        let x = section.height * tangent?.offset;
        (section.height > 0.0).then(|| section.foot + section.along * x)
    })
}

/// The viewpoints of a plane (a point, a unit normal) that may see two points farthest apart; none where the points are
/// not strictly on one side of it: then the border of a polygon decides, or the segment between them meets it.
pub(super) fn worst_viewpoints(
    [origin, normal]: [DVec3; 2],
    point: DVec3,
    moved: DVec3,
) -> [Option<DVec3>; 2] {
    let section = Section::new(origin, normal, point, moved - point);
    let [p, rise] = section.axis;
    let (low, high) = (section.height, section.height + rise);
    let same_side = low > 0.0 && high > 0.0;
    // Tangents from where the line meets the plane have the length of the geometric mean of both distances: the feet
    // of the circles through both points that touch the plane, written so that nothing cancels.
    let mean = sqrt(p * p + rise * rise) * sqrt(low * high);
    let near = low * (p * p + rise * high) / (p * low + mean);
    let far = -(p * low + mean) / rise;
    [near, far]
        .each(|x: f64| (same_side && x.is_finite()).then(|| section.foot + section.along * x))
}
