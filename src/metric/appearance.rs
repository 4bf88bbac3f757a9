//! The likeness of a candidate and a reference: squared luma error over a set of views, flat, Gouraud, and lit
//! where both store normals.
//!
//! Lindstrom & Turk 2000, sections 3.2 and 5: results are judged in views that did not drive the simplification (24 of
//! 512 x 512 pixels, [`ViewSet::evaluation`]), and the views together are one mosaic (equation 2). Deviation: pixels
//! are 2 x 2 samples, summed and not averaged, so that an error is an exact integer and edges weigh as much as they
//! cover. Culling, light, sides and specular term are those of each view; only the interpolation is replaced.
//! Units: scenes and views in one frame, that of the reference (see [`ViewSet::enter_frame`]).
//! Pictures are drawn view by view and dropped once compared: memory is a few pictures, not views times pictures.

use serde::Serialize;

use super::luma::{SquaredError, ViewErrors, squared_error};
use crate::{
    Error, Progress, Result, parallel,
    raster::{Grid, Scene, luma_sums, mean_luma},
    view::{Interpolation, Projection, Sphere, View, ViewSet, sets::dodecahedron},
};

/// Bytes of pictures in the making at a time; one view at least.
const MEMORY: u64 = 1 << 30;
/// Bytes of a sample while a picture is drawn: its key and its level.
const SAMPLE_BYTES: u64 = 9;
/// Triangles beyond which the rasterizer draws a picture in parts: for the estimate of memory only.
const PART: usize = 32_768;

/// The difference between a reference and a candidate in every view.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Appearance {
    /// With one intensity per triangle.
    pub flat: ViewErrors,
    /// With intensities interpolated between vertices.
    pub gouraud: ViewErrors,
    /// With the normals that the meshes store; `None` where one of them stores none.
    pub lit: Option<ViewErrors>,
}

/// The picture that differs most.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct WorstView {
    /// Number of the view, from 0.
    pub view: usize,
    /// Its shading there.
    pub shading: Interpolation,
    /// Its difference from the reference.
    pub error: SquaredError,
}

impl Appearance {
    /// The view and shading with the largest mean squared difference; flat before Gouraud before lit, then the first of
    /// equals.
    pub fn worst(&self) -> WorstView {
        let of = |errors: &ViewErrors, shading| {
            let (view, error) = errors.worst();
            WorstView {
                view,
                shading,
                error,
            }
        };
        let flat = of(&self.flat, Interpolation::Flat);
        let gouraud = of(&self.gouraud, Interpolation::Gouraud);
        let lit = self.lit.as_ref().map(|lit| of(lit, Interpolation::Lit));
        let mut worst = flat;
        for other in std::iter::once(gouraud).chain(lit) {
            if other.error.mean_square() > worst.error.mean_square() {
                worst = other;
            }
        }
        worst
    }
}

/// Draws the reference and all candidates in every view, flat, Gouraud, and lit where both store normals, and compares:
/// one [`Appearance`] for each candidate, in order.
///
/// The same bits for every number of threads. Cost: two or three pictures of each scene per view.
///
/// # Errors
/// [`Error::Unsupported`] where a vertex of a scene has no finite place in the frame; [`Error::Usage`] for a set
/// without views; [`Error::Interrupted`].
pub fn appearance(
    reference: &Scene,
    candidates: &[Scene],
    views: &ViewSet,
    progress: &dyn Progress,
) -> Result<Vec<Appearance>> {
    let stores = |scene: &Scene| !scene.stored_normals().is_empty();
    let mut shadings = vec![Interpolation::Flat, Interpolation::Gouraud];
    if stores(reference) && candidates.iter().any(stores) {
        shadings.push(Interpolation::Lit);
    }
    let found = errors(reference, candidates, views, &shadings, progress)?;
    let look = |errors: Vec<ViewErrors>| {
        let mut errors = errors.into_iter();
        match (errors.next(), errors.next(), errors.next()) {
            (Some(flat), Some(gouraud), lit) => Ok(Appearance { flat, gouraud, lit }),
            _ => Err(Error::Internal("two shadings, two errors".into())),
        }
    };
    found.into_iter().map(look).collect()
}

/// As [`appearance`], flat only. In the 20 views of [`image_error_views`] the total is the error of Zhang & Turk 2002,
/// equation 5.11: [`SquaredError::root`].
///
/// # Errors
/// As [`appearance`].
pub fn flat(
    reference: &Scene,
    candidates: &[Scene],
    views: &ViewSet,
    progress: &dyn Progress,
) -> Result<Vec<ViewErrors>> {
    let shading = [Interpolation::Flat];
    let found = errors(reference, candidates, views, &shading, progress)?;
    Ok(found.into_iter().flatten().collect())
}

/// The views of equation 5.11: from the 20 corners of a dodecahedron, in images of `size` x `size` pixels with
/// `samples` x `samples` samples each (the paper does not say how many).
///
/// # Errors
/// As [`ViewSet::around`] and [`ViewSet::with_samples`].
pub fn image_error_views(sphere: &Sphere, size: u32, samples: u32) -> Result<ViewSet> {
    ViewSet::around(sphere, &dodecahedron(), size, size, Projection::Perspective)?
        .with_samples(samples)
}

/// Draws and compares; for each candidate the errors in every shading, in order. Candidates without stored normals are
/// left out of the lit one, which is the last.
fn errors(
    reference: &Scene,
    candidates: &[Scene],
    views: &ViewSet,
    shadings: &[Interpolation],
    progress: &dyn Progress,
) -> Result<Vec<Vec<ViewErrors>>> {
    for scene in std::iter::once(reference).chain(candidates) {
        require_finite(scene)?;
    }
    let compare = |view: &View| -> Result<Vec<Vec<SquaredError>>> {
        let drawn = |&interpolation: &Interpolation| {
            let view = with(view, interpolation);
            (view, luma_sums(reference, &view, views))
        };
        let expected: Vec<(View, Grid<u16>)> = shadings.iter().map(drawn).collect();
        let samples = views.samples * views.samples;
        let errors = |scene: &Scene| -> Result<Vec<SquaredError>> {
            let pairs = expected.iter().filter(|(view, _)| shows(scene, view));
            let error = |(view, expected): &(View, Grid<u16>)| {
                let actual = luma_sums(scene, view, views);
                squared_error(expected, &actual, samples)
            };
            pairs.map(error).collect()
        };
        candidates.iter().map(errors).collect()
    };
    let scenes = std::iter::once(reference).chain(candidates);
    let largest = scenes.map(Scene::triangle_count).max().unwrap_or(0);
    let (count, group) = (views.views.len(), at_a_time(largest, views));
    let mut found = Vec::with_capacity(count);
    for (i, part) in views.views.chunks(group).enumerate() {
        progress.step("compare pictures", (i * group) as u64, count as u64)?;
        let errors = parallel::map_slice(part, compare);
        for view in errors {
            found.push(view?);
        }
    }
    progress.step("compare pictures", count as u64, count as u64)?;
    let errors = |candidate: usize| {
        let count = found.first().map_or(shadings.len(), |v| v[candidate].len());
        let of = |shading: usize| {
            ViewErrors::new(found.iter().map(|view| view[candidate][shading]).collect())
        };
        (0..count).map(of).collect()
    };
    (0..candidates.len()).map(errors).collect()
}

/// False where a view shows stored normals and the scene has none.
fn shows(scene: &Scene, view: &View) -> bool {
    view.shading.interpolation != Interpolation::Lit || !scene.stored_normals().is_empty()
}

/// The pictures that [`appearance`] compared in one view, each pixel rounded to the mean of its samples: for eyes.
///
/// # Errors
/// [`Error::Usage`] where the set has no such view.
pub fn pictures<const N: usize>(
    scenes: [&Scene; N],
    views: &ViewSet,
    view: usize,
    shading: Interpolation,
) -> Result<[Grid<u8>; N]> {
    let count = views.views.len();
    let Some(view) = views.views.get(view) else {
        let told = format!("there is no view {view}; expected a number below {count}");
        return Err(Error::Usage(told));
    };
    let view = with(view, shading);
    Ok(scenes.map(|scene| mean_luma(&luma_sums(scene, &view, views), views.samples)))
}

fn with(view: &View, interpolation: Interpolation) -> View {
    let mut view = *view;
    view.shading.interpolation = interpolation;
    view
}

/// Views that may be drawn at the same time, of scenes with at most `largest` triangles. It decides memory and speed,
/// never a result.
pub fn at_a_time(largest: usize, views: &ViewSet) -> usize {
    let threads = parallel::threads();
    let parts = threads.min(largest / PART + 1) as u64;
    let samples = u64::from(views.width * views.samples) * u64::from(views.height * views.samples);
    let fitting = MEMORY / (parts * samples * SAMPLE_BYTES).max(1);
    // Views take different time: several for each thread keep all of them busy.
    (fitting as usize).clamp(1, 4 * threads)
}

fn require_finite(scene: &Scene) -> Result<()> {
    let mut corners = scene.triangles().iter().flatten();
    match corners.find(|&&v| !scene.positions()[v as usize].is_finite()) {
        None => Ok(()),
        Some(v) => Err(Error::Unsupported(format!(
            "vertex {v} lies too far away to be seen together with the reference: check the units of both"
        ))),
    }
}
