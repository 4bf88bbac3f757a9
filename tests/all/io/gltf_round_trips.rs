//! Documents made at random: what is left of them after a change is what a reader finds again.

use lodmark::{
    mesh::{canonical, weld},
    simplify::{Options, Target, Topology, simplify},
};
use proptest::prelude::*;
use serde_json::{Map, Value, json};

use super::gltf_write::{edited, read, same, write};
use crate::support::{GltfBuilder, Random};

/// Whole numbers of thirty-seconds, so that moves and mirrors round nothing.
fn number(random: &mut Random) -> f32 {
    (random.next() % 256) as f32 / 32.0 - 4.0
}

fn unit(random: &mut Random) -> [f32; 3] {
    let axis = (random.next() % 3) as usize;
    let mut n = [0.0; 3];
    n[axis] = if random.next().is_multiple_of(2) {
        1.0
    } else {
        -1.0
    };
    n
}

/// A bumpy sheet of `side` cells a side, indexed or not, with attributes by the bits of `kinds`.
fn primitive(builder: &mut GltfBuilder, side: u16, kinds: u32, random: &mut Random) -> Value {
    let across = side + 1;
    let grid: Vec<u16> = (0..side * side)
        .flat_map(|cell| {
            let v = cell / side * across + cell % side;
            [v, v + 1, v + across, v + 1, v + across + 1, v + across]
        })
        .collect();
    let is_indexed = kinds & 1 == 1;
    let corners: Vec<u16> = if is_indexed {
        (0..across * across).collect()
    } else {
        grid.clone()
    };
    // Every vertex draws its values once, so that corners without indices agree.
    let mut columns: Vec<(&str, &str, Vec<Vec<f32>>)> = Vec::new();
    let mut column = |name, shape, draw: &mut dyn FnMut(u16) -> Vec<f32>| {
        columns.push((name, shape, (0..across * across).map(draw).collect()));
    };
    let at = |v: u16| [f32::from(v % across), f32::from(v / across)];
    column("POSITION", "VEC3", &mut |v| {
        let [x, y] = at(v);
        vec![x, y, number(random) / 8.0]
    });
    if kinds & 2 != 0 {
        column("NORMAL", "VEC3", &mut |_| unit(random).to_vec());
    }
    if kinds & 4 != 0 {
        column("TEXCOORD_0", "VEC2", &mut |v| {
            at(v).map(|x| x / 32.0).to_vec()
        });
    }
    if kinds & 8 != 0 {
        column("TEXCOORD_1", "VEC2", &mut |_| {
            vec![number(random), number(random)]
        });
    }
    if kinds & 16 != 0 {
        column("COLOR_0", "VEC4", &mut |_| {
            vec![0.25, number(random).abs() / 8.0, 1.0, 0.5]
        });
    }
    if kinds & 32 != 0 {
        column("_ID", "SCALAR", &mut |v| vec![f32::from(v)]);
    }
    let mut attributes = Map::new();
    for (name, shape, rows) in columns {
        let values: Vec<f32> = corners
            .iter()
            .flat_map(|&v| rows[usize::from(v)].clone())
            .collect();
        let accessor = builder.floats(shape, &values);
        if name == "POSITION" {
            let range = |pick: fn(f32, f32) -> f32| {
                let axis = |k: usize| values.iter().skip(k).step_by(3).copied().reduce(pick);
                json!([axis(0), axis(1), axis(2)])
            };
            builder.json["accessors"][accessor]["min"] = range(f32::min);
            builder.json["accessors"][accessor]["max"] = range(f32::max);
        }
        attributes.insert(name.into(), json!(accessor));
    }
    let mut primitive = json!({ "attributes": attributes });
    if is_indexed {
        primitive["indices"] = json!(builder.indices(&grid));
    }
    primitive
}

/// A document of some meshes, each of some primitives, one of them shown twice, one mirrored.
fn document(meshes: u32, kinds: u32, random: &mut Random) -> Vec<u8> {
    let mut builder = GltfBuilder::new();
    for number in 0..meshes {
        let primitives: Vec<Value> = (0..1 + random.next() % 2)
            .map(|_| {
                let side = 1 + (random.next() % 4) as u16;
                primitive(&mut builder, side, kinds, random)
            })
            .collect();
        let mesh = builder.mesh(json!(primitives));
        let shift = f64::from(number) * 16.0;
        let scale = if number == 1 {
            [-1.0, 1.0, 1.0]
        } else {
            [2.0, 2.0, 2.0]
        };
        builder.node(json!({ "mesh": mesh, "translation": [shift, 0.0, 0.0], "scale": scale }));
        if number == 0 {
            builder.node(json!({ "mesh": mesh, "translation": [0.0, 64.0, 0.0] }));
        }
    }
    builder.glb()
}

proptest! {
    #![proptest_config(crate::support::cases(120))]

    #[test]
    fn what_is_left_of_a_document_is_what_a_reader_finds(
        meshes in 1..4_u32, kinds in 0..64_u32, seed: u64, keeps in 1..4_u64,
    ) {
        let mesh = read(&document(meshes, kinds, &mut Random::new(seed, 1)));
        let mut random = Random::new(seed, 2);
        let kept: Vec<bool> = mesh.triangles().iter().map(|_| random.next() % 4 < keeps).collect();
        // One of every part, as a part without triangles keeps a place of its own.
        let materials = &mesh.materials().of_triangle;
        let first = |t: usize| t == 0 || materials[t] != materials[t - 1];
        let left = edited(&mesh, |t| kept[t] || first(t), |p| if p.z > 0.0 { p * 2.0 } else { p });
        let (bytes, notes) = write(&left);
        prop_assert!(notes.is_empty(), "{notes:?}");
        same(&read(&bytes), &left);
        let (again, _) = write(&read(&bytes));
        same(&read(&again), &left);
    }

    #[test]
    fn a_simplified_document_is_what_a_reader_finds(
        meshes in 1..4_u32, kinds in 0..64_u32, seed: u64, share in 0.1..0.9_f64,
    ) {
        let mesh = read(&document(meshes, kinds, &mut Random::new(seed, 1)));
        let mesh = canonical(&weld(mesh).mesh).mesh;
        let options = Options::memoryless(Target::Ratio(share)).topology(Topology::Auto);
        let outcome = simplify(&mesh, &options).expect("valid");
        let (bytes, _) = write(&outcome.mesh);
        let found = read(&bytes);
        prop_assert_eq!(found.triangles().len(), outcome.mesh.triangles().len());
        let nearest = |a: &lodmark::Mesh, b: &lodmark::Mesh| {
            // Places under a node's transform are rounded once more.
            a.positions().iter().all(|p| b.positions().iter().any(|q| (*p - *q).length() < 1e-5))
        };
        prop_assert!(nearest(&found, &outcome.mesh) && nearest(&outcome.mesh, &found));
    }
}
