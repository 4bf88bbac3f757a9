//! Cell files that nobody would write: every answer is a cell or a refusal, and what is a cell can be asked.

use glam::DVec3;
use lodmark::bound::{
    point::{Aperture, extent},
    view_cell::{ViewCell, file},
};
use proptest::prelude::*;

use super::{at, square};
use crate::support::cases;

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
        format!(
            "{{\"schema\": 1, \"cell\": {{\"point\": {}}}}}",
            deep("[", "]")
        ),
        format!(
            "{{\"schema\": 1, \"cell\": {{\"polygon\": [{}[0,0,0]]}}}}",
            "[1,2,3],".repeat(20_000)
        ),
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
    assert_eq!(
        file::read(folder.path()).expect_err("a folder").exit_code(),
        5
    );
}

/// Numbers as files have them, and as they do not.
fn number() -> impl Strategy<Value = String> {
    let odd = [
        "NaN",
        "Infinity",
        "-Infinity",
        "1e999",
        "-1e999",
        "1e308",
        "-1.7976931348623157e308",
        "1e-320",
        "-0.0",
        "5e-324",
        "1e154",
        "1e-160",
        "null",
        "\"1\"",
        "true",
        "[]",
        "0x10",
        "1_000",
        "+1",
        "01",
        "12345678901234567890123456789012345678901234567890",
    ];
    prop_oneof![
        3 => (-3_i32..4).prop_map(|i| i.to_string()),
        1 => prop::sample::select(odd.to_vec()).prop_map(String::from),
    ]
}

fn vector() -> impl Strategy<Value = String> {
    prop::collection::vec(number(), 3).prop_map(|v| format!("[{}]", v.join(",")))
}

fn body() -> impl Strategy<Value = String> {
    let pair = |a: &'static str, b: &'static str| {
        (vector(), vector())
            .prop_map(move |(p, q)| format!("{{\"{a}\": {p}, \"{b}\": {q}}}"))
            .boxed()
    };
    let list = |n: std::ops::Range<usize>| {
        prop::collection::vec(vector(), n)
            .prop_map(|v| format!("[{}]", v.join(",")))
            .boxed()
    };
    prop_oneof![
        vector().prop_map(|v| format!("\"point\": {v}")),
        list(1..4).prop_map(|v| format!("\"segment\": {v}")),
        pair("point", "direction").prop_map(|v| format!("\"line\": {v}")),
        list(0..7).prop_map(|v| format!("\"polygon\": {v}")),
        pair("point", "normal").prop_map(|v| format!("\"plane\": {v}")),
        list(0..9).prop_map(|v| format!("\"polyhedron\": {v}")),
        pair("low", "high").prop_map(|v| format!("\"box\": {v}")),
        pair("point", "normal").prop_map(|v| format!("\"half_space\": {v}")),
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
        let text = format!("{{\"schema\": 1, \"cell\": {{{body}}}}}");
        let answer = judge(&text);
        prop_assert!(answer.is_ok(), "{text}: {answer:?}");
    }
}
