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
        Interpolation::Lit => "lit",
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

/// Root mean squares, then signal-to-noise ratios; those of stored normals only where `lit`.
fn error_cells(
    rms: [Option<f64>; 3],
    psnr: [Option<f64>; 3],
    lit: bool,
) -> impl Iterator<Item = String> {
    let shadings = if lit { 3 } else { 2 };
    let rms = rms.into_iter().take(shadings);
    let rms = rms.map(|rms| table::number(rms, 4));
    let psnr = psnr.into_iter().take(shadings);
    rms.chain(psnr.map(|psnr| table::number(psnr, 2)))
}

/// The names of the columns of [`error_cells`].
fn error_head(lit: bool) -> &'static str {
    match lit {
        true => "RMS flat|Gouraud|lit|PSNR flat|Gouraud|lit",
        false => "RMS flat|Gouraud|PSNR flat|Gouraud",
    }
}

/// Prints a row for every mesh, the worst views, equation 5.11 and, where asked for, every view.
pub(super) fn show(options: &CompareArgs, reference: &MeshShape, found: &[Judgement<'_>]) {
    let lit = found.iter().any(|j| j.pictures.rms_lit.is_some());
    let errors = error_head(lit);
    let head =
        format!("mesh|triangles|boundary|silhouette|{errors}|mean %|max %|folds|flipped|equal");
    let mut rows = vec![
        table::head(&head),
        shape_cells(&options.reference, reference),
    ];
    for j in found {
        let errors = &j.pictures;
        let distances = j.errors.distances.distance_relative;
        let percent = |f: fn(Distances) -> f64| distances.map(|d| 100.0 * f(d));
        let folds = j.errors.folds.unwrap_or_default();
        let mut row = shape_cells(j.candidate.file, &j.candidate.shape);
        let rms = [
            Some(errors.rms_flat),
            Some(errors.rms_gouraud),
            errors.rms_lit,
        ];
        let psnr = [errors.psnr_flat, errors.psnr_gouraud, errors.psnr_lit];
        row.extend(error_cells(rms, psnr, lit));
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
    let lit = views.iter().any(|view| view.rms_lit.is_some());
    let mut rows = vec![table::head(&format!("view|{}", error_head(lit)))];
    for v in views {
        let mut row = vec![v.view.to_string()];
        let rms = [Some(v.rms_flat), Some(v.rms_gouraud), v.rms_lit];
        let psnr = [v.psnr_flat, v.psnr_gouraud, v.psnr_lit];
        row.extend(error_cells(rms, psnr, lit));
        rows.push(row);
    }
    table::aligned(&rows)
}
