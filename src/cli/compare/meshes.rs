//! Comparing meshes: pictures, distances, boundaries and silhouettes.

use std::path::Path;

use serde::Serialize;

use super::{CompareArgs, Found, red_differences, verdict};
use crate::{
    Error, Result,
    cli::{Common, Verdict, input, report, table, terminal::Terminal},
    encode::{
        png,
        sheet::{Style, Tile, sheet},
    },
    mesh::{Edges, Mesh, content_sha256},
    metric::{
        appearance::{Appearance, WorstView, appearance, flat, image_error_views, pictures},
        difference_strip,
        folds::{Folds, folds},
        luma::SquaredError,
        silhouette::{SilhouetteHistogram, silhouette_histogram},
        surface::{Distances, SurfaceDistance, surface_distance},
    },
    num::Frame,
    raster::Scene,
    view::{self, Eye, Projection, Sphere, ViewSet, ViewsName, frame_of},
};

/// A mesh as its file holds it, and welded.
struct Source<'a> {
    path: &'a Path,
    sha256: String,
    mesh: Mesh,
}

/// What is known about a mesh alone.
#[derive(Serialize)]
struct Shape<'a> {
    file: &'a Path,
    triangles: usize,
    /// After welding.
    vertices: usize,
    /// Edges with one triangle, after welding.
    boundary_edges: usize,
    /// Edges that are silhouette edges in exactly 0, 1, ... of the views.
    silhouette_histogram: SilhouetteHistogram,
    /// Number of views in which an edge is a silhouette edge, on average.
    silhouette_expectation: f64,
    /// Of the mesh in the file, before welding.
    content_sha256: String,
}

/// One candidate against the reference.
#[derive(Serialize)]
struct Judgement<'a> {
    candidate: Shape<'a>,
    /// Whether the files hold the same mesh.
    equal: bool,
    rms_flat: f64,
    rms_gouraud: f64,
    psnr_flat: Option<f64>,
    psnr_gouraud: Option<f64>,
    squared_error_flat: SquaredError,
    squared_error_gouraud: SquaredError,
    worst: WorstView,
    /// The larger of both ways, in file units.
    distance_mean: Option<f64>,
    distance_rms: Option<f64>,
    distance_max: Option<f64>,
    /// The same as fractions of the reference's diagonal.
    distance_relative: Option<Distances>,
    /// Each way.
    distance: Option<SurfaceDistance>,
    #[serde(flatten)]
    folds: Folds,
    #[serde(skip_serializing_if = "Option::is_none")]
    image_error: Option<ImageError>,
    views: Vec<Pictures>,
}

/// Zhang & Turk 2002, equation 5.11.
#[derive(Serialize)]
struct ImageError {
    /// Root of the sum of squared differences, in levels.
    error: f64,
    /// The same, per pixel.
    rms: f64,
    squared_error: SquaredError,
    views: usize,
}

/// One view of a candidate.
#[derive(Serialize)]
struct Pictures {
    view: usize,
    /// Where the viewer is, in file units; null for an orthographic view.
    eye: Option<[f64; 3]>,
    /// The direction towards the viewer; null for a perspective view.
    axis: Option<[f64; 3]>,
    rms_flat: f64,
    rms_gouraud: f64,
    psnr_flat: Option<f64>,
    psnr_gouraud: Option<f64>,
    squared_error_flat: u64,
    squared_error_gouraud: u64,
}

#[derive(Serialize)]
struct Findings<'a> {
    reference: Shape<'a>,
    #[serde(flatten)]
    found: Found<Judgement<'a>>,
}

pub(super) fn run(options: &CompareArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let mut sources = Vec::new();
    for path in options.files() {
        sources.push(read(path, terminal)?);
    }
    let (reference, candidates) = sources
        .split_first()
        .ok_or_else(|| Error::Internal("a reference without a file".into()))?;
    let sphere = Sphere::of_mesh(&reference.mesh)
        .ok_or_else(|| Error::Internal("a mesh with triangles has a bounding sphere".into()))?;
    let set = views(options, &sphere)?;
    let frame = frame_of(&reference.mesh);
    let framed = set.enter_frame(frame);
    let (reference_scene, reference_shape) = prepare(reference, frame, &framed, terminal)?;
    let (mut scenes, mut shapes) = (Vec::new(), Vec::new());
    for candidate in candidates {
        let (scene, shape) = prepare(candidate, frame, &framed, terminal)?;
        scenes.push(scene);
        shapes.push(shape);
    }
    let looks = appearance(&reference_scene, &scenes, &framed, terminal)?;
    let mut found = Vec::new();
    for ((candidate, shape), look) in candidates.iter().zip(shapes).zip(&looks) {
        let distance = match options.distance_samples() {
            None => None,
            Some(samples) => Some(surface_distance(
                &reference.mesh,
                &candidate.mesh,
                samples,
                terminal,
            )?),
        };
        let folds = folds(&reference.mesh, &candidate.mesh, terminal)?;
        found.push(Judgement::new(
            reference, shape, look, distance, folds, &set,
        ));
    }
    if options.image_error {
        let (size, samples) = (options.size.unwrap_or(512), options.samples.unwrap_or(2));
        let set = image_error_views(&sphere, size, samples)?.enter_frame(frame);
        let errors = flat(&reference_scene, &scenes, &set, terminal)?;
        for (judgement, errors) in found.iter_mut().zip(errors) {
            judgement.image_error = Some(ImageError {
                error: errors.total().root(),
                rms: errors.total().rms(),
                squared_error: errors.total(),
                views: errors.views().len(),
            });
        }
    }
    if let Some(folder) = &options.red_differences {
        red_differences::write(
            options,
            folder,
            &reference_scene,
            &scenes,
            &framed,
            terminal,
        )?;
    }
    if let Some(path) = &options.difference {
        write_difference(options, path, &reference_scene, &scenes, &framed, &found)?;
        terminal.say(&format!("{}: written", path.display()));
    }
    let holds = found
        .iter()
        .all(|j| options.holds(j.equal, Some(j.rms_flat.max(j.rms_gouraud))));
    let findings = Findings {
        reference: reference_shape,
        found: Found::new(found),
    };
    report(common, "compare", resolved(options, &set), &findings)?;
    terminal.finish();
    show(options, &findings.reference, findings.found.as_slice());
    Ok(verdict(holds))
}

fn read<'a>(path: &'a Path, terminal: &Terminal) -> Result<Source<'a>> {
    let mesh = input::read(path, false, terminal)?;
    input::require_triangles(path, &mesh)?;
    Ok(Source {
        path,
        sha256: content_sha256(&mesh),
        mesh: input::welded(path, mesh, terminal),
    })
}

/// The views, around the reference, in file units.
fn views(options: &CompareArgs, sphere: &Sphere) -> Result<ViewSet> {
    let name = match &options.views {
        None => &ViewsName::Rhombicuboctahedron,
        Some(ViewsName::File(path)) if options.size.is_some() || options.samples.is_some() => {
            return Err(Error::Usage(format!(
                "--size and --samples are part of the view file {}; leave them out",
                path.display()
            )));
        }
        Some(name) => name,
    };
    let size = [options.size.unwrap_or(512); 2];
    let set = view::resolve(name, sphere, size, Projection::Perspective)?;
    match name {
        ViewsName::File(_) => Ok(set),
        _ => set.with_samples(options.samples.unwrap_or(2)),
    }
}

/// A mesh in the frame of the reference, ready to be drawn, and what is known about it alone.
fn prepare<'a>(
    source: &Source<'a>,
    frame: Frame,
    framed: &ViewSet,
    terminal: &Terminal,
) -> Result<(Scene, Shape<'a>)> {
    let mesh = source.mesh.enter_frame(frame);
    let eyes: Vec<Eye> = framed.views.iter().map(|view| view.eye).collect();
    let histogram = silhouette_histogram(&mesh, &eyes, terminal)?;
    let shape = Shape {
        file: source.path,
        triangles: mesh.triangles().len(),
        vertices: mesh.positions().len(),
        boundary_edges: Edges::of(&mesh).boundary_count(),
        silhouette_expectation: histogram.expectation(),
        silhouette_histogram: histogram,
        content_sha256: source.sha256.clone(),
    };
    Ok((Scene::of(&mesh), shape))
}

impl<'a> Judgement<'a> {
    fn new(
        reference: &Source<'_>,
        candidate: Shape<'a>,
        look: &Appearance,
        distance: Option<SurfaceDistance>,
        folds: Folds,
        set: &ViewSet,
    ) -> Self {
        let (flat, gouraud) = (look.flat.total(), look.gouraud.total());
        let absolute = distance.map(|d| d.absolute());
        let errors = look.flat.views().iter().zip(look.gouraud.views());
        let views = set.views.iter().zip(errors).enumerate();
        Self {
            equal: candidate.content_sha256 == reference.sha256,
            rms_flat: flat.rms(),
            rms_gouraud: gouraud.rms(),
            psnr_flat: flat.psnr(),
            psnr_gouraud: gouraud.psnr(),
            squared_error_flat: flat,
            squared_error_gouraud: gouraud,
            worst: look.worst(),
            distance_mean: absolute.map(|d| d.mean),
            distance_rms: absolute.map(|d| d.rms),
            distance_max: absolute.map(|d| d.max),
            distance_relative: distance.and_then(|d| d.relative()),
            distance,
            folds,
            image_error: None,
            views: views
                .map(|(i, (view, (flat, gouraud)))| Pictures {
                    view: i,
                    eye: match view.eye {
                        Eye::Point(eye) => Some(eye.to_array()),
                        Eye::Axis(_) => None,
                    },
                    axis: match view.eye {
                        Eye::Point(_) => None,
                        Eye::Axis(axis) => Some(axis.to_array()),
                    },
                    rms_flat: flat.rms(),
                    rms_gouraud: gouraud.rms(),
                    psnr_flat: flat.psnr(),
                    psnr_gouraud: gouraud.psnr(),
                    squared_error_flat: flat.sum,
                    squared_error_gouraud: gouraud.sum,
                })
                .collect(),
            candidate,
        }
    }
}

fn resolved(options: &CompareArgs, set: &ViewSet) -> serde_json::Value {
    let views = options.views.as_ref();
    serde_json::json!({
        "reference": options.reference,
        "candidates": options.candidates,
        "views": views.unwrap_or(&ViewsName::Rhombicuboctahedron).to_string(),
        "width": set.width,
        "height": set.height,
        "samples": set.samples,
        "distance_samples": options.distance_samples(),
        "equal": options.equal,
        "max_rms": options.max_rms,
        "difference": options.difference,
        "difference_scale": options.pictured().then(|| options.difference_scale()),
        "image_error": options.image_error,
        "red_differences": options.red_differences,
    })
}

/// One row for each candidate: expected, actual and difference in its worst view.
fn write_difference(
    options: &CompareArgs,
    path: &Path,
    reference: &Scene,
    scenes: &[Scene],
    framed: &ViewSet,
    found: &[Judgement<'_>],
) -> Result<()> {
    let (mut strips, mut labels) = (Vec::new(), Vec::new());
    for (scene, judgement) in scenes.iter().zip(found) {
        let worst = judgement.worst;
        let [expected, actual] = pictures([reference, scene], framed, worst.view, worst.shading)?;
        strips.push(difference_strip(
            &expected,
            &actual,
            options.difference_scale(),
        )?);
        labels.push(format!(
            "{}: view {}, {}, RMS {:.4}",
            judgement.candidate.file.display(),
            worst.view,
            shading_name(worst),
            worst.error.rms()
        ));
    }
    let tiles: Vec<_> = strips
        .iter()
        .zip(&labels)
        .map(|(picture, label)| Tile { picture, label })
        .collect();
    png::write_grey(path, &sheet(&tiles, 1, Style::default())?)
}

fn shading_name(worst: WorstView) -> &'static str {
    match worst.shading {
        view::Interpolation::Flat => "flat",
        view::Interpolation::Gouraud => "Gouraud",
    }
}

fn show(options: &CompareArgs, reference: &Shape<'_>, found: &[Judgement<'_>]) {
    let head = [
        "mesh",
        "triangles",
        "boundary",
        "silhouette",
        "RMS flat",
        "Gouraud",
        "PSNR flat",
        "Gouraud",
        "mean %",
        "max %",
        "folds",
        "flipped",
        "equal",
    ];
    let shape = |s: &Shape<'_>| {
        vec![
            s.file.display().to_string(),
            s.triangles.to_string(),
            s.boundary_edges.to_string(),
            format!("{:.3}", s.silhouette_expectation),
        ]
    };
    let mut rows = vec![head.map(String::from).to_vec(), shape(reference)];
    for j in found {
        let percent = |f: fn(Distances) -> f64| j.distance_relative.map(|d| 100.0 * f(d));
        let mut row = shape(&j.candidate);
        row.extend([
            format!("{:.4}", j.rms_flat),
            format!("{:.4}", j.rms_gouraud),
            table::number(j.psnr_flat, 2),
            table::number(j.psnr_gouraud, 2),
            table::number(percent(|d| d.mean), 5),
            table::number(percent(|d| d.max), 4),
            j.folds.folded_edges.to_string(),
            j.folds.flipped_faces.to_string(),
            if j.equal { "yes" } else { "no" }.into(),
        ]);
        rows.push(row);
    }
    answer!("{}", table::aligned(&rows));
    for j in found {
        answer!(
            "{}: worst in view {}, {}: RMS {:.4}",
            j.candidate.file.display(),
            j.worst.view,
            shading_name(j.worst),
            j.worst.error.rms()
        );
    }
    for j in found {
        if let Some(e) = &j.image_error {
            answer!(
                "{}: image error {:.1} (equation 5.11, {} views), RMS {:.4}",
                j.candidate.file.display(),
                e.error,
                e.views,
                e.rms
            );
        }
    }
    if options.per_view {
        for j in found {
            show_views(j);
        }
    }
}

fn show_views(judgement: &Judgement<'_>) {
    let head = ["view", "RMS flat", "Gouraud", "PSNR flat", "Gouraud"];
    let mut rows = vec![head.map(String::from).to_vec()];
    for p in &judgement.views {
        rows.push(vec![
            p.view.to_string(),
            format!("{:.4}", p.rms_flat),
            format!("{:.4}", p.rms_gouraud),
            table::number(p.psnr_flat, 2),
            table::number(p.psnr_gouraud, 2),
        ]);
    }
    answer!("{}", judgement.candidate.file.display());
    answer!("{}", table::aligned(&rows));
}
