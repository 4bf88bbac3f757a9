//! Folds and flipped faces that the geometric methods leave, and their repair.

use glam::DVec3;
use lodmark::{
    mesh::{Mesh, generate},
    simplify::{MethodOptions, Normals, Options, Outcome, Replay, Target, simplify},
};
use proptest::prelude::*;

use crate::support::{faults, meshes, on_threads};

fn methods(triangles: u64) -> [Options; 2] {
    let target = Target::Triangles(triangles);
    [Options::memoryless(target), Options::quadric(target)]
}

fn run(mesh: &Mesh, options: &Options, unfold: bool) -> Outcome {
    let mut options = options.clone();
    options.unfold = unfold;
    options.normals = Normals::Carry;
    simplify(mesh, &options).expect("runs")
}

/// Two sheets with thin tubes between them, one per cell of a grid: what noise in a scanned surface leaves.
fn handles(count: u32) -> Mesh {
    let (sides, n) = (8, 8 * count);
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (level, z) in [0.0, 0.12].into_iter().enumerate() {
        let start = positions.len() as u32;
        for y in 0..=n {
            for x in 0..=n {
                let at = [x, y].map(|c| f64::from(c) / 8.0);
                // Nothing is a plane, or costs of 0 decide by numbers alone.
                let lift = 0.01 * (at[0] * (at[0] - 2.0) + at[1] * at[1] - at[0] * at[1]);
                positions.push(DVec3::new(at[0], at[1], z + lift));
            }
        }
        let at = |x: u32, y: u32| start + y * (n + 1) + x;
        for y in 0..n {
            for x in 0..n {
                // The middle of every cell is left out: a hole of four corners and as many sides.
                if (x % 8, y % 8) == (4, 4) {
                    continue;
                }
                let quad = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
                for t in [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]] {
                    triangles.push(if level == 1 { t } else { [t[0], t[2], t[1]] });
                }
            }
        }
    }
    let sheet = (n + 1) * (n + 1);
    for cy in 0..count {
        for cx in 0..count {
            let (x, y) = (cx * 8 + 4, cy * 8 + 4);
            let rim = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
            let rim = rim.map(|(x, y)| y * (n + 1) + x);
            // A tube in rings that narrow towards the middle.
            let mut below = rim;
            for ring in 1..sides {
                let t = f64::from(ring) / f64::from(sides);
                let narrow = 0.1 + 0.9 * (2.0 * t - 1.0).abs();
                let center = rim.map(|v| positions[v as usize]).iter().sum::<DVec3>() / 4.0;
                let above = [0, 1, 2, 3].map(|k| positions.len() as u32 + k);
                for v in rim {
                    let p = positions[v as usize];
                    let flat = center + (p - center) * narrow;
                    positions.push(flat.with_z(p.z + 0.12 * t));
                }
                join(&mut triangles, below, above);
                below = above;
            }
            join(&mut triangles, below, rim.map(|v| v + sheet));
        }
    }
    Mesh::from_triangles(positions, triangles).expect("valid")
}

fn join(triangles: &mut Vec<[u32; 3]>, below: [u32; 4], above: [u32; 4]) {
    for k in 0..4 {
        let [a, b] = [below[k], below[(k + 1) % 4]];
        let [c, d] = [above[k], above[(k + 1) % 4]];
        // The inside of a tube is outside.
        triangles.extend([[a, d, b], [a, c, d]]);
    }
}

#[test]
fn a_handle_that_was_flattened_is_unfolded() {
    let mesh = handles(4);
    let mut before = [0; 2];
    for level in [1000, 700, 500, 400, 300] {
        for options in methods(level) {
            let plain = run(&mesh, &options, false).mesh;
            let repaired = run(&mesh, &options, true).mesh;
            assert_eq!(plain.triangles().len(), repaired.triangles().len());
            let found = faults(&mesh, &plain);
            before = [before[0] + found[0], before[1] + found[1]];
            assert_eq!(faults(&mesh, &repaired), [0, 0], "{level} {options:?}");
        }
    }
    assert!(before[0] > 9, "nothing was to be repaired: {before:?}");
}

#[test]
fn a_fold_of_the_original_is_kept() {
    // A sheet that lies on itself, but for the width of a hair.
    let sheet = generate::grid(16, 16, generate::Height::Waves);
    let fold = |p: &DVec3| {
        let hair = 1e-4 * (1.0 + p.x.abs());
        DVec3::new(p.x.abs(), p.y, p.z + if p.x < 0.0 { hair } else { 0.0 })
    };
    let positions = sheet.positions().iter().map(fold).collect();
    let mesh = Mesh::from_triangles(positions, sheet.triangles().to_vec()).expect("valid");
    assert_eq!(faults(&mesh, &mesh)[0], 0);
    for options in methods(100) {
        let repaired = run(&mesh, &options, true).mesh;
        assert!(faults(&sheet, &repaired)[0] > 0, "the crease is gone");
    }
}

#[test]
fn no_repair_is_asked_for_where_others_guard_against_folds() {
    let target = Target::Triangles(10);
    for options in methods(10) {
        assert!(options.unfold);
        assert!(!matches!(options.method, MethodOptions::Image(_)));
    }
    assert!(!Options::image(target).unfold);
}

proptest! {
    #![proptest_config(crate::support::cases(48))]

    #[test]
    fn every_repair_makes_no_faults_and_is_in_the_history(
        kind in 0_usize..8, seed: u64, share in 0.05..0.6,
    ) {
        let mesh = meshes::any(kind, seed);
        let triangles = (mesh.triangles().len() as f64 * share) as u64 + 1;
        for options in methods(triangles) {
            let plain = run(&mesh, &options, false);
            let outcome = run(&mesh, &options, true);
            let mut replay = Replay::new(&mesh, &outcome.history).expect("the same mesh");
            replay.seek(outcome.mesh.triangles().len()).expect("fits");
            prop_assert_eq!(replay.live().to_mesh().expect("a mesh"), outcome.mesh.clone());
            prop_assert_eq!(plain.mesh.triangles().len(), outcome.mesh.triangles().len());
            if faults(&mesh, &plain.mesh) == [0, 0] {
                prop_assert_eq!(faults(&mesh, &outcome.mesh), [0, 0]);
            }
            let other = on_threads(3, || run(&mesh, &options, true));
            prop_assert_eq!(other.mesh, outcome.mesh);
        }
    }
}
