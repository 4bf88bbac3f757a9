//! `lodmark bound` and `lodmark bound-region` as a user runs them.

use std::fs;

use glam::DVec3;
use lodmark::{
    io,
    mesh::{Mesh, generate},
};
use tempfile::TempDir;

use crate::support::{code, expect, folder, json, lodmark, put, split, stdout};

/// A sphere, a coarser one, and a segment cell beside them.
fn scene() -> TempDir {
    let dir = folder();
    put(&dir, "ref.ply", &generate::icosphere(3));
    put(&dir, "low.ply", &generate::icosphere(2));
    let cell = r#"{"schema": 1, "cell": {"segment": [[-1, 0, 5], [1, 0, 5]]}}"#;
    fs::write(dir.path().join("cell.json"), cell).expect("writes");
    dir
}

#[test]
fn a_bound_names_the_worst_point_its_viewer_and_what_tests_would_have_claimed() {
    let dir = scene();
    let mut reports = Vec::new();
    for threads in ["1", "3"] {
        let words = [
            "bound",
            "ref.ply",
            "low.ply",
            "--cell",
            "cell.json",
            "--heuristics",
            "--pictures",
            "worst",
            "--size",
            "64",
            "--switch-px",
            "1",
            "--json",
            "report.json",
            "--threads",
            threads,
        ];
        expect(&dir, 0, &words);
        reports.push(fs::read(dir.path().join("report.json")).expect("written"));
    }
    assert!(reports[0] == reports[1], "threads change nothing");
    let report = json(&dir, "report.json");
    let number = |name: &str| report[name].as_f64().expect(name);
    assert!(number("bound_deg") >= number("attained_deg"));
    assert!(number("bound_deg") <= 1.01001 * number("attained_deg"));
    assert!(number("vertices_deg") <= number("bound_deg"));
    assert!(report["worst"]["viewpoint"][2] == 5.0, "{report}");
    assert_eq!(report["map"], "nearest triangle");
    // 1 pixel of 1080 in 60 degrees.
    assert!((number("switch_angle_deg") - 0.0612594).abs() < 1e-6);
    let expected = number("distance_bound") / (number("switch_angle_deg").to_radians());
    assert!((number("switch_distance") / expected - 1.0).abs() < 1e-2);
    for name in ["worst-view.png", "worst-zoom.png"] {
        let bytes = fs::read(dir.path().join("worst").join(name)).expect("written");
        assert!(bytes.starts_with(b"\x89PNG"));
    }
    // The views can be drawn again.
    expect(&dir, 0, "render low.ply again --views worst/views.json");
}

#[test]
fn a_recorded_map_is_bounded_below_the_angle_that_it_was_made_for() {
    let dir = scene();
    let words = split(
        "simplify ref.ply out.ply --method view-bounded --cell cell.json --error-deg 0.3 --bound-out map.bin",
    );
    expect(&dir, 0, &words);
    let bound = |low: &'static str| {
        vec![
            "bound",
            "ref.ply",
            low,
            "--cell",
            "cell.json",
            "--correspondence",
            "map.bin",
            "--json",
            "report.json",
        ]
    };
    expect(&dir, 0, &bound("out.ply"));
    let report = json(&dir, "report.json");
    let (bound_deg, attained) = (
        report["bound_deg"].as_f64().expect("a number"),
        report["attained_deg"].as_f64().expect("a number"),
    );
    assert!(attained > 0.0 && attained <= 0.3, "{report}");
    assert!(bound_deg <= 0.3 * 1.011, "{report}");
    assert_eq!(report["map"], "correspondence");
    let said = expect(&dir, 3, &bound("low.ply"));
    assert!(said.contains("another simplified mesh"), "{said}");
    let bytes = fs::read(dir.path().join("map.bin")).expect("written");
    for damaged in [
        &bytes[..bytes.len() / 2],
        &bytes[..10],
        b"nothing of the kind",
    ] {
        fs::write(dir.path().join("map.bin"), damaged).expect("writes");
        expect(&dir, 3, &bound("out.ply"));
    }
    let mut flipped = bytes.clone();
    flipped[200] ^= 1;
    fs::write(dir.path().join("map.bin"), flipped).expect("writes");
    let said = expect(&dir, 3, &bound("out.ply"));
    assert!(said.contains("checksum"), "{said}");
}

#[test]
fn a_question_without_an_answer_is_refused_with_the_reason() {
    let dir = scene();
    fs::write(dir.path().join("empty.obj"), "# nothing\n").expect("writes");
    fs::write(
        dir.path().join("bad.json"),
        r#"{"schema": 1, "cell": {"ball": 1}}"#,
    )
    .expect("writes");
    for (exit, words, said) in [
        (2, vec!["bound", "ref.ply", "low.ply"], "--cell"),
        (
            2,
            split("bound ref.ply low.ply --cell cell.json --precision 0"),
            "precision",
        ),
        (
            2,
            vec!["bound", "ref.ply", "low.ply", "--switch-deg", "90"],
            "less than 90",
        ),
        (
            2,
            vec!["bound", "ref.ply", "low.ply", "--switch-px", "-1"],
            "pixels",
        ),
        (
            3,
            vec!["bound", "ref.ply", "low.ply", "--cell", "bad.json"],
            "half_space",
        ),
        (
            5,
            vec!["bound", "ref.ply", "low.ply", "--cell", "none.json"],
            "none.json",
        ),
        (
            3,
            vec!["bound", "ref.ply", "empty.obj", "--cell", "cell.json"],
            "empty",
        ),
        (
            2,
            split("bound-region o.svg --cell cell.json --point 0,1 --error-deg 1"),
            "three numbers",
        ),
        (
            2,
            split("bound-region o.svg --cell cell.json --point 0,1,0 --error-deg 90"),
            "less than 90",
        ),
        (
            2,
            split("bound-region o.step --cell cell.json --point 0,1,0 --error-deg 1"),
            ".obj",
        ),
        (
            2,
            split("bound-region o.ply --cell cell.json --point 0,1,0 --error-deg 1 --directions 9"),
            "figure",
        ),
        (
            2,
            split("bound-region o.ply --cell cell.json --point 0,1,0 --error-deg 1 --reach 0"),
            "reach",
        ),
    ] {
        let message = expect(&dir, exit, &words);
        assert!(message.contains(said), "{words:?} said {message}");
    }
}

#[test]
fn points_without_faces_are_bounded_as_a_cloud() {
    let dir = scene();
    let positions = generate::icosphere(1).positions().to_vec();
    let moved = positions.iter().map(|&p| p + 0.125 * DVec3::X).collect();
    put(
        &dir,
        "cloud.obj",
        &Mesh::from_triangles(positions, Vec::new()).expect("valid"),
    );
    put(
        &dir,
        "moved.obj",
        &Mesh::from_triangles(moved, Vec::new()).expect("valid"),
    );
    let output = lodmark(&dir, "bound cloud.obj moved.obj --cell cell.json");
    assert_eq!(code(&output), 0, "{output:?}");
    assert!(stdout(&output).contains("guaranteed"));
}

#[test]
fn a_validity_region_is_drawn_as_a_figure_and_as_a_closed_surface() {
    let dir = scene();
    let words = |out: &'static str| {
        vec![
            "bound-region",
            out,
            "--cell",
            "cell.json",
            "--point",
            "0,0,0",
            "--point",
            "0,-2,1",
            "--error-deg",
            "5",
        ]
    };
    expect(&dir, 0, &words("region.svg"));
    let figure = fs::read_to_string(dir.path().join("region.svg")).expect("written");
    assert!(figure.starts_with("<svg") && figure.ends_with("</svg>\n"));
    assert_eq!(figure.matches("<polygon").count(), 2);
    assert!(
        !figure.contains("NaN") && !figure.contains("inf"),
        "{figure}"
    );
    expect(&dir, 0, &words("region.ply"));
    let mesh = io::read(&dir.path().join("region.ply"))
        .expect("reads")
        .mesh;
    assert_eq!(mesh.triangles().len(), 2 * 20 * 256);
    expect(&dir, 0, "check region.ply");
}

#[test]
fn a_region_without_a_surface_is_not_written_as_a_mesh() {
    let dir = scene();
    let words = |out: &'static str, point: &'static str, angle: &'static str| {
        let fixed = ["bound-region", out, "--cell", "cell.json"];
        [&fixed[..], &["--point", point, "--error-deg", angle]].concat()
    };
    // In the cell, at its end, and without an angle.
    for (point, angle, said) in [
        ("0.5,0,5", "5", "may stand on it"),
        ("1,0,5", "5", "may stand on it"),
        ("0,0,0", "0", "without an angle"),
    ] {
        let message = expect(&dir, 2, &words("none.ply", point, angle));
        assert!(message.contains(said), "{message}");
        assert!(!dir.path().join("none.ply").exists());
        // A figure shows the point; it says so where viewers may stand on it.
        let message = expect(&dir, 0, &words("point.svg", point, angle));
        assert_eq!(
            message.contains("may not move at all"),
            angle != "0",
            "{message}"
        );
        let figure = fs::read_to_string(dir.path().join("point.svg")).expect("written");
        assert!(figure.contains("<circle") && !figure.contains("NaN"));
    }
    // Near a right angle the region is wide, and still a closed surface.
    for out in ["wide.svg", "wide.ply"] {
        expect(&dir, 0, &words(out, "0,0,0", "89.999"));
    }
    let mesh = io::read(&dir.path().join("wide.ply")).expect("reads").mesh;
    assert!(mesh.positions().iter().all(|p| p.is_finite()));
    expect(&dir, 0, "check wide.ply");
}
