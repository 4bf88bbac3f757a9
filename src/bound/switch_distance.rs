//! The distance at which one level of detail may take the place of another (Eisemann & Décoret 2007, end of section 4).
//!
//! All viewpoints that see a displacement under at least an angle lie between two arcs over it, whose farthest points
//! stand half its length over the tangent of half the angle away from its middle. A viewer outside the ball of that
//! radius sees less, wherever he stands: the distance holds for every direction of view.

use super::planar::Aperture;
use crate::{
    Error, Result,
    num::math::{atan2, tan},
};

/// From which distance on a point and its replacement `displacement` away are seen less than the aperture apart: the
/// distance of the viewer from the middle between both, in the units of the displacement. Infinite for Theta = 0.
pub fn safe_view_distance(displacement: f64, aperture: Aperture) -> f64 {
    if displacement <= 0.0 {
        return 0.0;
    }
    0.5 * displacement / tan(0.5 * aperture.angle())
}

/// From which distance on no point of a replacement is seen off its place by more than the aperture, for a viewer at
/// that distance or farther from *every* point of the original: `displacement` is the largest distance between a point
/// of the original and its replacement. The middle between both may be nearer than the original by half of that.
pub fn switch_distance(displacement: f64, aperture: Aperture) -> f64 {
    if displacement <= 0.0 {
        return 0.0;
    }
    safe_view_distance(displacement, aperture) + 0.5 * displacement
}

/// The angle that so many pixels take in the middle of a picture. Towards its border, an angle `a` off the view axis,
/// the same angle covers `1 / cos^2 a` times as many: ask for fewer pixels where that matters.
///
/// `height` is in pixels, `field_of_view` the full angle from the lower to the upper side in radians.
///
/// # Errors
/// [`Error::Usage`] where a number has no sense: pixels that are negative or not finite, no height, a field of view
/// outside (0, pi), or pixels that take 90 degrees or more.
pub fn aperture_of_pixels(pixels: f64, height: u32, field_of_view: f64) -> Result<Aperture> {
    let sensible = pixels >= 0.0
        && pixels.is_finite()
        && height > 0
        && field_of_view > 0.0
        && field_of_view < std::f64::consts::PI;
    if !sensible {
        return Err(Error::Usage(format!(
            "{pixels} pixels of {height} in a field of view of {} degrees; expected at least 0 pixels, a height of at \
             least 1, and more than 0 and less than 180 degrees",
            field_of_view * (180.0 / std::f64::consts::PI)
        )));
    }
    let half = pixels * tan(0.5 * field_of_view) / f64::from(height);
    Aperture::radians(2.0 * atan2(half, 1.0))
}
