//! Viewers in the plane: on a segment, a ray, a line or one point.

use glam::DVec2;

use crate::{Error, Result};

/// A segment view cell, in a frame of its own: the cell lies on an axis through `origin`, between two abscissae that
/// may be infinite. Both sides of the axis are seen from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewerSegment {
    origin: DVec2,
    axis: DVec2,
    pub(super) first: f64,
    pub(super) last: f64,
}

impl ViewerSegment {
    /// The viewpoints from `a` to `b`; one viewpoint where they are equal.
    ///
    /// # Errors
    /// [`Error::Usage`] if a coordinate is not finite.
    pub fn between(a: DVec2, b: DVec2) -> Result<Self> {
        if !a.is_finite() || !b.is_finite() {
            return Err(Error::Usage(format!(
                "a view cell from {a} to {b} has no place: its ends must be finite"
            )));
        }
        // Scaled by its larger component first, so that no square overflows or vanishes.
        let span = b - a;
        let scale = span.x.abs().max(span.y.abs());
        if scale == 0.0 {
            return Ok(Self::on_x_axis(0.0, 0.0).moved(a));
        }
        let shrunk = span / scale;
        let length = crate::num::math::sqrt(shrunk.dot(shrunk));
        Ok(Self {
            origin: a,
            axis: shrunk / length,
            first: 0.0,
            last: length * scale,
        })
    }

    /// The viewpoints `(x, 0)` with `x` from the smaller to the larger of the two abscissae, each of which may be
    /// infinite: then the cell is a ray or the whole axis.
    pub fn on_x_axis(a: f64, b: f64) -> Self {
        Self {
            origin: DVec2::ZERO,
            axis: DVec2::X,
            first: a.min(b),
            last: a.max(b),
        }
    }

    /// The whole line through `point` along `direction`, the boundary of a half-plane.
    ///
    /// # Errors
    /// [`Error::Usage`] if a coordinate is not finite or the direction is zero.
    pub fn line(point: DVec2, direction: DVec2) -> Result<Self> {
        let along = Self::between(DVec2::ZERO, direction)?;
        if !point.is_finite() || along.last <= along.first {
            return Err(Error::Usage(format!(
                "no line goes through {point} along {direction}: give a finite point and a direction other than zero"
            )));
        }
        Ok(Self {
            origin: point,
            axis: along.axis,
            first: f64::NEG_INFINITY,
            last: f64::INFINITY,
        })
    }

    fn moved(self, by: DVec2) -> Self {
        Self {
            origin: self.origin + by,
            ..self
        }
    }

    /// `point` in the cell's frame: abscissa along the axis, ordinate to its left.
    pub fn enter(&self, point: DVec2) -> DVec2 {
        self.turn(point - self.origin)
    }

    /// `direction` in the cell's frame.
    pub fn turn(&self, direction: DVec2) -> DVec2 {
        DVec2::new(direction.dot(self.axis), self.axis.perp_dot(direction))
    }

    /// The viewpoint at abscissa `x` of the cell's frame.
    pub fn viewpoint(&self, x: f64) -> DVec2 {
        self.origin + self.axis * x
    }

    /// The origin of the cell's frame.
    pub fn origin(&self) -> DVec2 {
        self.origin
    }

    /// The abscissae of the two ends, the smaller first; infinite where the cell has no end.
    pub fn ends(&self) -> [f64; 2] {
        [self.first, self.last]
    }
}
