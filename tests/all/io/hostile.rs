//! Damaged and hostile files: an error that says where, never a panic, a hang, or memory the file does not back.

use lodmark::{
    Error,
    io::{self, Encoding, Format},
    mesh::Mesh,
};
use proptest::prelude::*;

const ALL: [Encoding; 6] = [
    Encoding::Obj,
    Encoding::PlyAscii,
    Encoding::PlyLittleEndian,
    Encoding::PlyBigEndian,
    Encoding::StlAscii,
    Encoding::StlBinary,
];

/// A small mesh with everything a format can hold.
fn rich() -> Mesh {
    let text = "mtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0.5 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\n\
                vn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 3/3/1\nusemtl b\nf 1/3/1 3/2/1 4/1/1\n";
    let loaded = io::read_bytes(Format::Obj, text.as_bytes(), "-");
    loaded.expect("valid").mesh
}

/// Reads, and holds the reader to its contract.
fn read(format: Format, bytes: &[u8]) -> Result<Mesh, String> {
    match io::read_bytes(format, bytes, "x") {
        Ok(loaded) => {
            let mesh = loaded.mesh;
            // Every vertex of a text takes two bytes per number at least; a polygon one byte and a separator per corner.
            assert!(mesh.positions().len() <= bytes.len());
            assert!(mesh.triangles().len() <= bytes.len());
            Ok(mesh)
        }
        Err(error @ Error::Input { .. }) => {
            let text = error.to_string();
            assert!(text.len() < 1000, "a message, not a dump: {text}");
            Err(text)
        }
        Err(other) => panic!("expected bad input, found {other}"),
    }
}

#[test]
fn a_file_cut_off_anywhere_is_an_error_or_a_valid_mesh() {
    for encoding in ALL {
        let (bytes, _) = io::encode(&rich(), encoding).expect("writes");
        assert!(read(encoding.format(), &bytes).is_ok());
        for end in 0..bytes.len() {
            let result = read(encoding.format(), &bytes[..end]);
            match encoding {
                // The end of a line of OBJ, and the last digits of any text, cannot be missed.
                Encoding::Obj => {}
                Encoding::PlyAscii | Encoding::StlAscii if end + 12 > bytes.len() => {}
                _ => assert!(result.is_err(), "{encoding:?} cut at {end}"),
            }
        }
    }
}

#[test]
fn an_empty_file_is_an_error() {
    for format in Format::ALL {
        for bytes in [b"".as_slice(), b" ", b"\n\n\n", b"\0"] {
            assert!(read(format, bytes).is_err(), "{format} {bytes:?}");
        }
    }
}

#[test]
fn a_billion_declared_items_in_a_hundred_bytes_are_refused() {
    for storage in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for (vertices, faces) in [
            ("1000000000", "1"),
            ("0", "1000000000"),
            ("18446744073709551615", "0"),
            ("0", "18446744073709551615"),
        ] {
            let text = format!(
                "ply\nformat {storage} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
                 element face {faces}\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0"
            );
            let said = read(Format::Ply, text.as_bytes()).expect_err("hostile");
            assert!(said.contains("bytes") || said.contains("at most"), "{said}");
        }
        let text = format!(
            "ply\nformat {storage} 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n\
             element x 1000000000\nproperty list uint uchar l\nend_header\n0 0 0"
        );
        assert!(read(Format::Ply, text.as_bytes()).is_err());
    }
    let mut stl = vec![0; 84];
    stl[80..].copy_from_slice(&1_000_000_000_u32.to_le_bytes());
    let said = read(Format::Stl, &stl).expect_err("hostile");
    assert!(said.contains("1000000000 triangles declared"), "{said}");
}

#[test]
fn elements_without_properties_cost_nothing_however_many() {
    let text = "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n\
                element nothing 18446744073709551615\nend_header\n";
    assert!(read(Format::Ply, text.as_bytes()).is_ok());
    assert!(read(Format::Ply, text.replace("nothing", "face").as_bytes()).is_err());
}

#[test]
fn a_list_of_two_billion_entries_is_refused_at_its_place() {
    for (storage, count) in [
        ("binary_little_endian", [0, 0, 0, 0x80]),
        ("binary_big_endian", [0x80, 0, 0, 0]),
    ] {
        for (element, name) in [
            ("face", "vertex_indices"),
            ("face", "other"),
            ("other", "other"),
        ] {
            let mut bytes = format!(
                "ply\nformat {storage} 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n\
                 element {element} 1\nproperty list uint int {name}\nproperty list uint int vertex_index\nend_header\n"
            )
            .into_bytes();
            bytes.extend([0; 12]);
            bytes.extend(count);
            bytes.extend([0; 20]);
            let said = read(Format::Ply, &bytes).expect_err("hostile");
            let placed = said.contains("a list of 2147483648 numbers") && said.contains("byte ");
            assert!(placed, "{said}");
        }
    }
}

#[test]
fn a_header_of_countless_elements_or_properties_is_refused() {
    let elements: String = (0..5000).map(|i| format!("element e{i} 0\n")).collect();
    let properties = format!("element vertex 0\n{}", "property int i\n".repeat(5000));
    for (lines, limit) in [
        (elements, "at most 1000 elements"),
        (properties, "at most 1000 properties"),
    ] {
        let text = format!("ply\nformat ascii 1.0\n{lines}end_header\n");
        let said = read(Format::Ply, text.as_bytes()).expect_err("hostile");
        assert!(said.contains(limit), "{said}");
    }
}

#[test]
fn an_obj_of_many_libraries_and_keywords_is_read_in_time() {
    let mut text = String::from("v 0 0 0\n");
    for i in 0..20_000 {
        text += &format!("mtllib {i}\nusemtl {i}\nkey{i}\n");
    }
    let loaded = io::read_bytes(Format::Obj, text.as_bytes(), "-").expect("valid");
    assert_eq!(loaded.mesh.materials().libraries.len(), 20_000);
    assert!(loaded.notes.len() < 40);
}

#[test]
fn large_polygons_and_repeated_vertices_are_read() {
    let mut text = String::from("v 0 0 0\nv 1 0 0\nf");
    for i in 0..10_000 {
        text += if i % 2 == 0 { " 1" } else { " -1" };
    }
    let mesh = read(Format::Obj, text.as_bytes()).expect("valid");
    assert_eq!(mesh.triangles().len(), 9998);
}

#[test]
fn a_colour_of_which_a_part_is_not_a_number_is_absent() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                property float red\nproperty float green\nproperty float blue\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n\
                0 0 0 1 1 nan\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n";
    let mesh = read(Format::Ply, text.as_bytes()).expect("valid");
    assert!(mesh.attributes().row(0).iter().all(|x| x.is_nan()));
    assert!(mesh.attributes().row(1).iter().all(|x| x.is_finite()));
    let (bytes, _) = io::encode(&mesh, Encoding::Obj).expect("writes");
    let again = read(Format::Obj, &bytes).expect("reads");
    assert!(again.attributes().row(0).iter().all(|x| x.is_nan()));
}

/// Pieces that a mutated file is likely to trip over.
const TRAPS: [&[u8]; 16] = [
    b"-1",
    b"0",
    b"4294967295",
    b"9223372036854775807",
    b"-9223372036854775808",
    b"1e999",
    b"nan",
    b"/",
    b"\n",
    b"\\\n",
    b" ",
    b"\xff\xff\xff\xff",
    b"\x80\0\0\0",
    b"\0",
    b"#",
    b"list",
];

fn formats() -> impl Strategy<Value = Format> {
    prop::sample::select(Format::ALL.to_vec())
}

/// The places of the corners of every triangle.
fn corners(mesh: &Mesh) -> Vec<[[u64; 3]; 3]> {
    let triangles = 0..mesh.triangles().len();
    let places = triangles.map(|t| mesh.corners(t));
    places
        .map(|points| points.map(|p| p.to_array().map(f64::to_bits)))
        .collect()
}

proptest! {
    #![proptest_config(crate::support::cases(2000))]

    #[test]
    fn random_bytes_are_never_a_panic(format in formats(), bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = read(format, &bytes);
    }

    #[test]
    fn random_words_are_never_a_panic(
        format in formats(),
        words in prop::collection::vec(
            prop::sample::select(vec![
                "v", "vt", "vn", "f", "usemtl", "o", "\n", "\n", "\n", "1", "2", "-1", "1/1/1", "1//1", "-1/-1", "0", "1e39", "ply\n",
                "format ascii 1.0\n", "element vertex 1\n", "property float x\nproperty float y\nproperty float z\n",
                "element face 1\n", "property list int int vertex_indices\n", "property list uchar double texcoord\n", "end_header\n",
                "solid", "facet normal", "outer loop", "vertex", "endloop", "endfacet", "endsolid", "#", "\\\n",
            ]),
            0..60,
        ),
    ) {
        let _ = read(format, words.join(" ").as_bytes());
    }

    #[test]
    fn mutated_files_are_never_a_panic(
        encoding in prop::sample::select(ALL.to_vec()),
        mutations in prop::collection::vec((any::<prop::sample::Index>(), 0_u8..4, any::<u8>(), prop::sample::select(TRAPS.to_vec())), 1..6),
    ) {
        let (mut bytes, _) = io::encode(&rich(), encoding).expect("writes");
        for (at, kind, byte, trap) in mutations {
            let at = at.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes[at] ^= 1 << (byte % 8),
                2 => { bytes.splice(at..at, trap.iter().copied()); }
                _ => { bytes.splice(at..(at + trap.len()).min(bytes.len()), trap.iter().copied()); }
            }
        }
        if let Ok(mesh) = read(encoding.format(), &bytes) {
            // What was accepted can be written, and read again.
            for out in [Encoding::Obj, Encoding::PlyBigEndian] {
                let (written, _) = io::encode(&mesh, out).expect("writes");
                let again = io::read_bytes(out.format(), &written, "-").expect("reads").mesh;
                // A PLY may store a vertex several times.
                prop_assert_eq!(corners(&again), corners(&mesh));
            }
        }
    }
}
