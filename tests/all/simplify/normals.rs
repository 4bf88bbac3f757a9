//! Stored normals of a result: they fit the original's, split where the surface folds, and are the same for everyone.

mod judged;

use glam::DVec3;
use lodmark::{
    Silent, io,
    mesh::{Attributes, ChannelKind, Mesh, MeshParts, canonical, generate},
    simplify::{Normals, Options, Outcome, Replay, Target, Topology, normals::settle, simplify},
};
use proptest::prelude::*;

use crate::support::{Random, folder, meshes, same_on_all_threads};

const WAYS: [Normals; 4] = [
    Normals::Fit,
    Normals::Carry,
    Normals::Recompute,
    Normals::Drop,
];

/// The mesh with attributes in place of its own; `of` gives the row of a corner.
fn with_rows(mesh: Mesh, kinds: &[ChannelKind], of: impl Fn(usize, u32) -> Vec<f64>) -> Mesh {
    let (mut values, mut corners) = (Vec::new(), Vec::new());
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        let first = 3 * t as u32;
        corners.push([first, first + 1, first + 2]);
        for &v in triangle {
            values.extend(of(t, v).into_iter().map(|x| f64::from(x as f32)));
        }
    }
    let attributes = Attributes::new(kinds, values, corners).expect("valid");
    let parts = MeshParts {
        attributes,
        ..mesh.into_parts()
    };
    canonical(&Mesh::new(parts).expect("valid")).mesh
}

/// The area-weighted normals of all vertices.
fn smooth_normals(mesh: &Mesh) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; mesh.positions().len()];
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        let [a, b, c] = mesh.corners(t);
        for &v in triangle {
            sums[v as usize] += (b - a).cross(c - a);
        }
    }
    sums.into_iter().map(DVec3::normalize_or_zero).collect()
}

/// The mesh with smooth stored normals and no other attributes.
pub(crate) fn smooth(mesh: Mesh) -> Mesh {
    let normals = smooth_normals(&mesh);
    with_rows(mesh, &[ChannelKind::Normal], |_, v| {
        normals[v as usize].to_array().to_vec()
    })
}

fn run(mesh: &Mesh, triangles: u64, normals: Normals) -> Outcome {
    let options = Options::memoryless(Target::triangles(triangles));
    simplify(mesh, &options.normals(normals)).expect("runs")
}

fn settled(original: &Mesh, simplified: &Mesh, normals: Normals) -> Mesh {
    let settled = settle(original, simplified.clone(), normals, &Silent);
    settled.expect("nobody interrupts").0
}

/// The stored normals of a triangle.
fn stored(mesh: &Mesh, t: usize) -> [DVec3; 3] {
    let attributes = mesh.attributes();
    let channel = attributes.channel(ChannelKind::Normal).expect("normals");
    attributes.corners()[t].map(|w| DVec3::from_slice(attributes.value(channel, w)))
}

fn face_normal(mesh: &Mesh, t: usize) -> DVec3 {
    let [a, b, c] = mesh.corners(t);
    (b - a).cross(c - a).normalize_or_zero()
}

#[test]
fn a_smooth_sphere_keeps_one_normal_at_a_vertex_which_points_outward() {
    let mesh = smooth(generate::icosphere(4));
    let outcome = run(&mesh, 400, Normals::Fit);
    let report = outcome.normals.expect("fitted");
    assert_eq!(report.stored_vertices, outcome.mesh.positions().len());
    for (t, triangle) in outcome.mesh.triangles().iter().enumerate() {
        for (v, normal) in triangle.iter().zip(stored(&outcome.mesh, t)) {
            let outward = outcome.mesh.positions()[*v as usize].normalize();
            assert!(normal.dot(outward) > libm::cos(0.02), "{normal} {outward}");
            assert!((normal.length() - 1.0).abs() < 1e-6);
        }
    }
}

/// A cube of six grids with hard edges.
fn hard_cube() -> Mesh {
    let parts = meshes::cube(6, false, false).into_parts();
    let flat = |p: DVec3| p / p.abs().max_element();
    let positions = parts.positions.iter().map(|&p| flat(p)).collect();
    let mesh = Mesh::from_triangles(positions, parts.triangles).expect("valid");
    let sides: Vec<DVec3> = (0..mesh.triangles().len())
        .map(|t| face_normal(&mesh, t).round() + DVec3::ZERO)
        .collect();
    let of_side = |t: usize, _| sides[t].to_array().to_vec();
    with_rows(mesh.clone(), &[ChannelKind::Normal], of_side)
}

#[test]
fn a_cube_keeps_three_exact_normals_at_every_corner() {
    let outcome = run(&hard_cube(), 12, Normals::Fit);
    assert_eq!(outcome.mesh.triangles().len(), 12);
    for t in 0..12 {
        let side = face_normal(&outcome.mesh, t);
        assert_eq!(stored(&outcome.mesh, t), [side.round() + DVec3::ZERO; 3]);
    }
    assert_eq!(outcome.normals.expect("fitted").stored_vertices, 24);
}

/// Two plates at a right angle, and the round bevel of `steps` strips between them, smooth all over.
fn bevel(steps: usize) -> Mesh {
    let (mut profile, radius) = (Vec::new(), 0.05);
    profile.push((DVec3::new(-1.0, 0.0, 0.0), DVec3::Y));
    for i in 0..=steps {
        let a = std::f64::consts::FRAC_PI_2 * i as f64 / steps as f64;
        let out = DVec3::new(libm::sin(a), libm::cos(a), 0.0);
        profile.push((out * radius - DVec3::new(radius, radius, 0.0), out));
    }
    profile.push((DVec3::new(0.0, -1.0, 0.0), DVec3::X));
    plates(&profile)
}

/// The surface that a profile sweeps along z, with the normals of the profile.
fn plates(profile: &[(DVec3, DVec3)]) -> Mesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for z in [0.0, 1.0] {
        positions.extend(profile.iter().map(|&(p, _)| p + DVec3::Z * z));
    }
    let n = profile.len() as u32;
    for i in 0..n - 1 {
        triangles.extend([[i, n + i, n + i + 1], [i, n + i + 1, i + 1]]);
    }
    let mesh = Mesh::from_triangles(positions, triangles).expect("valid");
    with_rows(mesh, &[ChannelKind::Normal], |_, v| {
        profile[(v % n) as usize].1.to_array().to_vec()
    })
}

#[test]
fn a_bevel_that_has_collapsed_leaves_a_split_edge() {
    let diagonal = DVec3::new(1.0, 1.0, 0.0).normalize();
    let profile = [
        (DVec3::new(-1.0, 0.0, 0.0), DVec3::Y),
        (DVec3::ZERO, diagonal),
        (DVec3::new(0.0, -1.0, 0.0), DVec3::X),
    ];
    let folded = plates(&profile);
    let fitted = settled(&bevel(4), &folded, Normals::Fit);
    for t in 0..4 {
        let face = face_normal(&fitted, t);
        for normal in stored(&fitted, t) {
            assert!(normal.dot(face) > libm::cos(0.2), "{t}: {normal} on {face}");
        }
    }
    assert_eq!(fitted.positions(), folded.positions());
    assert_eq!(fitted.triangles(), folded.triangles());
}

/// A sphere with a texture seam along a great circle, smooth normals and tangents around z.
fn seamed_sphere() -> Mesh {
    let mesh = generate::icosphere(3);
    let normals = smooth_normals(&mesh);
    let kinds = [
        ChannelKind::TexCoord(0),
        ChannelKind::Normal,
        ChannelKind::Tangent,
    ];
    let centres: Vec<DVec3> = (0..mesh.triangles().len())
        .map(|t| mesh.corners(t).iter().sum::<DVec3>() / 3.0)
        .collect();
    with_rows(mesh.clone(), &kinds, |t, v| {
        let (p, chart) = (mesh.positions()[v as usize], centres[t].x.signum());
        let n = normals[v as usize];
        let along = (DVec3::Z.cross(n) + DVec3::X * 1e-3).normalize();
        let tangent = (along - n * n.dot(along)).normalize();
        let mut row = vec![p.y + 3.0 * chart, p.z];
        row.extend(n.to_array());
        row.extend(tangent.to_array());
        row.push(chart);
        row
    })
}

#[test]
fn a_texture_seam_shows_in_no_normal_and_tangents_follow_theirs() {
    let mesh = seamed_sphere();
    let [fit, carry] = [Normals::Fit, Normals::Carry].map(|way| run(&mesh, 200, way).mesh);
    let mut normal_at = vec![None; fit.positions().len()];
    let attributes = fit.attributes();
    let tangents = attributes.channel(ChannelKind::Tangent).expect("tangents");
    for t in 0..fit.triangles().len() {
        for (k, normal) in stored(&fit, t).into_iter().enumerate() {
            let v = fit.triangles()[t][k] as usize;
            assert_eq!(*normal_at[v].get_or_insert(normal), normal);
            let [now, before] = [&fit, &carry].map(|m| {
                m.attributes()
                    .value(tangents, m.attributes().corners()[t][k])
            });
            assert!(DVec3::from_slice(now).dot(normal).abs() < 1e-6);
            assert!((DVec3::from_slice(now).length() - 1.0).abs() < 1e-6);
            assert_eq!(now[3].to_bits(), before[3].to_bits());
        }
    }
}

#[test]
fn everyone_gets_the_same_bits() {
    let mesh = meshes::textured_torus(24, 16, 3, true);
    for normals in WAYS {
        same_on_all_threads(|| run(&mesh, 200, normals).mesh);
    }
    let simplified = run(&mesh, 200, Normals::Carry).mesh;
    let turned = |mesh: &Mesh, by: usize| {
        let mut parts = mesh.clone().into_parts();
        let turn = |(t, c): (usize, &[u32; 3])| {
            let mut c = *c;
            c.rotate_left((t + by) % 3);
            c
        };
        let kinds: Vec<_> = mesh
            .attributes()
            .channels()
            .iter()
            .map(|c| c.kind)
            .collect();
        let corners = mesh.attributes().corners().iter().enumerate().map(turn);
        let values = mesh.attributes().values().to_vec();
        parts.triangles = mesh.triangles().iter().enumerate().map(turn).collect();
        parts.attributes = Attributes::new(&kinds, values, corners.collect()).expect("valid");
        Mesh::new(parts).expect("valid")
    };
    let plain = canonical(&settled(&mesh, &simplified, Normals::Fit)).mesh;
    for by in 0..3 {
        let fitted = settled(
            &turned(&mesh, by),
            &turned(&simplified, by + 1),
            Normals::Fit,
        );
        assert_eq!(canonical(&fitted).mesh, plain);
    }
}

#[test]
fn a_replay_has_the_normals_of_the_run_to_its_level() {
    let mesh = seamed_sphere();
    for normals in WAYS {
        let run = |triangles: u64| {
            let options = Options::memoryless(Target::triangles(triangles)).keep_folds();
            simplify(&mesh, &options.normals(normals)).expect("runs")
        };
        let history = run(60).history;
        for triangles in [60, 300, 1_000] {
            let level = history.level(&mesh, triangles).expect("its own history");
            assert_eq!(level, run(triangles as u64).mesh, "{normals:?} {triangles}");
        }
    }
}

#[test]
fn carried_normals_are_those_of_the_collapses() {
    let mesh = seamed_sphere();
    let outcome = run(&mesh, 100, Normals::Carry);
    let mut replay = Replay::new(&mesh, &outcome.history).expect("its own history");
    replay.seek(0).expect("fits");
    assert_eq!(replay.live().to_mesh().expect("a mesh"), outcome.mesh);
    assert_eq!(outcome.normals, None);
}

#[test]
fn dropped_normals_are_in_no_file_and_nothing_else_is_gone() {
    let mesh = seamed_sphere();
    let [drop, carry] = [Normals::Drop, Normals::Carry].map(|way| run(&mesh, 100, way).mesh);
    let kinds: Vec<_> = drop
        .attributes()
        .channels()
        .iter()
        .map(|c| c.kind)
        .collect();
    assert_eq!(kinds, [ChannelKind::TexCoord(0)]);
    assert_eq!(drop.positions(), carry.positions());
    assert_eq!(drop.triangles(), carry.triangles());
    let folder = folder();
    let [first, second] = ["first.gltf", "second.gltf"].map(|name| folder.path().join(name));
    io::write(&first, &mesh).expect("written");
    let read = canonical(&io::read(&first).expect("read").mesh).mesh;
    for (normals, has) in [(Normals::Drop, false), (Normals::Fit, true)] {
        io::write(&second, &run(&read, 100, normals).mesh).expect("written");
        let text = std::fs::read_to_string(&second).expect("text");
        for name in ["\"NORMAL\"", "\"TANGENT\""] {
            assert_eq!(text.contains(name), has, "{name}");
        }
        assert!(text.contains("\"TEXCOORD_0\""));
    }
}

#[test]
fn a_mesh_without_normals_is_none_of_their_business() {
    let mesh = generate::textured_torus(24, 12);
    let carry = run(&mesh, 100, Normals::Carry);
    for normals in WAYS {
        let outcome = run(&mesh, 100, normals);
        assert_eq!(outcome.mesh, carry.mesh);
        assert_eq!(outcome.history.to_bytes(), carry.history.to_bytes());
        assert_eq!(outcome.normals, None);
    }
}

#[test]
fn an_unchanged_mesh_keeps_its_normals_to_the_bit() {
    for mesh in [seamed_sphere(), hard_cube(), bevel(3)] {
        assert_eq!(canonical(&settled(&mesh, &mesh, Normals::Fit)).mesh, mesh);
    }
}

proptest! {
    #![proptest_config(crate::support::cases(24))]

    #[test]
    fn whatever_is_stored_results_have_unit_normals_or_none_at_all(
        kind in 0_usize..8, seed: u64, odd in 0_usize..6, share in 0.05..1.1,
    ) {
        let random = std::cell::RefCell::new(Random(seed));
        let mesh = with_rows(meshes::any(kind, seed), &[ChannelKind::Normal], |_, _| {
            let mut random = random.borrow_mut();
            let normal = match random.below(6) {
                _ if odd == 0 => DVec3::NAN,
                i if i > odd => random.direction(),
                1 => DVec3::NAN,
                2 => DVec3::ZERO,
                3 => random.direction() * 1e30,
                _ => random.direction() * 1e-38,
            };
            normal.to_array().to_vec()
        });
        let triangles = (mesh.triangles().len() as f64 * share) as u64 + 1;
        for normals in [Normals::Fit, Normals::Recompute] {
            let options = Options::memoryless(Target::triangles(triangles)).normals(normals);
            let outcome = simplify(&mesh, &options.topology(Topology::Preserve)).expect("runs");
            if outcome.history.is_empty() {
                continue;
            }
            for t in 0..outcome.mesh.triangles().len() {
                for normal in stored(&outcome.mesh, t) {
                    let length = normal.length();
                    let is_unit = (length - 1.0).abs() < 1e-3;
                    prop_assert!(if odd == 0 { length.is_nan() } else { is_unit }, "{normal}");
                }
            }
        }
    }
}
