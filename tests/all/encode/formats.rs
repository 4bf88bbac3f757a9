//! Files: pictures, arrays, reports, sheets, hashes.

use std::{collections::BTreeMap, fs, path::PathBuf};

use lodmark::{
    Error,
    encode::{
        atomic,
        hash::plane_sha256,
        json, npy,
        png::{self, Picture},
        sheet::{PADDING, sheet},
    },
    metric::difference_strip,
    raster::Grid,
};
use proptest::prelude::*;

use crate::support::folder;

fn file_with(folder: &tempfile::TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, bytes).expect("target is writable");
    path
}

fn plane<T: Arbitrary + Copy>() -> impl Strategy<Value = Grid<T>> {
    (1_u32..20, 1_u32..20).prop_flat_map(|(w, h)| {
        prop::collection::vec(any::<T>(), (w * h) as usize)
            .prop_map(move |v| Grid::new(w, h, v).expect("w * h values"))
    })
}

proptest! {
    #![proptest_config(crate::support::cases(40))]

    #[test]
    fn a_picture_reads_back_as_it_was_written(grey in plane::<u8>(), rgb in plane::<[u8; 3]>()) {
        let folder = folder();
        let path = folder.path().join("a.png");
        png::write_grey(&path, &grey).expect("written");
        prop_assert_eq!(png::read(&path).expect("read"), Picture::Grey(grey.clone()));
        prop_assert_eq!(Picture::Grey(grey.clone()).into_rgb().map(|p| p[1]), grey);
        png::write_rgb(&path, &rgb).expect("written");
        prop_assert_eq!(png::read(&path).expect("read"), Picture::Rgb(rgb.clone()));
        prop_assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
    }

    #[test]
    fn a_damaged_picture_is_an_error_and_never_a_panic(
        rgb in plane::<[u8; 3]>(),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..5),
        cut in any::<prop::sample::Index>(),
    ) {
        let folder = folder();
        let path = folder.path().join("a.png");
        png::write_rgb(&path, &rgb).expect("written");
        let mut bytes = fs::read(&path).expect("read");
        for (at, value) in damage {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        let cut = cut.index(bytes.len() + 1);
        for bytes in [&bytes[..], &bytes[..cut]] {
            if let Err(e) = png::read(&file_with(&folder, "b.png", bytes)) {
                prop_assert!(matches!(e, Error::Input { .. } | Error::Unsupported(_)), "{e}");
            }
        }
    }

    #[test]
    fn an_array_reads_back_as_it_was_written(
        ids in plane::<u32>(),
        points in prop::collection::vec(prop::array::uniform3(-1e30_f32..1e30), 0..20),
        levels in plane::<u8>(),
    ) {
        let folder = folder();
        let path = folder.path().join("a.npy");
        npy::write_plane(&path, &ids).expect("written");
        prop_assert_eq!(npy::read_plane::<u32>(&path).expect("read"), ids.clone());
        prop_assert!(npy::read_plane::<f32>(&path).is_err(), "the type is part of the array");
        let bytes = fs::read(&path).expect("read");
        let cut = file_with(&folder, "cut.npy", &bytes[..bytes.len() - 1]);
        prop_assert_eq!(npy::read_plane::<u32>(&cut).expect_err("cut off").exit_code(), 3);
        let depth = ids.map(|id| id as f32 * 0.5);
        npy::write_plane(&path, &depth).expect("written");
        prop_assert_eq!(npy::read_plane::<f32>(&path).expect("read"), depth);
        npy::write_plane(&path, &levels).expect("written");
        prop_assert_eq!(npy::read_plane::<u8>(&path).expect("read"), levels);
        npy::write_rows(&path, &points).expect("written");
        prop_assert_eq!(npy::read_rows::<f32>(&path).expect("read"), points);
    }

    #[test]
    fn a_damaged_array_is_an_error_and_never_a_panic(
        levels in plane::<u8>(),
        damage in prop::collection::vec((0_usize..140, any::<u8>()), 1..5),
        cut in 0_usize..160,
    ) {
        let folder = folder();
        let path = folder.path().join("a.npy");
        npy::write_plane(&path, &levels).expect("written");
        let mut bytes = fs::read(&path).expect("read");
        for (at, value) in damage {
            if let Some(byte) = bytes.get_mut(at) {
                *byte = value;
            }
        }
        for bytes in [&bytes[..], &bytes[..cut.min(bytes.len())]] {
            let path = file_with(&folder, "b.npy", bytes);
            if let Err(e) = npy::read_plane::<u8>(&path) {
                prop_assert_eq!(e.exit_code(), 3);
            }
            let _ = npy::read_rows::<u8>(&path);
        }
    }

    #[test]
    fn a_hash_changes_with_every_pixel_and_with_the_shape(
        image in plane::<u8>(),
        at in any::<prop::sample::Index>(),
        change in 1_u8..=255,
    ) {
        let hash = plane_sha256(&image);
        let mut other = image.clone();
        let at = at.index(other.values().len());
        other.values_mut()[at] ^= change;
        prop_assert_ne!(plane_sha256(&other), hash.clone());
        let row = Grid::new(image.values().len() as u32, 1, image.values().to_vec()).expect("same number");
        prop_assert_eq!(plane_sha256(&row) == hash, image.height() == 1);
    }
}

#[test]
fn an_npy_file_has_the_bytes_that_numpy_writes() {
    let folder = folder();
    let path = folder.path().join("a.npy");
    let ids = Grid::new(2, 1, vec![1_u32, 0x0102_0304]).expect("2 values");
    npy::write_plane(&path, &ids).expect("written");
    let bytes = fs::read(&path).expect("read");
    assert_eq!(bytes[..8], *b"\x93NUMPY\x01\x00");
    let header = String::from_utf8_lossy(&bytes[10..bytes.len() - 8]).into_owned();
    for part in ["'descr': '<u4'", "'fortran_order': False", "'shape': (1, 2"] {
        assert!(header.contains(part), "{part} in {header}");
    }
    assert_eq!((bytes.len() - 8) % 64, 0, "data is aligned");
    assert_eq!(bytes[bytes.len() - 8..], [1, 0, 0, 0, 4, 3, 2, 1]);
}

#[test]
fn an_array_that_claims_more_than_its_file_holds_is_refused() {
    let folder = folder();
    let path = folder.path().join("a.npy");
    npy::write_plane(&path, &Grid::filled(9, 9, 7_u8)).expect("written");
    let bytes = fs::read(&path).expect("read");
    let mut file = bytes[..10].to_vec();
    let body = format!(
        "{:<117}\n",
        "{'descr': '|u1', 'fortran_order': False, 'shape': (9999999999, 9999999999), }"
    );
    file.extend_from_slice(body.as_bytes());
    let error = npy::read_plane::<u8>(&file_with(&folder, "b.npy", &file)).expect_err("too large");
    assert_eq!(error.exit_code(), 3, "{error}");
}

#[test]
fn a_hash_is_that_of_size_and_little_endian_values() {
    // sha256(struct.pack("<3I", w, h, bytes per pixel) + array bytes), computed with Python's hashlib.
    let ids = Grid::new(2, 1, vec![1_u32, 0x0102_0304]).expect("2 values");
    let known = "bf4cbcc651f9cd94a4ba55a93a0a7d424c0376388d75828feb9848d7596be6ec";
    assert_eq!(plane_sha256(&ids), known);
    let colours = Grid::new(1, 2, vec![[1_u8, 2, 3], [4, 5, 6]]).expect("2 values");
    let known = "8ce1c03b80056fb6a460ee3e2fe4806a652245300e854ddbfc307c0e4e71b92e";
    assert_eq!(plane_sha256(&colours), known);
}

#[test]
fn a_picture_that_claims_a_size_it_cannot_have_is_refused_before_it_is_allocated() {
    let folder = folder();
    let path = folder.path().join("a.png");
    png::write_grey(&path, &Grid::filled(3, 3, 7)).expect("written");
    let bytes = fs::read(&path).expect("read");
    for (side, word) in [(16_384_u32, "hold"), (20_000, ""), (u32::MAX, "")] {
        let mut hostile = bytes.clone();
        hostile[16..20].copy_from_slice(&side.to_be_bytes());
        hostile[20..24].copy_from_slice(&side.to_be_bytes());
        let crc = crc32(&hostile[12..29]);
        hostile[29..33].copy_from_slice(&crc.to_be_bytes());
        let error = png::read(&file_with(&folder, "b.png", &hostile)).expect_err("hostile");
        assert_eq!(error.exit_code(), 3, "{error}");
        assert!(error.to_string().contains(word), "{side}: {error}");
    }
    let text = file_with(&folder, "c.png", b"solid");
    assert_eq!(png::read(&text).expect_err("no PNG").exit_code(), 3);
    let missing = folder.path().join("missing.png");
    assert_eq!(png::read(&missing).expect_err("no file").exit_code(), 5);
    assert!(png::write_grey(&path, &Grid::filled(0, 3, 7)).is_err());
}

/// The checksum of PNG chunks, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 };
        }
    }
    !crc
}

#[test]
fn transparency_is_refused_and_not_ignored() {
    let folder = folder();
    let path = folder.path().join("a.png");
    image::RgbaImage::new(2, 2).save(&path).expect("written");
    assert_eq!(png::read(&path).expect_err("alpha").exit_code(), 4);
    image::ImageBuffer::<image::Luma<u16>, _>::new(2, 2)
        .save(&path)
        .expect("written");
    assert_eq!(png::read(&path).expect_err("16 bits").exit_code(), 4);
}

#[test]
fn a_report_has_one_form_and_no_infinities() {
    #[derive(serde::Serialize)]
    struct Report {
        schema: u32,
        rms: f64,
        psnr: f64,
        views: Vec<Option<f64>>,
    }
    let value = Report {
        schema: 1,
        rms: 0.1,
        psnr: f64::INFINITY,
        views: vec![None, Some(f64::NAN), Some(1e-7)],
    };
    let text = "{\n  \"schema\": 1,\n  \"rms\": 0.1,\n  \"psnr\": null,\n  \"views\": [\n    null,\n    null,\n    \
                1e-7\n  ]\n}\n";
    assert_eq!(json::to_text(&value).expect("has a JSON form"), text);
    let folder = folder();
    let path = folder.path().join("a.json");
    json::write(&path, &value).expect("written");
    assert_eq!(fs::read_to_string(&path).expect("read"), text);
    let sorted = json::to_text(&serde_json::json!({"b": 1, "a": 2})).expect("JSON");
    assert_eq!(sorted, "{\n  \"a\": 2,\n  \"b\": 1\n}\n");
    let keyless: BTreeMap<[u8; 2], u8> = [([1, 2], 3)].into();
    let refused = json::to_text(&keyless).expect_err("no string");
    assert_eq!(refused.exit_code(), 70);
}

#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let folder = folder();
    let path = file_with(&folder, "a.txt", b"old");
    let failed = atomic::write(&path, |file| {
        file.write_all(b"new")?;
        Err(std::io::Error::other("disk full"))
    });
    assert_eq!(failed.expect_err("failed").exit_code(), 5);
    assert_eq!(fs::read(&path).expect("read"), b"old");
    assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
}

#[test]
fn a_label_is_drawn_below_its_picture() {
    let picture = Grid::filled(30, 4, 50_u8);
    let drawn = sheet(&[(&picture, "rms 1"), (&picture, "")], 2, 1).expect("small");
    let character = |level| match level {
        0 => '#',
        50 => 'o',
        _ => ' ',
    };
    let line = |y| {
        (0..drawn.width())
            .map(|x| character(drawn.at(x, y)))
            .collect::<String>()
    };
    let rows = (0..drawn.height()).map(|y| line(y).trim_end().to_string());
    let rows: Vec<String> = rows.collect();
    let both = format!(" {0} {0}", "o".repeat(30));
    let expected = [
        "",
        &both,
        &both,
        &both,
        &both,
        "",
        "",
        "                           #",
        "                          ##",
        " # ##  ## #   ####         #",
        " ##    # # # #             #",
        " #     # # #  ###          #",
        " #     # # #     #         #",
        " #     # # # ####         ###",
        "",
    ];
    assert_eq!(rows, expected, "\n{}", rows.join("\n"));
}

#[test]
fn a_long_label_is_cut_and_does_not_run_into_the_next_picture() {
    let picture = Grid::filled(20, 3, [9_u8; 3]);
    let labelled = |label| sheet(&[(&picture, label), (&picture, "x")], 2, PADDING).expect("small");
    assert_eq!(labelled("abcdefghij"), labelled("abc"));
}

#[test]
fn a_sheet_that_no_file_could_hold_is_refused() {
    let picture = Grid::filled(4096, 1, 0_u8);
    let tiles = [(&picture, ""); 5];
    let refused = sheet(&tiles, 5, PADDING).expect_err("too wide");
    assert_eq!(refused.exit_code(), 2);
    assert!(sheet(&tiles, u32::MAX, PADDING).is_err());
    assert!(sheet(&tiles, 2, PADDING).is_ok());
    assert!(sheet(&tiles[..0], 1, PADDING).is_err());
    assert!(sheet(&tiles, 0, PADDING).is_err());
    assert!(sheet(&tiles[..1], 1, u32::MAX).is_err());
}

#[test]
fn a_difference_strip_shows_expected_actual_and_difference_in_this_order() {
    let expected = Grid::filled(80, 10, 100_u8);
    let mut actual = expected.clone();
    actual.values_mut()[0] = 110;
    let strip = difference_strip(&expected, &actual, 4).expect("same size");
    let corners = [0, 1, 2].map(|i| strip.at(8 + 88 * i, 8));
    assert_eq!(corners, [100, 110, 168]);
    assert_eq!(strip.at(8 + 88 * 2 + 1, 8), 128);
    let smaller = Grid::filled(8, 10, 100_u8);
    assert!(difference_strip(&expected, &smaller, 4).is_err());
}
