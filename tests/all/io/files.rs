//! Files in and out: what survives, and what is said about the rest.

use std::fs;

use glam::DVec3;
use lodmark::{
    encode::atomic,
    io::{self, Encoding, Format},
    mesh::{Attributes, Channel, ChannelKind, Materials, Mesh, MeshParts, content_sha256, weld},
    num::Precision,
};
use proptest::prelude::*;

use super::readers::{SQUARE, obj};
use crate::support::{folder, read_model};

/// Every attribute value of every corner, by channel; NaN as one value.
pub(crate) fn corner_values(mesh: &Mesh) -> Vec<(ChannelKind, Vec<u64>)> {
    let attributes = mesh.attributes();
    let values = |&channel: &Channel| {
        let wedges = attributes.corners().iter().flatten();
        let values = wedges.flat_map(|&w| attributes.value(channel, w));
        (channel.kind, values.map(|x| x.to_bits()).collect())
    };
    attributes.channels().iter().map(values).collect()
}

fn bits(mesh: &Mesh) -> Vec<[u64; 3]> {
    let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
    mesh.positions().iter().map(bits).collect()
}

fn material_names(mesh: &Mesh) -> Vec<Option<String>> {
    let materials = mesh.materials();
    let name = |t| materials.names.get(materials.of(t) as usize).cloned();
    (0..mesh.triangles().len()).map(name).collect()
}

#[test]
fn a_binary_stl_that_begins_with_solid_is_binary() {
    let (mut bytes, _) = io::encode(&square(), Encoding::StlBinary).expect("writes");
    bytes[..6].copy_from_slice(b"solid ");
    let loaded = io::read_bytes(Format::Stl, &bytes, "-").expect("reads");
    assert_eq!(loaded.encoding, Encoding::StlBinary);
    assert_eq!(weld(loaded.mesh).mesh.positions().len(), 4);
}

fn mesh_of(text: &str) -> Mesh {
    obj(text).expect("valid").mesh
}

fn square() -> Mesh {
    mesh_of(&format!("{SQUARE}f 1 2 3\nf 1 3 4\n"))
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
    use Encoding::{PlyAscii, PlyBigEndian, StlAscii, StlBinary};
    for encoding in [PlyAscii, PlyBigEndian, StlAscii, StlBinary] {
        let (bytes, _) = io::encode(&square(), encoding).expect("writes");
        for name in ["a.obj", "a.bin", "a"] {
            let path = folder.path().join(name);
            fs::write(&path, &bytes).expect("writable");
            let loaded = io::read(&path).expect("reads");
            assert_eq!(loaded.encoding, encoding);
            let notes = loaded.notes;
            assert_eq!(notes.is_empty(), name != "a.obj", "{notes:?}");
        }
    }
    let path = folder.path().join("a.OBJ");
    fs::write(&path, SQUARE).expect("writable");
    assert_eq!(io::read(&path).expect("reads").encoding, Encoding::Obj);
    let refused = |name: &str| io::read(&folder.path().join(name)).expect_err(name);
    fs::write(folder.path().join("noise.dat"), [7; 100]).expect("writable");
    assert_eq!(refused("noise.dat").exit_code(), 3);
    fs::write(folder.path().join("a.glb"), b"glTF\x02\0\0\0").expect("writable");
    assert_eq!(refused("a.glb").exit_code(), 3);
    assert_eq!(refused("gone.ply").exit_code(), 5);
}

#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let folder = folder();
    let path = folder.path().join("a.ply");
    fs::write(&path, "old").expect("writable");
    let failed = atomic::write(&path, |w| {
        w.write_all(&[1; 200_000])?;
        Err(std::io::Error::other("disk full"))
    });
    assert_eq!(failed.expect_err("failed").exit_code(), 5);
    assert_eq!(fs::read(&path).expect("there"), b"old");
    assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 1);
    io::write(&path, &square()).expect("writes");
    let again = io::read(&path).expect("reads").mesh;
    assert_eq!(again.triangles(), square().triangles());
    assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 1);
}

#[test]
fn threads_that_write_into_one_folder_lose_no_file() {
    let folder = folder();
    let path = |name: u32| folder.path().join(format!("{name}"));
    std::thread::scope(|scope| {
        for thread in 0..4 {
            let path = &path;
            scope.spawn(move || {
                for i in 0..250 {
                    let name = thread * 250 + i;
                    atomic::write(&path(name), |w| write!(w, "{name}")).expect("written");
                }
            });
        }
    });
    assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 1000);
    for name in 0..1000 {
        let found = fs::read_to_string(path(name)).expect("there");
        assert_eq!(found, name.to_string());
    }
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
    let [file, link] = ["file.ply", "link.ply"].map(|name| folder.path().join(name));
    fs::write(&file, "old").expect("writable");
    std::os::unix::fs::symlink(&file, &link).expect("links exist");
    io::write(&link, &square()).expect("writes");
    assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
    assert_eq!(io::read(&file).expect("reads").mesh.triangles().len(), 2);
    atomic::write(std::path::Path::new("/dev/null"), |w| w.write_all(b"x")).expect("writes");
    assert!(!fs::metadata("/dev/null").expect("there").is_file());
}

#[test]
fn the_precision_of_text_follows_from_its_digits() {
    let coarse = mesh_of("v 0 0 0\nv 1 0 0\nv 0.1 0.3333333333333333 0\nf 1 2 3\n");
    assert_eq!(coarse.precision(), Precision::F32);
    assert_eq!(bits(&coarse)[2][0], f64::from(0.1_f32).to_bits());
    let far = mesh_of("v 500000.001 0 0\nv 500001.002 0 0\nv 500000 1 0\nf 1 2 3\n");
    assert_eq!(far.precision(), Precision::F64);
    assert_eq!(bits(&far)[0][0], 500_000.001_f64.to_bits());
    let huge = mesh_of("v 1e300 0 0\nv 0 1e300 0\nv 0 0 1e300\nf 1 2 3\n");
    assert_eq!(huge.precision(), Precision::F64);
    for size in ["1e30", "1e-30"] {
        let text = format!("v {size} 0 0\nv 0 {size} 0\nv 0 0 {size}\nf 1 2 3\n");
        assert_eq!(mesh_of(&text).precision(), Precision::F32, "{size}");
    }
}

#[test]
fn what_a_format_cannot_keep_is_said() {
    let mesh = mesh_of(&format!(
        "{SQUARE}vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\nusemtl m\nf 1/1/1 2/1/1 3/1/1\nf 1/2/2 3/1/1 4/1/1\n"
    ));
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
    let huge = mesh_of("v 1e300 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n");
    let refused = io::encode(&huge, Encoding::StlBinary).expect_err("too large");
    assert_eq!(refused.exit_code(), 4);
}

#[test]
fn a_ply_keeps_every_normal_of_a_vertex_where_faces_fold() {
    let mesh = mesh_of(&format!(
        "{SQUARE}vn 0 0 1\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n"
    ));
    for encoding in [Encoding::PlyAscii, Encoding::PlyLittleEndian] {
        let (bytes, _) = io::encode(&mesh, encoding).expect("writes");
        let stored = io::read_bytes(Format::Ply, &bytes, "-")
            .expect("reads")
            .mesh;
        assert_eq!(stored.positions().len(), 6);
        let again = weld(stored).mesh;
        assert_eq!(again.positions(), mesh.positions());
        assert_eq!(again.triangles(), mesh.triangles());
        assert_eq!(corner_values(&again), corner_values(&mesh));
    }
}

#[test]
fn header_lines_of_ply_may_end_as_on_any_system() {
    let (bytes, _) = io::encode(&square(), Encoding::PlyLittleEndian).expect("writes");
    let mut windows = bytes.windows(11);
    let end = windows.position(|w| w == b"end_header\n");
    let body = end.expect("a header") + 11;
    let header = String::from_utf8(bytes[..body].to_vec()).expect("ASCII");
    for end in ["\r\n", "\r"] {
        // A first coordinate whose first byte is a line feed must not be taken for part of the header.
        let mut file = header.replace('\n', end).into_bytes();
        file.extend_from_slice(&bytes[body..]);
        let first = file.len() - (bytes.len() - body);
        file[first] = b'\n';
        let mesh = io::read_bytes(Format::Ply, &file, "-").expect("reads").mesh;
        let line_feed = f64::from(f32::from_bits(10)).to_bits();
        assert_eq!(bits(&mesh)[0][0], line_feed, "{end:?}");
        assert_eq!(mesh.triangles(), square().triangles());
    }
}

#[test]
fn a_summary_tells_everything_a_file_holds() {
    let loaded = obj(&format!(
        "mtllib a.mtl\n{SQUARE}vt 0 0\nvn 0 0 1\nusemtl m\nf 1/1/1 2/1/1 3/1/1\nusemtl n\nf 1 3 4\ng x\n"
    ))
    .expect("valid");
    let summary = io::Summary::of(&loaded);
    assert_eq!(
        summary.report(),
        "format              OBJ, text, 32-bit coordinates\nvertices            4\ntriangles           2\n\
         attribute           normals\nattribute           texture coordinates (set 0)\nwedges              6\n\
         material            m: 1 triangles\nmaterial            n: 1 triangles\nmaterial library    a.mtl\n\
         note: 1 lines `g`: objects and groups are not kept\n"
    );
    let json = serde_json::to_value(&summary).expect("serializes");
    assert_eq!(json["format"], "obj");
    assert_eq!(json["materials"][0][0], "m");
}

#[test]
fn triangles_without_a_material_after_others_do_not_inherit_one() {
    let mut parts = square().into_parts();
    parts.materials.names = vec!["none".into()];
    parts.materials.of_triangle = vec![0, Materials::NONE];
    let mesh = Mesh::new(parts).expect("valid");
    let (bytes, notes) = io::encode(&mesh, Encoding::Obj).expect("writes");
    let told = "1 triangles without one get the material `none_`";
    assert!(notes[0].contains(told), "{notes:?}");
    let again = io::read_bytes(Format::Obj, &bytes, "-").expect("reads");
    let expected = ["none", "none_"].map(|name| Some(name.into()));
    assert_eq!(material_names(&again.mesh), expected);
}

/// A float of any size, now and then a special one.
fn coordinate(precision: Precision) -> BoxedStrategy<f64> {
    let finite = any::<f64>().prop_filter("finite", |x| x.is_finite());
    match precision {
        Precision::F64 => prop_oneof![finite, Just(-0.0), -1.0..1.0].boxed(),
        Precision::F32 => {
            let finite = any::<f32>().prop_filter("finite", |x| x.is_finite());
            prop_oneof![finite, -1.0_f32..1.0, Just(-0.0)]
                .prop_map(f64::from)
                .boxed()
        }
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
                prop::collection::vec(0..3_u32, triangles),
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
                            let row = if seams { vertices + corner } else { v };
                            values.extend(&t[2 * row..2 * row + 2]);
                        }
                        if colors {
                            let level = |i: usize| precision.round(f64::from(c[i]) / 255.0);
                            let color = |i| if bytes { level(i) } else { n[i] };
                            values.extend((3 * v..3 * v + 3).map(color));
                        }
                    }
                    let corners = (0..triangles.len() as u32).map(|i| [0, 1, 2].map(|k| 3 * i + k));
                    let corners = corners.collect();
                    let all = ["red", "a b", "#1"].map(String::from).to_vec();
                    Mesh::new(MeshParts {
                        positions: p.chunks(3).map(DVec3::from_slice).collect(),
                        attributes: Attributes::new(&kinds, values, corners).expect("fits"),
                        materials: Materials {
                            names: all,
                            of_triangle: names,
                            libraries: vec!["lib one.mtl".into()],
                            asset: None,
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
    #![proptest_config(crate::support::cases(300))]

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

#[test]
fn real_models_have_their_published_sizes() {
    for (name, vertices, triangles) in [
        ("bunny.ply", 35_947, 69_451),
        ("dragon.ply", 437_645, 871_414),
        ("spot.obj", 2_930, 5_856),
    ] {
        let Some(loaded) = read_model(name) else {
            continue;
        };
        assert_eq!(loaded.mesh.positions().len(), vertices, "{name}");
        assert_eq!(loaded.mesh.triangles().len(), triangles, "{name}");
        assert_eq!(loaded.mesh.precision(), Precision::F32, "{name}");
    }
}

#[test]
fn a_textured_model_is_what_tobj_alone_makes_of_it() {
    let Some(loaded) = read_model("spot.obj") else {
        return;
    };
    let (bytes, notes) = io::encode(&loaded.mesh, Encoding::Obj).expect("writes");
    assert!(notes.is_empty());
    let options = tobj::LoadOptions {
        triangulate: true,
        ..tobj::LoadOptions::default()
    };
    let no_library = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut &bytes[..], &options, no_library).expect("reads");
    let plain = &models[0].mesh;
    let attributes = loaded.mesh.attributes();
    let uv = attributes.channel(ChannelKind::TexCoord(0));
    let uv = uv.expect("textured");
    assert_eq!(plain.indices.len(), 3 * loaded.mesh.triangles().len());
    let bits = |x: f64| (x as f32).to_bits();
    let corners = loaded.mesh.triangles().as_flattened().iter();
    let wedges = attributes.corners().as_flattened();
    for (at, (&corner, &wedge)) in corners.zip(wedges).enumerate() {
        let [v, vt] = [plain.indices[at], plain.texcoord_indices[at]].map(|i| i as usize);
        let p = loaded.mesh.positions()[corner as usize].to_array();
        let expected = [0, 1, 2].map(|i| bits(plain.positions[3 * v + i]));
        assert_eq!(p.map(bits), expected);
        let q = attributes.value(uv, wedge);
        let expected = [0, 1].map(|i| bits(plain.texcoords[2 * vt + i]));
        assert_eq!([q[0], q[1]].map(bits), expected);
    }
}
