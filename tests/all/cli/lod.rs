//! `lodmark lod` as a user runs it.

use std::fs;

use lodmark::mesh::generate;

use crate::support::{
    bytes, code, expect, folder, json, lodmark, put, refused, split, stderr, stdout,
};

const TINY: &str = "--size 16 --distance-samples 100 --screen-height 32 --method quadric";

const SMALL: &str = "--size 32 --distance-samples 500 --screen-height 64 --method quadric";

#[test]
fn no_number_of_threads_changes_a_byte_of_any_file() {
    let dir = folder();
    put(&dir, "in.ply", &generate::torus(1.0, 0.4, 12, 8));
    let run = |threads: u32| {
        let words = format!(
            "lod in.ply out --levels 0.5,40,0.1 --json out.json --threads {threads} {SMALL}"
        );
        expect(&dir, 0, &words);
        let mut files: Vec<_> = fs::read_dir(dir.path().join("out"))
            .expect("a folder")
            .map(|entry| {
                entry
                    .expect("an entry")
                    .file_name()
                    .into_string()
                    .expect("a name")
            })
            .collect();
        files.sort();
        let expected = split("in.lod.json in_LOD0.ply in_LOD1.ply in_LOD2.ply in_LOD3.ply");
        assert_eq!(files, expected);
        files.push("../out.json".into());
        let content = files.iter().map(|name| bytes(&dir, &format!("out/{name}")));
        content.collect::<Vec<_>>()
    };
    let one = run(1);
    assert!(run(2) == one && run(3) == one);
}

#[test]
fn every_level_is_what_simplify_writes() {
    let dir = folder();
    put(&dir, "in.obj", &generate::torus(1.0, 0.4, 10, 6));
    let words = format!("lod in.obj out --levels 0.4,30 --json all.json {SMALL}");
    let output = lodmark(&dir, &words);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let table = stdout(&output);
    assert!(
        table.contains("switch distance") && table.contains("in.lod.json: written"),
        "{table}"
    );
    let all = json(&dir, "all.json");
    assert_eq!(all["triangles_in"], 120);
    for (number, target) in [(0, 120), (1, 48), (2, 30)] {
        expect(
            &dir,
            0,
            &format!("simplify in.obj one.obj -t {target} --method quadric --json one.json"),
        );
        let level = &all["levels"][number];
        let one = json(&dir, "one.json");
        assert_eq!(level["content_sha256"], one["content_sha256"]);
        assert_eq!(level["triangles"], one["triangles_out"]);
        assert_eq!(
            bytes(&dir, &format!("out/in_LOD{number}.obj")),
            bytes(&dir, "one.obj")
        );
    }
    // And it is judged as `compare` does.
    let words = "compare one.obj one.obj";
    expect(
        &dir,
        0,
        &format!("{words} --size 32 --distance-samples 500"),
    );
    let words =
        "compare out/in_LOD0.obj out/in_LOD2.obj --size 32 --distance-samples 500 --json both.json";
    expect(&dir, 0, words);
    let (level, both) = (&all["levels"][2], json(&dir, "both.json"));
    assert_eq!(level["rms_flat"], both["rms_flat"]);
    assert_eq!(level["rms_gouraud"], both["rms_gouraud"]);
}

#[test]
fn without_sizes_levels_are_halved() {
    let dir = folder();
    put(&dir, "in.stl", &generate::icosphere(2));
    let said = expect(&dir, 0, &format!("lod in.stl out {SMALL} --quiet"));
    assert_eq!(said, "");
    let levels = json(&dir, "out/in.lod.json")["levels"].clone();
    let counts = levels.as_array().expect("levels").iter();
    let counts: Vec<u64> = counts.filter_map(|l| l["triangles"].as_u64()).collect();
    assert!(
        counts.len() > 2 && counts[..3] == [320, 160, 80],
        "{counts:?}"
    );
}

#[test]
fn levels_for_distances_are_within_them() {
    let dir = folder();
    put(&dir, "in.ply", &generate::torus(1.0, 0.4, 10, 6));
    let words = format!("lod in.ply out --distances 0.1,9 --error-px 1.5 --error-rms 255 {TINY}");
    let said = expect(&dir, 0, &words);
    assert!(said.contains("no level for the distance 0.1"), "{said}");
    let manifest = json(&dir, "out/in.lod.json");
    assert_eq!(manifest["left_out"], serde_json::json!([0.1]));
    let level = &manifest["levels"][1];
    assert!(level["switch_distance"].as_f64() <= Some(9.0), "{level}");
    assert!(level["silhouette_px"].as_f64() <= Some(1.5));
}

#[test]
fn a_request_without_sense_is_refused_and_leaves_no_folder() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(1));
    fs::copy(dir.path().join("in.ply"), dir.path().join("mesh")).expect("copies");
    for (words, said) in [
        ("in.ply out --levels 0.2,0.5", "fine to coarse"),
        ("in.ply out --levels 90", "the input has 80"),
        ("in.ply out --levels 0.5,0.5", "before it has 40"),
        ("in.ply out --levels 0", "no level"),
        ("in.ply out --levels 1.5", "no level"),
        ("in.ply out --levels -1", "-1"),
        ("in.ply out --levels half", "0.25"),
        (
            "in.ply out --levels 0.5 --distances 3",
            "cannot be used with",
        ),
        ("in.ply out --distances 3,2", "above the one before"),
        ("in.ply out --distances -3", "above 0"),
        ("in.ply out --method tolerance", "keeps to an error"),
        ("in.ply out --method quadric --preset best", "preset"),
        ("in.ply out --screen-height 0", "3600"),
        ("in.ply out --fov 180", "fov"),
        ("in.ply out --error-px -1", "error-px"),
        ("in.ply out --error-rms 300", "error-rms"),
        ("in.ply out --size 0", "0"),
        ("mesh out", "extension"),
    ] {
        refused(&dir, 2, &format!("lod {words}"), said);
        assert!(!dir.path().join("out").exists(), "{words}");
    }
    refused(&dir, 5, "lod none.ply out", "none.ply");
    assert!(!dir.path().join("out").exists());
    refused(&dir, 5, "lod in.ply mesh --levels 40", "mesh");
    for name in ["in_LOD1.ply", "in.lod.json", "in_LOD17.ply"] {
        let words = format!("lod in.ply out --levels 40 --json out/{name} {SMALL}");
        refused(&dir, 2, &words, "twice");
    }
}
