//! The levels of a run and what they look like beside the original.

use std::fmt::Write;

use serde::Serialize;

use crate::{
    Error, Progress, Result,
    mesh::{Mesh, content_sha256},
    metric::{
        appearance::{flat, image_error_views},
        luma::SquaredError,
        surface::surface_distance,
    },
    num::Frame,
    raster::Scene,
    simplify::{Outcome, Replay},
    view::{Sphere, ViewSet, frame_of},
};

/// A level of a method, judged.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Level {
    pub(super) method: &'static str,
    /// Of the triangles of the original.
    pub(super) percent: f64,
    /// Triangles to reach.
    pub(super) target: usize,
    pub(super) triangles: usize,
    /// Whether they are no more than the target.
    pub(super) reached: bool,
    /// Zhang & Turk 2002, equation 5.11, in levels.
    pub(super) image_error: f64,
    /// The same, per pixel.
    pub(super) rms: f64,
    pub(super) squared_error: SquaredError,
    /// As shares of the diagonal of the original's bounding box.
    pub(super) distance_mean: Option<f64>,
    pub(super) distance_max: Option<f64>,
    /// How much less image error than the first method, in %; `None` for that method itself, and where one of the two
    /// did not reach the level: they are then of different sizes.
    pub(super) less: Option<f64>,
    content_sha256: String,
}

/// Judges levels, the pictures of all of them at once: the original is drawn only once.
pub(super) struct Judge<'a> {
    original: &'a Mesh,
    frame: Frame,
    scene: Scene,
    views: ViewSet,
    samples: Option<u32>,
    found: Vec<(Mesh, Level)>,
}

impl<'a> Judge<'a> {
    /// Against `original`, in images of `size` x `size` pixels of `per_pixel` x `per_pixel` samples, and at `samples`
    /// points on each surface.
    pub(super) fn new(
        original: &'a Mesh,
        size: u32,
        per_pixel: u32,
        samples: Option<u32>,
    ) -> Result<Self> {
        let frame = frame_of(original);
        let framed = original.enter_frame(frame);
        let sphere = Sphere::of_mesh(&framed)
            .ok_or_else(|| Error::Internal("a mesh with triangles has a sphere".into()))?;
        Ok(Self {
            original,
            frame,
            scene: Scene::of(&framed),
            views: image_error_views(&sphere, size, per_pixel)?,
            samples,
            found: Vec::new(),
        })
    }

    /// Takes the levels of a run from its history; `each` sees every one.
    pub(super) fn levels(
        &mut self,
        method: &'static str,
        outcome: &Outcome,
        percents: &[f64],
        targets: &[usize],
        mut each: impl FnMut(f64, &Mesh) -> Result<()>,
    ) -> Result<()> {
        let mut replay = Replay::new(self.original, &outcome.history)?;
        for (&percent, &target) in percents.iter().zip(targets) {
            replay.seek(target)?;
            let mesh = match replay.applied() {
                0 => self.original.clone(),
                _ => replay.live().to_mesh()?,
            };
            each(percent, &mesh)?;
            let triangles = mesh.triangles().len();
            let level = Level {
                method,
                percent,
                target,
                triangles,
                reached: triangles <= target,
                image_error: 0.0,
                rms: 0.0,
                squared_error: SquaredError {
                    sum: 0,
                    pixels: 0,
                    samples: 1,
                },
                distance_mean: None,
                distance_max: None,
                less: None,
                content_sha256: content_sha256(&mesh),
            };
            self.found.push((mesh, level));
        }
        Ok(())
    }

    /// Measures all levels.
    pub(super) fn finish(self, progress: &dyn Progress) -> Result<Vec<Level>> {
        let scenes: Vec<Scene> = self
            .found
            .iter()
            .map(|(mesh, _)| Scene::of(&mesh.enter_frame(self.frame)))
            .collect();
        let errors = flat(&self.scene, &scenes, &self.views, progress)?;
        drop(scenes);
        let mut levels: Vec<Level> = Vec::with_capacity(self.found.len());
        for ((mesh, mut level), errors) in self.found.into_iter().zip(errors) {
            let total = errors.total();
            (level.image_error, level.rms, level.squared_error) =
                (total.root(), total.rms(), total);
            if let Some(samples) = self.samples {
                let distance = surface_distance(self.original, &mesh, samples, progress)?;
                level.distance_mean = distance.relative().map(|d| d.mean);
                level.distance_max = distance.relative().map(|d| d.max);
            }
            let first = levels.first().map(|l| l.method);
            if first.is_some_and(|first| first != level.method) {
                let same = levels.iter().find(|l| l.target == level.target);
                let both = same.filter(|l| l.reached && level.reached);
                level.less = both.map(|l| less(l.image_error, level.image_error));
            }
            levels.push(level);
        }
        Ok(levels)
    }
}

/// How much less `error` is than `reference`, in %; 0 where both are 0.
fn less(reference: f64, error: f64) -> f64 {
    if error > 0.0 || reference > 0.0 {
        100.0 * (1.0 - error / reference)
    } else {
        0.0
    }
}

/// The mean of [`Level::less`] over the levels of every method that has it.
pub(super) fn means(levels: &[Level]) -> Vec<(&'static str, f64)> {
    let mut sums: Vec<(&'static str, f64, f64)> = Vec::new();
    for level in levels {
        if let Some(less) = level.less {
            match sums.iter_mut().find(|(name, ..)| *name == level.method) {
                Some((_, sum, count)) => (*sum, *count) = (*sum + less, *count + 1.0),
                None => sums.push((level.method, less, 1.0)),
            }
        }
    }
    sums.into_iter()
        .map(|(name, sum, count)| (name, sum / count))
        .collect()
}

/// A line for each level below a line of names; empty where nothing was measured.
pub(super) fn csv(levels: &[Level]) -> String {
    let mut text = String::from(
        "method,percent,target,triangles,reached,image_error,rms,distance_mean,distance_max,less_image_error_percent\n",
    );
    let number = |x: Option<f64>| x.map_or_else(String::new, |x| x.to_string());
    for l in levels {
        // Writing into a string cannot fail.
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{},{},{},{}",
            l.method,
            l.percent,
            l.target,
            l.triangles,
            l.reached,
            l.image_error,
            l.rms,
            number(l.distance_mean),
            number(l.distance_max),
            number(l.less)
        );
    }
    text
}
