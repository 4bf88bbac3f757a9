//! [`Paint`]: the light of a triangle in one view, before it is known which pixels it covers.

use super::Setup;
use crate::num::fixed::{level, luma};

/// The light a triangle sends to the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// White with one intensity: a level for every pixel.
    Flat(u8),
    /// White with an intensity in [0, 1] at every corner, interpolated perspective-correctly.
    Smooth([[f64; 1]; 3]),
    /// Red, green and blue in [0, 1] at every corner, interpolated perspective-correctly.
    Colored([[f64; 3]; 3]),
}

impl Paint {
    /// A triangle with one intensity, white or with colours at its corners.
    #[inline]
    pub fn flat(intensity: f64, colors: Option<&[[f64; 3]; 3]>) -> Self {
        match colors {
            None => Self::Flat(level(intensity)),
            Some(c) => Self::Colored(c.map(|rgb| rgb.map(|x| x * intensity))),
        }
    }

    /// A triangle with an intensity at every corner, white or with colours there.
    #[inline]
    pub fn gouraud(intensities: [f64; 3], colors: Option<&[[f64; 3]; 3]>) -> Self {
        match colors {
            None => Self::Smooth(intensities.map(|i| [i])),
            Some(c) => Self::Colored(std::array::from_fn(|k| c[k].map(|x| x * intensities[k]))),
        }
    }

    /// The luma at a pixel.
    #[inline]
    pub fn luma(&self, setup: &Setup, x: i32, y: i32) -> u8 {
        match self {
            Self::Flat(v) => *v,
            Self::Smooth(corners) => level(setup.interpolate(corners, x, y)[0]),
            Self::Colored(_) => luma(self.rgb(setup, x, y)),
        }
    }

    /// Red, green and blue at a pixel.
    #[inline]
    pub fn rgb(&self, setup: &Setup, x: i32, y: i32) -> [u8; 3] {
        match self {
            Self::Colored(corners) => setup.interpolate(corners, x, y).map(level),
            _ => [self.luma(setup, x, y); 3],
        }
    }
}
