//! The files of a chain: what the manifest says of them holds, and glTF levels share images.

use std::fs;

use lodmark::{
    Options, Target,
    chain::{Levels, Screen, chain},
    encode::hash::bytes_sha256,
    io,
    mesh::{Mesh, canonical, content_sha256, generate, weld},
};
use serde_json::{Value, json};

use crate::support::{GltfBuilder, bytes, folder, json as read_json, put};

fn levels(counts: &[u64]) -> Levels {
    let levels = Levels::targets(counts.iter().map(|&n| Target::triangles(n)));
    levels.screen(Screen::new(64, 60.0)).judged(32, 500)
}

#[test]
fn hashes_of_bytes_are_those_of_the_standard() {
    for (text, start) in [("", "e3b0c44298fc1c14"), ("abc", "ba7816bf8f01cfea")] {
        let found = bytes_sha256(text.as_bytes());
        assert!(found.starts_with(start) && found.len() == 64, "{found}");
    }
}

#[test]
fn the_manifest_tells_of_every_file_what_is_in_it() {
    let mesh = canonical(&generate::textured_torus(16, 8)).mesh;
    let options = Options::memoryless(Target::ratio(1.0));
    let found = chain(&mesh, &options, &levels(&[128, 40])).expect("levels");
    for extension in ["ply", "obj", "stl", "glb", "gltf"] {
        let dir = folder();
        let out = dir.path().join("out/deeper");
        found
            .write(&out, format!("a b.{extension}"))
            .expect("writes");
        let manifest = read_json(&dir, "out/deeper/a b.lod.json");
        assert_eq!(manifest["schema"], 1);
        assert_eq!(manifest["name"], "a b");
        let listed = manifest["levels"].as_array().expect("levels");
        assert_eq!(listed.len(), 3);
        for (number, (entry, level)) in listed.iter().zip(&found.levels).enumerate() {
            let name = format!("a b_LOD{number}.{extension}");
            assert_eq!(entry["file"], name);
            let bytes = bytes(&dir, &format!("out/deeper/{name}"));
            assert_eq!(entry["file_sha256"], bytes_sha256(&bytes), "{name}");
            assert_eq!(entry["content_sha256"], content_sha256(&level.mesh));
            let read = io::read(&out.join(&name)).expect("reads").mesh;
            assert_eq!(entry["triangles"], read.triangles().len());
            assert_eq!(entry["triangles"], level.mesh.triangles().len());
            assert_eq!(entry["vertices"], level.mesh.positions().len());
            assert_eq!(
                weld(read).mesh.positions().len(),
                level.mesh.positions().len()
            );
            assert_eq!(entry["reached"], true);
            for number in [
                "rms_flat",
                "rms_gouraud",
                "silhouette_error",
                "distance_mean",
                "geometric_error",
                "switch_distance",
            ] {
                let value = entry[number].as_f64().expect("a number");
                assert!(value >= 0.0, "{number}: {value}");
            }
            assert_eq!(entry["options"].is_null(), number == 0);
            assert_eq!(entry["screen_height"].is_null(), number == 0);
        }
        let center = manifest["sphere"]["center"].as_array().expect("a point");
        assert!(center.len() == 3 && manifest["sphere"]["radius"].as_f64() > Some(1.0));
        assert_eq!(manifest["screen"]["height"], 64);
    }
}

#[test]
fn a_chain_replaces_the_one_before_and_tells_of_levels_that_stay() {
    let mesh = canonical(&generate::icosphere(1)).mesh;
    let options = Options::memoryless(Target::ratio(1.0));
    let dir = folder();
    let long = chain(&mesh, &options, &levels(&[40, 20])).expect("levels");
    let short = chain(&mesh, &options, &levels(&[30])).expect("levels");
    let name = std::path::Path::new("x.ply");
    let written = lodmark::chain::write(&long, dir.path(), name).expect("writes");
    assert!(written.notes.is_empty(), "{:?}", written.notes);
    let written = lodmark::chain::write(&short, dir.path(), name).expect("writes");
    assert!(
        written.notes.iter().any(|n| n.contains("x_LOD2.ply")),
        "{:?}",
        written.notes
    );
    assert_eq!(
        read_json(&dir, "x.lod.json")["levels"]
            .as_array()
            .map(Vec::len),
        Some(2)
    );
    assert_eq!(
        io::read(&dir.path().join("x_LOD1.ply"))
            .expect("reads")
            .mesh,
        short.levels[1].mesh
    );
}

/// A picture that is told by its first bytes, and is large.
fn picture(length: usize) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    bytes.extend((bytes.len()..length).map(|i| (i % 251) as u8));
    bytes
}

/// A sphere with two images that lie in the buffer, and one material for each.
fn with_images(mesh: &Mesh) -> GltfBuilder {
    let mut builder = GltfBuilder::new();
    let places: Vec<f32> = mesh
        .positions()
        .iter()
        .flat_map(|p| p.to_array().map(|x| x as f32))
        .collect();
    let faces: Vec<u16> = mesh
        .triangles()
        .iter()
        .flatten()
        .map(|&v| v as u16)
        .collect();
    let place = builder.floats("VEC3", &places);
    builder.json["images"] = json!([]);
    builder.json["textures"] = json!([]);
    builder.json["materials"] = json!([]);
    for length in [9_001, 12_345] {
        let view = builder.view(&picture(length));
        let image = builder.push(
            "images",
            json!({"bufferView": view, "mimeType": "image/png", "name": "one"}),
        );
        let texture = builder.push("textures", json!({"source": image}));
        let look = json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}});
        builder.push("materials", look);
    }
    let indices = builder.indices(&faces);
    let primitive = json!([{"attributes": {"POSITION": place}, "indices": indices, "material": 1}]);
    let number = builder.mesh(primitive);
    builder.node(json!({"mesh": number}));
    builder
}

fn document(glb: &[u8]) -> Value {
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    serde_json::from_slice(&glb[20..20 + length]).expect("JSON")
}

#[test]
fn levels_of_a_glb_share_its_images_as_files() {
    let dir = folder();
    let source = with_images(&generate::icosphere(2)).glb();
    fs::write(dir.path().join("in.glb"), &source).expect("writes");
    let mesh = Mesh::read(dir.path().join("in.glb")).expect("reads");
    let options = Options::memoryless(Target::ratio(1.0));
    let found = chain(&mesh, &options, &levels(&[100, 30])).expect("levels");
    found
        .write(dir.path().join("out"), "in.glb")
        .expect("writes");
    assert_eq!(bytes(&dir, "out/in_image0.png"), picture(9_001));
    assert_eq!(bytes(&dir, "out/in_image1.png"), picture(12_345));
    let manifest = read_json(&dir, "out/in.lod.json");
    assert_eq!(
        manifest["images"],
        json!(["in_image0.png", "in_image1.png"])
    );
    for (number, level) in found.levels.iter().enumerate() {
        let name = format!("out/in_LOD{number}.glb");
        let glb = bytes(&dir, &name);
        // Neither image is in it.
        assert!(
            glb.len() + 20_000 < source.len(),
            "{} of {}",
            glb.len(),
            source.len()
        );
        let document = document(&glb);
        assert_eq!(document["images"][1]["uri"], "in_image1.png");
        assert_eq!(document["images"][1]["name"], "one");
        assert!(document["images"][1]["bufferView"].is_null());
        assert_eq!(document["materials"].as_array().map(Vec::len), Some(2));
        let read = Mesh::read(dir.path().join(&name)).expect("reads");
        assert_eq!(read.triangles().len(), level.mesh.triangles().len());
        assert_eq!(read.positions().len(), level.mesh.positions().len());
    }
}

#[test]
fn images_of_a_gltf_are_copied_once_and_what_views_share_stays() {
    let dir = folder();
    let mut builder = with_images(&generate::icosphere(1));
    fs::write(dir.path().join("skin.png"), picture(700)).expect("writes");
    builder.json["images"][0] = json!({"uri": "skin.png"});
    // The view of the other image is also that of an accessor: its bytes must stay.
    let view = builder.json["images"][1]["bufferView"].clone();
    builder.push(
        "accessors",
        json!({"bufferView": view, "componentType": 5121, "count": 16, "type": "SCALAR"}),
    );
    let source = builder.glb();
    fs::write(dir.path().join("in.glb"), &source).expect("writes");
    let mesh = Mesh::read(dir.path().join("in.glb")).expect("reads");
    let options = Options::memoryless(Target::ratio(1.0));
    let found = chain(&mesh, &options, &levels(&[30])).expect("levels");
    for name in ["in.glb", "in.gltf"] {
        found.write(dir.path().join("out"), name).expect("writes");
        assert_eq!(bytes(&dir, "out/skin.png"), picture(700));
        assert_eq!(bytes(&dir, "out/in_image1.png"), picture(12_345));
    }
    let document = document(&bytes(&dir, "out/in_LOD1.glb"));
    assert_eq!(document["images"][0]["uri"], "skin.png");
    let kept = document["accessors"].as_array().expect("accessors");
    let kept = kept
        .iter()
        .find(|a| a["componentType"] == 5121)
        .expect("kept");
    let view = &document["bufferViews"][kept["bufferView"].as_u64().expect("a view") as usize];
    assert_eq!(view["byteLength"], 12_345);
    let files = fs::read_dir(dir.path().join("out")).expect("a folder");
    let pictures = files.filter(|file| {
        let name = file.as_ref().expect("an entry").file_name();
        name.to_string_lossy().ends_with(".png")
    });
    assert_eq!(pictures.count(), 2);
    assert_eq!(
        io::read(&dir.path().join("out/in_LOD1.gltf"))
            .expect("reads")
            .mesh
            .triangles()
            .len(),
        30
    );
}

#[test]
fn a_chain_is_not_written_where_it_cannot_be() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(1));
    let source = dir.path().join("in.ply");
    fs::copy(&source, dir.path().join("file")).expect("copies");
    let found = Mesh::read(source).expect("reads");
    let found = chain(
        &found,
        &Options::memoryless(Target::ratio(1.0)),
        &levels(&[30]),
    )
    .expect("levels");
    for (folder, name, code) in [
        ("file", "x.ply", 5),
        ("out", "x.doc", 2),
        ("out", "x", 2),
        ("out", "", 2),
    ] {
        let error = found
            .write(dir.path().join(folder), name)
            .expect_err("refused");
        assert_eq!(error.exit_code(), code, "{error}");
    }
    assert!(!dir.path().join("out").exists());
}
