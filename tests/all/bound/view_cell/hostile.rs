//! Cell files that nobody would write: every answer is a cell or a refusal, and what is a cell can be asked.

use glam::DVec3;
use lodmark::bound::{
    point::{Aperture, extent},
    view_cell::{ViewCell, file},
};
use proptest::prelude::*;

use crate::support::{at, cases, split, square};

/// One file of each kind.
fn files() -> Vec<String> {
    let [a, b, c, d] = square();
    let up = at(0.0, 0.0, 1.0);
    [
        ViewCell::point(a),
        ViewCell::segment([a, c]),
        ViewCell::line(a, up),
        ViewCell::polygon(&[a, b, c, d]),
        ViewCell::plane(a, up),
        ViewCell::polyhedron(&[a, b, c, up]),
        ViewCell::half_space(a, up),
    ]
    .map(|cell| file::to_json(&cell.expect("a cell")).expect("has a form"))
    .into()
}

fn file_of(body: &str) -> String {
    format!("{{\"schema\": 1, \"cell\": {{{body}}}}}")
}

/// Refused as input, or a cell that gives numbers when asked.
fn judge(text: &str) -> Result<bool, String> {
    match file::from_json(text, "cell.json") {
        Err(error) if error.exit_code() == 3 => Ok(false),
        Err(error) => Err(format!("exit code {}: {error}", error.exit_code())),
        Ok(cell) => {
            let aperture = Aperture::degrees(1.0).expect("below 90");
            for p in [DVec3::ZERO, at(3.0, -2.0, 7.0)] {
                let t = extent(&cell, p, DVec3::X, aperture).length;
                let away = cell.distance_to_point(p);
                if t.is_nan() || t < 0.0 || away.is_nan() || away < 0.0 {
                    return Err(format!("{cell:?}: extent {t}, distance {away}"));
                }
            }
            Ok(true)
        }
    }
}

#[test]
fn a_cell_file_cut_off_anywhere_is_refused() {
    for text in files() {
        assert_eq!(judge(&text), Ok(true), "{text}");
        for end in 0..text.trim_end().len() {
            assert_eq!(judge(&text[..end]), Ok(false), "{}", &text[..end]);
        }
    }
}

#[test]
fn deep_or_endless_cell_files_cost_no_more_than_their_bytes() {
    let deep = |open: &str, close: &str| open.repeat(100_000) + &close.repeat(100_000);
    for text in [
        deep("[", "]"),
        deep("{\"schema\":", "}"),
        file_of(&format!("\"point\": {}", deep("[", "]"))),
        file_of(&format!(
            "\"polygon\": [{}[0,0,0]]",
            "[1,2,3],".repeat(20_000)
        )),
        "\0".repeat(1000),
        "\u{feff}{\"schema\": 1, \"cell\": {\"point\": [0,0,0]}}".into(),
    ] {
        assert_eq!(judge(&text), Ok(false), "{}", &text[..60]);
    }
    let folder = crate::support::folder();
    let path = folder.path().join("cell.json");
    for (bytes, said) in [
        (vec![b' '; (1 << 20) + 1], "more than"),
        (vec![0xff, 0xfe, 0x00], "utf-8"),
        (Vec::new(), "cell file"),
    ] {
        std::fs::write(&path, bytes).expect("writes");
        let error = file::read(&path).expect_err("no cell");
        assert_eq!(error.exit_code(), 3);
        assert!(error.to_string().contains(said), "{error}");
    }
    let refused = file::read(folder.path()).expect_err("a folder");
    assert_eq!(refused.exit_code(), 5);
}

/// Numbers as files have them, and as they do not.
fn number() -> impl Strategy<Value = String> {
    let odd = "NaN Infinity -Infinity 1e999 -1e999 1e308 -1.7976931348623157e308 1e-320 -0.0 5e-324 1e154 1e-160 \
               null \"1\" true [] 0x10 1_000 +1 01 12345678901234567890123456789012345678901234567890";
    prop_oneof![
        3 => (-3_i32..4).prop_map(|i| i.to_string()),
        1 => prop::sample::select(split(odd)).prop_map(String::from),
    ]
}

fn vector() -> impl Strategy<Value = String> {
    prop::collection::vec(number(), 3).prop_map(|v| format!("[{}]", v.join(",")))
}

fn body() -> impl Strategy<Value = String> {
    let pair = |kind: &'static str, a: &'static str, b: &'static str| {
        let both = (vector(), vector());
        both.prop_map(move |(p, q)| format!("\"{kind}\": {{\"{a}\": {p}, \"{b}\": {q}}}"))
    };
    let list = |kind: &'static str, n: std::ops::Range<usize>| {
        let all = prop::collection::vec(vector(), n);
        all.prop_map(move |v| format!("\"{kind}\": [{}]", v.join(",")))
    };
    prop_oneof![
        vector().prop_map(|v| format!("\"point\": {v}")),
        list("segment", 1..4),
        pair("line", "point", "direction"),
        list("polygon", 0..7),
        pair("plane", "point", "normal"),
        list("polyhedron", 0..9),
        pair("box", "low", "high"),
        pair("half_space", "point", "normal"),
    ]
}

proptest! {
    #![proptest_config(cases(2_000))]

    #[test]
    fn a_cell_file_with_damaged_bytes_is_never_a_panic(
        which in 0_usize..7,
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0_u8..3), 1..4),
    ) {
        let mut bytes = files()[which].clone().into_bytes();
        for (place, byte, how) in damage {
            let i = place.index(bytes.len());
            match how {
                0 => bytes[i] = byte,
                1 => bytes.insert(i, byte),
                _ => { bytes.remove(i); }
            }
        }
        let answer = judge(&String::from_utf8_lossy(&bytes));
        prop_assert!(answer.is_ok(), "{answer:?}");
    }

    #[test]
    fn a_cell_of_odd_numbers_is_never_a_panic(body in body()) {
        let text = file_of(&body);
        let answer = judge(&text);
        prop_assert!(answer.is_ok(), "{text}: {answer:?}");
    }
}
