//! The levels of a run and what they look like beside the original.

use std::fmt::Write;

use serde::Serialize;

use crate::{
    Error, Progress, Result,
    mesh::{Mesh, content_sha256},
    metric::{luma::SquaredError, report::Judge},
    simplify::{Outcome, Replay, normals::settle_level},
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
    /// True where they are no more than the target.
    pub(super) reached: bool,
    /// Zhang & Turk 2002, equation 5.11, in levels.
    pub(super) image_error: f64,
    /// The same, per pixel.
    pub(super) rms: f64,
    pub(super) squared_error: SquaredError,
    /// As shares of the diagonal of the original's bounding box.
    pub(super) distance_mean: Option<f64>,
    pub(super) distance_max: Option<f64>,
    /// Image error below that of the first method, in %; `None` for that method itself, and where one of the two
    /// did not reach the level: they are then of different sizes.
    pub(super) less: Option<f64>,
    content_sha256: String,
}

/// A level of a run before it is judged.
pub(super) struct Reached {
    pub(super) method: &'static str,
    pub(super) percent: f64,
    pub(super) target: usize,
    pub(super) mesh: Mesh,
}

/// Takes the levels of a run from its history.
pub(super) fn levels_of(
    original: &Mesh,
    outcome: &Outcome,
    (percents, targets): (&[f64], &[usize]),
    progress: &dyn Progress,
) -> Result<Vec<Reached>> {
    let mut replay = Replay::new(original, &outcome.history)?;
    let mut levels = Vec::with_capacity(targets.len());
    for (&percent, &target) in percents.iter().zip(targets) {
        replay.seek(target)?;
        let mesh = match replay.applied() {
            0 => original.clone(),
            _ => {
                let level = replay.live().to_mesh()?;
                settle_level(original, level, &outcome.history, progress)?
            }
        };
        levels.push(Reached {
            method: outcome.options.method.name(),
            percent,
            target,
            mesh,
        });
    }
    Ok(levels)
}

/// Judges the levels of all methods at once, so that the original is drawn only once.
pub(super) fn judged(
    judge: &Judge<'_>,
    found: &[Reached],
    progress: &dyn Progress,
) -> Result<Vec<Level>> {
    let meshes: Vec<&Mesh> = found.iter().map(|level| &level.mesh).collect();
    let comparison = judge.compare(&meshes, progress)?;
    let mut levels: Vec<Level> = Vec::with_capacity(found.len());
    for (level, report) in found.iter().zip(comparison.candidates) {
        let errors = report.errors;
        let image = errors
            .image_error
            .ok_or_else(|| Error::Internal("a level without its image error".into()))?;
        let triangles = level.mesh.triangles().len();
        let reached = triangles <= level.target;
        let distance = errors.distances.distance_relative;
        // The first method is what the others are measured by.
        let first = levels.first().filter(|first| first.method != level.method);
        let same = first.and_then(|_| levels.iter().find(|l| l.target == level.target));
        let less = same
            .filter(|l| l.reached && reached)
            .map(|l| less(l.image_error, image.error));
        levels.push(Level {
            method: level.method,
            percent: level.percent,
            target: level.target,
            triangles,
            reached,
            image_error: image.error,
            rms: image.rms,
            squared_error: image.squared_error,
            distance_mean: distance.map(|d| d.mean),
            distance_max: distance.map(|d| d.max),
            less,
            content_sha256: content_sha256(&level.mesh),
        });
    }
    Ok(levels)
}

/// The share of `reference` that `error` is less, in %; 0 where both are 0.
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
    let mean = |(name, sum, count)| (name, sum / count);
    sums.into_iter().map(mean).collect()
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
