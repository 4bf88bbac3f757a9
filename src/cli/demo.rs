//! `lodmark demo`: the first thing to run. Built-in scenes, every method, pictures to look at.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{Common, Verdict, report, terminal::Terminal};
use crate::{
    Error, Progress, Result,
    encode::{
        json, png,
        sheet::{Style, Tile, sheet},
    },
    io,
    mesh::{canonical, content_sha256, generate},
    metric::{appearance::appearance, difference::signed_picture, surface::surface_distance},
    raster::{self, Grid, Scene},
    simplify::{Amount, MethodOptions, Options as RunOptions, image::Preset, simplify},
    view::{Sphere, View, ViewSet, frame_of},
};

/// Simplify built-in scenes with every method and draw what became of them
#[derive(Debug, clap::Args)]
pub(super) struct DemoArgs {
    /// Folder for meshes, pictures and the report; made if missing
    #[arg(value_name = "DIR", default_value = "demo-out")]
    folder: PathBuf,
}

/// Scenes with the extension that keeps all they have, and the share of triangles that is left.
const SCENES: &[(&str, &str, f64)] = &[
    ("casing", "ply", 0.16),
    ("tori", "ply", 0.04),
    ("textured-torus", "obj", 0.03),
];

/// Side of a picture on the sheet, in pixels.
const SIDE: u32 = 256;

/// Points for the distance between surfaces: enough for three digits.
const SAMPLES: u32 = 50_000;

/// One simplified mesh, judged.
#[derive(Debug, Serialize)]
struct Judged {
    scene: &'static str,
    method: &'static str,
    file: String,
    triangles_in: usize,
    triangles_out: usize,
    rms_flat: f64,
    rms_gouraud: f64,
    /// Mean distance between the surfaces, the larger of both directions, as a share of the diagonal.
    distance_mean: Option<f64>,
    content_sha256: String,
}

pub(super) fn run(options: &DemoArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let folder = &options.folder;
    std::fs::create_dir_all(folder).map_err(|e| Error::io("create", folder, e))?;
    let mut found = Vec::new();
    let mut tiles: Vec<(Grid<u8>, String)> = Vec::new();
    for &(name, extension, share) in SCENES {
        terminal.step("demo", found.len() as u64, 3 * SCENES.len() as u64)?;
        scene(
            folder,
            (name, extension, share),
            terminal,
            &mut found,
            &mut tiles,
        )?;
    }
    let labelled: Vec<Tile<'_, u8>> = tiles
        .iter()
        .map(|(picture, label)| Tile { picture, label })
        .collect();
    let picture = sheet(&labelled, 4, Style::default())?;
    let sheet_file = folder.join("sheet.png");
    png::write_grey(&sheet_file, &picture)?;
    json::write(&folder.join("report.json"), &found)?;
    report(
        common,
        "demo",
        serde_json::json!({ "folder": folder }),
        serde_json::json!({ "results": found }),
    )?;
    answer!(
        "{:16} {:12} {:>9} {:>9} {:>9} {:>9}",
        "scene",
        "method",
        "triangles",
        "rms flat",
        "gouraud",
        "distance"
    );
    for r in &found {
        answer!(
            "{:16} {:12} {:>9} {:>9.2} {:>9.2} {:>9}",
            r.scene,
            r.method,
            r.triangles_out,
            r.rms_flat,
            r.rms_gouraud,
            r.distance_mean
                .map_or_else(|| "-".into(), |d| format!("{:.4} %", 100.0 * d))
        );
    }
    answer!("\nlook at  {}", sheet_file.display());
    answer!(
        "meshes   {}/*.ply, *.obj    figures  {}",
        folder.display(),
        folder.join("report.json").display()
    );
    Ok(Verdict::Good)
}

/// Simplifies one scene with every method and adds a row of pictures and one of differences.
fn scene(
    folder: &Path,
    (name, extension, share): (&'static str, &str, f64),
    terminal: &Terminal,
    found: &mut Vec<Judged>,
    tiles: &mut Vec<(Grid<u8>, String)>,
) -> Result<()> {
    let mesh = match name {
        "casing" => Some(generate::engine(1)),
        other => generate::by_name(other),
    };
    let mesh = mesh.ok_or_else(|| Error::Internal(format!("there is no scene {name}")))?;
    let mesh = canonical(&mesh).mesh;
    let frame = frame_of(&mesh);
    let framed = mesh.enter_frame(frame);
    let sphere =
        Sphere::of_mesh(&framed).ok_or_else(|| Error::Internal("a scene has triangles".into()))?;
    // The evaluation views at a quarter of their pixels: this should not take long.
    let judge = ViewSet {
        width: SIDE,
        height: SIDE,
        ..ViewSet::evaluation(&sphere)?
    };
    let view = judge.views[17];
    let original = Scene::of(&framed);
    io::write(&folder.join(format!("{name}.{extension}")), &mesh)?;
    let reference = picture(&original, &view, &judge);
    let mut pictures = vec![(
        reference.clone(),
        format!("{name}  {}", mesh.triangles().len()),
    )];
    let mut differences = vec![(reference.map(|_| 255), String::new())];
    let amount = Amount::Ratio(share);
    let methods = [
        by_images(amount),
        RunOptions::memoryless(amount),
        RunOptions::quadric(amount),
    ];
    for options in methods {
        let method = options.method.name();
        let outcome = simplify(&mesh, &options, terminal)?;
        let file = format!("{name}-{method}.{extension}");
        io::write(&folder.join(&file), &outcome.mesh)?;
        let result = Scene::of(&outcome.mesh.enter_frame(frame));
        let looks = appearance(&original, std::slice::from_ref(&result), &judge, terminal)?;
        let looks = looks
            .first()
            .ok_or_else(|| Error::Internal("one candidate, one appearance".into()))?;
        let distance = surface_distance(&mesh, &outcome.mesh, SAMPLES, terminal)?;
        let (flat, gouraud) = (looks.flat.total().rms(), looks.gouraud.total().rms());
        let picture = picture(&result, &view, &judge);
        differences.push((
            signed_picture(&reference, &picture, 2)?,
            "difference, doubled".into(),
        ));
        pictures.push((
            picture,
            format!(
                "{method}  {}  rms {flat:.2}",
                outcome.mesh.triangles().len()
            ),
        ));
        found.push(Judged {
            scene: name,
            method,
            file,
            triangles_in: mesh.triangles().len(),
            triangles_out: outcome.mesh.triangles().len(),
            rms_flat: flat,
            rms_gouraud: gouraud,
            distance_mean: distance.relative().map(|d| d.mean),
            content_sha256: content_sha256(&outcome.mesh),
        });
    }
    tiles.extend(pictures);
    tiles.extend(differences);
    Ok(())
}

/// The recipe for who is in a hurry, so that the demo ends within a minute.
fn by_images(amount: Amount) -> RunOptions {
    let mut options = RunOptions::image(amount);
    options.method = MethodOptions::Image(Preset::Fast.options());
    options
}

fn picture(scene: &Scene, view: &View, set: &ViewSet) -> Grid<u8> {
    raster::mean_luma(&raster::luma_sums(scene, view, set), set.samples)
}
