//! glTF as it should be: what the mesh is, and where it comes from.

use std::fs;

use glam::DVec3;
use lodmark::{
    io::{self, Encoding, Format, Loaded},
    mesh::{ChannelKind, Mesh, canonical, content_sha256, weld},
    num::math::sqrt,
};
use serde_json::json;

use crate::support::{GltfBuilder, asset_file, folder};

/// Corners of a square strip, and a fifth point beside it.
const POINTS: [f32; 15] = [
    0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 2.0, 1.0,
];

fn read(document: &GltfBuilder) -> Loaded {
    io::read_bytes(Format::Glb, &document.glb(), "-").expect("a good file")
}

/// The corners of all triangles.
fn corners(mesh: &Mesh) -> Vec<[DVec3; 3]> {
    (0..mesh.triangles().len())
        .map(|t| mesh.corners(t))
        .collect()
}

/// The values of a channel at the corners of all triangles.
fn values(mesh: &Mesh, kind: ChannelKind) -> Vec<Vec<f64>> {
    let attributes = mesh.attributes();
    let channel = attributes.channel(kind).expect("a channel");
    let wedges = attributes.corners().iter().flatten();
    wedges
        .map(|&wedge| attributes.value(channel, wedge).to_vec())
        .collect()
}

/// One triangle with the given attributes beside its positions.
fn triangle(document: &mut GltfBuilder, mut attributes: serde_json::Value) -> usize {
    attributes["POSITION"] = json!(document.floats("VEC3", &POINTS[..9]));
    document.mesh(json!([{"attributes": attributes}]))
}

/// Six times the volume of the cone from the origin: positive where faces turn outside.
fn volume(mesh: &Mesh) -> f64 {
    corners(mesh)
        .iter()
        .map(|[a, b, c]| a.dot(b.cross(*c)))
        .sum()
}

/// A tetrahedron around the origin.
fn tetrahedron(document: &mut GltfBuilder) -> usize {
    let points = [
        1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 1.0, -1.0, -1.0, -1.0, 1.0,
    ];
    let position = document.floats("VEC3", &points);
    let indices = document.indices(&[0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2]);
    document.mesh(json!([{"attributes": {"POSITION": position}, "indices": indices}]))
}

#[test]
fn strips_and_fans_are_the_triangles_that_the_specification_says() {
    let of = |mode: u32, indices: Option<&[u16]>| {
        let mut document = GltfBuilder::new();
        let position = document.floats("VEC3", &POINTS);
        let mut primitive = json!({"attributes": {"POSITION": position}, "mode": mode});
        if let Some(indices) = indices {
            primitive["indices"] = json!(document.indices(indices));
        }
        let mesh = document.mesh(json!([primitive]));
        document.node(json!({"mesh": mesh}));
        let loaded = read(&document);
        (corners(&loaded.mesh), loaded.notes)
    };
    let (list, notes) = of(4, Some(&[0, 1, 2, 1, 3, 2, 2, 3, 4]));
    assert_eq!(list[2][2], DVec3::new(0.0, 2.0, 1.0));
    assert!(notes.is_empty(), "{notes:?}");
    let turned = |t: [DVec3; 3]| [[t[0], t[1], t[2]], [t[1], t[2], t[0]], [t[2], t[0], t[1]]];
    let (strip, _) = of(5, None);
    assert_eq!(strip.len(), 3);
    for (found, expected) in strip.iter().zip(&list) {
        assert!(
            turned(*expected).contains(found),
            "{found:?} is not {expected:?}"
        );
    }
    let (fan, _) = of(6, Some(&[0, 1, 3, 2]));
    let (expected, _) = of(4, Some(&[1, 3, 0, 3, 2, 0]));
    assert_eq!(fan, expected);
    let (short, notes) = of(4, Some(&[0, 1, 2, 3]));
    assert_eq!((short.len(), notes.len()), (1, 1));
}

#[test]
fn points_lines_and_what_the_scene_does_not_show_are_left_and_noted() {
    let mut document = GltfBuilder::new();
    let mesh = triangle(&mut document, json!({}));
    let accessor = document.json["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"].clone();
    let lines = json!([{"attributes": {"POSITION": accessor}, "mode": 1}]);
    let lines = document.mesh(lines);
    triangle(&mut document, json!({}));
    document.node(json!({"mesh": mesh}));
    document.node(json!({"mesh": lines}));
    let loaded = read(&document);
    assert_eq!(loaded.mesh.triangles().len(), 1);
    assert_eq!(loaded.notes.len(), 2, "{:?}", loaded.notes);
    let asset = loaded.mesh.materials().asset.clone().expect("a document");
    assert_eq!(asset.parts.len(), 1);
    assert_eq!(asset.sections[0].0, "accessors");
    assert!(
        asset
            .sections
            .iter()
            .any(|(name, text)| name == "asset" && text.contains("nobody"))
    );
    document.json["scenes"] = json!([{"nodes": []}, {"nodes": [0]}]);
    assert_eq!(read(&document).mesh.triangles().len(), 0);
    document.json["scene"] = json!(1);
    assert_eq!(read(&document).mesh.triangles().len(), 1);
}

#[test]
fn sparse_elements_replace_those_of_the_view_or_zeros() {
    let mut document = GltfBuilder::new();
    let indices = document.view(&[1, 2]);
    let other: Vec<u8> = [5.0_f32, 0.0, 0.0, 0.0, 6.0, 0.0]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let values = document.view(&other);
    let sparse = json!({"count": 2, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    let mesh = triangle(&mut document, json!({}));
    document.json["accessors"][0]["sparse"] = sparse.clone();
    document.node(json!({"mesh": mesh}));
    let expected = [
        DVec3::ZERO,
        DVec3::new(5.0, 0.0, 0.0),
        DVec3::new(0.0, 6.0, 0.0),
    ];
    assert_eq!(corners(&read(&document).mesh), [expected]);
    document.json["accessors"][0] =
        json!({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": sparse});
    assert_eq!(corners(&read(&document).mesh), [expected]);
}

#[test]
fn strided_and_normalized_integers_are_the_numbers_they_stand_for() {
    let mut document = GltfBuilder::new();
    // Positions of 16-bit integers and texture coordinates of 8-bit ones, interleaved, 12 bytes a vertex.
    let mut bytes = Vec::new();
    for (p, t) in [
        ([0_i16, 0, 0], [0_u8, 255]),
        ([32767, 0, 0], [51, 0]),
        ([0, -32768, 0], [255, 102]),
    ] {
        bytes.extend(p.iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0, 0, t[0], t[1], 0, 0]);
    }
    let view = document.view(&bytes);
    document.json["bufferViews"][view]["byteStride"] = json!(12);
    let position = document.push(
        "accessors",
        json!({"bufferView": view, "componentType": 5122, "normalized": true, "count": 3, "type": "VEC3"}),
    );
    let uv = document.push(
        "accessors",
        json!({"bufferView": view, "byteOffset": 8, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC2"}),
    );
    let primitive = json!([{"attributes": {"POSITION": position, "TEXCOORD_0": uv}}]);
    let mesh = document.mesh(primitive);
    document.node(json!({"mesh": mesh, "scale": [2, 2, 2]}));
    document.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let mesh = read(&document).mesh;
    assert_eq!(
        corners(&mesh),
        [[
            DVec3::ZERO,
            DVec3::new(2.0, 0.0, 0.0),
            DVec3::new(0.0, -2.0, 0.0)
        ]]
    );
    let fifth = |n: u8| f64::from((f64::from(n) / 5.0) as f32);
    let expected = [[0.0, 1.0], [fifth(1), 0.0], [1.0, fifth(2)]];
    assert_eq!(values(&mesh, ChannelKind::TexCoord(0)), expected);
    // The same without the division.
    document.json["accessors"][position]["normalized"] = json!(false);
    assert_eq!(
        corners(&read(&document).mesh)[0][1],
        DVec3::new(65534.0, 0.0, 0.0)
    );
}

#[test]
fn buffers_are_read_from_files_beside_the_document_and_from_its_text() {
    let mut document = GltfBuilder::new();
    let mesh = triangle(&mut document, json!({}));
    document.node(json!({"mesh": mesh}));
    let expected = read(&document).mesh;
    let folder = folder();
    let path = folder.path().join("a.gltf");
    fs::create_dir(folder.path().join("my data")).expect("writable");
    fs::write(folder.path().join("my data/b.bin"), &document.bin).expect("writable");
    let escaped: String = document
        .bin
        .iter()
        .map(|byte| format!("%{byte:02x}"))
        .collect();
    let data = format!("data:application/octet-stream,{escaped}");
    for uri in ["my%20data/b.bin", "my data/../my%20data/./b.bin", &data] {
        fs::write(&path, document.text(json!({"uri": uri}))).expect("writable");
        let loaded = io::read(&path).expect(uri);
        assert_eq!(loaded.encoding, Encoding::Gltf);
        assert_eq!(loaded.mesh.positions(), expected.positions());
    }
    for uri in [
        "../b.bin",
        "my%20data/%2e%2e/../b.bin",
        "/etc/passwd",
        "file:///etc/passwd",
        "http://x/y",
        "",
    ] {
        fs::write(&path, document.text(json!({"uri": uri}))).expect("writable");
        let error = io::read(&path).expect_err(uri);
        assert_eq!(error.exit_code(), 3, "{error}");
        assert!(error.to_string().contains("inside it"), "{error}");
    }
    let text = document.text(json!({"uri": "b.bin"}));
    fs::write(&path, &text).expect("writable");
    assert_eq!(io::read(&path).expect_err("no file").exit_code(), 5);
    fs::write(folder.path().join("b.bin"), &document.bin[1..]).expect("writable");
    assert_eq!(io::read(&path).expect_err("a short file").exit_code(), 3);
    let error = io::read_bytes(Format::Gltf, text.as_bytes(), "-").expect_err("from memory");
    assert_eq!(error.exit_code(), 3, "{error}");
}

#[test]
fn base64_is_decoded_whatever_its_padding() {
    let mut document = GltfBuilder::new();
    let mesh = triangle(&mut document, json!({}));
    document.node(json!({"mesh": mesh}));
    // Nine floats, of which 2, 6 and so on are 1.
    let text = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    for uri in [
        format!("data:;base64,{text}"),
        format!("data:a/b;base64,{text}AA=="),
        format!("data:;base64,{text}AA"),
    ] {
        let text = document.text(json!({"uri": uri}));
        let loaded = io::read_bytes(Format::Gltf, text.as_bytes(), "-").expect(&uri);
        assert_eq!(corners(&loaded.mesh)[0][1], DVec3::X);
    }
    for uri in ["data:;base64", "data:;base64,AAAA", "data:;base64,A*AA"] {
        let text = document.text(json!({"uri": uri}));
        let error = io::read_bytes(Format::Gltf, text.as_bytes(), "-").expect_err(uri);
        assert_eq!(error.exit_code(), 3, "{error}");
    }
}

#[test]
fn mirrored_nodes_do_not_turn_faces_over() {
    for scale in [
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
        [-2.0, -1.0, 3.0],
        [-1.0, -1.0, -1.0],
    ] {
        let mut document = GltfBuilder::new();
        let mesh = tetrahedron(&mut document);
        document.node(json!({"mesh": mesh, "scale": scale, "rotation": [0.5, 0.5, 0.5, 0.5]}));
        let found = volume(&read(&document).mesh);
        assert!(found > 1.0, "{scale:?}: {found}");
    }
}

#[test]
fn normals_tangents_and_morph_targets_move_with_the_surface() {
    let mut document = GltfBuilder::new();
    let slope = sqrt(0.5) as f32;
    let normal = document.floats("VEC3", &[[slope, slope, 0.0]; 3].concat());
    let tangent = document.floats("VEC4", &[[slope, -slope, 0.0, 1.0]; 3].concat());
    let delta = document.floats("VEC3", &[[1.0, 2.0, 3.0]; 3].concat());
    let mesh = triangle(&mut document, json!({"NORMAL": normal, "TANGENT": tangent}));
    document.json["meshes"][mesh]["primitives"][0]["targets"] =
        json!([{}, {"POSITION": delta, "NORMAL": delta}]);
    document.node(json!({"mesh": mesh, "scale": [-2, 1, 1], "translation": [7, 8, 9]}));
    let mesh = read(&document).mesh;
    let near = |found: &[f64], expected: &[f64]| {
        let is_near = found
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(
            is_near && found.len() == expected.len(),
            "{found:?} is not {expected:?}"
        );
    };
    let (one, two) = (1.0 / sqrt(5.0), 2.0 / sqrt(5.0));
    near(&values(&mesh, ChannelKind::Normal)[0], &[-one, two, 0.0]);
    near(
        &values(&mesh, ChannelKind::Tangent)[0],
        &[-two, -one, 0.0, -1.0],
    );
    near(&values(&mesh, ChannelKind::Delta(3))[0], &[-2.0, 2.0, 3.0]);
    near(&values(&mesh, ChannelKind::Delta(4))[0], &[-0.5, 2.0, 3.0]);
    assert!(mesh.attributes().channel(ChannelKind::Delta(0)).is_none());
}

#[test]
fn a_mesh_shown_several_times_is_read_once_as_its_largest_instance_shows_it() {
    let mut document = GltfBuilder::new();
    let mesh = tetrahedron(&mut document);
    let child = document.push(
        "nodes",
        json!({"mesh": mesh, "matrix": [3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0, 5, 0, 0, 1]}),
    );
    document.node(json!({"mesh": mesh, "scale": [2, 2, 2], "children": [child]}));
    document.node(json!({"mesh": mesh, "scale": [0, 1, 1]}));
    let translations = document.floats("VEC3", &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let scales = document.floats("VEC3", &[1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    let instancing =
        json!({"attributes": {"TRANSLATION": translations, "SCALE": scales, "_ID": 0}});
    document.node(json!({"mesh": mesh, "extensions": {"EXT_mesh_gpu_instancing": instancing}}));
    let loaded = read(&document);
    assert_eq!(loaded.mesh.triangles().len(), 4);
    assert_eq!(loaded.mesh.positions()[0], DVec3::new(16.0, 6.0, 6.0));
    let asset = loaded.mesh.materials().asset.clone().expect("a document");
    assert_eq!(asset.parts[0].instances, 5);
    assert!(
        loaded.notes.iter().any(|note| note.ends_with(": 5")),
        "{:?}",
        loaded.notes
    );
    // An instance of accessors is the largest where it is.
    document.json["nodes"][0]["matrix"] = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    document.json["nodes"][1]["scale"] = json!([1, 1, 1]);
    assert_eq!(
        read(&document).mesh.positions()[0],
        DVec3::new(3.0, 2.0, 2.0)
    );
}

#[test]
fn a_skin_binds_its_mesh_and_the_node_of_the_mesh_does_not_count() {
    let mut document = GltfBuilder::new();
    let joints = document.view(&[1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0]);
    let joints = document.push(
        "accessors",
        json!({"bufferView": joints, "componentType": 5121, "count": 3, "type": "VEC4"}),
    );
    let weights = document.floats("VEC4", &[[0.75, 0.25, 0.0, 0.0]; 3].concat());
    let mesh = triangle(
        &mut document,
        json!({"JOINTS_0": joints, "WEIGHTS_0": weights}),
    );
    let mut bind = [0.0; 16];
    (0..4).for_each(|i| bind[5 * i] = 1.0);
    bind[13] = 4.0;
    let bind = document.floats("MAT4", &bind);
    let joint = document.node(json!({"translation": [1, 0, 0]}));
    document.node(json!({"mesh": mesh, "skin": 0, "translation": [100, 0, 0]}));
    document.json["skins"] = json!([{"joints": [joint], "inverseBindMatrices": bind}]);
    let loaded = read(&document);
    assert_eq!(loaded.mesh.positions()[0], DVec3::new(1.0, 4.0, 0.0));
    let skin = values(&loaded.mesh, ChannelKind::Skin(0));
    assert_eq!(skin[0], [1.0, 0.0, 0.0, 0.0, 0.75, 0.25, 0.0, 0.0]);
    assert!(loaded.notes[0].contains("skin"), "{:?}", loaded.notes);
}

#[test]
fn every_attribute_is_a_channel_and_what_is_none_is_noted() {
    let mut document = GltfBuilder::new();
    let two = document.floats("VEC2", &[0.5; 6]);
    let three = document.floats("VEC3", &[0.25; 9]);
    let four = document.floats("VEC4", &[0.75; 12]);
    let id = document.floats("SCALAR", &[7.0, 8.0, 9.0]);
    let first = triangle(
        &mut document,
        json!({"TEXCOORD_0": two, "TEXCOORD_3": two, "COLOR_0": three, "COLOR_1": four, "_ID": id, "ODD": id, "JOINTS_0": four}),
    );
    let second = triangle(&mut document, json!({"COLOR_0": four}));
    document.node(json!({"mesh": first}));
    document.node(json!({"mesh": second}));
    let loaded = read(&document);
    let custom = |number, width| ChannelKind::Custom { number, width };
    let found: Vec<ChannelKind> = loaded
        .mesh
        .attributes()
        .channels()
        .iter()
        .map(|c| c.kind)
        .collect();
    let expected = [
        ChannelKind::TexCoord(0),
        ChannelKind::TexCoord(3),
        ChannelKind::ColorAlpha,
        custom(0, 4),
        custom(1, 1),
    ];
    assert_eq!(found, expected);
    let colors = values(&loaded.mesh, ChannelKind::ColorAlpha);
    assert_eq!(
        (&colors[0][..], &colors[3][..]),
        (&[0.25, 0.25, 0.25, 1.0][..], &[0.75; 4][..])
    );
    let ids = values(&loaded.mesh, custom(1, 1));
    assert_eq!(ids[..3], [[7.0], [8.0], [9.0]]);
    assert!(ids[3][0].is_nan());
    let asset = loaded.mesh.materials().asset.clone().expect("a document");
    assert_eq!(asset.customs, ["COLOR_1", "_ID"]);
    for name in ["ODD", "JOINTS_0"] {
        assert!(
            loaded.notes.iter().any(|note| note.starts_with(name)),
            "{:?}",
            loaded.notes
        );
    }
}

#[test]
fn parts_have_names_of_their_own() {
    let mut document = GltfBuilder::new();
    document.json["materials"] = json!([{"name": "steel"}, {}, {"name": "a\nb"}]);
    let position = document.floats("VEC3", &POINTS[..9]);
    let of = |material: Option<usize>| match material {
        Some(material) => json!({"attributes": {"POSITION": position}, "material": material}),
        None => json!({"attributes": {"POSITION": position}}),
    };
    let first = json!([of(Some(0)), of(Some(1)), of(Some(2)), of(None)]);
    let second = json!([of(Some(0)), of(Some(0))]);
    let (first, second) = (document.mesh(first), document.mesh(second));
    document.json["meshes"][second]["name"] = json!("beam");
    document.node(json!({"mesh": first}));
    document.node(json!({"mesh": second}));
    let expected = [
        "steel (mesh 0)",
        "material 1",
        "a b",
        "no material",
        "steel (mesh beam) (primitive 0 of mesh 1)",
        "steel (mesh beam) (primitive 1 of mesh 1)",
    ];
    assert_eq!(read(&document).mesh.materials().names, expected);
}

#[test]
fn json_with_the_content_of_a_glb_is_the_same_mesh() {
    let mut document = GltfBuilder::new();
    let mesh = tetrahedron(&mut document);
    document.node(json!({"mesh": mesh}));
    let folder = folder();
    for name in ["a.glb", "a.gltf", "a"] {
        let path = folder.path().join(name);
        fs::write(&path, document.glb()).expect("writable");
        let loaded = io::read(&path).expect(name);
        assert_eq!(loaded.encoding, Encoding::Glb);
        assert_eq!(
            loaded.notes.is_empty(),
            name != "a.gltf",
            "{:?}",
            loaded.notes
        );
        let out = folder.path().join("out.glb");
        let notes = io::write(&out, &loaded.mesh).expect("writable");
        assert!(notes.is_empty(), "{notes:?}");
        let again = io::read(&out).expect(name).mesh;
        assert_eq!(again.triangles(), loaded.mesh.triangles());
    }
}

#[test]
fn real_assets_have_the_triangles_that_they_are_known_for() {
    for (name, triangles, parts) in [
        ("FlightHelmet/FlightHelmet.gltf", 94_722, 6),
        ("DamagedHelmet.glb", 15_452, 1),
        ("BoomBox/BoomBox.gltf", 6_036, 1),
        ("CesiumMan.glb", 4_672, 1),
        ("MorphStressTest.glb", 2_412, 2),
        ("Lamborghini_meshopt.glb", 145_917, 46),
        ("Pirate_meshopt_quantized.glb", 5_010, 1),
        ("TeapotsGalore_instancing/teapots_galore.gltf", 4_034, 2),
        ("conformance/VertexColorTest/VertexColorTest.gltf", 36, 2),
        ("conformance/MultiUVTest/MultiUVTest.gltf", 12, 1),
        (
            "conformance/TextureSettingsTest/TextureSettingsTest.gltf",
            72,
            10,
        ),
        (
            "conformance/TextureTransformTest/TextureTransformTest.gltf",
            18,
            9,
        ),
        ("conformance/box_sparse.glb", 12, 1),
    ] {
        let Some(path) = asset_file(name) else {
            continue;
        };
        let loaded = io::read(&path).expect(name);
        assert_eq!(loaded.mesh.triangles().len(), triangles, "{name}");
        let names = loaded.mesh.materials().names.len();
        assert_eq!(names, parts, "{name}");
        let mesh = canonical(&weld(loaded.mesh).mesh).mesh;
        assert!(mesh.materials().asset.is_some(), "{name}");
        assert!(!content_sha256(&mesh).is_empty());
    }
    if let Some(path) = asset_file("2CylinderEngine_draco/2CylinderEngine.gltf") {
        let error = io::read(&path).expect_err("Draco");
        assert_eq!(error.exit_code(), 4, "{error}");
    }
}
