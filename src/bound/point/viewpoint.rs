//! One viewpoint: the angle under which a pair of points is seen, and the extent of the validity region (equation 6).
//!
//! Deviation: equation 6 of the paper as printed lacks the length of `VM` under its root. Here the law of sines is
//! used, which needs no root and no choice of a sign: `t = |VM| sin T / sin(phi - T)`, phi the angle between `VM` and
//! the direction, unbounded for phi <= T.

use std::f64::consts::PI;

use glam::DVec3;

use super::Aperture;
use crate::num::math::{atan2, length};

/// The angle between two points as seen from `viewpoint`, in [0, pi] radians; pi where the viewpoint is one of two
/// different points, because next to it there is a viewpoint that sees them that far apart; 0 for equal points.
pub fn angle_from(viewpoint: DVec3, point: DVec3, moved: DVec3) -> f64 {
    let (a, b, shift) = (point - viewpoint, moved - viewpoint, moved - point);
    if shift == DVec3::ZERO {
        return 0.0;
    }
    if a == DVec3::ZERO || b == DVec3::ZERO {
        return PI;
    }
    // |a x b| = |a x shift|: the second is exact to rounding where the points are close to each other.
    atan2(length(a.cross(shift)), a.dot(b))
}

/// Distance that `point` may move along the unit vector `direction` before `viewpoint` sees it move by more than the
/// aperture; infinite where it never does, 0 where the viewpoint is the point.
pub fn extent_from(viewpoint: DVec3, point: DVec3, direction: DVec3, aperture: Aperture) -> f64 {
    let a = point - viewpoint;
    let (along, across) = (a.dot(direction), length(a.cross(direction)));
    let squared = a.dot(a);
    if squared <= 0.0 {
        return 0.0;
    }
    if aperture.sin() <= 0.0 {
        // Only moves along the ray are not seen at all, and those end at the viewer.
        return match across > 0.0 {
            true => 0.0,
            false if along < 0.0 => length(a),
            false => f64::INFINITY,
        };
    }
    let denominator = across * aperture.cos() - along * aperture.sin();
    if denominator > 0.0 {
        squared * aperture.sin() / denominator
    } else {
        f64::INFINITY
    }
}
