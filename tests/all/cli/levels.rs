//! `lodmark levels` as a user runs it: the same as single runs, compared one by one.
#![expect(clippy::float_cmp, reason = "the same results are the same bits")]

use std::fs;

use lodmark::{io, mesh::generate};
use serde_json::Value;
use tempfile::TempDir;

use crate::support::{bytes, code, expect, folder, json, lodmark, put, refused, stdout, text};

const SMALL: &str = "--size 48 --distance-samples 2000 --cameras 6 --visibility-size 64";

fn scene() -> TempDir {
    let dir = folder();
    put(&dir, "in.ply", &generate::shells(2, 2));
    dir
}

#[test]
fn every_level_is_the_run_to_it_and_is_judged_as_compare_does() {
    let dir = scene();
    let words = format!("levels in.ply out --levels 20,60 --meshes --json levels.json {SMALL}");
    let output = lodmark(&dir, &words);
    assert_eq!(code(&output), 0, "{output:?}");
    let found = json(&dir, "levels.json");
    let levels = found["levels"].as_array().expect("levels");
    let name = |l: &Value| format!("{}-{}", l["method"].as_str().expect("a name"), l["percent"]);
    let names: Vec<String> = levels.iter().map(name).collect();
    let expected = "quadric-60.0 quadric-20.0 visibility-60.0 visibility-20.0";
    assert_eq!(names.join(" "), expected);
    for level in levels {
        let method = level["method"].as_str().expect("a name");
        let target = &level["target"];
        let guided = match method {
            "visibility" => "--cameras 6 --visibility-size 64",
            _ => "",
        };
        let words = format!("simplify in.ply one.ply -t {target} --method {method} --keep-folds");
        expect(&dir, 0, &format!("{words} {guided} --json one.json"));
        let [level_sha256, one_sha256] =
            [level, &json(&dir, "one.json")].map(|report| report["content_sha256"].clone());
        assert_eq!(level_sha256, one_sha256, "{method} {target}");
        let percent = level["percent"].as_f64().expect("a number");
        let read = |name: &str| io::read(&dir.path().join(name)).expect("written").mesh;
        assert_eq!(
            read(&format!("out/{method}-{percent}.ply")),
            read("one.ply")
        );
        let words = "compare in.ply one.ply --size 48 --distance-samples 2000 --image-error --json one.json";
        expect(&dir, 0, words);
        let one = json(&dir, "one.json");
        assert_eq!(level["image_error"], one["image_error"]["error"]);
        assert_eq!(level["rms"], one["image_error"]["rms"]);
        let (a, b) = (&level["distance_mean"], &one["distance_relative"]["mean"]);
        let [x, y] = [a, b].map(|value| value.as_f64().expect("a number"));
        // `compare` measures the file, whose triangles have another order than the canonical one.
        assert!((x - y).abs() < 1e-12, "{a} {b}");
    }
    let error = |i: usize| levels[i]["image_error"].as_f64().expect("a number");
    let less = |i: usize| levels[i]["less"].as_f64().expect("a number");
    assert_eq!(less(2), 100.0 * (1.0 - error(2) / error(0)));
    assert_eq!(less(3), 100.0 * (1.0 - error(3) / error(1)));
    assert!(levels[0]["less"].is_null());
    let mean = &found["mean_less_image_error"][0];
    assert_eq!(mean["method"], "visibility");
    assert_eq!(mean["percent"].as_f64(), Some((less(2) + less(3)) / 2.0));
    // Half of the shells are hidden.
    assert!(less(2) > 50.0, "{} {}", less(2), less(3));
    let csv = text(&dir, "out/levels.csv");
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 5);
    for (line, level) in lines[1..].iter().zip(levels) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), lines[0].split(',').count());
        assert_eq!(cells[4], "true");
        assert_eq!(cells[5].parse::<f64>().ok(), level["image_error"].as_f64());
    }
    let svg = text(&dir, "out/levels.svg");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    assert!(svg.contains("visibility: image error") && svg.contains("quadric: mean distance"));
    let said = stdout(&output);
    assert!(said.contains("less image error on average"), "{said}");
}

#[test]
fn every_level_of_a_thin_sheet_keeps_its_folds() {
    // Two layers that lie on each other fold when few faces are left.
    let dir = folder();
    let mut sheet = generate::torus(1.0, 0.4, 40, 20).into_parts();
    for p in &mut sheet.positions {
        p.z *= 0.02;
    }
    let sheet = lodmark::mesh::Mesh::new(sheet).expect("a mesh");
    put(&dir, "in.ply", &sheet);
    let words =
        "levels in.ply out --levels 30,12,4 --meshes --methods quadric --no-distance --size 48";
    expect(&dir, 0, words);
    let mut unfolded = 0;
    for (percent, target) in [(30, "480"), (12, "192"), (4, "64")] {
        let words = format!("simplify in.ply one.ply -t {target} --method quadric");
        expect(&dir, 0, &words);
        let changed = bytes(&dir, "one.ply");
        expect(&dir, 0, &format!("{words} --keep-folds"));
        let one = bytes(&dir, "one.ply");
        let level = bytes(&dir, &format!("out/quadric-{percent}.ply"));
        assert_eq!(level, one, "{percent} %");
        unfolded += usize::from(changed != one);
    }
    assert!(unfolded > 0, "nothing was folded: the sheet tests nothing");
}

#[test]
fn a_level_that_was_not_reached_does_not_count() {
    let dir = folder();
    put(&dir, "in.ply", &generate::torus(1.0, 0.4, 12, 8));
    let words = "levels in.ply out --levels 50,1 --no-distance --methods quadric,memoryless --json levels.json";
    expect(&dir, 0, &format!("{words} --size 48"));
    let found = json(&dir, "levels.json");
    let levels = found["levels"].as_array().expect("levels");
    // No torus has two triangles.
    assert_eq!(levels[3]["reached"], false);
    assert!(levels[2]["less"].is_number() && levels[3]["less"].is_null());
    let mean = &found["mean_less_image_error"][0];
    assert_eq!(mean["percent"], levels[2]["less"]);
    let csv = text(&dir, "out/levels.csv");
    let line = csv.lines().nth(4).unwrap_or_default();
    assert!(line.contains(",false,"), "{csv}");
}

#[test]
fn a_mesh_that_is_nothing_once_it_is_welded_is_refused_and_leaves_no_folder() {
    let dir = folder();
    let file = dir.path().join("in.obj");
    fs::write(file, "v 0 0 0\nv 1 0 0\nf 1 1 2\n").expect("writes");
    let error = expect(&dir, 3, "levels in.obj out");
    let named = error.contains("in.obj") && error.contains("no triangles");
    assert!(named, "{error}");
    assert!(!dir.path().join("out").exists());
}

#[test]
fn damaged_weights_are_found_before_any_method_runs() {
    let dir = scene();
    fs::write(dir.path().join("weights.bin"), b"LODMVISI").expect("writes");
    let words = "levels in.ply out --visibility weights.bin";
    refused(&dir, 3, words, "weights.bin");
    assert!(!dir.path().join("out").exists());
}

#[test]
fn no_number_of_threads_changes_a_byte_of_the_levels() {
    let dir = scene();
    let run = |threads: &str| {
        let words = format!(
            "levels in.ply out --levels 30,10,5 --json levels.json --methods memoryless,visibility,quadric \
             --threads {threads} {SMALL}"
        );
        expect(&dir, 0, &words);
        ["out/levels.csv", "out/levels.svg", "levels.json"].map(|name| bytes(&dir, name))
    };
    let one = run("1");
    assert_eq!(run("3"), one);
}

#[test]
fn levels_without_sense_are_refused_before_anything_is_made() {
    let dir = scene();
    for (words, said) in [
        ("--levels 0", "above 0"),
        ("--levels 50,150", "above 0 and up to 100"),
        ("--levels half", "50,25"),
        ("--methods quadric,quadric", "twice"),
        ("--methods guess", "quadric"),
        ("--methods quadric --cameras 18", "--cameras"),
        ("--cameras 9", "258"),
        ("--size 0", "0"),
        ("--samples 3", "samples"),
    ] {
        refused(&dir, 2, &format!("levels in.ply out {words}"), said);
    }
    refused(&dir, 5, "levels none.ply out", "none.ply");
    assert!(!dir.path().join("out/levels.csv").exists());
}

#[test]
fn an_engine_costs_less_image_error_where_visibility_is_known() {
    let dir = folder();
    put(&dir, "in.ply", &generate::engine(1));
    let words = "levels in.ply out --levels 25,6,1.5 --no-distance --topology-free --json levels.json --size 96";
    expect(
        &dir,
        0,
        &format!("{words} --cameras 66 --visibility-size 160"),
    );
    let mean = &json(&dir, "levels.json")["mean_less_image_error"][0];
    assert_eq!(mean["method"], "visibility");
    // Zhang & Turk 2002 have 51.8 % for their motor.
    assert!(mean["percent"].as_f64().is_some_and(|p| p > 40.0), "{mean}");
}
