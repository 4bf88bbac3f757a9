//! The difference between the original and its levels as it is seen: luma and outlines, view by view.

use crate::{
    Progress, Result,
    metric::{
        appearance::at_a_time,
        luma::{SquaredError, squared_error},
        outline::OutlineDifference,
    },
    parallel,
    raster::{Grid, Scene, luma, sum_samples},
    view::{Interpolation, View, ViewSet},
};

/// The difference of a level from the original in one view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sighting {
    pub(super) luma: SquaredError,
    pub(super) outline: OutlineDifference,
}

/// Draws the original and its levels in every view, lit where all of them store normals and flat elsewhere; for each
/// level what differs in each view.
///
/// The same bits for every number of threads.
///
/// # Errors
/// As [`squared_error`]; [`Error::Interrupted`](crate::Error::Interrupted).
pub(super) fn sightings(
    original: &Scene,
    levels: &[&Scene],
    views: &ViewSet,
    progress: &dyn Progress,
) -> Result<Vec<Vec<Sighting>>> {
    let all = || std::iter::once(original).chain(levels.iter().copied());
    let lit = all().all(|scene| !scene.stored_normals().is_empty());
    let look = |view: &View| -> Result<Vec<Sighting>> {
        let mut view = *view;
        view.shading.interpolation = match lit {
            true => Interpolation::Lit,
            false => Interpolation::Flat,
        };
        let expected = Sight::of(original, &view, views);
        let sighting = |level: &&Scene| expected.sighting(&Sight::of(level, &view, views), views);
        levels.iter().map(sighting).collect()
    };
    let largest = all().map(Scene::triangle_count).max().unwrap_or(0);
    let mut found: Vec<Vec<Sighting>> = levels.iter().map(|_| Vec::new()).collect();
    for part in views.views.chunks(at_a_time(largest, views)) {
        if progress.interrupted() {
            return Err(crate::Error::Interrupted);
        }
        for view in parallel::map_slice(part, look) {
            for (of_level, sighting) in found.iter_mut().zip(view?) {
                of_level.push(sighting);
            }
        }
    }
    Ok(found)
}

/// One picture: the luma of its pixels, and which of its samples are covered.
struct Sight {
    sums: Grid<u16>,
    mask: Grid<bool>,
}

impl Sight {
    fn of(scene: &Scene, view: &View, views: &ViewSet) -> Self {
        let picture = luma(scene, view, views);
        Self {
            sums: sum_samples(&picture.tones, views.samples),
            mask: picture.keys.map(|key| !key.is_background()),
        }
    }

    fn sighting(&self, level: &Self, views: &ViewSet) -> Result<Sighting> {
        let samples = views.samples * views.samples;
        Ok(Sighting {
            luma: squared_error(&self.sums, &level.sums, samples)?,
            outline: OutlineDifference::between(&self.mask, &level.mask)?,
        })
    }
}
