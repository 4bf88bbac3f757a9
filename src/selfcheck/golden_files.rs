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
    },
    metric::{difference::compare, difference_strip},
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
    check_recorded(folder, recorded(folder)?, items, out)
}

/// As [`check`], but only the goldens of some groups are asked for.
///
/// # Errors
/// As [`check`].
pub fn check_groups(
    folder: &Path,
    groups: &[&Group],
    items: &[Item],
    out: &Path,
) -> Result<Vec<Mismatch>> {
    let record = recorded(folder)?.of_groups(groups);
    check_recorded(folder, record, items, out)
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

fn check_recorded(
    folder: &Path,
    record: Record,
    items: &[Item],
    out: &Path,
) -> Result<Vec<Mismatch>> {
    let mut mismatches = record.compare(items);
    let mut strips = Vec::new();
    for item in items {
        let Some(actual) = &item.picture else {
            continue;
        };
        let path = picture_path(folder, &item.name);
        let expected = match png::read(&path) {
            Ok(expected) => expected,
            Err(Error::Io { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
                mismatches.push(Mismatch {
                    name: format!("{}.png", item.name),
                    expected: None,
                    actual: Some(pixels_sha256(actual)),
                    pixels: None,
                });
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
            None => mismatches.push(Mismatch {
                name: format!("{}.png", item.name),
                expected: Some(pixels_sha256(&expected)),
                actual: Some(pixels_sha256(actual)),
                pixels: Some(pixels),
            }),
        }
        strips.extend(strip.map(|strip| (picture_path(out, &item.name), strip)));
    }
    if !mismatches.is_empty() {
        fs::create_dir_all(out).map_err(|e| Error::io("create", out, e))?;
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
    fs::create_dir_all(folder).map_err(|e| Error::io("create", folder, e))?;
    for item in items {
        if let Some(picture) = &item.picture {
            let path = picture_path(folder, &item.name);
            if !png::read(&path).is_ok_and(|old| old == *picture) {
                write(&path, picture)?;
            }
        }
    }
    let text = Record::of(items).to_text();
    atomic::write(&folder.join(RECORD_NAME), |file| {
        file.write_all(text.as_bytes())
    })
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
    let size = |p: &Picture| match p {
        Picture::Grey(plane) => (plane.width(), plane.height()),
        Picture::Rgb(plane) => (plane.width(), plane.height()),
    };
    let same_size = size(expected) == size(actual);
    match (expected, actual) {
        (Picture::Grey(e), Picture::Grey(a)) => {
            let strip = same_size.then(|| difference_strip(e, a, SCALE));
            let strip = strip.transpose()?.map(Picture::Grey);
            Ok((compare(e, a).to_string(), strip))
        }
        _ => {
            let (e, a) = (expected.clone().into_rgb(), actual.clone().into_rgb());
            let strip = same_size.then(|| difference_strip(&e, &a, SCALE));
            let strip = strip.transpose()?.map(Picture::Rgb);
            Ok((compare(&e, &a).to_string(), strip))
        }
    }
}
