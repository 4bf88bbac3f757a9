//! Figure 8 of Zhang & Turk 2002: where candidates differ from the reference, in the red channel.

use std::path::Path;

use super::CompareArgs;
use crate::{
    Error, Progress, Result,
    cli::terminal::Terminal,
    encode::{
        png,
        sheet::{Style, Tile, sheet},
    },
    metric::{appearance::pictures, difference::red_picture, luma::squared_error},
    raster::Scene,
    view::{Interpolation, ViewSet},
};

/// Writes `view-NN.png` for every view: below the reference and the candidates, above each candidate the reference
/// with the differences in red.
pub(super) fn write(
    options: &CompareArgs,
    folder: &Path,
    reference: &Scene,
    candidates: &[Scene],
    framed: &ViewSet,
    terminal: &Terminal,
) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|e| Error::io("create", folder, e))?;
    let count = framed.views.len();
    let scale = options.difference_scale();
    for view in 0..count {
        terminal.step("draw differences", view as u64, count as u64)?;
        let [expected] = pictures([reference], framed, view, Interpolation::Flat)?;
        let (mut above, mut below) = (Vec::new(), Vec::new());
        above.push((expected.map(|_| [255; 3]), String::new()));
        below.push((
            expected.map(|v| [v; 3]),
            options.reference.display().to_string(),
        ));
        for (scene, path) in candidates.iter().zip(&options.candidates) {
            let [actual] = pictures([scene], framed, view, Interpolation::Flat)?;
            let rms = squared_error(&expected, &actual, 1)?.rms();
            above.push((
                red_picture(&expected, &actual, scale)?,
                format!("difference x{scale}, RMS {rms:.3}"),
            ));
            below.push((actual.map(|v| [v; 3]), path.display().to_string()));
        }
        let columns = above.len() as u32;
        above.extend(below);
        let tiles: Vec<_> = above
            .iter()
            .map(|(picture, label)| Tile { picture, label })
            .collect();
        let picture = sheet(&tiles, columns, Style::default())?;
        png::write_rgb(&folder.join(format!("view-{view:02}.png")), &picture)?;
    }
    terminal.say(&format!("{}: {count} pictures written", folder.display()));
    Ok(())
}
