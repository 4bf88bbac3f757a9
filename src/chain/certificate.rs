//! The distance from which on a level may be shown, proved.
//!
//! Every point of each surface has a point of the other one no farther than a distance that holds for all of them
//! (`lodmark bound`, both ways). A viewer who sees no such pair under more than an angle sees the covered areas displaced by
//! no more than that. The angle is the one that the accepted pixels take at the border of the screen, where a pixel takes the
//! least; viewers for whom both surfaces do not fit into the height of the screen are not asked about. Nothing is proved
//! about luma.

use super::Screen;
use crate::{
    Error, Progress, Result,
    bound::{
        nearest_triangle::{NearestTriangle, originals},
        planar::Aperture,
        surface::{Effort, Measure, measure},
        switch_distance::{aperture_of_pixels, switch_distance},
    },
    mesh::FramedMesh,
    num::math::cos,
};

/// Parts of triangles that are looked at most for each way, or four times the triangles: degenerate surfaces would be
/// divided for long, and the bound holds wherever that ends.
const PIECES: u64 = 2_000_000;

/// The angle that the accepted pixels take at least.
///
/// # Errors
/// [`Error::Usage`] where that is 90 degrees or more.
pub(super) fn aperture(screen: &Screen) -> Result<Aperture> {
    let view = screen.fov_deg.to_radians();
    let slant = cos(0.5 * view);
    aperture_of_pixels(screen.error_px * (slant * slant), screen.height, view)
}

/// The proved distance from the middle of a sphere of this radius around the original, in units of the frame; infinite
/// where no displacement is accepted and there is one.
///
/// # Errors
/// As [`aperture`]; [`Error::Interrupted`].
pub(super) fn certified_distance(
    [original, level]: [&FramedMesh; 2],
    radius: f64,
    screen: &Screen,
    progress: &dyn Progress,
) -> Result<f64> {
    let mut largest = 0.0_f64;
    for (from, to) in [(original, level), (level, original)] {
        let nearest = NearestTriangle::new(to.in_frame_units())
            .ok_or_else(|| Error::Internal("a mesh with triangles has something near".into()))?;
        let faces = originals(from.in_frame_units());
        let effort = Effort {
            pieces: PIECES.max(4 * faces.len() as u64),
            ..Effort::default()
        };
        let bound = measure(faces, &nearest, Measure::Distance, effort, progress)?;
        largest = largest.max(bound.bound);
    }
    let aperture = aperture(screen)?;
    let least = screen.nearest(radius + largest);
    Ok(least.max(radius + switch_distance(largest, aperture)))
}
