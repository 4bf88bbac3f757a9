//! The interval of planes that a face in space may be projected on, along the plane's normal.
//!
//! Exact where the cell is a half-space or a plane: there the extent of a point grows with its height above the
//! boundary and with nothing else (Eisemann & Décoret 2007, section 5), so that the limit is linear and the corners of
//! the face decide, with the points where it crosses the boundary. For other cells there is no closed form yet, and the
//! bound here is conservative: a point that moves by no more than `distance sin(theta)` is never seen to move by more
//! than theta, whatever the direction.

use glam::{DVec2, DVec3};

use super::{
    planar::{Aperture, Interval, tangents},
    view_cell::{Shape, ViewCell},
};
use crate::num::{Each, math};

/// Offsets of valid planes, and what they are worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceInterval {
    /// Offsets `rho` of the planes `x . d = rho` that the face may be projected on.
    pub offsets: Interval,
    /// True where every other offset is too far for some viewer; false where the bound is conservative: all of these
    /// offsets are valid, others may be.
    pub exact: bool,
}

/// The planes across the unit vector `direction` that a face with these corners may be projected on, seen from `cell`
/// within `aperture`. Nothing is left where part of the face lies in the cell, unless that part lies in the plane.
pub fn face_interval(
    cell: &ViewCell,
    corners: &[DVec3; 3],
    direction: DVec3,
    aperture: Aperture,
) -> FaceInterval {
    let (Shape::HalfSpace { point, normal } | Shape::Plane { point, normal }) = *cell.shape()
    else {
        let distance = cell.distance_to_triangle(*corners);
        let offsets = conservative_interval(distance, corners, direction, aperture);
        let exact = false;
        return FaceInterval { offsets, exact };
    };
    // What is below a plane sees it as what is above its other side does.
    let two_sided = matches!(cell.shape(), Shape::Plane { .. });
    let rates = [normal, -normal].each(|up| rates(up, direction, aperture));
    let limit = |p: DVec3, height: f64| {
        let [down, up] = rates[usize::from(two_sided && height < 0.0)];
        let way = if two_sided {
            height.abs()
        } else {
            height.max(0.0)
        };
        let rho = p.dot(direction);
        Interval::new(rho - down * way, rho + up * way)
    };
    let offsets = on_either_side(point, normal, corners, limit);
    let exact = true;
    FaceInterval { offsets, exact }
}

/// The offsets that move no point of a face by more than `distance sin(aperture)`, where no viewer is closer to the
/// face than `distance`: all valid, not all that are.
pub fn conservative_interval(
    distance: f64,
    corners: &[DVec3; 3],
    direction: DVec3,
    aperture: Aperture,
) -> Interval {
    let reach = distance * aperture.sin();
    corners.iter().fold(Interval::ALL, |all, p| {
        all.and(Interval::around(p.dot(direction), reach))
    })
}

/// The extents of a point at height 1 above a plane of viewers: against the direction and along it.
fn rates(normal: DVec3, direction: DVec3, aperture: Aperture) -> [f64; 2] {
    let up = direction.dot(normal);
    let flat = math::length(direction - normal * up);
    [-1.0, 1.0].each(|sign| {
        let turned = DVec2::new(flat, sign * up);
        let limits = tangents(turned, aperture).into_iter().flatten();
        limits.fold(f64::INFINITY, |least, t| least.min(t.length))
    })
}

/// The points of a face at which a limit that is linear on each side of a plane can be least: corners and crossings.
fn on_either_side(
    point: DVec3,
    normal: DVec3,
    corners: &[DVec3; 3],
    limit: impl Fn(DVec3, f64) -> Interval,
) -> Interval {
    let heights = corners.each(|p| (p - point).dot(normal));
    let mut all = Interval::ALL;
    for i in 0..3 {
        let j = (i + 1) % 3;
        all = all.and(limit(corners[i], heights[i]));
        if (heights[i] < 0.0) != (heights[j] < 0.0) {
            let t = heights[i] / (heights[i] - heights[j]);
            all = all.and(limit(corners[i] + (corners[j] - corners[i]) * t, 0.0));
        }
    }
    all
}
