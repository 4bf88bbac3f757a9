//! The angle Theta that a bound is given for: half the opening of the cone of valid positions, in [0, 90) degrees.

use crate::{
    Error, Result,
    num::math::{cos, sin},
};

/// An angle in [0, pi/2) with its sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aperture {
    radians: f64,
    sine: f64,
    cosine: f64,
}

impl Aperture {
    /// An angle in radians.
    ///
    /// # Errors
    /// [`Error::Usage`] outside [0, pi/2).
    pub fn new(radians: f64) -> Result<Self> {
        if !(0.0..std::f64::consts::FRAC_PI_2).contains(&radians) {
            return Err(Error::Usage(format!(
                "the angle is {} degrees; expected at least 0 and less than 90",
                radians.to_degrees()
            )));
        }
        Ok(Self {
            radians,
            sine: sin(radians),
            cosine: cos(radians),
        })
    }

    /// An angle in degrees.
    ///
    /// # Errors
    /// [`Error::Usage`] outside [0, 90).
    pub fn from_degrees(degrees: f64) -> Result<Self> {
        Self::new(degrees.to_radians())
    }

    /// The angle in radians.
    #[must_use]
    pub fn radians(self) -> f64 {
        self.radians
    }

    /// Its sine, in [0, 1].
    #[must_use]
    pub fn sine(self) -> f64 {
        self.sine
    }

    /// Its cosine, in (0, 1].
    #[must_use]
    pub fn cosine(self) -> f64 {
        self.cosine
    }
}
