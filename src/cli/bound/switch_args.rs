//! The distance from which on a replacement may be shown.

use crate::{
    Result,
    bound::{
        planar::Aperture,
        switch_distance::{aperture_of_pixels, switch_distance},
    },
};

/// The tolerance of a viewer who is shown LOW instead of REF.
#[derive(Clone, Debug, clap::Args, serde::Serialize)]
pub(super) struct SwitchArgs {
    /// Say from which distance on LOW is seen less than this off REF, in degrees
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    #[arg(conflicts_with = "switch_px")]
    switch_deg: Option<f64>,
    /// Say from which distance on LOW is seen less than this many pixels off REF, in the middle of the screen
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true)]
    switch_px: Option<f64>,
    /// Height of that screen in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = 1080, requires = "switch_px", value_parser = clap::value_parser!(u32).range(1..))]
    screen_height: u32,
    /// Angle from its lower to its upper side, in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 60.0)]
    #[arg(requires = "switch_px", allow_negative_numbers = true)]
    fov: f64,
}

impl SwitchArgs {
    /// The angle that is asked about.
    pub(super) fn aperture(&self) -> Result<Option<Aperture>> {
        match (self.switch_deg, self.switch_px) {
            (Some(degrees), _) => Aperture::degrees(degrees).map(Some),
            (None, Some(pixels)) => {
                let view = self.fov.to_radians();
                aperture_of_pixels(pixels, self.screen_height, view).map(Some)
            }
            (None, None) => Ok(None),
        }
    }
}

/// A distance in file units; infinite (in the report: null) for an angle of 0.
#[derive(Debug, serde::Serialize)]
pub(super) struct Found {
    /// No point of REF is farther from its replacement.
    distance_bound: f64,
    switch_angle_deg: f64,
    /// From every point of REF.
    switch_distance: f64,
}

impl Found {
    pub(super) fn new(distance_bound: f64, aperture: Aperture) -> Self {
        Self {
            distance_bound,
            switch_angle_deg: aperture.angle().to_degrees(),
            switch_distance: switch_distance(distance_bound, aperture),
        }
    }

    pub(super) fn tell(&self) {
        answer!("distance          at most {}", self.distance_bound);
        if self.switch_distance.is_infinite() {
            return answer!(
                "switch            at no distance: without an angle every displacement is seen"
            );
        }
        let (distance, degrees) = (self.switch_distance, self.switch_angle_deg);
        answer!("switch            from a distance of {distance} on: at most {degrees:.6} degrees");
    }
}
