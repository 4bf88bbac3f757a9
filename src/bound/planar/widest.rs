//! Equation 1 in the plane: the largest angle under which a viewer in a segment cell sees a point and its replacement
//! apart.
//!
//! Where the line through both does not separate viewpoints, the angle has two stationary viewpoints on the line of the
//! cell, at the geometric mean of the distances to where the two lines meet; the roots of one quadratic, taken about
//! the middle of the two points so that the discriminant is a product of positive terms.

use glam::DVec2;

use super::ViewerSegment;
use crate::num::{Each, math};

/// The worst view of a replaced point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WidestAngle {
    /// The angle in radians, in [0, pi].
    pub angle: f64,
    /// The viewpoint that sees it; `None` where no viewpoint sees any, or only one at infinity.
    pub viewpoint: Option<DVec2>,
}

/// The largest angle between `point` and `replacement` seen from `cell`. Where the segment between them touches the
/// cell it is pi: viewers beside the contact see up to that.
pub fn segment_error(cell: &ViewerSegment, point: DVec2, replacement: DVec2) -> WidestAngle {
    let (m, s) = (cell.enter(point), cell.enter(replacement));
    let at = |angle: f64, x: Option<f64>| {
        let viewpoint = x.map(|x| cell.viewpoint(x));
        WidestAngle { angle, viewpoint }
    };
    if m == s {
        return at(0.0, None);
    }
    let [first, last] = cell.ends();
    if let Some(x) = contact(m, s, first, last) {
        return at(std::f64::consts::PI, Some(x));
    }
    let mut worst = (0.0, None);
    let stationary = stationary(m, s).into_iter().flatten();
    for x in [first, last].into_iter().chain(stationary) {
        if !x.is_finite() || x < first || x > last {
            continue;
        }
        let (a, b) = (m - DVec2::new(x, 0.0), s - DVec2::new(x, 0.0));
        let angle = math::atan2(a.perp_dot(b).abs(), a.dot(b));
        if angle > worst.0 {
            worst = (angle, Some(x));
        }
    }
    at(worst.0, worst.1)
}

/// An abscissa of the cell on the segment from `m` to `s`.
fn contact(m: DVec2, s: DVec2, first: f64, last: f64) -> Option<f64> {
    if m.y == 0.0 && s.y == 0.0 {
        let x = m.x.min(s.x).max(first);
        return (x <= m.x.max(s.x).min(last)).then_some(x);
    }
    if (m.y > 0.0 && s.y > 0.0) || (m.y < 0.0 && s.y < 0.0) {
        return None;
    }
    let x = m.x + (s.x - m.x) * (m.y / (m.y - s.y));
    (first <= x && x <= last).then_some(x)
}

/// Abscissae where the angle between `m` and `s` is stationary along the axis.
fn stationary(m: DVec2, s: DVec2) -> [Option<f64>; 2] {
    // About the middle of both abscissae: B x^2 - 2 A x - B C = 0, with A^2 + B^2 C = m.y s.y |MS|^2.
    let (middle, half) = ((m.x + s.x) / 2.0, (s.x - m.x) / 2.0);
    let a = -half * (s.y + m.y);
    let b = s.y - m.y;
    let c = m.y * s.y - half * half;
    let product = m.y * s.y;
    if product < 0.0 {
        return [None, None];
    }
    let root = math::sqrt(product) * math::sqrt((s - m).dot(s - m));
    let larger = if a < 0.0 { a - root } else { a + root };
    [larger / b, -b * c / larger].each(|x| x.is_finite().then_some(middle + x))
}
