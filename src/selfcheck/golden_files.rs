//! Goldens as files: the record, and pictures for eyes.
//!
//! A folder holds `golden.txt` and a PNG for every item with a picture. Pictures are decoded and compared by pixels.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{Group, Item, Mismatch, Record};
use crate::{
    Error, Result,
    encode::{
        atomic,
        hash::plane_sha256,
        json,
        png::{self, Picture},
        sheet::Ink,
    },
    metric::{
        difference::{ImageComparison, Levels, Pixel, compare},
        difference_strip,
    },
    raster::Grid,
};

/// File name of the record.
pub const RECORD_NAME: &str = "golden.txt";

/// Factor by which differences are magnified in a strip.
const SCALE: u8 = 4;

/// Where the picture of an item lies.
pub fn picture_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{}.png", name.replace('/', "_")))
}

/// Holds the items against the goldens in `folder`: values, and the pixels of pictures. Where something does not hold,
/// `out` gets a strip `expected | actual | difference` for every picture concerned, and `mismatches.json`.
///
/// A golden that is missing is a mismatch, and so is one that no case has.
///
/// # Errors
/// [`Error::Input`] for a damaged record; [`Error::Io`].
pub fn check(folder: &Path, items: &[Item], out: &Path) -> Result<Vec<Mismatch>> {
    check_groups(folder, &[], items, out)
}

/// Reads the record of a folder; it is empty where there is none.
fn recorded(folder: &Path) -> Result<Record> {
    let path = folder.join(RECORD_NAME);
    match fs::read_to_string(&path) {
        Ok(text) => Record::parse(&text, &path),
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(Record::default()),
        Err(e) => Err(Error::io("read", &path, e)),
    }
}

/// As [`check`], but only the goldens of these groups are asked for; all of them for no group.
///
/// # Errors
/// As [`check`].
pub fn check_groups(
    folder: &Path,
    groups: &[&Group],
    items: &[Item],
    out: &Path,
) -> Result<Vec<Mismatch>> {
    let mut record = recorded(folder)?;
    if !groups.is_empty() {
        record = record.of_groups(groups);
    }
    let mut mismatches = record.compare(items);
    let mut strips = Vec::new();
    for item in items {
        let Some(actual) = &item.picture else {
            continue;
        };
        let mismatch = |expected, pixels| Mismatch {
            name: format!("{}.png", item.name),
            expected,
            actual: Some(pixels_sha256(actual)),
            pixels,
        };
        let expected = match png::read(&picture_path(folder, &item.name)) {
            Ok(expected) => expected,
            Err(Error::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
                mismatches.push(mismatch(None, None));
                continue;
            }
            Err(e) => return Err(e),
        };
        if expected == *actual {
            continue;
        }
        let (pixels, strip) = difference(&expected, actual)?;
        match mismatches.iter_mut().find(|m| m.name == item.name) {
            Some(mismatch) => mismatch.pixels = Some(pixels),
            None => mismatches.push(mismatch(Some(pixels_sha256(&expected)), Some(pixels))),
        }
        strips.extend(strip.map(|strip| (picture_path(out, &item.name), strip)));
    }
    if !mismatches.is_empty() {
        atomic::folder(out)?;
        for (path, strip) in &strips {
            write(path, strip)?;
        }
        json::write(&out.join("mismatches.json"), &mismatches)?;
    }
    Ok(mismatches)
}

/// Makes the items the goldens of `folder`, which is created if it does not exist. Nothing else in it is touched, and
/// pictures whose pixels hold are left as they are.
///
/// # Errors
/// [`Error::Io`].
pub fn bless(folder: &Path, items: &[Item]) -> Result<()> {
    atomic::folder(folder)?;
    for item in items {
        if let Some(picture) = &item.picture {
            let path = picture_path(folder, &item.name);
            if !png::read(&path).is_ok_and(|old| old == *picture) {
                write(&path, picture)?;
            }
        }
    }
    let text = Record::of(items).to_text();
    atomic::write_bytes(&folder.join(RECORD_NAME), text.as_bytes())
}

fn write(path: &Path, picture: &Picture) -> Result<()> {
    match picture {
        Picture::Grey(plane) => png::write_grey(path, plane),
        Picture::Rgb(plane) => png::write_rgb(path, plane),
    }
}

fn pixels_sha256(picture: &Picture) -> String {
    match picture {
        Picture::Grey(plane) => plane_sha256(plane),
        Picture::Rgb(plane) => plane_sha256(plane),
    }
}

/// Says how two pictures differ, and shows it where they have the same size.
fn difference(expected: &Picture, actual: &Picture) -> Result<(String, Option<Picture>)> {
    match (expected, actual) {
        (Picture::Grey(e), Picture::Grey(a)) => difference_of(e, a, Picture::Grey),
        _ => {
            let (e, a) = (expected.clone().into_rgb(), actual.clone().into_rgb());
            difference_of(&e, &a, Picture::Rgb)
        }
    }
}

fn difference_of<P: Pixel + Ink + Levels>(
    expected: &Grid<P>,
    actual: &Grid<P>,
    picture: fn(Grid<P>) -> Picture,
) -> Result<(String, Option<Picture>)> {
    let found = compare(expected, actual);
    let strip = match found {
        ImageComparison::Sizes { .. } => None,
        _ => Some(picture(difference_strip(expected, actual, SCALE)?)),
    };
    Ok((found.to_string(), strip))
}
