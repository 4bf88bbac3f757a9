//! The distance from which on a level may be shown: measured by rendering the original and the level from there.
//!
//! From every distance of a ladder, the far end first, both are drawn in the 24 views of the small rhombicuboctahedron
//! (Lindstrom & Turk 2000, section 3.2), with the pixels of the screen. A level passes where in every view its silhouette
//! is displaced by no more than the accepted pixels ([`OutlineDifference`]: the Hausdorff distance of the covered areas,
//! on 2 x 2 samples per pixel) and the root mean square of the differences of luma, over a square picture as high as the
//! screen as in `lodmark compare`, is no more than the accepted levels. The farthest rung where it fails and the next one
//! are bisected: whatever passes nearer than a failure does not count. No rung is nearer than where the sphere fills the
//! height of the screen.
//!
//! [`OutlineDifference`]: crate::metric::outline::OutlineDifference

use super::{
    Screen,
    sighting::{Sighting, sightings},
};
use crate::{
    Progress, Result,
    num::math::sqrt,
    raster::Scene,
    view::{Sphere, ViewSet, sets::rhombicuboctahedron},
};

/// Halvings of the last step of the ladder: the distance is then known to 2 %.
const BISECTIONS: u32 = 3;

/// The worst that is seen of a level from a distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Seen {
    /// From the middle of the sphere.
    pub(super) distance: f64,
    /// Displacement of the silhouette in pixels.
    pub(super) silhouette_px: f64,
    /// RMS of luma over a square picture as high as the screen, in levels.
    pub(super) luma_rms: f64,
}

/// An original that is ready to be looked at from any distance, in one frame with its levels.
#[derive(Debug)]
pub(super) struct Lookout<'a> {
    pub(super) original: &'a Scene,
    pub(super) sphere: Sphere,
    pub(super) screen: Screen,
}

impl Lookout<'_> {
    /// The switch distance of every level with what is seen from there; `None` for one that fails even where the sphere is
    /// no larger than a pixel.
    ///
    /// Cost: pictures as large as the sphere is seen, from the far end of the ladder to where the level fails.
    ///
    /// # Errors
    /// As [`sightings`]; [`Error::Usage`](crate::Error::Usage) where a view cannot be placed.
    pub(super) fn switch_distances(
        &self,
        levels: &[&Scene],
        progress: &dyn Progress,
    ) -> Result<Vec<Option<Seen>>> {
        let ladder = self.screen.ladder(self.sphere.radius);
        let mut passed: Vec<Option<Seen>> = vec![None; levels.len()];
        let mut failed: Vec<Option<f64>> = vec![None; levels.len()];
        let rungs = ladder.len() as u64;
        for (done, &distance) in (0..).zip(ladder.iter().rev()) {
            progress.step("switch distance", done, rungs)?;
            let open: Vec<usize> = (0..levels.len()).filter(|&i| failed[i].is_none()).collect();
            if open.is_empty() {
                break;
            }
            let scenes: Vec<&Scene> = open.iter().map(|&i| levels[i]).collect();
            for (i, seen) in open
                .into_iter()
                .zip(self.look(&scenes, distance, progress)?)
            {
                if self.accepts(&seen) {
                    passed[i] = Some(seen);
                } else {
                    failed[i] = Some(distance);
                }
            }
        }
        for (i, level) in levels.iter().enumerate() {
            for _ in 0..BISECTIONS {
                let (Some(far), Some(near)) = (passed[i], failed[i]) else {
                    break;
                };
                let middle = sqrt(near * far.distance);
                for seen in self.look(&[level], middle, progress)? {
                    match self.accepts(&seen) {
                        true => passed[i] = Some(seen),
                        false => failed[i] = Some(middle),
                    }
                }
            }
        }
        progress.step("switch distance", rungs, rungs)?;
        Ok(passed)
    }

    /// Renders levels from a distance and measures the worst of each.
    pub(super) fn look(
        &self,
        levels: &[&Scene],
        distance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<Seen>> {
        let window = self.screen.window(self.sphere.radius, distance);
        let directions = rhombicuboctahedron();
        let views = ViewSet::from_distance(&self.sphere, &directions, distance, window)?;
        let found = sightings(self.original, levels, &views, progress)?;
        let worst = |views_of: Vec<Sighting>| {
            let none = Seen {
                distance,
                ..Seen::default()
            };
            views_of.iter().fold(none, |worst, sighting| {
                let samples = f64::from(views.samples);
                let shift = sighting.outline.displacement() / samples;
                let mut luma = sighting.luma;
                luma.pixels = u64::from(self.screen.height) * u64::from(self.screen.height);
                Seen {
                    distance,
                    silhouette_px: worst.silhouette_px.max(shift),
                    luma_rms: worst.luma_rms.max(luma.rms()),
                }
            })
        };
        Ok(found.into_iter().map(worst).collect())
    }

    fn accepts(&self, seen: &Seen) -> bool {
        seen.silhouette_px <= self.screen.error_px && seen.luma_rms <= self.screen.error_rms
    }
}
