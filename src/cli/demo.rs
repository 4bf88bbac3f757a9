//! `lodmark demo`: the first thing to run. Built-in scenes, every method, pictures to look at.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{Common, Verdict, report, terminal::Terminal};
use crate::{
    Error, Progress, Result,
    encode::{
        atomic, json, png,
        sheet::{PADDING, sheet},
    },
    io,
    mesh::{Mesh, canonical, content_sha256, generate},
    metric::{
        difference::signed_picture,
        report::{CompareOptions, Judge},
    },
    raster::{Grid, Scene},
    simplify::{Options as RunOptions, Target, image::Preset, simplify_with},
    view::Interpolation,
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

/// The view that is drawn, of the 24.
const VIEW: usize = 17;

/// Points for the distance between surfaces.
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
    atomic::folder(folder)?;
    let mut found = Vec::new();
    let mut tiles: Vec<(Grid<u8>, String)> = Vec::new();
    for &about in SCENES {
        terminal.step("demo", found.len() as u64, 3 * SCENES.len() as u64)?;
        scene(folder, about, terminal, &mut found, &mut tiles)?;
    }
    let picture = sheet(&tiles, 4, PADDING)?;
    let sheet_file = folder.join("sheet.png");
    png::write_grey(&sheet_file, &picture)?;
    json::write(&folder.join("report.json"), &found)?;
    let resolved = serde_json::json!({ "folder": folder });
    let results = serde_json::json!({ "results": found });
    report(common, "demo", resolved, results)?;
    answer!("scene            method       triangles  rms flat   gouraud  distance");
    for r in &found {
        let distance = r.distance_mean.map(|d| format!("{:.4} %", 100.0 * d));
        answer!(
            "{:16} {:12} {:>9} {:>9.2} {:>9.2} {:>9}",
            r.scene,
            r.method,
            r.triangles_out,
            r.rms_flat,
            r.rms_gouraud,
            distance.unwrap_or_else(|| "-".into())
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
    let judge = Judge::new(&mesh, &judged_by())?;
    io::write(&folder.join(format!("{name}.{extension}")), &mesh)?;
    let amount = Target::Ratio(share);
    let methods = [
        // The recipe for who is in a hurry, so that the demo ends within a minute.
        RunOptions::image(amount).preset(Preset::Fast),
        RunOptions::memoryless(amount),
        RunOptions::quadric(amount),
    ];
    let mut results: Vec<(&'static str, Mesh)> = Vec::new();
    for options in methods {
        let outcome = simplify_with(&mesh, &options, terminal)?;
        results.push((options.method.name(), outcome.mesh));
    }
    let meshes: Vec<&Mesh> = results.iter().map(|(_, mesh)| mesh).collect();
    let comparison = judge.compare(&meshes, terminal)?;
    let scenes: Vec<Scene> = meshes.iter().map(|mesh| judge.scene(mesh)).collect();
    let scenes: Vec<&Scene> = scenes.iter().collect();
    let pictures = judge.pictures(&scenes, VIEW, Interpolation::Flat)?;
    let reference = &pictures[0];
    let triangles_in = mesh.triangles().len();
    let mut above = vec![(reference.clone(), format!("{name}  {triangles_in}"))];
    let mut below = vec![(reference.map(|_| 255), String::new())];
    let judged = results.iter().zip(comparison.candidates);
    for (((method, mesh), report), picture) in judged.zip(&pictures[1..]) {
        let file = format!("{name}-{method}.{extension}");
        io::write(&folder.join(&file), mesh)?;
        let errors = report.errors;
        let drawn = errors
            .pictures
            .ok_or_else(|| Error::Internal("a result that was not drawn".into()))?;
        let (rms_flat, rms_gouraud) = (drawn.rms_flat, drawn.rms_gouraud);
        let triangles_out = mesh.triangles().len();
        let difference = signed_picture(reference, picture, 2)?;
        below.push((difference, "difference, doubled".into()));
        let label = format!("{method}  {triangles_out}  rms {rms_flat:.2}");
        above.push((picture.clone(), label));
        found.push(Judged {
            scene: name,
            method,
            file,
            triangles_in,
            triangles_out,
            rms_flat,
            rms_gouraud,
            distance_mean: errors.distances.distance_relative.map(|d| d.mean),
            content_sha256: content_sha256(mesh),
        });
    }
    tiles.extend(above);
    tiles.extend(below);
    Ok(())
}

/// The evaluation views at a quarter of their pixels, and enough points for three digits: this should not take long.
fn judged_by() -> CompareOptions {
    CompareOptions {
        size: SIDE,
        distance_samples: Some(SAMPLES),
        silhouettes: false,
        folds: false,
        ..CompareOptions::default()
    }
}
