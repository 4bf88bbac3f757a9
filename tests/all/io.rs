//! Files in and out: what survives, and what is said about the rest.

use std::{fs, path::PathBuf};

use glam::DVec3;
use lodmark::{
    Error,
    io::{self, Encoding, Format},
    mesh::{Attributes, ChannelKind, Materials, Mesh, MeshParts, content_sha256, weld},
    num::Precision,
};
use proptest::prelude::*;

fn obj(text: &str) -> Result<io::Loaded, Error> {
    io::read_bytes(Format::Obj, text.as_bytes(), "test.obj")
}

fn ply(text: &str) -> Result<io::Loaded, Error> {
    io::read_bytes(Format::Ply, text.as_bytes(), "test.ply")
}

fn stl(text: &str) -> Result<io::Loaded, Error> {
    io::read_bytes(Format::Stl, text.as_bytes(), "test.stl")
}

fn message(result: Result<io::Loaded, Error>) -> String {
    let error = result.expect_err("damaged");
    assert_eq!(error.exit_code(), 3, "{error}");
    error.to_string()
}

/// Every attribute value of every corner, by channel; NaN as one value.
fn corner_values(mesh: &Mesh) -> Vec<(ChannelKind, Vec<u64>)> {
    let attributes = mesh.attributes();
    attributes
        .channels()
        .iter()
        .map(|&channel| {
            let values = attributes
                .corners()
                .iter()
                .flatten()
                .flat_map(|&w| attributes.value(channel, w))
                .map(|x| x.to_bits())
                .collect();
            (channel.kind, values)
        })
        .collect()
}

fn bits(mesh: &Mesh) -> Vec<[u64; 3]> {
    mesh.positions()
        .iter()
        .map(|p| p.to_array().map(f64::to_bits))
        .collect()
}

fn material_names(mesh: &Mesh) -> Vec<Option<String>> {
    (0..mesh.triangles().len())
        .map(|t| {
            mesh.materials()
                .names
                .get(mesh.materials().of(t) as usize)
                .cloned()
        })
        .collect()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn a_polygon_becomes_a_fan_around_its_first_corner() {
    let loaded = obj(&format!("{SQUARE}f 1 2 3 4\n")).expect("valid");
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
    let loaded = ply(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_index\nend_header\n\
         0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 2 0\n5 4 3 2 1 0\n",
    )
    .expect("valid");
    assert_eq!(loaded.mesh.triangles(), [[4, 3, 2], [4, 2, 1], [4, 1, 0]]);
}

#[test]
fn vertices_that_no_face_uses_and_their_order_are_kept() {
    let loaded = obj(&format!("v 9 9 9\n{SQUARE}f -1 -2 -3\n")).expect("valid");
    assert_eq!(loaded.mesh.positions()[0], DVec3::splat(9.0));
    assert_eq!(loaded.mesh.positions().len(), 5);
    assert_eq!(loaded.mesh.triangles(), [[4, 3, 2]]);
}

#[test]
fn a_mesh_without_anything_is_written_and_read() {
    for encoding in [
        Encoding::Obj,
        Encoding::PlyAscii,
        Encoding::StlAscii,
        Encoding::StlBinary,
    ] {
        let (bytes, _) = io::encode(&Mesh::default(), encoding).expect("writes");
        let loaded = io::read_bytes(encoding.format(), &bytes, "-").expect("reads");
        assert_eq!(loaded.mesh, Mesh::default(), "{encoding:?}");
    }
}

#[test]
fn objects_and_groups_share_their_vertices() {
    let loaded = obj(&format!(
        "o one\n{SQUARE}f 1 2 3\no two\nusemtl red\nf 1 3 4\ng three\nf 2 3 4\n"
    ))
    .expect("valid");
    assert_eq!(loaded.mesh.positions().len(), 4);
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2], [0, 2, 3], [1, 2, 3]]);
    assert!(loaded.notes.iter().any(|n| n.contains("objects")));
}

#[test]
fn materials_without_a_library_keep_their_names() {
    let loaded = obj(&format!(
        "mtllib not there.mtl\n{SQUARE}f 1 2 3\nusemtl red # paint\nf 1 3 4 2\nusemtl blue\nf 2 3 4\nusemtl red # paint\nf 1 2 4\n"
    ))
    .expect("valid");
    let materials = loaded.mesh.materials();
    assert_eq!(materials.names, ["red # paint", "blue"]);
    assert_eq!(materials.of_triangle, [Materials::NONE, 0, 0, 1, 0]);
    assert_eq!(materials.libraries, ["not there.mtl"]);
}

#[test]
fn corners_without_texture_coordinates_have_none_of_their_neighbours() {
    let loaded = obj(&format!(
        "{SQUARE}vt 0.25 0.5\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1 3 4\nf 2//1 3//1 4//1\n"
    ))
    .expect("valid");
    let attributes = loaded.mesh.attributes();
    let uv = attributes.channel(ChannelKind::TexCoord(0)).expect("uv");
    let normal = attributes.channel(ChannelKind::Normal).expect("normal");
    let present = |channel, t: usize| {
        attributes.corners()[t].map(|w| !attributes.value(channel, w)[0].is_nan())
    };
    assert_eq!(
        [0, 1, 2].map(|t| present(uv, t)),
        [[true; 3], [false; 3], [false; 3]]
    );
    assert_eq!(
        [0, 1, 2].map(|t| present(normal, t)),
        [[true; 3], [false; 3], [true; 3]]
    );
    assert_eq!(
        attributes.value(uv, attributes.corners()[0][2]),
        [0.25, 0.5]
    );
}

#[test]
fn colours_of_some_vertices_do_not_shift_to_others() {
    let loaded = obj("v 0 0 0\nv 1 0 0 1 0.5 0\nv 0 1 0\nf 1 2 3\n").expect("valid");
    let attributes = loaded.mesh.attributes();
    let color = attributes.channel(ChannelKind::Color).expect("colour");
    let of = attributes.corners()[0].map(|w| attributes.value(color, w).to_vec());
    assert!(of[0][0].is_nan() && of[2][0].is_nan());
    assert_eq!(of[1], [1.0, 0.5, 0.0]);
}

#[test]
fn a_weight_divides_the_coordinates_and_zero_is_refused() {
    let loaded = obj("v 2 4 6 2\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("valid");
    assert_eq!(loaded.mesh.positions()[0], DVec3::new(1.0, 2.0, 3.0));
    assert!(message(obj("v 0 0 0\nv 1 1 1 0\n")).contains("line 2: the weight"));
}

#[test]
fn faces_may_come_before_their_vertices_and_lines_may_continue() {
    let loaded =
        obj("# c\\\nf 1 \\\r\n 2 3\r\nv 0 0 0\r\nv 1 0 0 # x\r\nv 0 1 \\\n 0\n").expect("valid");
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2]]);
}

#[test]
fn text_that_is_not_utf8_is_no_obstacle() {
    let mut bytes = b"# caf\xe9\nusemtl caf\xe9\n".to_vec();
    bytes.extend_from_slice(SQUARE.as_bytes());
    bytes.extend_from_slice(b"f 1 2 3\n");
    let loaded = io::read_bytes(Format::Obj, &bytes, "-").expect("valid");
    assert_eq!(loaded.mesh.materials().names, ["caf\u{fffd}"]);
}

#[test]
fn obj_errors_name_their_line() {
    for (text, expected) in [
        ("v 0 0 0\nv 1 x 0\n", "line 2: found `x`; expected a number"),
        ("v 0 0\n", "line 1: a vertex of 2 numbers"),
        (
            "v 0 0 nan\n",
            "line 1: found `nan`; expected a finite number",
        ),
        (
            "v 0 0 0\nv inf 0 0\n",
            "line 2: found `inf`; expected a finite number",
        ),
        (
            "v 0 0 0\nf 1 1 2\n",
            "line 2: a corner names `v` 2, but there are 1",
        ),
        ("v 0 0 0\nf 1 1 0\n", "line 2: a corner names `v` 0"),
        (
            "v 0 0 0\nf -2 1 1\n",
            "line 2: a corner names `v` -2, and 1 come before",
        ),
        (
            "v 0 0 0\nf 1/1 1/1 1/1\n",
            "line 2: a corner names `vt` 1, but there are 0",
        ),
        ("v 0 0 0\nf 1/-5 1 1\n", "line 2: a corner names `vt` -5"),
        (
            "v 0 0 0\nf 1//9223372036854775807 1 1\n",
            "line 2: a corner names `vn`",
        ),
        (
            "v 0 0 0\n\nf 1 1/a 1\n",
            "line 3: found `1/a`; expected a corner",
        ),
        (
            "v 0 0 0\nf 1/1/1/1 1 1\n",
            "line 2: found `1/1/1/1`; expected a corner",
        ),
        (
            "v 0 0 0\nvt\n",
            "line 2: a texture coordinate without numbers",
        ),
        (
            "v 0 0 0\nvn 1 0\n",
            "line 2: expected a normal of three numbers",
        ),
        (
            "v 0 0 0\nvn 1 0 q\n",
            "line 2: found `q`; expected a number",
        ),
        (
            "v 0 0 0 1 1 red\n",
            "line 1: found `red`; expected a colour value",
        ),
        ("hello\n", "no line begins with `v`"),
        ("v 0 0 0\n\0\n", "line 2: a zero byte"),
    ] {
        let said = message(obj(text));
        assert!(said.contains(expected), "{text:?}: {said}");
        assert!(said.starts_with("test.obj: "), "{said}");
    }
}

const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                      element face 1\nproperty list uchar int vertex_indices\nend_header\n";

#[test]
fn ply_errors_name_their_line() {
    for (body, expected) in [
        (
            "0 0 0\n1 0 0\n0 b 0\n3 0 1 2\n",
            "line 12: found `b`; expected `y` of vertex 2 of 3",
        ),
        (
            "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
            "line 13: face 0 names vertex 3; expected a number from 0 to 2",
        ),
        (
            "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
            "line 13: face 0 names vertex -1",
        ),
        (
            "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n",
            "line 13: face 0 names vertex 1.5",
        ),
        (
            "0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
            "the file ends; expected `vertex_indices` of face 0",
        ),
        (
            "0 0 0\n1 0 0\n0 1 0\n-3 0 1\n",
            "line 13: found a list of -3 numbers",
        ),
        (
            "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n",
            "line 12: vertex 2 is (0, NaN, 0)",
        ),
        (
            "0 0 0\n1 0 0\n0 1e39 0\n3 0 1 2\n",
            "line 12: vertex 2 is (0, inf, 0)",
        ),
        ("0 0 0\n1 0", "3 items of `vertex` need at least 18 bytes"),
    ] {
        let said = message(ply(&format!("{HEADER}{body}")));
        assert!(said.contains(expected), "{body:?}: {said}");
    }
}

#[test]
fn a_wrong_ply_header_is_reported_with_its_line() {
    for (from, to, expected) in [
        ("ply\n", "plx\n", "line 1: found `plx`; expected `ply`"),
        (
            "ascii",
            "utf8",
            "line 2: found `format utf8 1.0`; expected the format",
        ),
        (
            " 1.0",
            " 2.0",
            "line 2: found `format ascii 2.0`; expected version 1.0",
        ),
        (
            "vertex 3",
            "vertex -3",
            "line 3: found `element vertex -3`; expected `element NAME COUNT`",
        ),
        ("float x", "half x", "line 4: found `property half x`"),
        (
            "list uchar",
            "list float",
            "line 8: found `property list float int vertex_indices`",
        ),
        (
            "end_header",
            "",
            "line 10: found `0 0 0`; expected format, element",
        ),
        (
            "format ascii 1.0\n",
            "",
            "expected a `format` line before the end",
        ),
        ("float y", "float w", "vertices without `y`"),
        ("element vertex", "element corner", "no element `vertex`"),
        ("vertex_indices", "corners", "faces without vertices"),
    ] {
        let text = format!("{HEADER}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").replacen(from, to, 1);
        let said = message(ply(&text));
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn unknown_ply_elements_and_properties_are_skipped_and_told_of() {
    let loaded = ply(
        "ply\nformat ascii 1.0\ncomment c\nobj_info o\nelement camera 1\nproperty list uchar float f\nproperty int i\n\
         element vertex 3\nproperty float x\nproperty float confidence\nproperty float y\nproperty list uchar int l\nproperty float z\n\
         element face 2\nproperty uchar red\nproperty list uint short vertex_indices\nelement nothing 1000000000\nend_header\n\
         2 0.5 0.5 7\n0 9 0 2 7 8 0\n1 9 0 0 0\n0 9 1 1 7 0\n255 3 0 1 2\n0 2 0 1\n",
    )
    .expect("valid");
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2]]);
    assert_eq!(loaded.mesh.positions()[2], DVec3::Y);
    for told in [
        "`camera`",
        "`confidence`",
        "`l`",
        "`red`",
        "`nothing`",
        "fewer than three corners",
    ] {
        assert!(
            loaded.notes.iter().any(|n| n.contains(told)),
            "{told}: {:?}",
            loaded.notes
        );
    }
}

#[test]
fn ply_attributes_are_found_under_all_their_names() {
    for (u, v) in [("s", "t"), ("u", "v"), ("texture_u", "texture_v")] {
        let loaded = ply(&format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n\
             property float {u}\nproperty float {v}\nproperty float nx\nproperty float ny\nproperty float nz\n\
             element face 1\nproperty list uchar int vertex_indices\nend_header\n\
             0 0 0 0 51 255 255 0.5 0.25 0 0 1\n1 0 0 0 51 255 255 0.5 0.25 0 0 1\n0 1 0 0 51 255 0 0.5 0.25 0 0 1\n3 0 1 2\n"
        ))
        .expect("valid");
        let attributes = loaded.mesh.attributes();
        let kinds: Vec<ChannelKind> = attributes.channels().iter().map(|c| c.kind).collect();
        assert_eq!(
            kinds,
            [
                ChannelKind::Normal,
                ChannelKind::TexCoord(0),
                ChannelKind::ColorAlpha
            ]
        );
        let fifth = f64::from(51.0_f32 / 255.0_f32);
        assert_eq!(
            attributes.row(attributes.corners()[0][2]),
            [0.0, 0.0, 1.0, 0.5, 0.25, 0.0, fifth, 1.0, 0.0]
        );
    }
}

#[test]
fn corner_texture_coordinates_make_a_seam() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         property float nx\nproperty float ny\nproperty float nz\nelement face 3\n\
         property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n\
         0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n\
         3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0.5 0.5 1 1 0 1\n4 0 1 2 3 0\n";
    let loaded = ply(text).expect("valid");
    let attributes = loaded.mesh.attributes();
    assert_eq!(
        attributes.corners()[0][2],
        attributes.corners()[1][1],
        "equal uv at vertex 2"
    );
    assert_ne!(
        attributes.corners()[0][0],
        attributes.corners()[1][0],
        "seam at vertex 0"
    );
    let uv = attributes.channel(ChannelKind::TexCoord(0)).expect("uv");
    assert!(attributes.value(uv, attributes.corners()[2][0])[0].is_nan());
    let (bytes, _) = io::encode(&loaded.mesh, Encoding::PlyBigEndian).expect("writes");
    let again = io::read_bytes(Format::Ply, &bytes, "-").expect("reads");
    assert_eq!(corner_values(&again.mesh), corner_values(&loaded.mesh));
    assert!(
        message(ply(&text.replace("6 0 0 1 0 1 1", "5 0 0 1 0 1")))
            .contains("3 corners and 5 texture coordinates")
    );
}

#[test]
fn stl_errors_name_their_line() {
    let text = "solid a b c\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a b c\n";
    assert_eq!(stl(text).expect("valid").mesh.triangles(), [[0, 1, 2]]);
    assert_eq!(
        stl(&text.to_uppercase().replace("1 0 0", "1e0 -0 0"))
            .expect("valid")
            .encoding,
        Encoding::StlAscii
    );
    for (from, to, expected) in [
        (
            "vertex 1 0 0",
            "vertex 1 0 q",
            "line 5: found `q`; expected a finite coordinate",
        ),
        (
            "vertex 1 0 0",
            "vertex 1 0 inf",
            "line 5: found `inf`; expected a finite coordinate",
        ),
        ("vertex 1 0 0\n", "", "line 7: this facet has 2 corners"),
        ("outer", "inner", "line 3: found `inner`; expected `outer`"),
        (
            "endsolid a b c\n",
            "",
            "the file ends; expected `facet` or `endsolid`",
        ),
        ("solid a", "sold a", "neither the text `solid`"),
    ] {
        let said = message(stl(&text.replacen(from, to, 1)));
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn a_binary_stl_that_begins_with_solid_is_binary() {
    let (mut bytes, _) = io::encode(&square(), Encoding::StlBinary).expect("writes");
    bytes[..6].copy_from_slice(b"solid ");
    let loaded = io::read_bytes(Format::Stl, &bytes, "-").expect("reads");
    assert_eq!(loaded.encoding, Encoding::StlBinary);
    assert_eq!(weld(loaded.mesh).mesh.positions().len(), 4);
}

fn square() -> Mesh {
    obj(&format!("{SQUARE}f 1 2 3\nf 1 3 4\n"))
        .expect("valid")
        .mesh
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).expect("target is writable")
}

#[test]
fn an_unknown_extension_is_a_usage_error_that_lists_the_known_ones() {
    let folder = folder();
    for name in ["a.fbx", "a", ".obj"] {
        let path = folder.path().join(name);
        let error = io::write(&path, &square()).expect_err("unknown");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains(".obj, .ply, .stl"), "{error}");
        assert!(!path.exists());
    }
}

#[test]
fn content_wins_over_a_wrong_name_and_says_so() {
    let folder = folder();
    for encoding in [
        Encoding::PlyAscii,
        Encoding::PlyBigEndian,
        Encoding::StlAscii,
        Encoding::StlBinary,
    ] {
        let (bytes, _) = io::encode(&square(), encoding).expect("writes");
        for name in ["a.obj", "a.bin", "a"] {
            let path = folder.path().join(name);
            fs::write(&path, &bytes).expect("writable");
            let loaded = io::read(&path).expect("reads");
            assert_eq!(loaded.encoding, encoding);
            assert_eq!(
                loaded.notes.is_empty(),
                name != "a.obj",
                "{:?}",
                loaded.notes
            );
        }
    }
    let path = folder.path().join("a.OBJ");
    fs::write(&path, SQUARE).expect("writable");
    assert_eq!(io::read(&path).expect("reads").encoding, Encoding::Obj);
    let path = folder.path().join("noise.dat");
    fs::write(&path, [7; 100]).expect("writable");
    assert_eq!(io::read(&path).expect_err("noise").exit_code(), 3);
    let path = folder.path().join("a.glb");
    fs::write(&path, b"glTF\x02\0\0\0").expect("writable");
    assert_eq!(io::read(&path).expect_err("glTF").exit_code(), 4);
    assert_eq!(
        io::read(&folder.path().join("gone.ply"))
            .expect_err("gone")
            .exit_code(),
        5
    );
}

#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let folder = folder();
    let path = folder.path().join("a.ply");
    fs::write(&path, "old").expect("writable");
    let failed = io::atomic::write(&path, |w| {
        w.write_all(&[1; 200_000])?;
        Err(std::io::Error::other("disk full"))
    });
    assert_eq!(failed.expect_err("failed").exit_code(), 5);
    assert_eq!(fs::read(&path).expect("there"), b"old");
    assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 1);
    io::write(&path, &square()).expect("writes");
    assert_eq!(
        io::read(&path).expect("reads").mesh.triangles(),
        square().triangles()
    );
    assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 1);
}

#[test]
fn a_missing_folder_and_a_folder_in_place_of_the_file_are_io_errors() {
    let folder = folder();
    fs::create_dir(folder.path().join("b.ply")).expect("writable");
    for name in ["nowhere/a.ply", "b.ply"] {
        let error = io::write(&folder.path().join(name), &square()).expect_err("refused");
        assert_eq!(error.exit_code(), 5, "{error}");
    }
}

#[cfg(unix)]
#[test]
fn a_link_and_a_device_are_written_through() {
    let folder = folder();
    let (file, link) = (
        folder.path().join("file.ply"),
        folder.path().join("link.ply"),
    );
    fs::write(&file, "old").expect("writable");
    std::os::unix::fs::symlink(&file, &link).expect("links exist");
    io::write(&link, &square()).expect("writes");
    assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
    assert_eq!(io::read(&file).expect("reads").mesh.triangles().len(), 2);
    io::atomic::write(std::path::Path::new("/dev/null"), |w| w.write_all(b"x")).expect("writes");
    assert!(!fs::metadata("/dev/null").expect("there").is_file());
}

#[test]
fn the_precision_of_text_follows_from_its_digits() {
    let coarse = obj("v 0 0 0\nv 1 0 0\nv 0.1 0.3333333333333333 0\nf 1 2 3\n")
        .expect("valid")
        .mesh;
    assert_eq!(coarse.precision(), Precision::F32);
    assert_eq!(coarse.positions()[2].x, f64::from(0.1_f32));
    let far = obj("v 500000.001 0 0\nv 500001.002 0 0\nv 500000 1 0\nf 1 2 3\n")
        .expect("valid")
        .mesh;
    assert_eq!(far.precision(), Precision::F64);
    assert_eq!(far.positions()[0].x, 500_000.001);
    let huge = obj("v 1e300 0 0\nv 0 1e300 0\nv 0 0 1e300\nf 1 2 3\n")
        .expect("valid")
        .mesh;
    assert_eq!(huge.precision(), Precision::F64);
    for size in ["1e30", "1e-30"] {
        let mesh = obj(&format!(
            "v {size} 0 0\nv 0 {size} 0\nv 0 0 {size}\nf 1 2 3\n"
        ))
        .expect("valid")
        .mesh;
        assert_eq!(mesh.precision(), Precision::F32, "{size}");
    }
}

#[test]
fn what_a_format_cannot_keep_is_said() {
    let mesh = obj(&format!(
        "{SQUARE}vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\nusemtl m\nf 1/1/1 2/1/1 3/1/1\nf 1/2/2 3/1/1 4/1/1\n"
    ))
    .expect("valid")
    .mesh;
    let notes = |encoding| io::encode(&mesh, encoding).expect("writes").1.join("; ");
    assert_eq!(notes(Encoding::Obj), "");
    assert!(notes(Encoding::PlyAscii).contains("cannot keep materials"));
    assert!(notes(Encoding::PlyAscii).contains("normals differ between corners at 1 vertices"));
    assert!(notes(Encoding::StlBinary).contains("cannot keep materials"));
    assert!(notes(Encoding::StlBinary).contains("cannot keep normals"));
    let wide = Mesh::new(MeshParts {
        precision: Precision::F64,
        ..square().into_parts()
    })
    .expect("valid");
    assert!(io::encode(&wide, Encoding::StlAscii).expect("writes").1[0].contains("32-bit"));
    let huge = obj("v 1e300 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n")
        .expect("valid")
        .mesh;
    assert_eq!(
        io::encode(&huge, Encoding::StlBinary)
            .expect_err("too large")
            .exit_code(),
        4
    );
}

/// A float of any size, now and then a special one.
fn coordinate(precision: Precision) -> BoxedStrategy<f64> {
    let finite = any::<f64>().prop_filter("finite", |x| x.is_finite());
    match precision {
        Precision::F64 => prop_oneof![finite, Just(-0.0), -1.0..1.0].boxed(),
        Precision::F32 => prop_oneof![
            any::<f32>()
                .prop_filter("finite", |x| x.is_finite())
                .prop_map(f64::from),
            (-1.0_f32..1.0).prop_map(f64::from),
            Just(-0.0),
        ]
        .boxed(),
    }
}

/// Meshes with attributes and materials: one row per vertex, except texture coordinates, which may have seams.
fn meshes() -> impl Strategy<Value = Mesh> {
    let precisions = prop_oneof![Just(Precision::F32), Just(Precision::F64)];
    (precisions, 1_usize..8, 0_usize..10, any::<[bool; 5]>()).prop_flat_map(
        |(precision, vertices, triangles, [normals, uvs, colors, seams, bytes])| {
            let numbers = |n| prop::collection::vec(coordinate(precision), n);
            let index = 0..vertices as u32;
            (
                numbers(3 * vertices),
                prop::collection::vec([index.clone(), index.clone(), index], triangles),
                numbers(3 * vertices),
                numbers(2 * vertices + 6 * triangles),
                prop::collection::vec(any::<u8>(), 3 * vertices),
                prop::collection::vec(prop_oneof![Just("red"), Just("a b"), Just("#1")], triangles),
            )
                .prop_map(move |(p, triangles, n, t, c, names)| {
                    let mut kinds = Vec::new();
                    kinds.extend(normals.then_some(ChannelKind::Normal));
                    kinds.extend(uvs.then_some(ChannelKind::TexCoord(0)));
                    kinds.extend(colors.then_some(ChannelKind::Color));
                    let mut values = Vec::new();
                    for (corner, &v) in triangles.as_flattened().iter().enumerate() {
                        let v = v as usize;
                        if normals {
                            values.extend(&n[3 * v..3 * v + 3]);
                        }
                        if uvs {
                            let at = if seams {
                                2 * (vertices + corner)
                            } else {
                                2 * v
                            };
                            values.extend(&t[at..at + 2]);
                        }
                        if colors {
                            values.extend((3 * v..3 * v + 3).map(|i| {
                                if bytes {
                                    precision.round(f64::from(c[i]) / 255.0)
                                } else {
                                    n[i]
                                }
                            }));
                        }
                    }
                    let corners = (0..triangles.len() as u32)
                        .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
                        .collect();
                    let all = ["red", "a b", "#1"];
                    Mesh::new(MeshParts {
                        positions: p.chunks(3).map(DVec3::from_slice).collect(),
                        attributes: Attributes::new(&kinds, values, corners).expect("fits"),
                        materials: Materials {
                            names: all.map(String::from).to_vec(),
                            of_triangle: names
                                .iter()
                                .map(|name| {
                                    all.iter().position(|a| a == name).expect("one of all") as u32
                                })
                                .collect(),
                            libraries: vec!["lib one.mtl".into()],
                        },
                        triangles,
                        precision,
                    })
                    .expect("valid")
                })
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn reading_what_was_written_changes_no_bit(mesh in meshes()) {
        for encoding in [Encoding::Obj, Encoding::PlyAscii, Encoding::PlyLittleEndian, Encoding::PlyBigEndian] {
            let (bytes, _) = io::encode(&mesh, encoding).expect("writes");
            let again = io::read_bytes(encoding.format(), &bytes, "-").expect("reads");
            prop_assert_eq!(again.encoding, encoding);
            let again = again.mesh;
            prop_assert_eq!(again.precision(), mesh.precision());
            prop_assert_eq!(bits(&again), bits(&mesh));
            prop_assert_eq!(again.triangles(), mesh.triangles());
            if !mesh.triangles().is_empty() {
                prop_assert_eq!(corner_values(&again), corner_values(&mesh));
            }
            if encoding == Encoding::Obj {
                prop_assert_eq!(material_names(&again), material_names(&mesh));
                prop_assert_eq!(&again.materials().libraries, &mesh.materials().libraries);
            }
            let (twice, _) = io::encode(&again, encoding).expect("writes");
            let thrice = io::read_bytes(encoding.format(), &twice, "-").expect("reads").mesh;
            prop_assert_eq!(content_sha256(&thrice), content_sha256(&again), "a second time");
        }
    }

    #[test]
    fn an_stl_keeps_the_bits_of_every_corner(mesh in meshes()) {
        for encoding in [Encoding::StlAscii, Encoding::StlBinary] {
            let Ok((bytes, _)) = io::encode(&mesh, encoding) else { continue };
            prop_assert_eq!(Format::of_content(&bytes), Some(Format::Stl));
            let again = io::read_bytes(Format::Stl, &bytes, "-").expect("reads").mesh;
            let of = |mesh: &Mesh| -> Vec<_> {
                (0..mesh.triangles().len())
                    .map(|t| mesh.corners(t).map(|p| p.to_array().map(|x| (x as f32).to_bits())))
                    .collect()
            };
            prop_assert_eq!(of(&again), of(&mesh));
        }
    }
}

fn model(name: &str) -> Option<io::Loaded> {
    let folder = std::env::var_os("LODMARK_MODELS").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/models"),
        PathBuf::from,
    );
    let path = folder.join(name);
    if !path.exists() {
        #[expect(clippy::print_stderr, reason = "the reason for skipping")]
        {
            eprintln!("skipped: {} is not there", path.display());
        }
        return None;
    }
    Some(io::read(&path).expect("a good file"))
}

#[test]
fn real_models_have_their_published_sizes() {
    for (name, vertices, triangles) in [
        ("bunny.ply", 35_947, 69_451),
        ("dragon.ply", 437_645, 871_414),
        ("spot.obj", 2_930, 5_856),
    ] {
        let Some(loaded) = model(name) else { continue };
        assert_eq!(loaded.mesh.positions().len(), vertices, "{name}");
        assert_eq!(loaded.mesh.triangles().len(), triangles, "{name}");
        assert_eq!(loaded.mesh.precision(), Precision::F32, "{name}");
    }
}

#[test]
fn a_textured_model_is_what_tobj_alone_makes_of_it() {
    let Some(loaded) = model("spot.obj") else {
        return;
    };
    let (bytes, notes) = io::encode(&loaded.mesh, Encoding::Obj).expect("writes");
    assert!(notes.is_empty());
    let options = tobj::LoadOptions {
        triangulate: true,
        ..tobj::LoadOptions::default()
    };
    let (models, _) = tobj::load_obj_buf(&mut &bytes[..], &options, |_| {
        Err(tobj::LoadError::OpenFileFailed)
    })
    .expect("reads");
    let plain = &models[0].mesh;
    let attributes = loaded.mesh.attributes();
    let uv = attributes
        .channel(ChannelKind::TexCoord(0))
        .expect("textured");
    assert_eq!(plain.indices.len(), 3 * loaded.mesh.triangles().len());
    for (t, (corners, wedges)) in loaded
        .mesh
        .triangles()
        .iter()
        .zip(attributes.corners())
        .enumerate()
    {
        for c in 0..3 {
            let (v, vt) = (
                plain.indices[3 * t + c] as usize,
                plain.texcoord_indices[3 * t + c] as usize,
            );
            let p = loaded.mesh.positions()[corners[c] as usize].to_array();
            assert_eq!(
                p.map(|x| x as f32),
                [0, 1, 2].map(|i| plain.positions[3 * v + i] as f32)
            );
            let q = attributes.value(uv, wedges[c]);
            assert_eq!(
                [q[0] as f32, q[1] as f32],
                [0, 1].map(|i| plain.texcoords[2 * vt + i] as f32)
            );
        }
    }
}
