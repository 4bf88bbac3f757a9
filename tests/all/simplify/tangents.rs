//! Tangents that are recomputed: the directions in which u grows, and on which side the picture goes up.

use glam::DVec3;
use lodmark::{
    mesh::{Attributes, ChannelKind, Mesh, MeshParts, canonical, generate},
    simplify::{
        Options, Replay, Tangents, Target, normals::settle_level, simplify, tangents::settle,
    },
};
use serde_json::json;

use crate::support::{GltfBuilder, Random, expect, folder, json as report, meshes, on_threads};

/// A point with its normal and its texture coordinates.
type Sample = (DVec3, DVec3, [f64; 2]);

/// A sheet of `n * n` squares over the parameters 0 to 1 in both directions; corners of one square share no wedge.
fn sheet(n: usize, sample: impl Fn(f64, f64, f64) -> Sample) -> Mesh {
    let at = |x: usize, y: usize| y * (n + 1) + x;
    let of = |i: usize| i as f64 / n as f64;
    let mut positions = vec![DVec3::ZERO; (n + 1) * (n + 1)];
    let (mut triangles, mut values, mut corners) = (Vec::new(), Vec::new(), Vec::new());
    for y in 0..n {
        for x in 0..n {
            let first = (values.len() / 5) as u32;
            for (x1, y1) in [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)] {
                // The middle of the square tells on which side of a fold of the texture it lies.
                let (p, normal, uv) = sample(of(x1), of(y1), (x as f64 + 0.5) / n as f64);
                positions[at(x1, y1)] = p;
                values.extend(
                    normal
                        .to_array()
                        .into_iter()
                        .chain(uv)
                        .map(|x| f64::from(x as f32)),
                );
            }
            let quad = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)].map(|v| v as u32);
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                triangles.push([quad[a], quad[b], quad[c]]);
                corners.push([a, b, c].map(|k| first + k as u32));
            }
        }
    }
    let kinds = [ChannelKind::Normal, ChannelKind::TexCoord(0)];
    Mesh::new(MeshParts {
        positions,
        triangles,
        attributes: Attributes::new(&kinds, values, corners).expect("valid"),
        ..MeshParts::default()
    })
    .expect("valid")
}

fn with_tangents(mesh: Mesh) -> Mesh {
    settle(mesh, Tangents::Recompute).expect("a mesh").0
}

fn is_one(sign: f64) -> bool {
    sign.total_cmp(&1.0).is_eq()
}

/// Place, normal and tangent of every corner.
fn corners(mesh: &Mesh) -> Vec<(DVec3, DVec3, DVec3, f64)> {
    let attributes = mesh.attributes();
    let normals = attributes.channel(ChannelKind::Normal).expect("normals");
    let tangents = attributes.channel(ChannelKind::Tangent).expect("tangents");
    let vector = |v: &[f64]| DVec3::new(v[0], v[1], v[2]);
    let pairs = mesh.triangles().iter().zip(attributes.corners());
    let pairs = pairs.flat_map(|(vertices, wedges)| vertices.iter().zip(wedges));
    pairs
        .map(|(&v, &w)| {
            let tangent = attributes.value(tangents, w);
            let normal = vector(attributes.value(normals, w));
            (
                mesh.positions()[v as usize],
                normal,
                vector(tangent),
                tangent[3],
            )
        })
        .collect()
}

/// A slanted plane whose texture lies askew and, left of the middle, is mirrored.
fn plane(mirrored: bool) -> Mesh {
    let (along, across) = (DVec3::new(2.0, 0.0, 1.0), DVec3::new(0.5, 1.5, 0.0));
    sheet(6, |s, t, middle| {
        let u = if mirrored && middle < 0.5 {
            0.5 - s
        } else {
            s - 0.5
        };
        (
            along * s + across * t,
            along.cross(across).normalize(),
            [3.0 * u, 0.5 * t],
        )
    })
}

#[test]
fn on_a_plane_tangents_are_where_u_grows_and_their_sign_tells_a_mirrored_texture() {
    // The derivative by u at constant v, on either side.
    let along = DVec3::new(2.0, 0.0, 1.0).normalize();
    for mirrored in [false, true] {
        let mesh = with_tangents(plane(mirrored));
        let mut signs = [0; 2];
        for (t, (_, normal, tangent, sign)) in corners(&mesh).into_iter().enumerate() {
            let middle = ((t / 6) % 6) as f64 / 6.0 + 1.0 / 12.0;
            let side = if mirrored && middle < 0.5 { -1.0 } else { 1.0 };
            assert!((tangent - along * side).length() < 1e-5, "{tangent}");
            assert!(tangent.dot(normal).abs() < 1e-5);
            assert!(sign.total_cmp(&side).is_eq());
            signs[usize::from(sign > 0.0)] += 1;
        }
        assert_eq!(signs[0] > 0, mirrored);
    }
    // The vertices of the fold have a wedge for either side; all others have one.
    let wedges = |mirrored| {
        canonical(&with_tangents(plane(mirrored)))
            .mesh
            .attributes()
            .wedge_count()
    };
    assert_eq!((wedges(false), wedges(true)), (49, 49 + 7));
}

#[test]
fn on_a_sphere_tangents_go_around_the_axis() {
    let (pi, n) = (std::f64::consts::PI, 40);
    let sphere = sheet(n, |s, t, _| {
        let (longitude, latitude) = (pi * s, pi * (0.2 + 0.6 * t) - pi / 2.0);
        let ring = libm::cos(latitude);
        let p = DVec3::new(
            ring * libm::cos(longitude),
            ring * libm::sin(longitude),
            libm::sin(latitude),
        );
        (p, p, [s, t])
    });
    let mut worst = 0.0_f64;
    for (p, normal, tangent, sign) in corners(&with_tangents(sphere)) {
        let around = DVec3::Z.cross(p).normalize();
        worst = worst.max((tangent - around).length());
        assert!(tangent.dot(normal).abs() < 1e-5 && is_one(sign));
        assert!((tangent.length() - 1.0).abs() < 1e-5);
    }
    // Half a cell of the grid at its rim, where one side is missing.
    assert!(worst < 0.04, "{worst}");
}

#[test]
fn a_simplified_sphere_has_tangents_of_its_own_and_carried_ones_stay_as_they_were() {
    let mesh = canonical(&plane(true)).mesh;
    let options = Options::memoryless(Target::Triangles(20));
    let carry = simplify(&mesh, &options).expect("valid");
    assert!(carry.tangents.is_none());
    assert!(
        carry
            .mesh
            .attributes()
            .channel(ChannelKind::Tangent)
            .is_none()
    );
    let options = options.tangents(Tangents::Recompute);
    let run = || simplify(&mesh, &options).expect("valid");
    let again = run();
    let account = again.tangents.expect("made");
    assert_eq!(account.triangles, again.mesh.triangles().len());
    assert_eq!(account.triangles_without, 0);
    let along = DVec3::new(2.0, 0.0, 1.0).normalize();
    for (_, _, tangent, sign) in corners(&again.mesh) {
        assert!((tangent * sign - along).length() < 1e-4, "{tangent} {sign}");
    }
    assert_eq!(on_threads(1, run).mesh, on_threads(3, run).mesh);
    // A level of the history has the tangents of its run.
    let mut replay = Replay::new(&mesh, &again.history).expect("its mesh");
    replay.seek(20).expect("replays");
    let level = replay.live().to_mesh().expect("valid");
    let level = settle_level(&mesh, level, &again.history, &lodmark::Silent).expect("valid");
    assert_eq!(level, again.mesh);
}

#[test]
fn any_mesh_gets_unit_tangents_or_none_and_nothing_else_changes() {
    let mut random = Random(8);
    for (kind, mesh) in [
        meshes::textured_torus(9, 7, 1, true),
        meshes::soup(12, 60, 2),
        generate::icosphere(1),
    ]
    .into_iter()
    .enumerate()
    {
        // Any normals and coordinates, equal, zero, absent and huge ones among them.
        for strange in [false, true] {
            let mut values = Vec::new();
            let mut corners = Vec::new();
            for t in 0..mesh.triangles().len() as u32 {
                for _ in 0..3 {
                    let row = match random.below(if strange { 6 } else { 1 }) {
                        0..=2 => [random.unit() - 0.5, 0.5, random.unit(), random.unit(), 0.25],
                        3 => [0.0; 5],
                        4 => [f64::NAN; 5],
                        _ => [3e38, -3e38, 1e30, 3e38, -1e-40],
                    };
                    values.extend(row.map(|x| f64::from(x as f32)));
                }
                corners.push([3 * t, 3 * t + 1, 3 * t + 2]);
            }
            let kinds = [ChannelKind::Normal, ChannelKind::TexCoord(0)];
            let parts = mesh.clone().into_parts();
            let before = Mesh::new(MeshParts {
                attributes: Attributes::new(&kinds, values, corners).expect("valid"),
                ..parts
            })
            .expect("valid");
            let after = with_tangents(before.clone());
            assert_eq!(before.triangles(), after.triangles(), "{kind}");
            assert_eq!(before.positions(), after.positions());
            for (_, _, tangent, sign) in self::corners(&after) {
                let is_unit = (tangent.length() - 1.0).abs() < 1e-3 && is_one(sign.abs());
                assert!(
                    is_unit || tangent.x.is_nan() && sign.is_nan(),
                    "{tangent} {sign}"
                );
            }
        }
    }
    let plain = generate::icosphere(1);
    let (same, account) = settle(plain.clone(), Tangents::Recompute).expect("a mesh");
    assert!(same == plain && account.is_none());
}

#[test]
fn gltf_gets_tangents_for_primitives_without_and_the_sign_that_its_v_downwards_asks_for() {
    let dir = folder();
    let n = 6_u16;
    let (mut places, mut normals, mut coordinates) = (Vec::new(), Vec::new(), Vec::new());
    for y in 0..=n {
        for x in 0..=n {
            let [s, t] = [x, y].map(|i| f32::from(i) / f32::from(n));
            places.extend([s, t, 0.0]);
            normals.extend([0.0, 0.0, 1.0]);
            // Upright: the top of the picture is v = 0.
            coordinates.extend([s, 1.0 - t]);
        }
    }
    let at = |x: u16, y: u16| y * (n + 1) + x;
    let cells = (0..n * n).map(|i| (i % n, i / n));
    let faces: Vec<u16> = cells
        .flat_map(|(x, y)| {
            [
                at(x, y),
                at(x + 1, y),
                at(x + 1, y + 1),
                at(x, y),
                at(x + 1, y + 1),
                at(x, y + 1),
            ]
        })
        .collect();
    let mut document = GltfBuilder::new();
    let position = document.floats("VEC3", &places);
    let normal = document.floats("VEC3", &normals);
    let texture = document.floats("VEC2", &coordinates);
    let plain = document.floats("VEC3", &places.iter().map(|x| x + 3.0).collect::<Vec<_>>());
    let indices = document.indices(&faces);
    let mesh = document.mesh(json!([
        {"attributes": {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": texture}, "indices": indices},
        {"attributes": {"POSITION": plain, "NORMAL": normal}, "indices": indices},
    ]));
    document.node(json!({"mesh": mesh}));
    std::fs::write(dir.path().join("in.glb"), document.glb()).expect("writes");
    let words = "simplify in.glb out.glb -t 60 --method memoryless --json run.json";
    expect(&dir, 0, words);
    assert!(report(&dir, "run.json")["tangents"].is_null());
    let said = expect(
        &dir,
        0,
        &format!("{words} --tangents recompute --history h"),
    );
    assert!(said.contains("tangents recomputed"), "{said}");
    let run = report(&dir, "run.json");
    assert_eq!(run["options"]["tangents"], "recompute");
    let [with, without] = ["triangles", "triangles_without"].map(|n| run["tangents"][n].as_u64());
    let all = run["triangles_out"].as_u64();
    assert_eq!(with.zip(without).map(|(a, b)| a + b), all);
    assert!(with > Some(0) && without > Some(0));
    let out = Mesh::read(dir.path().join("out.glb")).expect("reads");
    let mut count = 0;
    for (p, _, tangent, sign) in corners(&out) {
        if p.x <= 1.0 {
            assert!(
                (tangent - DVec3::X).length() < 1e-5 && is_one(sign),
                "{tangent} {sign}"
            );
            count += 1;
        } else {
            assert!(tangent.x.is_nan());
        }
    }
    assert_eq!(Some(count), with.map(|n| 3 * n));
    expect(&dir, 0, "replay in.glb h again.glb -t 60 --json again.json");
    assert_eq!(
        report(&dir, "again.json")["content_sha256"],
        run["content_sha256"]
    );
    // Nothing to make tangents of is said.
    let said = expect(
        &dir,
        0,
        &format!("{words} --tangents recompute --normals drop"),
    );
    assert!(said.contains("no tangents"), "{said}");
}
