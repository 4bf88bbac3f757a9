//! `lodmark simplify --weights`: whose weights the numbers of a file are, and what the command tells of them.

use std::{fs, path::Path};

use glam::DVec3;
use lodmark::{
    encode::npy,
    io,
    mesh::{Mesh, generate},
};
use tempfile::TempDir;

use crate::support::{bytes, expect, folder, json, lodmark, put, refused, split, stdout};

fn save(dir: &TempDir, name: &str, weights: &[f32]) {
    let path = dir.path().join(name);
    npy::write_array(&path, weights, &[weights.len() as u64]).expect("writes");
}

/// A mesh whose triangles share no vertex, as scanners and STL files have them.
fn torn(mesh: &Mesh) -> Mesh {
    let corners = mesh.triangles().iter().flatten();
    let places = corners.map(|&v| mesh.positions()[v as usize]);
    let triangles = (0..mesh.triangles().len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    Mesh::from_triangles(places.collect(), triangles.collect()).expect("valid")
}

fn weight(p: DVec3) -> f32 {
    match p.x {
        x if x > 0.9 => 1.0,
        x if x > 0.0 => 0.9,
        _ => 0.0,
    }
}

/// The places of a file that weigh 1, as text.
fn heavy(path: &Path) -> Vec<String> {
    let mesh = io::read(path).expect("reads").mesh;
    let heavy = mesh.positions().iter().filter(|p| weight(**p) >= 1.0);
    let mut heavy: Vec<String> = heavy.map(|p| format!("{p:?}")).collect();
    heavy.sort();
    heavy.dedup();
    heavy
}

#[test]
fn weights_count_the_vertices_of_the_file_or_the_places_that_they_have() {
    let dir = folder();
    let mesh = torn(&generate::torus(1.0, 0.4, 16, 8));
    put(&dir, "in.ply", &mesh);
    let stored: Vec<f32> = mesh.positions().iter().map(|&p| weight(p)).collect();
    let mut places: Vec<DVec3> = Vec::new();
    for &p in mesh.positions() {
        if !places.contains(&p) {
            places.push(p);
        }
    }
    let welded: Vec<f32> = places.iter().map(|&p| weight(p)).collect();
    save(&dir, "stored.npy", &stored);
    save(&dir, "welded.npy", &welded);
    let words =
        "simplify in.ply OUT.ply -t 60 --method memoryless --json OUT.json --weights OUT.npy";
    for name in ["stored", "welded"] {
        let said = expect(&dir, 0, &words.replace("OUT", name));
        let report = json(&dir, &format!("{name}.json"));
        let locked = welded.iter().filter(|&&w| w >= 1.0).count();
        assert_eq!(report["weights"]["locked"], locked);
        assert_eq!(report["weights"]["held"], locked);
        assert_eq!(report["locked_vertices"], locked);
        let [kept, removed] = ["mean_kept", "mean_removed"].map(|m| report["weights"][m].as_f64());
        assert!(kept > removed && removed.is_some(), "{report}");
        assert_eq!(report["options"]["weights"]["vertices"], welded.len());
        let told = format!("{locked} of {locked} vertices of weight 1");
        assert!(said.contains(&told), "{said}");
    }
    let [stored, welded] = ["stored.ply", "welded.ply"].map(|name| bytes(&dir, name));
    assert_eq!(stored, welded);
    assert_eq!(
        heavy(&dir.path().join("stored.ply")),
        heavy(&dir.path().join("in.ply"))
    );
    // Without weights they would not be there.
    expect(
        &dir,
        0,
        "simplify in.ply plain.ply -t 60 --method memoryless",
    );
    assert_ne!(
        heavy(&dir.path().join("plain.ply")),
        heavy(&dir.path().join("in.ply"))
    );
}

#[test]
fn a_file_that_holds_no_weights_for_this_mesh_is_named_with_both_numbers() {
    let dir = folder();
    put(&dir, "in.ply", &torn(&generate::icosphere(1)));
    save(&dir, "few.npy", &[0.5; 17]);
    save(&dir, "large.npy", &[1.5; 240]);
    let table = dir.path().join("table.npy");
    npy::write_array(&table, &[0.5_f32; 240], &[240, 1]).expect("writes");
    let double = dir.path().join("double.npy");
    npy::write_array(&double, &[0.5_f64; 240], &[240]).expect("writes");
    fs::write(dir.path().join("noise.npy"), "noise").expect("writes");
    let words = "simplify in.ply out.ply -t 20 --method memoryless --weights";
    for (source, exit, parts) in [
        (
            "few.npy",
            3,
            &["17 weights", "240 vertices", "42 places"][..],
        ),
        ("large.npy", 3, &["vertex 0", "1.5"]),
        ("table.npy", 3, &["dimensions"]),
        ("double.npy", 3, &["<f8", "<f4"]),
        ("noise.npy", 3, &["noise.npy"]),
        ("absent.npy", 5, &["absent.npy"]),
        ("few.txt", 2, &[".npy", "COLOR_0.r"]),
        ("COLOR_0.x", 2, &["`x`"]),
        ("COLOR_0.r", 3, &["no vertex colours"]),
    ] {
        for part in parts {
            refused(&dir, exit, &format!("{words} {source}"), part);
        }
    }
    assert!(!dir.path().join("out.ply").exists());
}

#[test]
fn a_painted_channel_weighs_as_the_same_numbers_of_a_file() {
    let dir = folder();
    let mesh = generate::torus(1.0, 0.4, 16, 8);
    let red = |p: DVec3| [0.0, 0.25, 1.0][usize::from(p.x > 0.0) + usize::from(p.x > 0.9)];
    let mut text = String::new();
    for &p in mesh.positions() {
        let [x, y, z] = p.to_array().map(|x| x as f32);
        text += &format!("v {x} {y} {z} {} 0.5 0\n", red(p));
    }
    for t in mesh.triangles() {
        text += &format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    fs::write(dir.path().join("in.obj"), text).expect("writes");
    let weights: Vec<f32> = mesh.positions().iter().map(|&p| red(p) as f32).collect();
    save(&dir, "red.npy", &weights);
    let words = "simplify in.obj OUT.ply -t 60 --method quadric --weights";
    expect(
        &dir,
        0,
        &format!("{} COLOR_0.r", words.replace("OUT", "channel")),
    );
    expect(
        &dir,
        0,
        &format!("{} red.npy", words.replace("OUT", "file")),
    );
    expect(
        &dir,
        0,
        &format!("{} COLOR_0.b", words.replace("OUT", "other")),
    );
    let [channel, file, other] =
        ["channel", "file", "other"].map(|n| bytes(&dir, &format!("{n}.ply")));
    assert!(channel == file && channel != other);
    refused(&dir, 3, &format!("{words} COLOR_0.a"), "without opacity");
}

#[test]
fn the_example_in_the_help_is_what_the_command_takes() {
    let dir = folder();
    let help = stdout(&lodmark(&dir, "simplify --help"));
    let help = split(&help).join(" ");
    for part in [
        "w = np.zeros(289, 'f4'); w[0:17] = 1; w[17:68] = 0.9",
        "np.save('weights.npy', w)",
        "lodmark simplify IN OUT --ratio 0.1 --weights weights.npy",
        "--weights COLOR_0.r",
    ] {
        assert!(help.contains(part), "{part}");
    }
    put(
        &dir,
        "in.ply",
        &generate::grid(16, 16, generate::Height::Waves),
    );
    let mut weights = vec![0.0_f32; 289];
    weights[0..17].fill(1.0);
    weights[17..68].fill(0.9);
    save(&dir, "weights.npy", &weights);
    let said = expect(
        &dir,
        0,
        "simplify in.ply out.ply --ratio 0.1 --weights weights.npy",
    );
    assert!(said.contains("17 of 17 vertices of weight 1"), "{said}");
}
