//! `lodmark compare` as a user runs it: figures, reports, pictures and verdicts.
#![expect(
    clippy::float_cmp,
    clippy::disallowed_methods,
    reason = "exact results are met exactly, and are computed without the crate's own functions"
)]

use std::fs;

use glam::DVec3;
use lodmark::{
    encode::png,
    mesh::{Edges, Mesh, generate},
    raster,
};
use serde_json::Value;
use tempfile::TempDir;

use crate::{
    metric::appearance::shaken,
    support::{
        bytes, code, expect, folder, json, lodmark, meshes::with_normals, put, refused, stdout,
    },
};

/// Runs `compare`, holds it to an exit code, and reads its report.
#[track_caller]
fn report(dir: &TempDir, exit: i32, words: &str) -> Value {
    expect(dir, exit, &format!("compare --json report.json {words}"));
    json(dir, "report.json")
}

/// [`report`] with small pictures and few samples.
#[track_caller]
fn small(dir: &TempDir, exit: i32, words: &str) -> Value {
    report(
        dir,
        exit,
        &format!("{words} --size 32 --distance-samples 2000"),
    )
}

fn float(value: &Value, key: &str) -> f64 {
    let number = value[key].as_f64();
    number.unwrap_or_else(|| panic!("{key} of {value}"))
}

#[test]
fn a_mesh_is_equal_to_itself_in_every_figure() {
    let dir = folder();
    put(&dir, "a.ply", &generate::torus(1.0, 0.4, 12, 8));
    let found = small(&dir, 0, "a.ply a.ply --equal --max-rms 0");
    assert_eq!(found["command"], "compare");
    assert_eq!(found["equal"], true);
    for key in ["rms_flat", "rms_gouraud"] {
        assert_eq!(float(&found, key), 0.0, "{key}");
    }
    // The points between the vertices are rounded.
    for key in ["distance_mean", "distance_max"] {
        assert!(float(&found, key) < 1e-15, "{key}");
    }
    for key in ["psnr_flat", "psnr_gouraud"] {
        let none = found[key].is_null();
        assert!(none, "{key}: an infinite ratio has no number");
    }
    let views = found["views"].as_array().expect("views");
    assert_eq!(views.len(), 24);
    let equal = |v: &Value| v["rms_flat"] == 0.0 && v["psnr_flat"].is_null();
    assert!(views.iter().all(equal));
    assert_eq!(found["options"]["samples"], 2);
}

#[test]
fn meshes_are_equal_where_their_files_hold_the_same() {
    let dir = folder();
    let mesh = generate::torus(1.0, 0.4, 12, 8);
    put(&dir, "a.ply", &mesh);
    put(&dir, "b.obj", &mesh);
    let mut triangles = mesh.triangles().to_vec();
    triangles.reverse();
    let turned = Mesh::from_triangles(mesh.positions().to_vec(), triangles).expect("the same");
    put(&dir, "c.ply", &turned);
    let same = small(&dir, 0, "a.ply b.obj --equal");
    assert_eq!(same["equal"], true, "format is no content");
    let other = small(&dir, 1, "a.ply c.ply --equal");
    assert_eq!(other["equal"], false, "another order is another file");
    assert_eq!(float(&other, "rms_flat"), 0.0, "but it looks the same");
    // With several candidates all of them must hold.
    let several = small(&dir, 1, "a.ply b.obj c.ply --equal");
    let several = several["candidates"].as_array().expect("a list").clone();
    let equal: Vec<_> = several.iter().map(|c| c["equal"].clone()).collect();
    assert_eq!(equal, [true, false]);
    assert_eq!(several[1]["candidate"]["file"], "c.ply");
}

#[test]
fn normals_are_judged_where_both_files_store_some() {
    let dir = folder();
    let radial = |mesh: &Mesh| with_normals(mesh, |_, p, _| Some(p));
    let [fine, coarse] = [3, 2].map(generate::icosphere);
    put(&dir, "a.obj", &radial(&fine));
    put(&dir, "b.obj", &radial(&coarse));
    put(&dir, "c.obj", &coarse);
    let found = small(&dir, 0, "a.obj b.obj c.obj a.obj");
    let [b, c, a] = [0, 1, 2].map(|i| found["candidates"][i].clone());
    assert!(float(&b, "rms_lit") > 0.0 && float(&b, "psnr_lit") > 0.0);
    assert!(float(&b["views"][0], "rms_lit") > 0.0);
    assert!(c["rms_lit"].is_null() && c["squared_error_lit"].is_null());
    assert!(c["views"][0]["rms_lit"].is_null());
    assert_eq!(float(&a, "rms_lit"), 0.0);
    // A column where there is something to see.
    let table = |words: &str| {
        let words = format!("compare {words} --size 32 --no-distance --per-view");
        stdout(&lodmark(&dir, words.as_str()))
    };
    let heads = |words: &str| {
        let text = table(words);
        let heads = text.lines().filter(|line| line.contains("RMS flat"));
        heads
            .map(|line| line.matches(" lit").count())
            .collect::<Vec<_>>()
    };
    assert_eq!(heads("a.obj b.obj"), [2, 2]);
    assert_eq!(heads("a.obj c.obj"), [0, 0]);
    // All pictures are held to a limit.
    let mut sharp = radial(&fine).into_parts();
    sharp.attributes = with_normals(&fine, |_, p, _| Some(DVec3::new(p.y, p.z, p.x)))
        .attributes()
        .clone();
    put(&dir, "d.obj", &Mesh::new(sharp).expect("valid"));
    let found = small(&dir, 1, "a.obj d.obj --max-rms 1");
    assert_eq!(float(&found, "rms_flat"), 0.0);
    assert!(float(&found, "rms_lit") > 1.0);
    assert_eq!(found["worst"]["shading"], "lit");
}

#[test]
fn a_limit_on_the_rms_holds_up_to_the_rms_itself() {
    let dir = folder();
    let mesh = generate::torus(1.0, 0.4, 12, 8);
    put(&dir, "a.ply", &mesh);
    put(&dir, "b.ply", &generate::torus(1.0, 0.4, 10, 6));
    let words = "a.ply b.ply --size 32 --no-distance";
    let found = report(&dir, 0, words);
    assert!(found["distance_mean"].is_null() && found["distance"].is_null());
    let rms = float(&found, "rms_flat").max(float(&found, "rms_gouraud"));
    assert!(rms > 1.0);
    report(&dir, 0, &format!("{words} --max-rms {rms}"));
    report(&dir, 1, &format!("{words} --max-rms {}", rms * 0.999));
}

#[test]
fn distances_boundaries_and_silhouettes_of_shifted_squares_are_known() {
    let dir = folder();
    let square = |z: f64, name: &str| {
        let text = format!("v 0 0 {z}\nv 3 0 {z}\nv 3 4 {z}\nv 0 4 {z}\nf 1 2 3\nf 1 3 4\n");
        fs::write(dir.path().join(name), text).expect("writes");
    };
    square(0.0, "low.obj");
    square(0.5, "high.obj");
    let found = small(&dir, 0, "low.obj high.obj");
    assert!((float(&found, "distance_mean") - 0.5).abs() < 1e-12);
    assert_eq!(float(&found, "distance_max"), 0.5);
    let relative = float(&found["distance_relative"], "max");
    assert!((relative - 0.1).abs() < 1e-12, "the diagonal is 5");
    let shape = &found["reference"];
    assert_eq!(shape["boundary_edges"], 4);
    let counts = shape["silhouette_histogram"]["counts"].as_array();
    let counts = counts.expect("counts");
    // The diagonal lies on no silhouette, the sides on all of them.
    assert_eq!((&counts[0], &counts[24]), (&1.into(), &4.into()));
    assert_eq!(counts.len(), 25);
}

#[test]
fn the_report_counts_what_the_mesh_has() {
    let dir = folder();
    let mesh = generate::grid(5, 3, generate::Height::Waves);
    put(&dir, "a.ply", &mesh);
    let found = small(&dir, 0, "a.ply a.ply");
    let shape = &found["candidate"];
    assert_eq!(shape["triangles"], mesh.triangles().len());
    assert_eq!(shape["vertices"], mesh.positions().len());
    assert_eq!(shape["boundary_edges"], Edges::of(&mesh).boundary_count());
    let sha256 = lodmark::mesh::content_sha256(&mesh);
    assert_eq!(shape["content_sha256"], sha256);
}

#[test]
fn the_rms_is_that_of_pictures_drawn_by_another_command() {
    let dir = folder();
    let normals = |mesh: Mesh| with_normals(&mesh, |_, p, own| Some(p + own * 2.0));
    put(&dir, "a.ply", &normals(generate::torus(1.0, 0.4, 16, 10)));
    put(&dir, "b.ply", &normals(generate::torus(1.0, 0.35, 9, 6)));
    let drawn = |mesh: &str, to: &str, shading: &str| {
        let views = if mesh == "a.ply" {
            format!("rhombicuboctahedron --size 48 --shading {shading}")
        } else {
            // In the views around the reference.
            format!("expected-{shading}/scene.json")
        };
        expect(&dir, 0, &format!("render {mesh} {to} --views {views}"));
    };
    let words = "a.ply b.ply --size 48 --samples 1 --no-distance";
    let found = report(&dir, 0, words);
    for shading in ["flat", "gouraud", "lit"] {
        drawn("a.ply", &format!("expected-{shading}"), shading);
        drawn("b.ply", &format!("actual-{shading}"), shading);
        let (mut sum, mut pixels) = (0.0, 0.0);
        for view in 0..24 {
            let read = |kind: &str| {
                let name = format!("{kind}-{shading}/view-{view:02}-luma.png");
                let picture = png::read(&dir.path().join(name));
                picture.expect("drawn").into_luma()
            };
            let (a, b) = (read("expected"), read("actual"));
            for (&a, &b) in a.values().iter().zip(b.values()) {
                sum += (f64::from(a) - f64::from(b)).powi(2);
                pixels += 1.0;
            }
        }
        let rms = (sum / pixels).sqrt();
        assert!(rms > 1.0);
        assert!((float(&found, &format!("rms_{shading}")) - rms).abs() < 1e-9);
        let psnr = 20.0 * (255.0 / rms).log10();
        assert!((float(&found, &format!("psnr_{shading}")) - psnr).abs() < 1e-9);
    }
    // The file of the views, which are the same, leads to the same pictures; size and samples are its own.
    let words = "a.ply b.ply --views expected-flat/scene.json";
    let again = report(&dir, 0, &format!("{words} --no-distance"));
    assert_eq!(again["rms_gouraud"], found["rms_gouraud"]);
    assert_eq!(again["options"]["width"], 48);
    expect(&dir, 2, &format!("compare {words} --size 48"));
}

#[test]
fn no_number_of_threads_changes_a_byte_of_the_report() {
    let dir = folder();
    put(&dir, "a.ply", &generate::engine(2));
    put(&dir, "b.ply", &shaken(&generate::engine(2), 0.01));
    put(&dir, "c.ply", &generate::torus(1.0, 0.4, 12, 8));
    let mut all = Vec::new();
    for threads in ["1", "2", "3", "8"] {
        let words = "a.ply b.ply c.ply --difference d.png --threads";
        small(&dir, 0, &format!("{words} {threads}"));
        all.push(["report.json", "d.png"].map(|name| bytes(&dir, name)));
    }
    assert!(all.iter().all(|files| *files == all[0]));
}

#[test]
fn the_difference_picture_shows_the_worst_view_of_every_candidate() {
    let dir = folder();
    put(&dir, "a.ply", &generate::icosphere(2));
    put(&dir, "b.ply", &generate::icosphere(1));
    put(&dir, "c.ply", &generate::cube());
    let size = |candidates: &str| {
        let words = "--size 32 --no-distance --difference d.png";
        expect(&dir, 0, &format!("compare a.ply {candidates} {words}"));
        let picture = png::read(&dir.path().join("d.png")).expect("a PNG picture");
        let picture = picture.into_luma();
        (picture.width(), picture.height())
    };
    let (one, two) = (size("b.ply"), size("b.ply c.ply"));
    assert!(one.0 > 3 * 32 && one.1 > 32);
    assert_eq!(two.0, one.0);
    assert!(two.1 > 2 * 32 && two.1 < 2 * one.1);
}

#[test]
fn a_table_has_a_row_for_every_mesh_and_with_per_view_for_every_view() {
    let dir = folder();
    put(&dir, "a.ply", &generate::icosphere(2));
    put(&dir, "b.ply", &generate::icosphere(1));
    let words = "compare a.ply a.ply b.ply --per-view --size 32 --distance-samples 2000";
    let output = lodmark(&dir, words);
    assert_eq!(code(&output), 0);
    let text = stdout(&output);
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("mesh") && lines[0].contains("RMS flat"));
    assert!(lines[1].starts_with("a.ply") && lines[1].contains("320"));
    assert!(lines[2].ends_with("yes") && lines[3].ends_with("no"));
    assert!(lines[3].starts_with("b.ply") && lines[3].contains("80"));
    assert_eq!(lines.len(), 4 + 2 + 2 * (2 + 24));
}

#[test]
fn images_are_equal_or_it_is_said_where_they_are_not() {
    let dir = folder();
    let grey = |name: &str, values: &[u8]| {
        let plane = raster::Grid::new(4, values.len() as u32 / 4, values.to_vec());
        png::write_grey(&dir.path().join(name), &plane.expect("rows")).expect("writes");
    };
    grey("a.png", &[7; 8]);
    grey("b.png", &[7, 7, 7, 7, 7, 7, 9, 7]);
    grey("c.png", &[7; 4]);
    let same = report(&dir, 0, "a.png a.png --equal --max-rms 0");
    assert_eq!(same["equal"], true);
    assert_eq!(same["comparison"], "equal");
    assert!(same["psnr"].is_null());
    let other = report(&dir, 1, "a.png b.png --equal --difference d.png");
    let pixels = &other["comparison"]["pixels"];
    assert_eq!(pixels["count"], 1);
    assert_eq!(pixels["first"], serde_json::json!([2, 1]));
    assert!((float(&other, "rms") - (4.0_f64 / 8.0).sqrt()).abs() < 1e-12);
    assert!(dir.path().join("d.png").exists());
    report(&dir, 0, "a.png b.png --max-rms 1");
    report(&dir, 1, "a.png b.png --max-rms 0.5");
    let sizes = report(&dir, 1, "a.png b.png c.png --max-rms 255");
    let sizes = &sizes["candidates"][1];
    let none = sizes["rms"].is_null();
    assert!(none, "pictures of two sizes have no difference");
    let actual = &sizes["comparison"]["sizes"]["actual"];
    assert_eq!(*actual, serde_json::json!([4, 1]));
    let said = stdout(&lodmark(&dir, "compare a.png b.png"));
    let place = "1 of 8 pixels differ, first at (2, 1)";
    assert!(said.contains(place), "{said}");
}

#[test]
fn arrays_of_ids_are_compared_number_by_number() {
    let dir = folder();
    put(&dir, "a.ply", &generate::icosphere(2));
    put(&dir, "b.ply", &generate::icosphere(1));
    for (mesh, to) in [("a.ply", "a"), ("b.ply", "b")] {
        let words = format!("render {mesh} {to} --buffer ids,luma --size 16");
        expect(&dir, 0, &words);
    }
    let (a, b) = ("a/view-00-ids.npy", "b/view-00-ids.npy");
    let same = report(&dir, 0, &format!("{a} {a} --equal"));
    assert_eq!(same["equal"], true);
    let other = report(&dir, 1, &format!("{a} {b} --equal"));
    assert!(other["comparison"]["pixels"]["count"].as_u64() > Some(10));
    expect(&dir, 2, &["compare", a, "a/view-00-luma.png"]);
    expect(&dir, 2, &["compare", a, b, "--difference", "d.png"]);
}

#[test]
fn a_comparison_without_sense_is_refused_before_it_is_made() {
    let dir = folder();
    put(&dir, "a.ply", &generate::icosphere(1));
    // The images do not exist: nothing is read before the request makes sense.
    for (words, said) in [
        ("a.ply", "CAND"),
        ("a.ply x.png", "image"),
        ("x.png y.png a.ply", "image"),
        ("x.png y.png --size 64", "--size"),
        ("x.png y.png --no-distance", "--no-distance"),
        ("x.ply y.ply --max-rms -1", "max-rms"),
        ("x.ply y.ply --max-rms NaN", "max-rms"),
        ("x.ply y.ply --difference d.jpg", ".png"),
        ("x.ply y.ply --difference-scale 3", "--difference"),
        ("x.ply y.ply --distance-samples 0", "distance-samples"),
        (
            "x.ply y.ply --distance-samples 5 --no-distance",
            "cannot be used",
        ),
        ("a.ply a.ply --samples 3", "samples"),
        ("a.ply a.ply --size 4096", "2048"),
    ] {
        refused(&dir, 2, &format!("compare {words}"), said);
    }
}

#[test]
fn a_candidate_that_shows_nothing_or_lies_too_far_away_is_refused() {
    let dir = folder();
    let triangle = |name: &str, scale: &str| {
        let text = format!("v 0 0 0\nv {scale} 0 0\nv 0 {scale} 0\nf 1 2 3\n");
        fs::write(dir.path().join(name), text).expect("writes");
    };
    triangle("tiny.obj", "1e-300");
    triangle("vast.obj", "1e300");
    fs::write(dir.path().join("points.obj"), "v 0 0 0\n").expect("writes");
    refused(&dir, 3, "compare tiny.obj points.obj", "points.obj");
    refused(&dir, 4, "compare tiny.obj vast.obj --size 16", "units");
    expect(&dir, 0, "compare vast.obj tiny.obj --size 16");
}

#[test]
fn the_image_error_is_the_flat_error_from_the_corners_of_a_dodecahedron() {
    let dir = folder();
    put(&dir, "a.ply", &generate::torus(1.0, 0.4, 12, 8));
    put(&dir, "b.ply", &generate::torus(1.0, 0.4, 10, 6));
    let words = "a.ply b.ply --size 32 --no-distance";
    let plain = report(&dir, 0, words);
    assert!(plain["image_error"].is_null() && plain["options"]["image_error"] == false);
    let found = report(&dir, 0, &format!("{words} --image-error"));
    assert_eq!(plain["rms_flat"], found["rms_flat"]);
    let found = &found["image_error"];
    let dodecahedron = report(&dir, 0, &format!("{words} --views dodecahedron"));
    assert_eq!(found["rms"], dodecahedron["rms_flat"]);
    assert_eq!(found["squared_error"], dodecahedron["squared_error_flat"]);
    assert_eq!(found["views"], 20);
    // Squares of sums of 4 samples.
    let views = dodecahedron["views"].as_array().expect("views").iter();
    let sum: f64 = views.map(|v| float(v, "squared_error_flat") / 16.0).sum();
    assert!((float(found, "error") - sum.sqrt()).abs() < 1e-9 * sum.sqrt());
    for (name, level) in [("a.png", 3), ("b.png", 4)] {
        let plane = raster::Grid::filled(4, 4, level);
        png::write_grey(&dir.path().join(name), &plane).expect("writes");
    }
    refused(
        &dir,
        2,
        "compare a.png b.png --image-error",
        "--image-error",
    );
}

#[test]
fn differences_are_drawn_in_red_over_the_reference_for_every_view() {
    let dir = folder();
    let mesh = generate::torus(1.0, 0.4, 12, 8);
    put(&dir, "a.ply", &mesh);
    put(&dir, "b.ply", &generate::torus(1.0, 0.4, 8, 6));
    let words = "a.ply a.ply b.ply --size 40 --samples 1 --no-distance --red-differences red --difference-scale 4";
    report(&dir, 0, &format!("{words} --views octahedron:0"));
    for view in 0..6 {
        let path = dir.path().join(format!("red/view-{view:02}.png"));
        let png::Picture::Rgb(sheet) = png::read(&path).expect("written") else {
            panic!("a sheet with red in it has colours");
        };
        // Cells of 40 + 8 pixels; the picture that equals the reference is grey, the other one is not.
        let red = |left: u32| {
            let pixels = (8..48).flat_map(|y| (left..left + 40).map(move |x| (x, y)));
            let is_red = |(x, y)| {
                let [r, g, b] = sheet.at(x, y);
                assert!(r >= g && g == b);
                r > g
            };
            pixels.filter(|&place| is_red(place)).count()
        };
        assert_eq!(red(56), 0, "view {view}");
        assert!(red(104) > 20, "view {view}");
    }
    assert!(!dir.path().join("red/view-06.png").exists());
    expect(&dir, 2, "compare a.ply b.ply --difference-scale 4");
}
