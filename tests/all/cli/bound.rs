//! `lodmark bound` and `lodmark bound-region` as a user runs them.

use std::fs;

use glam::DVec3;
use lodmark::{
    io,
    mesh::{Mesh, generate},
};
use tempfile::TempDir;

use crate::support::{bytes, code, expect, folder, json, lodmark, put, refused, stdout, text};

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
        let words = format!(
            "bound ref.ply low.ply --cell cell.json --heuristics --pictures worst --size 64 --switch-px 1 \
             --json report.json --threads {threads}"
        );
        expect(&dir, 0, &words);
        reports.push(bytes(&dir, "report.json"));
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
    for name in ["worst/worst-view.png", "worst/worst-zoom.png"] {
        assert!(bytes(&dir, name).starts_with(b"\x89PNG"));
    }
    // The views can be drawn again.
    expect(&dir, 0, "render low.ply again --views worst/views.json");
}

#[test]
fn a_recorded_map_is_bounded_below_the_angle_that_it_was_made_for() {
    let dir = scene();
    let words = "simplify ref.ply out.ply --method view-bounded --cell cell.json --error-deg 0.3 --bound-out map.bin";
    expect(&dir, 0, words);
    let bound = |low: &str| {
        format!("bound ref.ply {low} --cell cell.json --correspondence map.bin --json report.json")
    };
    expect(&dir, 0, &bound("out.ply"));
    let report = json(&dir, "report.json");
    let [bound_deg, attained] =
        ["bound_deg", "attained_deg"].map(|name| report[name].as_f64().expect("a number"));
    assert!(attained > 0.0 && attained <= 0.3, "{report}");
    assert!(bound_deg <= 0.3 * 1.011, "{report}");
    assert_eq!(report["map"], "correspondence");
    refused(&dir, 3, &bound("low.ply"), "another simplified mesh");
    let mut map = bytes(&dir, "map.bin");
    for damaged in [&map[..map.len() / 2], &map[..10], b"nothing of the kind"] {
        fs::write(dir.path().join("map.bin"), damaged).expect("writes");
        expect(&dir, 3, &bound("out.ply"));
    }
    map[200] ^= 1;
    fs::write(dir.path().join("map.bin"), map).expect("writes");
    refused(&dir, 3, &bound("out.ply"), "checksum");
}

#[test]
fn a_question_without_an_answer_is_refused_with_the_reason() {
    let dir = scene();
    fs::write(dir.path().join("empty.obj"), "# nothing\n").expect("writes");
    let ball = r#"{"schema": 1, "cell": {"ball": 1}}"#;
    fs::write(dir.path().join("bad.json"), ball).expect("writes");
    for (exit, words, said) in [
        (2, "", "--cell"),
        (2, "--cell cell.json --precision 0", "precision"),
        (2, "--switch-deg 90", "less than 90"),
        (2, "--switch-px -1", "pixels"),
        (3, "--cell bad.json", "half_space"),
        (5, "--cell none.json", "none.json"),
    ] {
        refused(&dir, exit, &format!("bound ref.ply low.ply {words}"), said);
    }
    refused(&dir, 3, "bound ref.ply empty.obj --cell cell.json", "empty");
    for (words, said) in [
        ("o.svg --point 0,1 --error-deg 1", "three numbers"),
        ("o.svg --point 0,1,0 --error-deg 90", "less than 90"),
        ("o.step --point 0,1,0 --error-deg 1", ".obj"),
        ("o.ply --point 0,1,0 --error-deg 1 --directions 9", "figure"),
        ("o.ply --point 0,1,0 --error-deg 1 --reach 0", "reach"),
    ] {
        refused(
            &dir,
            2,
            &format!("bound-region {words} --cell cell.json"),
            said,
        );
    }
}

#[test]
fn points_without_faces_are_bounded_as_a_cloud() {
    let dir = scene();
    let positions = generate::icosphere(1).positions().to_vec();
    let moved = positions.iter().map(|&p| p + 0.125 * DVec3::X).collect();
    for (name, points) in [("cloud.obj", positions), ("moved.obj", moved)] {
        let cloud = Mesh::from_triangles(points, Vec::new()).expect("valid");
        put(&dir, name, &cloud);
    }
    let output = lodmark(&dir, "bound cloud.obj moved.obj --cell cell.json");
    assert_eq!(code(&output), 0, "{output:?}");
    assert!(stdout(&output).contains("guaranteed"));
}

#[test]
fn a_validity_region_is_drawn_as_a_figure_and_as_a_closed_surface() {
    let dir = scene();
    let words = |out: &str| {
        format!("bound-region {out} --cell cell.json --point 0,0,0 --point 0,-2,1 --error-deg 5")
    };
    expect(&dir, 0, &words("region.svg"));
    let figure = text(&dir, "region.svg");
    assert!(figure.starts_with("<svg") && figure.ends_with("</svg>\n"));
    assert_eq!(figure.matches("<polygon").count(), 2);
    let finite = !figure.contains("NaN") && !figure.contains("inf");
    assert!(finite, "{figure}");
    expect(&dir, 0, &words("region.ply"));
    let read = io::read(&dir.path().join("region.ply")).expect("reads");
    assert_eq!(read.mesh.triangles().len(), 2 * 20 * 256);
    expect(&dir, 0, "check region.ply");
}

#[test]
fn a_region_without_a_surface_is_not_written_as_a_mesh() {
    let dir = scene();
    let words = |out: &str, point: &str, angle: &str| {
        format!("bound-region {out} --cell cell.json --point {point} --error-deg {angle}")
    };
    // In the cell, at its end, and without an angle.
    for (point, angle, said) in [
        ("0.5,0,5", "5", "may stand on it"),
        ("1,0,5", "5", "may stand on it"),
        ("0,0,0", "0", "without an angle"),
    ] {
        refused(&dir, 2, &words("none.ply", point, angle), said);
        assert!(!dir.path().join("none.ply").exists());
        // A figure shows the point; it says so where viewers may stand on it.
        let message = expect(&dir, 0, &words("point.svg", point, angle));
        let fixed = message.contains("may not move at all");
        assert_eq!(fixed, angle != "0", "{message}");
        let figure = text(&dir, "point.svg");
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
