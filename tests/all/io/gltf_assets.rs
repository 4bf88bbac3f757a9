//! Real glTF files, from the folder that `LODMARK_ASSETS` names, else `../shared/assets`: a quarter of their triangles.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

use lodmark::{
    Options, Target, io,
    mesh::{ChannelKind, Mesh, canonical, content_digest, weld},
    simplify,
};
use serde_json::Value;

use super::gltf_documents::{asset, section, text_of};
use crate::support::{
    asset_file, folder,
    oracle::{gltf_errors, gltf_validator},
    say,
};

const FILES: &[&str] = &[
    "BoomBox/BoomBox.gltf",
    "CesiumMan.glb",
    "DamagedHelmet.glb",
    "FlightHelmet/FlightHelmet.gltf",
    "Lamborghini_meshopt.glb",
    "MorphStressTest.glb",
    "Pirate_meshopt_quantized.glb",
    "TeapotsGalore_instancing/teapots_galore.gltf",
    "conformance/MultiUVTest/MultiUVTest.gltf",
    "conformance/TextureSettingsTest/TextureSettingsTest.gltf",
    "conformance/TextureTransformTest/TextureTransformTest.gltf",
    "conformance/VertexColorTest/VertexColorTest.gltf",
    "conformance/box_sparse.glb",
];

/// The files that are there and can be read.
fn assets() -> Vec<(PathBuf, Mesh)> {
    let folder = std::env::var_os("LODMARK_ASSETS").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/assets"),
        PathBuf::from,
    );
    let mut found = Vec::new();
    for name in FILES {
        let path = folder.join(name);
        if path.exists() {
            let mesh = io::read(&path).expect("a good file").mesh;
            found.push((path, mesh));
        } else {
            say(&format!("skipped: {} is not there", path.display()));
        }
    }
    found
}

fn images(mesh: &Mesh) -> Vec<Vec<u8>> {
    let asset = asset(mesh);
    if text_of(asset, "images").is_none() {
        return Vec::new();
    }
    let views = section(asset, "bufferViews");
    let of = |image: &Value| {
        let view = image["bufferView"].as_u64()?;
        let number = |name: &str| views[view as usize][name].as_u64().unwrap_or(0) as usize;
        let buffer = &asset.buffers[number("buffer")];
        Some(buffer[number("byteOffset")..][..number("byteLength")].to_vec())
    };
    let images = section(asset, "images");
    images
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(of)
        .collect()
}

#[test]
fn files_that_did_not_change_give_everything_back() {
    let folder = folder();
    for (path, mesh) in assets() {
        let out = folder.path().join("same.glb");
        io::write(&out, &canonical(&weld(mesh.clone()).mesh).mesh).expect("written");
        let again = io::read(&out).expect("read").mesh;
        assert!(
            content_digest(&again) == content_digest(&mesh),
            "{}",
            path.display()
        );
        let packed = [
            "images",
            "bufferViews",
            "buffers",
            "extensionsUsed",
            "extensionsRequired",
        ];
        for (name, text) in &asset(&mesh).sections {
            if !packed.contains(&name.as_str()) {
                assert_eq!(text_of(asset(&again), name), Some(text.as_str()), "{name}");
            }
        }
        let before = images(&mesh);
        if !before.is_empty() {
            assert!(images(&again) == before, "{}", path.display());
        }
    }
}

#[test]
fn simplified_files_are_valid_and_have_lost_no_material() {
    let folder = folder();
    let mut files = Vec::new();
    for (number, (path, stored)) in assets().into_iter().enumerate() {
        let mesh = canonical(&weld(stored).mesh).mesh;
        let less = simplify(&mesh, &Options::memoryless(Target::ratio(0.25)))
            .expect("it runs")
            .mesh;
        for extension in ["glb", "gltf"] {
            let out = folder.path().join(format!("{number}/out.{extension}"));
            std::fs::create_dir_all(folder.path().join(number.to_string())).expect("a folder");
            let notes = io::write(&out, &less).expect("written");
            let again = io::read(&out).expect("read").mesh;
            let vanished = notes
                .iter()
                .filter(|note| note.starts_with("vanished: "))
                .count();
            assert_eq!(
                again.triangles().len(),
                less.triangles().len() + vanished,
                "{}: {notes:?}",
                path.display()
            );
            let names = |mesh: &Mesh| -> BTreeSet<String> {
                mesh.materials().names.iter().cloned().collect()
            };
            assert_eq!(names(&again), names(&mesh), "{}", path.display());
            files.extend([path.clone(), out]);
        }
    }
    let Some(validator) = gltf_validator() else {
        return;
    };
    let errors = gltf_errors(validator, &files);
    for (files, errors) in files.chunks(2).zip(errors.chunks(2)) {
        let new: Vec<&String> = errors[1]
            .iter()
            .filter(|e| !errors[0].contains(e))
            .collect();
        assert!(new.is_empty(), "{}: {new:?}", files[1].display());
    }
}

/// By place, the skin and the morph deltas of every corner there.
fn deformations(mesh: &Mesh) -> Vec<BTreeSet<Vec<u64>>> {
    let attributes = mesh.attributes();
    let bound = |kind: ChannelKind| matches!(kind, ChannelKind::Skin(_) | ChannelKind::Delta(_));
    let channels: Vec<_> = attributes
        .channels()
        .iter()
        .filter(|c| bound(c.kind))
        .collect();
    let mut at: BTreeMap<[u64; 3], BTreeSet<Vec<u64>>> = BTreeMap::new();
    for (corners, wedges) in mesh.triangles().iter().zip(attributes.corners()) {
        for (&v, &w) in corners.iter().zip(wedges) {
            let place = mesh.positions()[v as usize].to_array().map(f64::to_bits);
            let values = channels.iter().flat_map(|&&c| attributes.value(c, w));
            let values = values.map(|x| x.to_bits()).collect();
            at.entry(place).or_default().insert(values);
        }
    }
    at.into_values().collect()
}

#[test]
fn what_hangs_together_at_rest_hangs_together_in_every_pose() {
    let folder = folder();
    for name in ["CesiumMan.glb", "MorphStressTest.glb"] {
        let Some(path) = asset_file(name) else {
            continue;
        };
        let mesh = canonical(&weld(io::read(&path).expect("a good file").mesh).mesh).mesh;
        let several = |mesh: &Mesh| deformations(mesh).iter().filter(|d| d.len() > 1).count();
        let before = several(&mesh);
        for share in [0.5, 0.1, 0.02] {
            let options = Options::memoryless(Target::ratio(share));
            let less = simplify(&mesh, &options).expect("it runs").mesh;
            let out = folder.path().join("out.glb");
            io::write(&out, &less).expect("written");
            let again = io::read(&out).expect("read").mesh;
            // Vertices at one place that move alike stay at one place: no animation opens an edge between them.
            assert!(several(&again) <= before, "{name} at {share}");
        }
    }
}
