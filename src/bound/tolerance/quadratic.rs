//! A convex quadratic function of a position.

use glam::DVec3;

use crate::{
    geometry::{Sym3, axis_across},
    num::{Each, math},
};

/// `v . H v / 2 + c . v` with a symmetric, positive semidefinite `H`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quadratic {
    /// `H`.
    pub matrix: Sym3,
    /// `c`.
    pub linear: DVec3,
}

impl Quadratic {
    /// Its value.
    pub fn at(&self, v: DVec3) -> f64 {
        0.5 * v.dot(self.matrix.times(v)) + self.linear.dot(v)
    }

    /// The point at which it is least; `None` where `H` is singular but for rounding.
    pub fn minimum(&self) -> Option<DVec3> {
        let [a, b, c] = [DVec3::X, DVec3::Y, DVec3::Z].each(|axis| self.matrix.times(axis));
        let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
        let determinant = a.dot(bc);
        let trace = self.matrix.trace();
        if determinant <= 1e-12 * (trace * trace * trace) {
            return None;
        }
        let r = -self.linear;
        let v = DVec3::new(bc.dot(r), ca.dot(r), ab.dot(r)) / determinant;
        v.is_finite().then_some(v)
    }

    /// The point of the plane through `point` across `normal` at which it is least; `None` where that is not one.
    pub fn minimum_on_plane(&self, point: DVec3, normal: DVec3) -> Option<DVec3> {
        let x = math::unit(normal.cross(axis_across(normal)))?;
        let y = normal.cross(x);
        let (hx, hy) = (self.matrix.times(x), self.matrix.times(y));
        let (xx, xy, yy) = (x.dot(hx), x.dot(hy), y.dot(hy));
        let slope = self.matrix.times(point) + self.linear;
        let (sx, sy) = (slope.dot(x), slope.dot(y));
        let determinant = xx * yy - xy * xy;
        if determinant <= 1e-12 * ((xx + yy) * (xx + yy)) {
            return None;
        }
        let s = (xy * sy - yy * sx) / determinant;
        let t = (xy * sx - xx * sy) / determinant;
        let v = point + x * s + y * t;
        v.is_finite().then_some(v)
    }

    /// The point between two at which it is least.
    pub fn minimum_between(&self, from: DVec3, to: DVec3) -> DVec3 {
        let d = to - from;
        let curve = d.dot(self.matrix.times(d));
        let slope = (self.matrix.times(from) + self.linear).dot(d);
        // A flat function is least at an end.
        if slope >= 0.0 {
            from
        } else if curve <= -slope {
            to
        } else {
            from + d * (-slope / curve)
        }
    }
}
