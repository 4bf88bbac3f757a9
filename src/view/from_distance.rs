//! Views of a sphere from a distance, as one sees it on a screen: a square window around the middle of a larger picture.
//!
//! A window has the pixels that the whole picture would have there, and costs no more than what it shows.

use glam::DVec3;

use super::{
    BACKGROUND, View, ViewSet,
    framing::rolled_up,
    sphere::{Sphere, usable_radius},
};
use crate::{
    Error, Result,
    num::{fixed::SubpixelBits, math},
};

/// A square window around the middle of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Width and height in pixels.
    pub side: u32,
    /// Width of a pixel at distance 1 from the eye.
    pub pixel: f64,
    /// Samples per pixel along each axis: 1, 2 or 4.
    pub samples: u32,
}

impl ViewSet {
    /// Views of the middle of `sphere` from `distance` in `directions` (towards the viewer, of any length), rolled as
    /// [`View::around`] says. What is nearer than the sphere by half a radius and by half the way to it is cut off.
    ///
    /// # Errors
    /// [`Error::Usage`] where the eye is not outside of the sphere, there is no direction or one has no length, the size
    /// is refused by [`ViewSet::check_size`], or numbers do not stay finite.
    pub fn from_distance(
        sphere: &Sphere,
        directions: &[DVec3],
        distance: f64,
        window: Window,
    ) -> Result<Self> {
        let count = directions.len();
        let place = |(i, &d)| view(sphere, d, [i, count], distance, window);
        let views: Option<Vec<View>> = directions.iter().enumerate().map(place).collect();
        let views = views.filter(|views| !views.is_empty()).ok_or_else(|| {
            Error::Usage(format!(
                "no views from the distance {distance:e} of a sphere of radius {:e}; expected a distance above the radius, \
                 and at least one direction, none of them zero",
                sphere.radius
            ))
        })?;
        let set = Self {
            width: window.side,
            height: window.side,
            samples: window.samples,
            subpixel: SubpixelBits::Eight,
            background: BACKGROUND,
            views,
        };
        set.check_size()?;
        Ok(set)
    }
}

fn view(
    sphere: &Sphere,
    direction: DVec3,
    [index, count]: [usize; 2],
    distance: f64,
    window: Window,
) -> Option<View> {
    let back = math::unit(direction)?;
    let up = rolled_up(back, index, count)?;
    let radius = usable_radius(sphere);
    let eye = sphere.center + back * distance;
    let near = (distance - 1.5 * radius).max(0.5 * (distance - radius));
    let half = 0.5 * f64::from(window.side) * window.pixel;
    View::perspective_along(
        eye,
        back,
        up,
        [near, distance + 2.0 * radius],
        [1.0 / half; 2],
    )
}
