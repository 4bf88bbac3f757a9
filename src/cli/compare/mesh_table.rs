//! The findings about meshes as tables on the terminal.

use std::path::Path;

use super::{CompareArgs, meshes::Judgement};
use crate::{
    cli::table,
    metric::{
        appearance::WorstView,
        report::{MeshShape, ViewReport},
        surface::Distances,
    },
    view::Interpolation,
};

pub(super) fn shading_name(worst: WorstView) -> &'static str {
    match worst.shading {
        Interpolation::Flat => "flat",
        Interpolation::Gouraud => "Gouraud",
    }
}

/// The first columns, for the reference too.
fn shape_cells(file: &Path, shape: &MeshShape) -> Vec<String> {
    vec![
        file.display().to_string(),
        shape.triangles.to_string(),
        shape.boundary_edges.to_string(),
        table::number(shape.silhouette_expectation, 3),
    ]
}

/// Root mean squares, then signal-to-noise ratios.
fn error_cells(rms: [f64; 2], psnr: [Option<f64>; 2]) -> impl Iterator<Item = String> {
    let rms = rms.into_iter().map(|rms| format!("{rms:.4}"));
    rms.chain(psnr.into_iter().map(|psnr| table::number(psnr, 2)))
}

/// Prints a row for every mesh, the worst views, equation 5.11 and, where asked for, every view.
pub(super) fn show(options: &CompareArgs, reference: &MeshShape, found: &[Judgement<'_>]) {
    let head = "mesh|triangles|boundary|silhouette|RMS flat|Gouraud|PSNR flat|Gouraud|mean %|max %|folds|flipped|equal";
    let mut rows = vec![
        table::head(head),
        shape_cells(&options.reference, reference),
    ];
    for j in found {
        let errors = &j.pictures;
        let distances = j.errors.distances.distance_relative;
        let percent = |f: fn(Distances) -> f64| distances.map(|d| 100.0 * f(d));
        let folds = j.errors.folds.unwrap_or_default();
        let mut row = shape_cells(j.candidate.file, &j.candidate.shape);
        let psnr = [errors.psnr_flat, errors.psnr_gouraud];
        row.extend(error_cells([errors.rms_flat, errors.rms_gouraud], psnr));
        row.extend([
            table::number(percent(|d| d.mean), 5),
            table::number(percent(|d| d.max), 4),
            folds.folded_edges.to_string(),
            folds.flipped_faces.to_string(),
            if j.equal { "yes" } else { "no" }.into(),
        ]);
        rows.push(row);
    }
    answer!("{}", table::aligned(&rows));
    for j in found {
        let (file, worst) = (j.candidate.file.display(), j.pictures.worst);
        let (view, shading, rms) = (worst.view, shading_name(worst), worst.error.rms());
        answer!("{file}: worst in view {view}, {shading}: RMS {rms:.4}");
    }
    for j in found {
        if let Some(e) = &j.errors.image_error {
            let (file, error, views, rms) = (j.candidate.file.display(), e.error, e.views, e.rms);
            answer!("{file}: image error {error:.1} (equation 5.11, {views} views), RMS {rms:.4}");
        }
    }
    if options.per_view {
        for j in found {
            answer!("{}", j.candidate.file.display());
            answer!("{}", view_table(&j.errors.views));
        }
    }
}

fn view_table(views: &[ViewReport]) -> String {
    let mut rows = vec![table::head("view|RMS flat|Gouraud|PSNR flat|Gouraud")];
    for v in views {
        let mut row = vec![v.view.to_string()];
        let psnr = [v.psnr_flat, v.psnr_gouraud];
        row.extend(error_cells([v.rms_flat, v.rms_gouraud], psnr));
        rows.push(row);
    }
    table::aligned(&rows)
}
