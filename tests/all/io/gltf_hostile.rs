//! Damaged and hostile glTF: an error that says where, never a panic, a hang, or memory that the file does not back.

use lodmark::{
    Error,
    io::{self, Format},
};
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::support::GltfBuilder;

/// A document with a little of everything.
fn rich() -> GltfBuilder {
    let mut document = GltfBuilder::new();
    let points = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.5];
    let position = document.floats("VEC3", &points);
    let uv = document.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    let normal = document.floats("VEC3", &[[0.0, 0.0, 1.0]; 4].concat());
    let weights = document.floats("VEC4", &[[1.0, 0.0, 0.0, 0.0]; 4].concat());
    let joints = document.view(&[0; 16]);
    let joints = document.push(
        "accessors",
        json!({"bufferView": joints, "componentType": 5121, "count": 4, "type": "VEC4"}),
    );
    let indices = document.indices(&[0, 1, 2, 1, 3, 2]);
    let places = document.view(&[1, 3]);
    let values = document.view(&[0; 24]);
    let delta = document.push(
        "accessors",
        json!({"componentType": 5126, "count": 4, "type": "VEC3", "sparse": {
            "count": 2, "indices": {"bufferView": places, "componentType": 5121}, "values": {"bufferView": values}}}),
    );
    let scales = document.floats("VEC3", &[1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    let mesh = document.mesh(json!([
        {"attributes": {"POSITION": position, "TEXCOORD_0": uv, "NORMAL": normal, "JOINTS_0": joints, "WEIGHTS_0": weights},
         "indices": indices, "targets": [{"POSITION": delta}], "material": 0},
        {"attributes": {"POSITION": position}, "mode": 5},
    ]));
    document.json["materials"] = json!([{"name": "m"}]);
    let joint = document.node(json!({"rotation": [0, 0, 1, 0]}));
    document.json["skins"] = json!([{"joints": [joint]}]);
    document.node(json!({"mesh": mesh, "skin": 0}));
    let instancing = json!({"attributes": {"SCALE": scales}});
    document.node(json!({"mesh": mesh, "extensions": {"EXT_mesh_gpu_instancing": instancing}}));
    document
}

/// Reads, and holds the reader to its contract.
fn read(bytes: &[u8]) -> Result<usize, String> {
    match io::read_bytes(Format::Glb, bytes, "-") {
        Ok(loaded) => Ok(loaded.mesh.triangles().len()),
        Err(error @ (Error::Input { .. } | Error::Unsupported(_))) => {
            let text = error.to_string();
            assert!(text.len() < 1000, "a message, not a dump: {text}");
            Err(text)
        }
        Err(error) => panic!("another kind of error: {error}"),
    }
}

/// What the reader says about the document after a change.
fn said(change: impl FnOnce(&mut Value)) -> String {
    let mut document = rich();
    change(&mut document.json);
    read(&document.glb()).expect_err("hostile")
}

#[test]
fn the_document_that_the_others_damage_is_good() {
    assert_eq!(read(&rich().glb()), Ok(4));
}

#[test]
fn a_glb_that_is_cut_off_is_an_error_wherever_it_ends() {
    let bytes = rich().glb();
    for end in 0..bytes.len() {
        assert!(read(&bytes[..end]).is_err(), "cut at {end}");
    }
    let mut longer = bytes;
    longer.extend([0; 5]);
    assert_eq!(read(&longer), Ok(4));
}

#[test]
fn what_does_not_exist_is_named_with_who_names_it() {
    let primitive = |json: &mut Value| json["meshes"][0]["primitives"][0].take();
    for (change, expected) in [
        (
            &(|json: &mut Value| json["nodes"][1]["mesh"] = json!(9)) as &dyn Fn(&mut Value),
            "nodes[1] names meshes[9]",
        ),
        (&|json| json["nodes"][1]["skin"] = json!(9), "skins[9]"),
        (
            &|json| json["nodes"][0]["children"] = json!([9]),
            "nodes[0] names nodes[9]",
        ),
        (&|json| json["scenes"][0]["nodes"] = json!([9]), "nodes[9]"),
        (&|json| json["scene"] = json!(9), "scenes[9]"),
        (&|json| json["skins"][0]["joints"] = json!([9]), "nodes[9]"),
        (&|json| json["skins"][0]["joints"] = json!([]), "no joints"),
        (
            &|json| json["meshes"][0]["primitives"][0]["indices"] = json!(99),
            "accessors[99]",
        ),
        (
            &|json| json["meshes"][0]["primitives"][0]["material"] = json!(99),
            "materials[99]",
        ),
        (
            &|json| json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(1),
            "expected 3 of a position",
        ),
        (
            &|json| json["meshes"][0]["primitives"][0]["attributes"] = json!({}),
            "no attribute POSITION",
        ),
        (
            &|json| json["meshes"][0]["primitives"][0]["mode"] = json!(7),
            "unknown mode 7",
        ),
        (
            &|json| json["meshes"][0]["primitives"][0]["indices"] = json!(0),
            "cannot be indices",
        ),
        (
            &|json| json["accessors"][0]["bufferView"] = json!(99),
            "bufferViews[99]",
        ),
        (
            &|json| json["accessors"][0]["componentType"] = json!(5124),
            "component type 5124",
        ),
        (&|json| json["accessors"][0]["type"] = json!("VEC5"), "VEC5"),
        (
            &|json| json["accessors"][0]["count"] = json!(3),
            "there are 3 vertices",
        ),
        (&|json| json["accessors"][1]["count"] = json!(3), "expected"),
        (
            &|json| json["accessors"][0]["byteOffset"] = json!(u64::MAX),
            "go beyond",
        ),
        (
            &|json| json["bufferViews"][0]["byteOffset"] = json!(u64::MAX),
            "buffers[0]",
        ),
        (
            &|json| json["bufferViews"][0]["buffer"] = json!(1),
            "buffers[1]",
        ),
        (
            &|json| json["bufferViews"][0]["byteStride"] = json!(4),
            "apart",
        ),
        (
            &|json| drop(json.as_object_mut().expect("an object").remove("asset")),
            "asset",
        ),
        (&|json| json["accessors"] = json!([{}]), "accessors"),
        (&|json| json["accessors"] = json!("many"), "accessors"),
        (&|json| drop(primitive(json)), "meshes"),
    ] {
        let said = said(change);
        assert!(
            said.contains(expected),
            "{said} does not tell of {expected}"
        );
    }
}

#[test]
fn nodes_that_are_no_trees_are_refused() {
    for (change, expected) in [
        (
            &(|json: &mut Value| json["nodes"][0]["children"] = json!([0])) as &dyn Fn(&mut Value),
            "its own ancestor",
        ),
        (
            &|json| {
                json["nodes"][0]["children"] = json!([1]);
                json["nodes"][1]["children"] = json!([0]);
            },
            "its own ancestor",
        ),
        (
            &|json| {
                json["nodes"][0]["children"] = json!([2]);
                json["nodes"][1]["children"] = json!([2]);
            },
            "expected one parent",
        ),
        (
            &|json| json["nodes"][0]["children"] = json!([1, 1]),
            "expected one parent",
        ),
    ] {
        let said = said(change);
        assert!(said.contains(expected), "{said}");
    }
    // A chain that would exhaust a stack.
    let mut document = rich();
    let length = 100_000;
    let nodes = (0..length).map(|n| {
        if n + 1 < length {
            json!({"children": [n + 1]})
        } else {
            json!({"mesh": 0})
        }
    });
    document.json["nodes"] = nodes.collect();
    document.json["scenes"][0]["nodes"] = json!([0]);
    assert_eq!(read(&document.glb()), Ok(4));
}

#[test]
fn counts_that_no_bytes_back_are_refused_before_memory_is_taken() {
    for accessor in 0..8 {
        let said = said(|json| json["accessors"][accessor]["count"] = json!(1_000_000_000));
        assert!(
            said.contains("accessors") || said.contains("size"),
            "{said}"
        );
    }
    for (change, expected) in [
        (
            &(|json: &mut Value| json["accessors"][6]["sparse"]["count"] = json!(1_000_000_000))
                as &dyn Fn(&mut Value),
            "size justifies",
        ),
        (
            &|json| json["accessors"][6]["sparse"]["count"] = json!(100),
            "sparse indices",
        ),
        (
            &|json| {
                json["accessors"][0] =
                    json!({"componentType": 5126, "count": 4_000_000_000_u32, "type": "VEC3"})
            },
            "",
        ),
        (
            &|json| {
                json["accessors"][0] =
                    json!({"componentType": 5126, "count": u64::MAX, "type": "VEC3"})
            },
            "too many",
        ),
        (
            &|json| json["buffers"] = json!([{"byteLength": 1_000_000_000}]),
            "cut off",
        ),
    ] {
        let said = match said_of(change) {
            Ok(text) => text,
            Err(text) => text,
        };
        assert!(said.contains(expected), "{said}");
    }
    // One set of vertices for very many primitives.
    let mut document = GltfBuilder::new();
    let position = document.floats("VEC3", &vec![1.0; 30_000]);
    let primitives: Vec<Value> = (0..10_000)
        .map(|_| json!({"attributes": {"POSITION": position}}))
        .collect();
    let mesh = document.mesh(json!(primitives));
    document.node(json!({"mesh": mesh}));
    let said = read(&document.glb()).expect_err("a bomb");
    assert!(said.contains("size justifies"), "{said}");
    // The same, of which each uses a triangle, is a file as others are.
    let few = document.indices(&[5, 6, 7]);
    let primitives: Vec<Value> = (0..10_000)
        .map(|_| json!({"attributes": {"POSITION": position}, "indices": few}))
        .collect();
    document.json["meshes"][0]["primitives"] = json!(primitives);
    assert_eq!(read(&document.glb()), Ok(10_000));
}

/// As [`said`], of a document whose buffers the change may declare.
fn said_of(change: &dyn Fn(&mut Value)) -> Result<String, String> {
    let mut document = rich();
    change(&mut document.json);
    let text = document.text(json!({"uri": "data:,"}));
    let text = if document.json["buffers"].is_null() {
        return read(&document.glb()).map(|n| n.to_string());
    } else {
        text
    };
    let mut json: Value = serde_json::from_str(&text).expect("JSON");
    json["buffers"] = document.json["buffers"].clone();
    json["buffers"][0]["uri"] = json!("data:,abc");
    io::read_bytes(Format::Gltf, json.to_string().as_bytes(), "-")
        .map(|_| String::new())
        .map_err(|e| e.to_string())
}

#[test]
fn names_as_long_as_the_file_do_not_fill_a_message() {
    let long = "n".repeat(100_000);
    for change in [
        &(|json: &mut Value| json["accessors"][0]["type"] = json!(long)) as &dyn Fn(&mut Value),
        &|json| json["accessors"][0]["count"] = json!(long),
        &|json| json["extensionsRequired"] = json!([long]),
        &|json| json["asset"]["version"] = json!(long),
    ] {
        said(change);
    }
}

#[test]
fn sparse_indices_out_of_order_or_range_are_refused() {
    for (bytes, expected) in [
        ([3, 1], "increasing"),
        ([1, 1], "increasing"),
        ([1, 4], "there are 4"),
    ] {
        let mut document = rich();
        let at = document.json["bufferViews"][6]["byteOffset"]
            .as_u64()
            .expect("a number") as usize;
        assert_eq!(document.bin[at..at + 2], [1, 3]);
        document.bin[at..at + 2].copy_from_slice(&bytes);
        let said = read(&document.glb()).expect_err("hostile");
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    for bad in [f32::NAN, f32::INFINITY] {
        let mut document = rich();
        document.bin[..4].copy_from_slice(&bad.to_le_bytes());
        let said = read(&document.glb()).expect_err("hostile");
        assert!(
            said.contains("vertex 0") && said.contains("meshes[0]"),
            "{said}"
        );
    }
    let said = said(|json| json["nodes"][2]["scale"] = json!([1e60, 1e60, 1e60]));
    assert!(said.contains("32-bit"), "{said}");
}

#[test]
fn what_is_required_and_not_supported_ends_with_4() {
    let draco = json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {}}});
    for change in [
        &(|json: &mut Value| json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]))
            as &dyn Fn(&mut Value),
        &|json| json["extensionsRequired"] = json!(["KHR_texture_transform", "ACME_magic"]),
        &|json| json["asset"]["version"] = json!("1.0"),
        &|json| json["asset"]["minVersion"] = json!("2.1"),
        &|json| {
            json["meshes"][0]["primitives"][0]["extensions"] = draco.clone();
            json["accessors"][0]
                .as_object_mut()
                .expect("an object")
                .remove("bufferView");
        },
    ] {
        let mut document = rich();
        change(&mut document.json);
        let error =
            io::read_bytes(Format::Glb, &document.glb(), "a.glb").expect_err("not supported");
        assert_eq!(error.exit_code(), 4, "{error}");
        assert!(error.to_string().starts_with("a.glb: "), "{error}");
    }
    // Beside data that everyone can read it is no obstacle.
    let mut document = rich();
    document.json["meshes"][0]["primitives"][0]["extensions"] = draco;
    document.json["extensionsRequired"] = json!(["KHR_materials_anything"]);
    assert_eq!(read(&document.glb()), Ok(4));
}

proptest! {
    #![proptest_config(crate::support::cases(1500))]

    #[test]
    fn flipped_bytes_of_a_glb_are_never_a_panic(
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<bool>()), 1..6),
    ) {
        let mut bytes = rich().glb();
        for (at, byte, whole) in flips {
            let at = at.index(bytes.len());
            bytes[at] = if whole { byte } else { bytes[at] ^ (1 << (byte % 8)) };
        }
        let _ = read(&bytes);
    }

    #[test]
    fn numbers_of_the_document_changed_at_will_are_never_a_panic(
        changes in prop::collection::vec(
            (any::<prop::sample::Index>(), prop::sample::select(vec!["0", "1", "2", "7", "255", "5121", "5125", "65535", "1e9", "4294967295", "18446744073709551615", "-1", "0.5", "null", "[]"])),
            1..4,
        ),
    ) {
        let document = rich();
        let mut text = document.text(json!({"uri": "data:,"}));
        let data: String = document.bin.iter().map(|byte| format!("%{byte:02x}")).collect();
        for (at, new) in changes {
            let starts: Vec<usize> = text.char_indices().zip(text.chars().skip(1))
                .filter(|((_, a), b)| !a.is_ascii_digit() && b.is_ascii_digit()).map(|((i, _), _)| i + 1).collect();
            let start = starts[at.index(starts.len())];
            let length = text[start..].find(|c: char| !c.is_ascii_digit()).unwrap_or(0);
            text.replace_range(start..start + length, new);
        }
        let text = text.replace("data:,", &format!("data:,{data}"));
        let _ = read(text.as_bytes());
    }
}
