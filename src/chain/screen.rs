//! The screen that levels are seen on: what is accepted there, and how large things are by their distance.
//!
//! A distance is that of the viewer from the middle of the minimum bounding sphere of the original. Engines measure it in
//! shares of the screen, each in its own way and all of them by that sphere: [`ScreenShares`].

use serde::Serialize;

use crate::{
    Error, Result,
    num::math::{sin, sqrt, tan},
    view::{SIDE_LIMIT, Window},
};

/// Width of a screen by its height, where a share of its area is asked for.
pub const ASPECT: f64 = 16.0 / 9.0;

/// Largest height: a window that is somewhat larger must have an image.
const HEIGHT_LIMIT: u32 = 3_600;

/// Samples per pixel along each axis, where they fit.
const SAMPLES: u32 = 2;

/// Half of a window by the radius of the sphere in it: levels may reach beyond the sphere of the original.
const MARGIN: f64 = 1.125;

/// Ratio of two neighbouring rungs of the ladder of distances: the fourth root of 2, and its powers.
const STEPS: [f64; 4] = [
    1.0,
    1.189_207_115_002_721,
    std::f64::consts::SQRT_2,
    1.681_792_830_507_429,
];

/// The screen that levels are seen on, and the errors that are accepted on it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Screen {
    /// Height in pixels [default: 1080].
    pub height: u32,
    /// Angle from the lower to the upper side in degrees [default: 60].
    pub fov_deg: f64,
    /// Largest displacement of the silhouette in pixels [default: 1].
    pub error_px: f64,
    /// Largest root mean square of the differences of luma over a square picture as high as the screen, in levels
    /// [default: 2].
    pub error_rms: f64,
}

impl Default for Screen {
    fn default() -> Self {
        Self {
            height: 1_080,
            fov_deg: 60.0,
            error_px: 1.0,
            error_rms: 2.0,
        }
    }
}

/// The size of a sphere on the screen as engines measure it, each as a share.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ScreenShares {
    /// Its diameter by the height of the screen, as Unity has it (`screenRelativeTransitionHeight`).
    pub screen_height: f64,
    /// Its diameter by the shorter side of the screen, as Unreal has it (`ScreenSize`): equal to that, unless the screen is
    /// upright.
    pub screen_diameter: f64,
    /// The area of a disc of that diameter by the area of a screen of 16:9, as readers of `MSFT_screencoverage` take it.
    pub coverage: f64,
}

impl Screen {
    /// A screen with a height in pixels and an angle from its lower to its upper side in degrees.
    #[must_use]
    pub fn new(height: u32, fov_deg: f64) -> Self {
        Self {
            height,
            fov_deg,
            ..Self::default()
        }
    }

    /// Accepts other errors than one pixel and two levels.
    #[must_use]
    pub fn accept(mut self, error_px: f64, error_rms: f64) -> Self {
        (self.error_px, self.error_rms) = (error_px, error_rms);
        self
    }

    /// Tests every number for its range.
    ///
    /// # Errors
    /// [`Error::Usage`] that names the number, its value and the range.
    pub(super) fn check(&self) -> Result<()> {
        if !(1..=HEIGHT_LIMIT).contains(&self.height) {
            return Err(Error::Usage(format!(
                "a screen height of {} pixels; expected 1 to {HEIGHT_LIMIT}",
                self.height
            )));
        }
        for (name, value, [low, high]) in [
            ("fov", self.fov_deg, [1.0, 170.0]),
            ("error-px", self.error_px, [0.0, f64::MAX]),
            ("error-rms", self.error_rms, [0.0, 255.0]),
        ] {
            if !(low..=high).contains(&value) {
                return Err(Error::Usage(format!(
                    "{name} is {value}; expected a number from {low} to {high:e}"
                )));
            }
        }
        Ok(())
    }

    /// Half the field of view in radians.
    fn half_view(&self) -> f64 {
        0.5 * self.fov_deg.to_radians()
    }

    /// The width of a pixel at distance 1.
    fn pixel(&self) -> f64 {
        2.0 * tan(self.half_view()) / f64::from(self.height)
    }

    /// The distance at which a sphere fills the height of the screen.
    pub(super) fn nearest(&self, radius: f64) -> f64 {
        radius / sin(self.half_view())
    }

    /// The distances at which a sphere is looked at, from near to far: from where it fills the height of the screen to
    /// where it is no larger than a pixel, neighbours in the ratio of the fourth root of 2.
    pub(super) fn ladder(&self, radius: f64) -> Vec<f64> {
        let mut ladder = Vec::new();
        let mut octave = self.nearest(radius);
        while octave.is_finite() && octave > radius {
            for step in STEPS {
                let distance = octave * step;
                ladder.push(distance);
                if 2.0 * self.pixels(radius, distance) <= 1.0 {
                    return ladder;
                }
            }
            octave *= 2.0;
        }
        ladder
    }

    /// The radius of a sphere on the screen, in pixels.
    fn pixels(&self, radius: f64, distance: f64) -> f64 {
        let tangent = radius / sqrt((distance - radius) * (distance + radius));
        tangent / self.pixel()
    }

    /// The window in which a sphere is seen from a distance, with all that may reach beyond it a little.
    pub(super) fn window(&self, radius: f64, distance: f64) -> Window {
        let half = (MARGIN * self.pixels(radius, distance) + 1.0).ceil();
        // At most what SIDE_LIMIT holds, by HEIGHT_LIMIT.
        let side = ((2.0 * half) as u32).min(SIDE_LIMIT);
        Window {
            side,
            pixel: self.pixel(),
            samples: if side * SAMPLES <= SIDE_LIMIT {
                SAMPLES
            } else {
                1
            },
        }
    }

    /// The shares of the screen that a sphere has from a distance, as engines compute them.
    pub(super) fn shares(&self, radius: f64, distance: f64) -> ScreenShares {
        let share = radius / (distance * tan(self.half_view()));
        ScreenShares {
            screen_height: share,
            screen_diameter: share,
            coverage: std::f64::consts::FRAC_PI_4 * share * share / ASPECT,
        }
    }
}
