//! The working frame: coordinates scaled by a power of two so that a mesh has a size near 1.
//!
//! Thresholds then mean one thing, and coordinates around 1e30 or 1e-30 neither overflow nor vanish when they are
//! squared. Scaling by a power of two is exact, so it is undone exactly on output.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{Each, math::scale_by_power_of_two};

/// Floating-point type of the coordinates of a file; results are rounded to it *before* they are judged,
/// so that the images which drove a choice are those of the file that is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// 32-bit floats: the usual case.
    #[default]
    F32,
    /// 64-bit floats: the input carries doubles.
    F64,
}

impl Precision {
    /// `x` rounded to this precision (ties to even), still as `f64`; infinite where `f32` overflows.
    #[inline]
    #[must_use]
    pub fn round(self, x: f64) -> f64 {
        match self {
            Self::F32 => f64::from(x as f32),
            Self::F64 => x,
        }
    }

    /// [`Precision::round`] of every coordinate.
    #[inline]
    #[must_use]
    pub fn round_vector(self, p: DVec3) -> DVec3 {
        DVec3::new(self.round(p.x), self.round(p.y), self.round(p.z))
    }
}

/// A scaling by `2^exponent` from frame units to the units of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Frame {
    /// File units = frame units * 2^exponent.
    pub exponent: i32,
}

impl Frame {
    /// The frame in which a length of `size` file units lies in [0.5, 1); the identity for 0 and non-finite sizes.
    pub fn for_size(size: f64) -> Self {
        let usual = size > 0.0 && size.is_finite();
        let exponent = if usual { libm::frexp(size).1 } else { 0 };
        Self { exponent }
    }

    /// From file units to frame units; exact.
    pub fn enter(self, p: DVec3) -> DVec3 {
        self.scaled(p, -self.exponent)
    }

    /// From frame units to file units; exact.
    pub fn leave(self, p: DVec3) -> DVec3 {
        self.scaled(p, self.exponent)
    }

    /// A length (or any scalar of dimension length^`power`) from frame units to file units; exact.
    pub fn leave_length(self, x: f64, power: i32) -> f64 {
        scale_by_power_of_two(x, self.exponent * power)
    }

    /// A length from file units to frame units; exact.
    pub fn enter_length(self, x: f64) -> f64 {
        scale_by_power_of_two(x, -self.exponent)
    }

    /// The frame position nearest to `p` that `precision` can store in file units; `None` where it is not finite.
    pub fn round(self, p: DVec3, precision: Precision) -> Option<DVec3> {
        let file = precision.round_vector(self.leave(p));
        file.is_finite().then(|| self.enter(file))
    }

    fn scaled(self, p: DVec3, exponent: i32) -> DVec3 {
        if exponent == 0 {
            return p;
        }
        let scaled = p.to_array().each(|x| scale_by_power_of_two(x, exponent));
        DVec3::from_array(scaled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_brings_any_size_into_half_to_one_and_back_exactly() {
        for size in [1e-300, 1e-30, 0.5, 0.75, 1.0, 3.0, 1e30, 1e300] {
            let frame = Frame::for_size(size);
            let inside = frame.enter_length(size);
            assert!((0.5..1.0).contains(&inside), "{size} became {inside}");
            assert_eq!(frame.leave_length(inside, 1).to_bits(), f64::to_bits(size));
        }
    }

    #[test]
    fn rounding_in_the_frame_is_rounding_in_file_units() {
        let frame = Frame::for_size(1e-42);
        // Subnormal in f32.
        let p = frame.round(frame.enter(DVec3::splat(1.235e-42)), Precision::F32);
        let expected = DVec3::splat(f64::from(1.235e-42_f32));
        assert_eq!(p.map(|p| frame.leave(p)), Some(expected));
        // Beyond the largest f32.
        let huge = Frame::for_size(1e38);
        assert_eq!(huge.round(DVec3::splat(8.0), Precision::F32), None);
    }
}
