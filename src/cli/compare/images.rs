//! Comparing images: equal, or where and how much they are not.

use std::path::Path;

use serde::Serialize;

use super::{CompareArgs, Found};
use crate::{
    Error, Result,
    cli::{Common, Verdict, has_extension, report, table, terminal::Terminal},
    encode::{
        npy,
        png::{self, Picture},
        sheet::{PADDING, sheet},
    },
    metric::{
        difference::{ImageComparison, compare},
        difference_strip,
        luma::{SquaredError, squared_error},
    },
    raster::Grid,
};

/// The content of a file.
enum Image {
    Picture(Picture),
    /// Ids or depths.
    Numbers(Grid<u32>),
}

#[derive(Serialize)]
struct Judgement<'a> {
    candidate: &'a Path,
    equal: bool,
    /// Place and size of the differences.
    comparison: ImageComparison,
    /// Of luma, in levels; null for numbers and where sizes differ.
    rms: Option<f64>,
    psnr: Option<f64>,
    squared_error: Option<SquaredError>,
}

pub(super) fn run(options: &CompareArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    refuse_foreign(options)?;
    let images = options.files().map(read).collect::<Result<Vec<_>>>()?;
    let (expected, candidates) = images
        .split_first()
        .ok_or_else(|| Error::Internal("a reference without a file".into()))?;
    let found = options.candidates.iter().zip(candidates);
    let found = found.map(|(path, actual)| judge(&options.reference, expected, path, actual));
    let found = found.collect::<Result<Vec<_>>>()?;
    let holds = found.iter().all(|j| options.holds(j.equal, j.rms));
    if let Some(path) = &options.difference {
        write_difference(options, path, expected, candidates)?;
        terminal.say(&format!("{}: written", path.display()));
    }
    let resolved = serde_json::json!({
        "reference": options.reference,
        "candidates": options.candidates,
        "equal": options.equal,
        "max_rms": options.max_rms,
        "difference": options.difference,
        "difference_scale": options.difference.as_ref().map(|_| options.difference_scale()),
    });
    let findings = Found::new(found);
    report(common, "compare", resolved, &findings)?;
    findings.as_slice().iter().for_each(show);
    Ok(Verdict::of(holds))
}

fn show(judgement: &Judgement<'_>) {
    let name = judgement.candidate.display();
    answer!("{name}: {}", judgement.comparison);
    if let Some(rms) = judgement.rms.filter(|_| !judgement.equal) {
        let psnr = table::number(judgement.psnr, 2);
        answer!("{name}: luma differs by {rms:.4} levels RMS, PSNR {psnr}");
    }
}

/// An option that would be ignored is an error.
fn refuse_foreign(options: &CompareArgs) -> Result<()> {
    let foreign = [
        ("--views", options.views.is_some()),
        ("--size", options.size.is_some()),
        ("--samples", options.samples.is_some()),
        ("--distance-samples", options.distance_samples.is_some()),
        ("--no-distance", options.no_distance),
        ("--image-error", options.image_error),
        ("--per-view", options.per_view),
        ("--red-differences", options.red_differences.is_some()),
    ];
    match foreign.iter().find(|(_, given)| *given) {
        Some((name, _)) => {
            let told = format!("{name} means nothing to images; leave it out");
            Err(Error::Usage(told))
        }
        None => Ok(()),
    }
}

fn read(path: &Path) -> Result<Image> {
    if has_extension(path, "npy") {
        npy::read_plane(path).map(Image::Numbers)
    } else {
        png::read(path).map(Image::Picture)
    }
}

fn judge<'a>(
    reference: &Path,
    expected: &Image,
    candidate: &'a Path,
    actual: &Image,
) -> Result<Judgement<'a>> {
    let (comparison, squared_error) = match (expected, actual) {
        (Image::Numbers(e), Image::Numbers(a)) => (compare(e, a), None),
        (Image::Picture(e), Image::Picture(a)) => pictures(e, a)?,
        _ => {
            return Err(Error::Usage(format!(
                "{} and {} hold different things: levels are compared with levels (.png), numbers with numbers (.npy)",
                reference.display(),
                candidate.display()
            )));
        }
    };
    Ok(Judgement {
        candidate,
        equal: comparison.is_equal(),
        rms: squared_error.map(SquaredError::rms),
        psnr: squared_error.and_then(SquaredError::psnr),
        comparison,
        squared_error,
    })
}

/// Grey pictures as they are; where one has colours, both in colours.
fn pictures(
    expected: &Picture,
    actual: &Picture,
) -> Result<(ImageComparison, Option<SquaredError>)> {
    let comparison = match (expected, actual) {
        (Picture::Grey(e), Picture::Grey(a)) => compare(e, a),
        _ => compare(&expected.clone().into_rgb(), &actual.clone().into_rgb()),
    };
    if matches!(comparison, ImageComparison::Sizes { .. }) {
        return Ok((comparison, None));
    }
    let [expected, actual] = [expected, actual].map(|picture| picture.clone().into_luma());
    Ok((comparison, Some(squared_error(&expected, &actual, 1)?)))
}

fn write_difference(
    options: &CompareArgs,
    path: &Path,
    expected: &Image,
    candidates: &[Image],
) -> Result<()> {
    let picture = |image: &Image| {
        match image {
        Image::Picture(picture) => Ok(picture.clone().into_rgb()),
        Image::Numbers(_) => Err(Error::Usage(
            "a difference picture is made of pictures (.png), not of numbers (.npy); leave --difference out".into(),
        )),
    }
    };
    let expected = picture(expected)?;
    let mut strips = Vec::new();
    for (candidate, file) in candidates.iter().zip(&options.candidates) {
        let strip = difference_strip(&expected, &picture(candidate)?, options.difference_scale())?;
        strips.push((strip, file.display().to_string()));
    }
    png::write_rgb(path, &sheet(&strips, 1, PADDING)?)
}
