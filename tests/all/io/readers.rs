//! What readers make of files written by hand, and where they say a file is wrong.

use glam::DVec3;
use lodmark::{
    Error,
    io::{self, Encoding, Format},
    mesh::{ChannelKind, Materials, Mesh},
};

use super::files::corner_values;

pub(crate) fn obj(text: &str) -> Result<io::Loaded, Error> {
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

/// Holds the notes of a reader to parts that they must have.
#[track_caller]
fn require_notes(loaded: &io::Loaded, parts: &[&str]) {
    let notes = &loaded.notes;
    for part in parts {
        assert!(notes.iter().any(|n| n.contains(part)), "{part}: {notes:?}");
    }
}

pub(crate) const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

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
    use Encoding::{Obj, PlyAscii, StlAscii, StlBinary};
    for encoding in [Obj, PlyAscii, StlAscii, StlBinary] {
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
    let faces = |channel| [0, 1, 2].map(|t| present(channel, t));
    assert_eq!(faces(uv), [[true; 3], [false; 3], [false; 3]]);
    assert_eq!(faces(normal), [[true; 3], [false; 3], [true; 3]]);
    let last = attributes.corners()[0][2];
    assert_eq!(attributes.value(uv, last), [0.25, 0.5]);
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
fn lines_points_and_slivers_are_told_of() {
    let loaded = obj(&format!(
        "{SQUARE}f 1 2\nf 1\nf 1 2 3\nl 1 2\np 1\ns off\nvp 1\nvt 0 0 0.5\n"
    ))
    .expect("valid");
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2]]);
    assert!(loaded.mesh.attributes().is_empty());
    let lines = ["1 lines `l`", "1 lines `p`", "1 lines `s`", "1 lines `vp`"];
    require_notes(&loaded, &lines);
    require_notes(&loaded, &["2 faces with fewer", "third texture"]);
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
    // The second line of a file.
    for (line, expected) in [
        ("v 1 x 0", "found `x`; expected a number"),
        ("v 0 0 nan", "found `nan`; expected a finite number"),
        ("v inf 0 0", "found `inf`; expected a finite number"),
        ("f 1 1 2", "a corner names `v` 2, but there are 1"),
        ("f 1 1 0", "a corner names `v` 0"),
        ("f -2 1 1", "a corner names `v` -2, and 1 come before"),
        ("f 1/1 1/1 1/1", "a corner names `vt` 1, but there are 0"),
        ("f 1/-5 1 1", "a corner names `vt` -5"),
        ("f 1//9223372036854775807 1 1", "a corner names `vn`"),
        ("f 1/1/1/1 1 1", "found `1/1/1/1`; expected a corner"),
        ("vt", "a texture coordinate without numbers"),
        ("vn 1 0", "expected a normal of three numbers"),
        ("vn 1 0 q", "found `q`; expected a number"),
        ("v 0 0 0 1 1 red", "found `red`; expected a colour value"),
        ("\0", "a zero byte"),
    ] {
        let said = message(obj(&format!("v 0 0 0\n{line}\n")));
        let expected = format!("test.obj: line 2: {expected}");
        assert!(said.starts_with(&expected), "{line:?}: {said}");
    }
    for (text, expected) in [
        ("v 0 0\n", "line 1: a vertex of 2 numbers"),
        ("v 0 0 nan\n", "line 1: found `nan`"),
        ("v 0 0 0 1 1 red\n", "line 1: found `red`"),
        (
            "v 0 0 0\n\nf 1 1/a 1\n",
            "line 3: found `1/a`; expected a corner",
        ),
        ("hello\n", "no line begins with `v`"),
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
    let said_of = |vertex: &str, face: &str| {
        message(ply(&format!("{HEADER}0 0 0\n1 0 0\n{vertex}\n{face}\n")))
    };
    for (vertex, expected) in [
        ("0 b 0", "found `b`; expected `y` of vertex 2 of 3"),
        ("0 nan 0", "vertex 2 is (0, NaN, 0)"),
        ("0 1e39 0", "vertex 2 is (0, inf, 0)"),
    ] {
        let said = said_of(vertex, "3 0 1 2");
        let expected = format!("line 12: {expected}");
        assert!(said.contains(&expected), "{vertex}: {said}");
    }
    for (face, expected) in [
        (
            "3 0 1 3",
            "face 0 names vertex 3; expected a number from 0 to 2",
        ),
        ("3 0 1 -1", "face 0 names vertex -1"),
        ("3 0 1 1.5", "face 0 names vertex 1.5"),
        ("-3 0 1", "found a list of -3 numbers"),
    ] {
        let said = said_of("0 1 0", face);
        let expected = format!("line 13: {expected}");
        assert!(said.contains(&expected), "{face}: {said}");
    }
    let said = said_of("0 1 0", "3 0 1");
    let expected = "the file ends; expected `vertex_indices` of face 0";
    assert!(said.contains(expected), "{said}");
    let said = message(ply(&format!("{HEADER}0 0 0\n1 0")));
    let expected = "3 items of `vertex` need at least 18 bytes";
    assert!(said.contains(expected), "{said}");
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
    require_notes(&loaded, &["`camera`", "`confidence`", "`l`", "`red`"]);
    require_notes(&loaded, &["`nothing`", "fewer than three corners"]);
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
        use ChannelKind::{ColorAlpha, Normal, TexCoord};
        assert_eq!(kinds, [Normal, TexCoord(0), ColorAlpha]);
        let fifth = f64::from(51.0_f32 / 255.0_f32);
        let row = attributes.row(attributes.corners()[0][2]);
        assert_eq!(row, [0.0, 0.0, 1.0, 0.5, 0.25, 0.0, fifth, 1.0, 0.0]);
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
    let [first, second] = [0, 1].map(|t| attributes.corners()[t]);
    assert_eq!(first[2], second[1], "equal uv at vertex 2");
    assert_ne!(first[0], second[0], "seam at vertex 0");
    let uv = attributes.channel(ChannelKind::TexCoord(0)).expect("uv");
    assert!(attributes.value(uv, attributes.corners()[2][0])[0].is_nan());
    let (bytes, _) = io::encode(&loaded.mesh, Encoding::PlyBigEndian).expect("writes");
    let again = io::read_bytes(Format::Ply, &bytes, "-").expect("reads");
    assert_eq!(corner_values(&again.mesh), corner_values(&loaded.mesh));
    let said = message(ply(&text.replace("6 0 0 1 0 1 1", "5 0 0 1 0 1")));
    assert!(said.contains("3 corners and 5 texture coordinates"));
}

#[test]
fn stl_errors_name_their_line() {
    let text = "solid a b c\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a b c\n";
    assert_eq!(stl(text).expect("valid").mesh.triangles(), [[0, 1, 2]]);
    let loaded = stl(&text.to_uppercase().replace("1 0 0", "1e0 -0 0"));
    assert_eq!(loaded.expect("valid").encoding, Encoding::StlAscii);
    for number in ["q", "inf"] {
        let said = message(stl(&text.replace("1 0 0", &format!("1 0 {number}"))));
        let expected = format!("line 5: found `{number}`; expected a finite coordinate");
        assert!(said.contains(&expected), "{said}");
    }
    for (from, to, expected) in [
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
