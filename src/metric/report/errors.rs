//! The findings of a comparison. They serialize as the reports of `lodmark compare` have them.

use serde::Serialize;

use crate::{
    mesh::{Edges, Mesh},
    metric::{
        appearance::{Appearance, WorstView},
        folds::Folds,
        luma::{SquaredError, ViewErrors},
        silhouette::SilhouetteHistogram,
        surface::{Distances, SurfaceDistance},
    },
    view::{Eye, ViewSet},
};

/// Candidates held against a reference.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The reference alone.
    pub reference: MeshShape,
    /// The candidates, in their order.
    pub candidates: Vec<CandidateReport>,
}

/// One candidate against the reference.
#[derive(Clone, Debug)]
pub struct CandidateReport {
    /// The candidate alone.
    pub shape: MeshShape,
    /// Its differences from the reference.
    pub errors: ErrorReport,
}

/// Size and outline of one mesh alone.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeshShape {
    /// Number of triangles.
    pub triangles: usize,
    /// Number of vertices.
    pub vertices: usize,
    /// Edges with one triangle.
    pub boundary_edges: usize,
    /// Edges that are silhouette edges in exactly 0, 1, ... of the views.
    pub silhouette_histogram: Option<SilhouetteHistogram>,
    /// Number of views in which an edge is a silhouette edge, on average.
    pub silhouette_expectation: Option<f64>,
}

/// Everything that was measured between a candidate and the reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorReport {
    /// Over all views of the pictures.
    #[serde(flatten)]
    pub pictures: Option<PictureReport>,
    /// Between the surfaces.
    #[serde(flatten)]
    pub distances: DistanceReport,
    /// Folds that the reference does not have.
    #[serde(flatten)]
    pub folds: Option<Folds>,
    /// Zhang & Turk 2002, equation 5.11.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub image_error: Option<ImageError>,
    /// View by view; empty without pictures.
    pub views: Vec<ViewReport>,
}

/// Picture errors over all views: one mosaic for each shading, and the worst single picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PictureReport {
    /// RMS with one intensity per triangle, in levels.
    pub rms_flat: f64,
    /// RMS with intensities interpolated between vertices, in levels.
    pub rms_gouraud: f64,
    /// RMS with the normals that the meshes store, in levels; `None` where one of them stores none.
    pub rms_lit: Option<f64>,
    /// Flat peak signal-to-noise ratio in decibels; `None` where no pixel differs.
    pub psnr_flat: Option<f64>,
    /// Gouraud peak signal-to-noise ratio in decibels; `None` where no pixel differs.
    pub psnr_gouraud: Option<f64>,
    /// Lit peak signal-to-noise ratio in decibels; `None` where no pixel differs or `rms_lit` is.
    pub psnr_lit: Option<f64>,
    /// Exact sum behind `rms_flat`.
    pub squared_error_flat: SquaredError,
    /// Exact sum behind `rms_gouraud`.
    pub squared_error_gouraud: SquaredError,
    /// Exact sum behind `rms_lit`.
    pub squared_error_lit: Option<SquaredError>,
    /// The picture that differs most.
    pub worst: WorstView,
}

/// Distances between the surfaces; `None` throughout where none were measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct DistanceReport {
    /// Mean distance in file units, the larger of both ways.
    pub distance_mean: Option<f64>,
    /// Root of the mean squared distance in file units, the larger of both ways.
    pub distance_rms: Option<f64>,
    /// Largest measured distance in file units, the larger of both ways.
    pub distance_max: Option<f64>,
    /// The same three as fractions of the reference's diagonal; `None` also where that is 0.
    pub distance_relative: Option<Distances>,
    /// Each way.
    pub distance: Option<SurfaceDistance>,
}

/// Zhang & Turk 2002, equation 5.11.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ImageError {
    /// Root of the sum of squared differences, in levels.
    pub error: f64,
    /// The same per pixel, comparable between sizes.
    pub rms: f64,
    /// Exact sum behind both.
    pub squared_error: SquaredError,
    /// Number of views.
    pub views: usize,
}

/// Picture errors of a candidate in one view.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ViewReport {
    /// Number of the view, from 0.
    pub view: usize,
    /// Position of the viewer in file units; `None` for an orthographic view.
    pub eye: Option<[f64; 3]>,
    /// Direction towards the viewer; `None` for a perspective view.
    pub axis: Option<[f64; 3]>,
    /// As [`PictureReport::rms_flat`], in this view.
    pub rms_flat: f64,
    /// As [`PictureReport::rms_gouraud`], in this view.
    pub rms_gouraud: f64,
    /// As [`PictureReport::rms_lit`], in this view.
    pub rms_lit: Option<f64>,
    /// As [`PictureReport::psnr_flat`], in this view.
    pub psnr_flat: Option<f64>,
    /// As [`PictureReport::psnr_gouraud`], in this view.
    pub psnr_gouraud: Option<f64>,
    /// As [`PictureReport::psnr_lit`], in this view.
    pub psnr_lit: Option<f64>,
    /// Sum of squared differences, flat, in the unit of [`SquaredError::sum`].
    pub squared_error_flat: u64,
    /// Sum of squared differences, Gouraud, in the unit of [`SquaredError::sum`].
    pub squared_error_gouraud: u64,
    /// Sum of squared differences, lit, in the unit of [`SquaredError::sum`]; `None` where `rms_lit` is.
    pub squared_error_lit: Option<u64>,
}

impl MeshShape {
    /// Counts the edges of a mesh; `histogram` is that of its silhouettes.
    pub(super) fn new(mesh: &Mesh, histogram: Option<SilhouetteHistogram>) -> Self {
        Self {
            triangles: mesh.triangles().len(),
            vertices: mesh.positions().len(),
            boundary_edges: Edges::of(mesh).boundary_count(),
            silhouette_expectation: histogram.as_ref().map(SilhouetteHistogram::expectation),
            silhouette_histogram: histogram,
        }
    }
}

impl PictureReport {
    /// Sums up the errors of all views.
    pub(super) fn new(appearance: &Appearance) -> Self {
        let (flat, gouraud) = (appearance.flat.total(), appearance.gouraud.total());
        let lit = appearance.lit.as_ref().map(ViewErrors::total);
        Self {
            rms_flat: flat.rms(),
            rms_gouraud: gouraud.rms(),
            rms_lit: lit.map(SquaredError::rms),
            psnr_flat: flat.psnr(),
            psnr_gouraud: gouraud.psnr(),
            psnr_lit: lit.and_then(SquaredError::psnr),
            squared_error_flat: flat,
            squared_error_gouraud: gouraud,
            squared_error_lit: lit,
            worst: appearance.worst(),
        }
    }

    /// The largest RMS of all shadings, in levels.
    #[must_use]
    pub fn largest_rms(&self) -> f64 {
        let smooth = self.rms_flat.max(self.rms_gouraud);
        self.rms_lit.map_or(smooth, |lit| lit.max(smooth))
    }
}

impl DistanceReport {
    /// Takes the larger of both ways.
    pub(super) fn new(distance: SurfaceDistance) -> Self {
        let absolute = distance.absolute();
        Self {
            distance_mean: Some(absolute.mean),
            distance_rms: Some(absolute.rms),
            distance_max: Some(absolute.max),
            distance_relative: distance.relative(),
            distance: Some(distance),
        }
    }
}

impl ImageError {
    /// Sums up the errors of the 20 views.
    pub(super) fn new(errors: &ViewErrors) -> Self {
        Self {
            error: errors.total().root(),
            rms: errors.total().rms(),
            squared_error: errors.total(),
            views: errors.views().len(),
        }
    }
}

impl ViewReport {
    /// Lists the errors of every view; eyes are those of `set`.
    pub(super) fn of_all(set: &ViewSet, appearance: &Appearance) -> Vec<Self> {
        let (flat, gouraud) = (appearance.flat.views(), appearance.gouraud.views());
        let errors = flat.iter().zip(gouraud);
        let lit = appearance.lit.as_ref().map(ViewErrors::views);
        let mut reports = Vec::with_capacity(set.views.len());
        for (view, (drawn, (flat, gouraud))) in set.views.iter().zip(errors).enumerate() {
            let (eye, axis) = match drawn.eye {
                Eye::Point(eye) => (Some(eye.to_array()), None),
                Eye::Axis(axis) => (None, Some(axis.to_array())),
            };
            let lit = lit.and_then(|views| views.get(view).copied());
            reports.push(Self {
                view,
                eye,
                axis,
                rms_flat: flat.rms(),
                rms_gouraud: gouraud.rms(),
                rms_lit: lit.map(SquaredError::rms),
                psnr_flat: flat.psnr(),
                psnr_gouraud: gouraud.psnr(),
                psnr_lit: lit.and_then(SquaredError::psnr),
                squared_error_flat: flat.sum,
                squared_error_gouraud: gouraud.sum,
                squared_error_lit: lit.map(|error| error.sum),
            });
        }
        reports
    }
}
