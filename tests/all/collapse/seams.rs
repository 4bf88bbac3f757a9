//! Texture seams and borders of materials under collapses.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use lodmark::{
    collapse::{Engine, Rules, Schedule, Topology},
    mesh::{Attributes, ChannelKind, Mesh, MeshParts},
    simplify::{Options, Stop, Target, simplify},
};
use proptest::prelude::*;

use crate::{
    collapse::engine::{Dice, groups},
    support::{collapse, live, meshes},
};

/// Faces linked through edges at whose ends both have the same texture coordinates are one chart.
fn charts(mesh: &Mesh) -> usize {
    groups(mesh.triangles().len(), |i, j| {
        let mut shared = mesh.triangles()[i].to_vec();
        shared.retain(|v| mesh.triangles()[j].contains(v));
        shared.len() == 2 && shared.iter().all(|&v| uv(mesh, i, v) == uv(mesh, j, v))
    })
}

/// Texture coordinates of a triangle at one of its vertices; empty where there are none.
fn uv(mesh: &Mesh, t: usize, v: u32) -> Vec<u64> {
    let attributes = mesh.attributes();
    let Some(channel) = attributes.channel(ChannelKind::TexCoord(0)) else {
        return Vec::new();
    };
    let k = mesh.triangles()[t].iter().position(|&c| c == v);
    let values = attributes.value(channel, attributes.corners()[t][k.expect("a corner")]);
    values.iter().map(|x| x.to_bits()).collect()
}

/// Edges with two faces whose texture coordinates or materials differ.
fn seam_degrees(mesh: &Mesh) -> BTreeMap<u32, usize> {
    let mut at: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (t, &[a, b, c]) in mesh.triangles().iter().enumerate() {
        for [x, y] in [[a, b], [b, c], [c, a]] {
            at.entry([x.min(y), x.max(y)]).or_default().push(t);
        }
    }
    let mut degrees = BTreeMap::new();
    for (edge, faces) in at {
        let [f, g] = faces[..] else { continue };
        let differs = edge.iter().any(|&v| uv(mesh, f, v) != uv(mesh, g, v))
            || mesh.materials().of(f) != mesh.materials().of(g);
        if differs {
            for v in edge {
                *degrees.entry(v).or_insert(0) += 1;
            }
        }
    }
    degrees
}

fn corners_of_seams(mesh: &Mesh) -> Vec<DVec3> {
    let degrees = seam_degrees(mesh);
    let corners = degrees.iter().filter(|&(_, &d)| d != 2);
    corners
        .map(|(&v, _)| mesh.positions()[v as usize])
        .collect()
}

proptest! {
    #![proptest_config(crate::support::cases(24))]

    #[test]
    fn seams_stay_closed_charts_stay_apart_and_coordinates_stay_in_range(
        flat: bool, seed: u64, target in 30_usize..150,
    ) {
        let mesh = meshes::textured_torus(12, 8, seed, flat);
        let live = live(&mesh);
        let mut engine = Engine::new(live, Rules::default(), Schedule::Lazy);
        collapse(&mut engine, &mut Dice(seed), target);
        let after = engine.live().to_mesh().expect("valid");
        prop_assert!(after.triangles().len() < 160, "nearly nothing was collapsed");
        prop_assert_eq!(charts(&after), charts(&mesh));
        prop_assert_eq!(corners_of_seams(&after), corners_of_seams(&mesh));
        prop_assert!(seam_degrees(&after).values().all(|&d| d >= 2));
        for w in 0..after.attributes().wedge_count() as u32 {
            let row = after.attributes().row(w);
            prop_assert!((0.0..=1.0).contains(&row[0]) && (0.0..=1.0).contains(&row[1]));
            if flat {
                let length = row[2] * row[2] + row[3] * row[3] + row[4] * row[4];
                prop_assert!((length - 1.0).abs() < 1e-5);
            }
        }
    }
}

#[test]
fn charts_and_materials_of_a_cube_keep_their_corners() {
    for (with_charts, with_materials) in [(true, false), (false, true), (true, true)] {
        let mesh = meshes::cube(6, with_charts, with_materials);
        let options = Options::memoryless(Target::Triangles(24));
        let outcome = simplify(&mesh, &options).expect("valid");
        assert_eq!(outcome.stop, Stop::TargetReached);
        let key = |p: &DVec3| p.to_array().map(f64::to_bits);
        let sorted = |mut corners: Vec<DVec3>| {
            corners.sort_unstable_by_key(key);
            corners
        };
        let corners = sorted(corners_of_seams(&outcome.mesh));
        assert_eq!(corners.len(), 8);
        assert_eq!(corners, sorted(corners_of_seams(&mesh)));
        if with_charts {
            assert_eq!(charts(&outcome.mesh), 6);
        }
        if with_materials {
            let used = outcome.mesh.materials().of_triangle.iter();
            assert_eq!(used.collect::<BTreeSet<_>>().len(), 6);
        }
    }
}

#[test]
fn normals_that_differ_everywhere_do_not_stop_simplification() {
    let parts = meshes::textured_torus(12, 8, 4, true).into_parts();
    let channel = parts.attributes.channel(ChannelKind::Normal);
    let channel = channel.expect("normals");
    let values = (0..parts.attributes.wedge_count() as u32)
        .flat_map(|w| parts.attributes.value(channel, w).to_vec())
        .collect();
    let corners = parts.attributes.corners().to_vec();
    let attributes = Attributes::new(&[ChannelKind::Normal], values, corners);
    let mesh = Mesh::new(MeshParts {
        attributes: attributes.expect("valid"),
        ..parts
    })
    .expect("valid");
    let outcome = simplify(&mesh, &Options::memoryless(Target::Triangles(60)));
    assert_eq!(outcome.expect("valid").stop, Stop::TargetReached);
}

#[test]
fn a_value_that_one_end_lacks_is_absent_at_the_new_vertex() {
    let mut parts = meshes::grid(4, 1).into_parts();
    let absent = |t: usize| if t.is_multiple_of(5) { f64::NAN } else { 0.25 };
    let values = (0..parts.triangles.len()).flat_map(|t| [absent(t), absent(t)]);
    let corners = (0..parts.triangles.len() as u32).map(|t| [t; 3]).collect();
    let kinds = [ChannelKind::TexCoord(0)];
    parts.attributes = Attributes::new(&kinds, values.collect(), corners).expect("valid");
    let mesh = Mesh::new(parts).expect("valid");
    let live = live(&mesh);
    let rules = Rules {
        topology: Topology::Free,
        ..Rules::default()
    };
    let mut engine = Engine::new(live, rules, Schedule::Lazy);
    collapse(&mut engine, &mut Dice(3), 4);
    let left = engine.live().to_mesh().expect("valid");
    for w in 0..left.attributes().wedge_count() as u32 {
        let row = left.attributes().row(w);
        assert_eq!(row[0].is_nan(), row[1].is_nan());
        assert!(row[0].is_nan() || row[0].to_bits() == 0.25_f64.to_bits());
    }
}
