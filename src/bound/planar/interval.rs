//! Intervals of lines with one normal, by their offsets, and discs that such lines may reach.

use glam::DVec2;

use super::point::reach_of;

/// Offsets `rho` of the valid lines `x . n = rho` with the normal n; none where `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The smallest valid offset; minus infinity where there is none.
    pub min: f64,
    /// The largest valid offset; infinity where there is none.
    pub max: f64,
}

impl Interval {
    /// Every offset.
    pub const ALL: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY);

    /// No offset.
    pub const NONE: Self = Self::new(f64::INFINITY, f64::NEG_INFINITY);

    /// The offsets from `min` to `max`.
    #[inline(always)]
    pub const fn new(min: f64, max: f64) -> Self {
        Self { min, max }
    }

    /// One offset.
    pub fn at(rho: f64) -> Self {
        Self::new(rho, rho)
    }

    /// The offsets at most `reach` away from `rho`.
    pub fn around(rho: f64, reach: f64) -> Self {
        Self::new(rho - reach, rho + reach)
    }

    /// The offsets that are in both.
    #[inline]
    pub fn and(self, other: Self) -> Self {
        Self::new(self.min.max(other.min), self.max.min(other.max))
    }

    /// True where no offset is in it.
    pub fn is_empty(self) -> bool {
        self.min > self.max
    }

    /// True where `rho` is in it.
    pub fn contains(self, rho: f64) -> bool {
        self.min <= rho && rho <= self.max
    }
}

/// A disc in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its centre.
    pub centre: DVec2,
    /// Its radius.
    pub radius: f64,
}

/// An interval in the making.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds(pub(super) Interval);

impl Bounds {
    /// Narrows the interval to the lines that a point of the face at offset `rho`, `sight` away from a viewpoint, may
    /// reach.
    #[inline(always)]
    pub(super) fn narrow(&mut self, sight: DVec2, rho: f64, sin: f64, cos: f64) {
        let squared = sight.x * sight.x + sight.y * sight.y;
        let across = sight.x.abs();
        let up = rho + reach_of(squared, across, sight.y, sin, cos);
        let down = rho - reach_of(squared, across, -sight.y, sin, cos);
        self.0.max = self.0.max.min(up);
        self.0.min = self.0.min.max(down);
    }

    /// Narrows the interval to the line through a point of the face that lies at a viewpoint.
    pub(super) fn pin(&mut self, rho: f64) {
        self.0 = self.0.and(Interval::at(rho));
    }
}
