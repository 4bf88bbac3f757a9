//! What comes out of glTF files that go through the mesh: everything that the mesh did not change, as it was.

use std::{collections::BTreeMap, fs, path::Path};

use glam::DVec3;
use lodmark::{
    io::{self, Encoding, Format},
    mesh::{Asset, ChannelKind, Mesh, MeshParts, canonical, generate, weld},
};
use serde_json::{Value, json};

use super::gltf_documents::{Builder, F32, U8, U16, accessor, asset, glb, section, text_of};
use crate::support::folder;

pub(super) fn read(bytes: &[u8]) -> Mesh {
    io::read_bytes(Format::Glb, bytes, "-")
        .expect("a good file")
        .mesh
}

pub(super) fn write(mesh: &Mesh) -> (Vec<u8>, Vec<String>) {
    io::encode(mesh, Encoding::Glb).expect("it can be written")
}

/// The mesh without some of its triangles, and with some of its vertices moved.
pub(super) fn edited(
    mesh: &Mesh,
    keeps: impl Fn(usize) -> bool,
    moves: impl Fn(DVec3) -> DVec3,
) -> Mesh {
    let mut parts = mesh.clone().into_parts();
    let kept: Vec<usize> = (0..parts.triangles.len()).filter(|&t| keeps(t)).collect();
    let kinds: Vec<ChannelKind> = parts.attributes.channels().iter().map(|c| c.kind).collect();
    let corners = parts.attributes.corners();
    let corners = kept
        .iter()
        .filter_map(|&t| corners.get(t).copied())
        .collect();
    let values = parts.attributes.values().to_vec();
    parts.attributes = lodmark::Attributes::new(&kinds, values, corners).expect("valid");
    parts.triangles = kept.iter().map(|&t| parts.triangles[t]).collect();
    parts.materials.of_triangle = kept
        .iter()
        .map(|&t| parts.materials.of_triangle[t])
        .collect();
    for p in &mut parts.positions {
        *p = moves(*p);
    }
    Mesh::new(parts).expect("valid")
}

fn without_first(mesh: &Mesh) -> Mesh {
    edited(mesh, |t| t > 0, |p| p)
}

/// What a reader makes of it: the order is not part of it, directions are those of 32-bit floats.
pub(super) fn same(a: &Mesh, b: &Mesh) {
    let plain = |mesh: &Mesh| canonical(&weld(mesh.clone()).mesh).mesh;
    let (a, b) = (plain(a), plain(b));
    assert_eq!(a.positions(), b.positions());
    assert_eq!(a.triangles(), b.triangles());
    assert_eq!(a.materials().names, b.materials().names);
    assert_eq!(a.materials().of_triangle, b.materials().of_triangle);
    let rows = |mesh: &Mesh| -> Vec<f64> {
        let corners = mesh.attributes().corners().as_flattened().iter();
        corners
            .flat_map(|&w| mesh.attributes().row(w).to_vec())
            .collect()
    };
    for (x, y) in rows(&a).into_iter().zip(rows(&b)) {
        assert!(
            (x.is_nan() && y.is_nan()) || (x - y).abs() < 1e-6,
            "{x} {y}"
        );
    }
}

/// Two squares of two triangles, side by side, with everything that vertices can have.
fn squares(extra: Value) -> Vec<u8> {
    let mut builder = Builder::default();
    let mut primitives = Vec::new();
    for x in [0.0, 1.0] {
        let corners = [
            [x, 0.0, 0.0],
            [x + 1.0, 0.0, 0.0],
            [x + 1.0, 1.0, 0.0],
            [x, 1.0, 0.25],
        ];
        let mut add = |component, shape, normalized, values: &[f64]| {
            builder.add(component, shape, normalized, values)
        };
        let of_four = |four: &[f64]| four.repeat(4);
        primitives.push(json!({
            "attributes": {
                "POSITION": add(F32, "VEC3", false, corners.as_flattened()),
                "NORMAL": add(F32, "VEC3", false, &of_four(&[0.0, 0.0, 1.0])),
                "TANGENT": add(F32, "VEC4", false, &of_four(&[1.0, 0.0, 0.0, -1.0])),
                "TEXCOORD_0": add(F32, "VEC2", false, &[0.0, 0.0, 0.9, 0.0, 0.9, 0.9, 0.0, 0.9]),
                "TEXCOORD_1": add(U16, "VEC2", true, &of_four(&[0.25, 0.5])),
                "COLOR_0": add(U8, "VEC4", true, &[255.0, 51.0, 0.0, 255.0].repeat(4).map_to(255.0)),
                "JOINTS_0": add(U8, "VEC4", false, &of_four(&[0.0, 1.0, 0.0, 0.0])),
                "WEIGHTS_0": add(U8, "VEC4", true, &[128.0, 127.0, 0.0, 0.0].repeat(4).map_to(255.0)),
                "_ID": add(U16, "SCALAR", false, &[7.0, 7.0, 8.0, 60000.0]),
            },
            "targets": [
                { "POSITION": add(F32, "VEC3", false, &of_four(&[0.0, 0.0, 0.5])) },
                {
                    "POSITION": add(F32, "VEC3", false, &of_four(&[0.0, 0.125, 0.0])),
                    "NORMAL": add(F32, "VEC3", false, &of_four(&[0.5, 0.0, 0.0])),
                },
            ],
            "indices": add(U16, "SCALAR", false, &[0.0, 1.0, 2.0, 0.0, 2.0, 3.0]),
            "material": primitives.len(),
            "extras": { "kept": x },
        }));
    }
    let image = builder.view(b"\x89PNG\r\n\x1a\n not really");
    let key = builder.add(F32, "SCALAR", false, &[0.0, 1.0]);
    let moves = builder.add(F32, "VEC3", false, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let mut document = json!({
        "asset": { "version": "2.0", "copyright": "somebody", "generator": "a test" },
        "scene": 0,
        "scenes": [{ "nodes": [0, 1, 2] }],
        "nodes": [{ "mesh": 0, "skin": 0 }, {}, {}],
        "skins": [{ "joints": [1, 2] }],
        "materials": [{ "name": "left" }, { "name": "right" }],
        "images": [{ "bufferView": image, "mimeType": "image/png" }],
        "meshes": [{ "name": "pair", "primitives": primitives, "weights": [0, 0] }],
        "animations": [{
            "samplers": [{ "input": key, "output": moves }],
            "channels": [{ "sampler": 0, "target": { "node": 1, "path": "translation" } }],
        }],
        "extras": { "note": 1.50 },
    });
    for (name, value) in extra.as_object().expect("an object") {
        document[name] = value.clone();
    }
    builder.finish(document)
}

trait MapTo {
    fn map_to(self, one: f64) -> Vec<f64>;
}

impl MapTo for Vec<f64> {
    /// Integers as the numbers that they stand for.
    fn map_to(self, one: f64) -> Vec<f64> {
        self.into_iter().map(|x| x / one).collect()
    }
}

#[test]
fn a_mesh_that_did_not_change_gives_back_every_section_and_every_byte() {
    let bytes = squares(json!({}));
    let mesh = read(&bytes);
    let (written, notes) = write(&mesh);
    assert!(notes.is_empty(), "{notes:?}");
    let again = read(&written);
    assert_eq!(asset(&again).sections, asset(&mesh).sections);
    assert_eq!(asset(&again).buffers, asset(&mesh).buffers);
    assert_eq!(again, mesh);
    // As the methods take it: welded and sorted, triangles turned.
    let taken = canonical(&weld(mesh.clone()).mesh).mesh;
    assert_eq!(write(&taken).0, written);
}

#[test]
fn a_primitive_that_changed_is_appended_and_nothing_else_moves() {
    let mesh = read(&squares(json!({})));
    let taken = edited(&mesh, |t| t != 2, |p| p);
    let (written, notes) = write(&taken);
    assert!(notes.is_empty(), "{notes:?}");
    let again = read(&written);
    same(&again, &taken);
    let (old, new) = (asset(&mesh), asset(&again));
    for (name, text) in &old.sections {
        if !["meshes", "accessors", "bufferViews", "buffers"].contains(&name.as_str()) {
            assert_eq!(Some(text.as_str()), text_of(new, name), "{name}");
        }
    }
    let meshes = section(new, "meshes");
    assert_eq!(
        meshes[0]["primitives"][0],
        section(old, "meshes")[0]["primitives"][0]
    );
    assert_eq!(meshes[0]["weights"], json!([0, 0]));
    let primitive = &meshes[0]["primitives"][1];
    assert_eq!(primitive["extras"], json!({ "kept": 1.0 }));
    assert_eq!(primitive["material"], 1);
    let before = section(old, "accessors").as_array().expect("a list").len() as u64;
    for (name, index) in primitive["attributes"].as_object().expect("attributes") {
        assert!(index.as_u64().expect("an index") >= before, "{name}");
        let was = &section(old, "meshes")[0]["primitives"][1]["attributes"][name];
        let (was, is) = (accessor(old, was), accessor(new, index));
        // The triangle that is left has vertices 0, 2 and 3: their values, bit for bit.
        if name == "TEXCOORD_1" {
            assert_eq!(
                is.elements[0],
                [0.250_003_8_f32, 0.500_007_6].map(f64::from)
            );
            continue;
        }
        let kept: Vec<f64> = [0, 2, 3]
            .iter()
            .flat_map(|&v| was.elements[v].clone())
            .collect();
        let found: Vec<f64> = is.elements.concat();
        let mut sorted = (kept.clone(), found.clone());
        sorted.0.sort_by(f64::total_cmp);
        sorted.1.sort_by(f64::total_cmp);
        assert_eq!(sorted.0, sorted.1, "{name}");
        if ["COLOR_0", "JOINTS_0", "WEIGHTS_0", "_ID"].contains(&name.as_str()) {
            assert_eq!(
                was.entry["componentType"], is.entry["componentType"],
                "{name}"
            );
            assert_eq!(was.entry["normalized"], is.entry["normalized"], "{name}");
        }
    }
    let positions = accessor(new, &primitive["attributes"]["POSITION"]);
    assert_eq!(positions.entry["min"], json!([1.0, 0.0, 0.0]));
    assert_eq!(positions.entry["max"], json!([2.0, 1.0, 0.25]));
    assert_eq!(primitive["targets"].as_array().map(Vec::len), Some(2));
    // What the other primitive and the animation refer to is the same text, but for where its bytes are.
    let (was, is) = (section(old, "accessors"), section(new, "accessors"));
    assert_eq!(was[0], is[0]);
    assert_eq!(
        was[was.as_array().map_or(0, Vec::len) - 1],
        is[before as usize - 1]
    );
    assert_eq!(
        accessor(new, &json!(before - 1)).elements,
        accessor(old, &json!(before - 1)).elements
    );
}

#[test]
fn what_nothing_refers_to_becomes_a_stub_and_its_bytes_go() {
    let mesh = read(&squares(json!({})));
    let (written, _) = write(&edited(&mesh, |t| t != 2, |p| p));
    let again = read(&written);
    let (old, new) = (asset(&mesh), asset(&again));
    let dead = &section(old, "meshes")[0]["primitives"][1]["attributes"]["POSITION"];
    let dead = dead.as_u64().expect("an index") as usize;
    let stub = &section(new, "accessors")[dead];
    assert_eq!(
        stub,
        &json!({ "componentType": F32, "count": 1, "type": "VEC3" })
    );
    let view = &section(new, "bufferViews")[dead];
    assert_eq!(view, &json!({ "buffer": 0, "byteLength": 4 }));
    assert!(new.buffers[0].len() < old.buffers[0].len() + 4);
    let image = image_bytes(new, 0);
    assert_eq!(image, image_bytes(old, 0));
}

fn image_bytes(asset: &Asset, image: usize) -> &[u8] {
    let view = section(asset, "images")[image]["bufferView"]
        .as_u64()
        .expect("a view") as usize;
    let view = &section(asset, "bufferViews")[view];
    let number = |name: &str| view[name].as_u64().unwrap_or(0) as usize;
    &asset.buffers[number("buffer")][number("byteOffset")..][..number("byteLength")]
}

#[test]
fn beside_an_unknown_extension_everything_stays() {
    let mesh = read(&squares(json!({ "extensionsUsed": ["ACME_anything"] })));
    let (written, notes) = write(&edited(&mesh, |t| t != 2, |p| p));
    assert!(
        notes.iter().any(|n| n.contains("ACME_anything")),
        "{notes:?}"
    );
    let again = read(&written);
    let (old, new) = (asset(&mesh), asset(&again));
    assert!(new.buffers[0].starts_with(&old.buffers[0]));
    for list in ["accessors", "bufferViews"] {
        let (old, new) = (section(old, list), section(new, list));
        let (old, new) = (
            old.as_array().expect("a list"),
            new.as_array().expect("a list"),
        );
        assert_eq!(new[..old.len()], old[..], "{list}");
    }
}

#[test]
fn placements_are_undone_and_mirrors_turn_no_face_over() {
    for node in [
        json!({ "mesh": 0, "scale": [-2.0, 2.0, 2.0], "translation": [3.0, 0.5, 0.0] }),
        json!({ "mesh": 0, "scale": [4.0, 0.5, 2.0] }),
        json!({ "mesh": 0, "rotation": [0.0, 0.0, 0.6, 0.8], "scale": [1.0, 1.0, -1.0] }),
    ] {
        let mesh = read(&squares(json!({ "nodes": [node, {}, {}] })));
        let moved = edited(
            &mesh,
            |t| t != 2,
            |p| if p.z > 0.1 { p + DVec3::splat(0.25) } else { p },
        );
        let (written, _) = write(&moved);
        same(&read(&written), &moved);
    }
}

#[test]
fn weights_of_new_vertices_sum_exactly() {
    let mesh = read(&squares(json!({})));
    let (skin, mut parts) = (
        mesh.attributes().channel(ChannelKind::Skin(0)),
        mesh.clone().into_parts(),
    );
    let skin = skin.expect("a skin");
    let stride = parts.attributes.stride();
    let mut values = parts.attributes.values().to_vec();
    for row in values.chunks_mut(stride) {
        row[skin.offset..][..8].copy_from_slice(&[1.0, 0.0, 0.0, 0.0, 0.3, 0.3, 0.2, 0.2]);
    }
    let kinds: Vec<ChannelKind> = parts.attributes.channels().iter().map(|c| c.kind).collect();
    let corners = parts.attributes.corners().to_vec();
    parts.attributes = lodmark::Attributes::new(&kinds, values, corners).expect("valid");
    let changed = Mesh::new(parts).expect("valid");
    let again = read(&write(&changed).0);
    let primitive = &section(asset(&again), "meshes")[0]["primitives"][0];
    let weights = accessor(asset(&again), &primitive["attributes"]["WEIGHTS_0"]);
    assert_eq!(weights.entry["componentType"], U8);
    for element in weights.elements {
        assert_eq!(element.iter().sum::<f64>() as u32, 255);
    }
}

#[test]
fn a_part_that_is_gone_stays_valid_and_is_said() {
    let mesh = read(&squares(json!({})));
    let left = edited(&mesh, |t| t < 2, |p| p);
    let (written, notes) = write(&left);
    assert!(
        notes.iter().any(|n| n.starts_with("vanished: right;")),
        "{notes:?}"
    );
    let again = read(&written);
    assert_eq!(again.triangles().len(), 3);
    assert_eq!(again.materials().names.len(), 2);
    assert_eq!(canonical(&weld(again).mesh).mesh.triangles().len(), 2);
}

#[test]
fn a_strip_that_changed_becomes_a_list() {
    let mut builder = Builder::default();
    let positions = [0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0., 0., 2., 0.];
    let positions = builder.add(F32, "VEC3", false, &positions);
    let document = json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": positions }, "mode": 5 }] }],
    });
    let mesh = read(&builder.finish(document));
    assert_eq!(mesh.triangles().len(), 3);
    let unchanged = read(&write(&mesh).0);
    assert_eq!(asset(&unchanged).sections, asset(&mesh).sections);
    let less = without_first(&mesh);
    let again = read(&write(&less).0);
    assert_eq!(
        section(asset(&again), "meshes")[0]["primitives"][0].get("mode"),
        None
    );
    same(&again, &less);
}

#[test]
fn attributes_that_no_channel_carries_are_dropped_with_a_word() {
    let known = read(&squares(json!({})));
    let sections = asset(&known).sections.iter();
    let sections: Vec<String> = sections
        .map(|(name, text)| format!("\"{name}\":{}", text.replace("\"_ID\"", "\"WHAT\"")))
        .collect();
    let mesh = read(&glb(
        &format!("{{{}}}", sections.join(",")),
        &asset(&known).buffers[0],
    ));
    let (written, notes) = write(&without_first(&mesh));
    assert!(notes.iter().any(|n| n.contains("WHAT")), "{notes:?}");
    let again = read(&written);
    let primitives = &section(asset(&again), "meshes")[0]["primitives"];
    assert_eq!(primitives[0]["attributes"].get("WHAT"), None);
    assert!(primitives[1]["attributes"].get("WHAT").is_some());
}

#[test]
fn views_that_nobody_reads_may_be_wrong_and_stay_so() {
    let known = read(&squares(json!({})));
    let broken = r#"{"buffer":0,"byteOffset":99999999,"byteLength":5}"#;
    let sections = asset(&known)
        .sections
        .iter()
        .map(|(name, text)| match name.as_str() {
            "bufferViews" => format!("\"{name}\":{},{broken}]", &text[..text.len() - 1]),
            _ => format!("\"{name}\":{text}"),
        });
    let sections: Vec<String> = sections.collect();
    let mesh = read(&glb(
        &format!("{{{}}}", sections.join(",")),
        &asset(&known).buffers[0],
    ));
    for changed in [mesh.clone(), without_first(&mesh)] {
        let again = read(&write(&changed).0);
        assert!(
            text_of(asset(&again), "bufferViews")
                .expect("views")
                .contains(broken)
        );
    }
}

#[test]
fn meshes_of_other_formats_get_a_document_of_their_own() {
    let folder = folder();
    let torus = canonical(&generate::textured_torus(12, 6)).mesh;
    for name in ["a.glb", "a.gltf"] {
        let path = folder.path().join(name);
        torus.write(&path).expect("written");
        let again = Mesh::read(&path).expect("read");
        assert_eq!(again.positions(), torus.positions(), "{name}");
        assert_eq!(again.triangles().len(), torus.triangles().len());
        // And back: v runs up again.
        let back = folder.path().join("b.obj");
        again.write(&back).expect("written");
        let back = Mesh::read(&back).expect("read");
        let uv = |mesh: &Mesh| {
            mesh.attributes()
                .channel(ChannelKind::TexCoord(0))
                .expect("UVs")
        };
        for (a, b) in back.triangles().iter().zip(torus.triangles()) {
            assert_eq!(a, b);
        }
        for (a, b) in back
            .attributes()
            .corners()
            .iter()
            .zip(torus.attributes().corners())
        {
            for (&a, &b) in a.iter().zip(b) {
                let a = back.attributes().value(uv(&back), a);
                let b = torus.attributes().value(uv(&torus), b);
                assert!((a[0] - b[0]).abs() < 1e-7 && (a[1] - b[1]).abs() < 1e-7);
            }
        }
    }
    let named = "usemtl steel\nf 1 2 3\nusemtl wood\nf 1 3 4\n";
    let mesh = super::readers::obj(&format!("{}{named}", super::readers::SQUARE))
        .expect("valid")
        .mesh;
    let again = read(&write(&mesh).0);
    assert_eq!(again.materials().names, ["steel", "wood"]);
    assert_eq!(again.triangles().len(), 2);
    let empty = Mesh::new(MeshParts::default()).expect("valid");
    assert!(io::encode(&empty, Encoding::Glb).is_ok());
    let far = Mesh::new(MeshParts {
        positions: vec![DVec3::splat(1e300), DVec3::X, DVec3::Y],
        triangles: vec![[0, 1, 2]],
        precision: lodmark::Precision::F64,
        ..MeshParts::default()
    });
    let refused = io::encode(&far.expect("valid"), Encoding::Glb);
    assert_eq!(refused.expect_err("too far").exit_code(), 4);
}

#[test]
fn a_document_has_its_files_beside_it_and_replaces_no_others() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("in")).expect("a folder");
    fs::write(at("in/a b.png"), b"\x89PNG\r\n\x1a\n pixels").expect("written");
    let bytes = squares(json!({ "images": [{ "uri": "a%20b.png", "name": "painted" }] }));
    let mesh = io::read_bytes(Format::Glb, &bytes, at("in/x.glb"))
        .expect("good")
        .mesh;
    let names = |below: &str| -> Vec<String> {
        let entries = fs::read_dir(at(below)).expect("a folder");
        let mut names: Vec<String> = entries
            .map(|e| {
                e.expect("an entry")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        names.sort();
        names
    };
    fs::create_dir(at("out")).expect("a folder");
    mesh.write(at("out/my mesh.gltf")).expect("written");
    assert_eq!(names("out"), ["a b.png", "my mesh.bin", "my mesh.gltf"]);
    let again = Mesh::read_as_stored(at("out/my mesh.gltf")).expect("read");
    assert_eq!(section(asset(&again), "buffers")[0]["uri"], "my%20mesh.bin");
    assert_eq!(
        text_of(asset(&again), "images"),
        text_of(asset(&mesh), "images")
    );
    same(&again, &mesh);
    // Again, over itself; then beside files of others.
    again.write(at("out/my mesh.gltf")).expect("written");
    assert_eq!(names("out").len(), 3);
    fs::write(at("out/a b.png"), b"other pixels").expect("written");
    fs::write(at("out/new.bin"), b"other bytes").expect("written");
    mesh.write(at("out/new.gltf")).expect("written");
    assert_eq!(fs::read(at("out/new.bin")).expect("there"), b"other bytes");
    assert_eq!(fs::read(at("out/a b.png")).expect("there"), b"other pixels");
    let again = Mesh::read_as_stored(at("out/new.gltf")).expect("read");
    assert_eq!(section(asset(&again), "images")[0]["uri"], "a%20b-2.png");
    // A GLB elsewhere takes its images along.
    mesh.write(at("out/whole.glb")).expect("written");
    let whole = Mesh::read_as_stored(at("out/whole.glb")).expect("read");
    assert_eq!(section(asset(&whole), "images")[0]["mimeType"], "image/png");
    assert_eq!(section(asset(&whole), "images")[0]["name"], "painted");
    assert_eq!(image_bytes(asset(&whole), 0), b"\x89PNG\r\n\x1a\n pixels");
    // One text with everything in it.
    let (text, _) = io::encode(&mesh, Encoding::Gltf).expect("written");
    let again = io::read_bytes(Format::Gltf, &text, "-").expect("read").mesh;
    same(&again, &mesh);
}

#[test]
fn names_that_leave_the_folder_are_left_alone() {
    let folder = folder();
    let out = folder.path().join("out.gltf");
    let outside = json!({ "images": [{ "uri": "../x.png" }, { "uri": "missing.png" }] });
    let mesh = io::read_bytes(Format::Glb, &squares(outside), "elsewhere/x.glb")
        .expect("good")
        .mesh;
    let notes = io::write(&out, &mesh).expect("written");
    assert_eq!(notes.len(), 2, "{notes:?}");
    let files: BTreeMap<_, _> = fs::read_dir(folder.path())
        .expect("a folder")
        .map(|e| (e.expect("an entry").file_name(), ()))
        .collect();
    assert_eq!(files.len(), 2);
    assert!(!Path::new("x.png").exists());
}
