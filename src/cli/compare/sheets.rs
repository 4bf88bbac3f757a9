//! Sheets of pictures: the worst view of every candidate, and every view with the differences in red.

use std::path::Path;

use super::{CompareArgs, mesh_table::shading_name, meshes::Judgement};
use crate::{
    Progress, Result,
    cli::terminal::Terminal,
    encode::{
        atomic, png,
        sheet::{PADDING, sheet},
    },
    mesh::Mesh,
    metric::{difference::red_picture, difference_strip, luma::squared_error, report::Judge},
    raster::Scene,
    view::Interpolation,
};

/// Writes a row for each candidate: expected, actual and difference in its worst view.
pub(super) fn write_worst(
    options: &CompareArgs,
    path: &Path,
    judge: &Judge<'_>,
    candidates: &[&Mesh],
    found: &[Judgement<'_>],
) -> Result<()> {
    let mut strips = Vec::new();
    for (mesh, judgement) in candidates.iter().zip(found) {
        let worst = judgement.pictures.worst;
        let pictures = judge.pictures(&[&judge.scene(mesh)], worst.view, worst.shading)?;
        let (file, view) = (judgement.candidate.file.display(), worst.view);
        let (shading, rms) = (shading_name(worst), worst.error.rms());
        let label = format!("{file}: view {view}, {shading}, RMS {rms:.4}");
        let scale = options.difference_scale();
        strips.push((difference_strip(&pictures[0], &pictures[1], scale)?, label));
    }
    png::write_grey(path, &sheet(&strips, 1, PADDING)?)
}

/// Writes Figure 8 of Zhang & Turk 2002 as `view-NN.png` for every view: below the reference and the candidates, above
/// each candidate the reference with the differences in red.
pub(super) fn write_red(
    options: &CompareArgs,
    folder: &Path,
    judge: &Judge<'_>,
    candidates: &[&Mesh],
    terminal: &Terminal,
) -> Result<()> {
    atomic::folder(folder)?;
    let scenes: Vec<Scene> = candidates.iter().map(|mesh| judge.scene(mesh)).collect();
    let scenes: Vec<&Scene> = scenes.iter().collect();
    let count = judge.views().map_or(0, |set| set.views.len());
    let scale = options.difference_scale();
    for view in 0..count {
        terminal.step("draw differences", view as u64, count as u64)?;
        let pictures = judge.pictures(&scenes, view, Interpolation::Flat)?;
        let (mut above, mut below) = (Vec::new(), Vec::new());
        let expected = &pictures[0];
        for (i, (actual, file)) in pictures.iter().zip(options.files()).enumerate() {
            above.push(if i == 0 {
                (expected.map(|_| [255; 3]), String::new())
            } else {
                let rms = squared_error(expected, actual, 1)?.rms();
                let label = format!("difference x{scale}, RMS {rms:.3}");
                (red_picture(expected, actual, scale)?, label)
            });
            below.push((actual.map(|v| [v; 3]), file.display().to_string()));
        }
        let columns = above.len() as u32;
        above.extend(below);
        let picture = sheet(&above, columns, PADDING)?;
        png::write_rgb(&folder.join(format!("view-{view:02}.png")), &picture)?;
    }
    terminal.say(&format!("{}: {count} pictures written", folder.display()));
    Ok(())
}
