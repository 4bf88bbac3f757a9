//! Levels beside the original: the errors of their pictures, and how far they are from it.

use serde::Serialize;

use super::{
    Levels, ScreenShares,
    sighting::{Sighting, sightings},
    switch_distance::Seen,
};
use crate::{
    Error, Progress, Result,
    mesh::Mesh,
    metric::report::{CandidateReport, CompareOptions, compare},
    num::Frame,
    raster::Scene,
    view::{Projection, Sphere, ViewSet, sets::rhombicuboctahedron},
};

/// The errors of a level, and the distance from which on nobody should see them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LevelReport {
    /// RMS of luma over 24 views with one intensity per triangle, in levels, as `compare` has it.
    pub rms_flat: f64,
    /// The same with intensities interpolated between vertices.
    pub rms_gouraud: f64,
    /// The same with the normals that the meshes store; `None` where one of them stores none.
    pub rms_lit: Option<f64>,
    /// Area that the level or the original covers and the other one does not, over the same views, as a share of what the
    /// original covers.
    pub silhouette_error: f64,
    /// Mean distance of the surfaces in file units, the larger of both ways.
    pub distance_mean: f64,
    /// Largest measured distance of the surfaces in file units, the larger of both ways.
    pub distance_max: f64,
    /// The same, under the name that 3D Tiles have for it.
    pub geometric_error: f64,
    /// The least distance of the viewer from the middle of the sphere, in file units, from which on the accepted errors
    /// are kept; 0 for level 0, `None` where even a sphere of one pixel is too near.
    pub switch_distance: Option<f64>,
    /// The displacement of the silhouette in pixels, seen from there.
    pub silhouette_px: Option<f64>,
    /// The RMS of luma over a square picture as high as the screen in levels, seen from there.
    pub luma_rms: Option<f64>,
    /// The size of the sphere on the screen, seen from there; `None` for level 0, which may have any.
    #[serde(flatten)]
    pub shares: Option<ScreenShares>,
    /// The distance from which on the silhouette is proved to be displaced by no more than the accepted pixels; only where
    /// that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certified_distance: Option<f64>,
}

/// The views of the silhouette error around a sphere, in its units: those of `compare`.
pub(super) fn evaluation_views(sphere: &Sphere, size: u32) -> Result<ViewSet> {
    let directions = rhombicuboctahedron();
    ViewSet::around(sphere, &directions, size, size, Projection::Perspective)?.with_samples(2)
}

/// The area that only one of two scenes covers, as a share of what the original covers.
pub(super) fn silhouette_error(
    original: &Scene,
    level: &Scene,
    views: &ViewSet,
    progress: &dyn Progress,
) -> Result<f64> {
    let found = sightings(original, &[level], views, progress)?;
    let sum = |part: fn(&Sighting) -> u64| found.iter().flatten().map(part).sum::<u64>();
    let covered = sum(|s| s.outline.covered);
    let differing = sum(|s| s.outline.differing);
    Ok(match differing {
        0 => 0.0,
        _ => differing as f64 / covered.max(1) as f64,
    })
}

/// Judges levels as `compare` does; the errors of each, without what is seen from afar.
pub(super) fn judged(
    original: &Mesh,
    meshes: &[&Mesh],
    silhouette_errors: &[f64],
    levels: &Levels,
    progress: &dyn Progress,
) -> Result<Vec<LevelReport>> {
    let options = CompareOptions {
        size: levels.size,
        distance_samples: Some(levels.distance_samples),
        silhouettes: false,
        folds: false,
        ..CompareOptions::default()
    };
    let comparison = compare(original, meshes, &options, progress)?;
    let reports = comparison.candidates.iter().zip(silhouette_errors);
    reports.map(|(report, &error)| of(report, error)).collect()
}

fn of(report: &CandidateReport, silhouette_error: f64) -> Result<LevelReport> {
    let (pictures, distances) = (report.errors.pictures, report.errors.distances);
    let missing = || Error::Internal("a level was not judged".into());
    let pictures = pictures.ok_or_else(missing)?;
    let distance_max = distances.distance_max.ok_or_else(missing)?;
    Ok(LevelReport {
        rms_flat: pictures.rms_flat,
        rms_gouraud: pictures.rms_gouraud,
        rms_lit: pictures.rms_lit,
        silhouette_error,
        distance_mean: distances.distance_mean.ok_or_else(missing)?,
        distance_max,
        geometric_error: distance_max,
        switch_distance: None,
        silhouette_px: None,
        luma_rms: None,
        shares: None,
        certified_distance: None,
    })
}

impl LevelReport {
    /// The report of the input itself.
    pub(super) fn of_input(stores_normals: bool) -> Self {
        Self {
            rms_flat: 0.0,
            rms_gouraud: 0.0,
            rms_lit: stores_normals.then_some(0.0),
            silhouette_error: 0.0,
            distance_mean: 0.0,
            distance_max: 0.0,
            geometric_error: 0.0,
            switch_distance: Some(0.0),
            silhouette_px: Some(0.0),
            luma_rms: Some(0.0),
            shares: None,
            certified_distance: None,
        }
    }

    /// Adds what is seen from afar, which was measured in units of `frame`.
    pub(super) fn see(&mut self, seen: Seen, shares: ScreenShares, frame: Frame) {
        self.switch_distance = Some(frame.leave_length(seen.distance, 1));
        self.silhouette_px = Some(seen.silhouette_px);
        self.luma_rms = Some(seen.luma_rms);
        self.shares = Some(shares);
    }
}
