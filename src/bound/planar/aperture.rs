//! The angular error that a viewer accepts: half the opening of the cone around the ray to a point.

use crate::{Error, Result, num::math};

/// An angle in [0, pi/2) with its sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aperture {
    angle: f64,
    sin: f64,
    cos: f64,
}

impl Aperture {
    /// The aperture of `angle` radians.
    ///
    /// # Errors
    /// [`Error::Usage`] unless `angle` lies in [0, pi/2): from a right angle on, a cone is no longer convex.
    pub fn radians(angle: f64) -> Result<Self> {
        if !(0.0..std::f64::consts::FRAC_PI_2).contains(&angle) {
            return Err(Error::Usage(format!(
                "an angle of {} degrees cannot bound an error: give at least 0 and less than 90 degrees",
                angle * (180.0 / std::f64::consts::PI)
            )));
        }
        Ok(Self {
            angle,
            sin: math::sin(angle),
            cos: math::cos(angle),
        })
    }

    /// The aperture of `angle` degrees.
    ///
    /// # Errors
    /// [`Error::Usage`] unless `angle` lies in [0, 90).
    pub fn degrees(angle: f64) -> Result<Self> {
        if !(0.0..90.0).contains(&angle) {
            return Err(Error::Usage(format!(
                "an angle of {angle} degrees cannot bound an error: give at least 0 and less than 90 degrees"
            )));
        }
        Self::radians(angle * (std::f64::consts::PI / 180.0))
    }

    /// The angle in radians.
    pub fn angle(self) -> f64 {
        self.angle
    }

    /// Its sine, in [0, 1).
    pub fn sin(self) -> f64 {
        self.sin
    }

    /// Its cosine, in (0, 1].
    pub fn cos(self) -> f64 {
        self.cos
    }
}
