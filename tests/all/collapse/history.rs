//! Recorded runs: any level, in both directions, from bytes nobody can trust.

use lodmark::{
    Error,
    collapse::{History, Replay, Topology},
    mesh::Mesh,
    simplify::{Normals, Options, Outcome, Target, simplify},
};
use proptest::prelude::*;
use sha2::{Digest, Sha256};

use crate::support::meshes;

fn run(mesh: &Mesh, triangles: u64) -> Outcome {
    let mut options = Options::memoryless(Target::Triangles(triangles));
    // What is repaired after the last collapse belongs to the level where the run ended.
    options.unfold = false;
    options.normals = Normals::Carry;
    // And what gives way depends on the target from the start.
    options.rules.topology = Topology::Preserve;
    simplify(mesh, &options).expect("valid")
}

fn read(bytes: &[u8]) -> Result<History, Error> {
    History::from_bytes(bytes, "run.lmh")
}

/// Lets a replay go to a level, where it is what a fresh one finds.
pub(crate) fn seek(walk: &mut Replay<'_>, mesh: &Mesh, history: &History, level: usize) -> Mesh {
    let mut fresh = Replay::new(mesh, history).expect("the same mesh");
    walk.seek(level).expect("fits");
    fresh.seek(level).expect("fits");
    assert_eq!(walk.applied(), fresh.applied());
    let walked = walk.live().to_mesh().expect("a mesh");
    assert_eq!(walked, fresh.live().to_mesh().expect("a mesh"));
    walked
}

/// Reads damaged bytes, which are refused as a bad file, or replayed as far as they fit; true where they were read.
pub(crate) fn read_damaged(mesh: &Mesh, bytes: &[u8]) -> bool {
    match read(bytes) {
        Err(e) => {
            assert!(matches!(e.exit_code(), 3 | 4), "{e}");
            false
        }
        Ok(history) => {
            if let Ok(mut replay) = Replay::new(mesh, &history)
                && let Err(e) = replay.seek(0)
            {
                assert_eq!(e.exit_code(), 3, "{e}");
            }
            true
        }
    }
}

proptest! {
    #![proptest_config(crate::support::cases(24))]

    #[test]
    fn every_level_of_a_replay_is_the_direct_run_to_it(
        kind in 0_usize..8, seed: u64, levels in prop::collection::vec(1_u64..140, 1..8),
    ) {
        let mesh = meshes::any(kind, seed);
        let history = read(&run(&mesh, 1).history.to_bytes()).expect("just written");
        let mut walk = Replay::new(&mesh, &history).expect("the same mesh");
        for level in levels {
            let walked = seek(&mut walk, &mesh, &history, level as usize);
            if mesh.triangles().len() as u64 > level {
                prop_assert_eq!(walked, run(&mesh, level).mesh);
            }
        }
        while walk.back() {}
        prop_assert_eq!(walk.applied(), 0);
        prop_assert_eq!(walk.live().triangle_count(), fresh_count(&mesh));
    }

    #[test]
    fn damaged_histories_are_refused_without_a_panic(
        kind in 0_usize..8, at: prop::sample::Index, bit in 0_u8..8, cut: bool, repair: bool,
    ) {
        let mesh = meshes::any(kind, 5);
        let bytes = run(&mesh, 8).history.to_bytes();
        let mut damaged = bytes.clone();
        let at = at.index(bytes.len() - 32);
        if cut {
            damaged.truncate(at);
        } else {
            damaged[at] ^= 1 << bit;
        }
        if repair && damaged.len() > 32 {
            // Someone who means harm repairs the checksum.
            let body = damaged.len() - if cut { 0 } else { 32 };
            damaged.truncate(body);
            let sum = Sha256::digest(&damaged);
            damaged.extend(sum);
        }
        let was_read = read_damaged(&mesh, &damaged);
        prop_assert!(repair || !was_read, "the checksum missed the damage");
    }
}

fn fresh_count(mesh: &Mesh) -> usize {
    let whole = |t: &&[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    mesh.triangles().iter().filter(whole).count()
}

#[test]
fn a_history_survives_its_file() {
    for kind in 0..8 {
        let outcome = run(&meshes::any(kind, 3), 4);
        let read = read(&outcome.history.to_bytes()).expect("just written");
        assert_eq!(read, outcome.history);
    }
}

#[test]
fn a_history_of_another_mesh_is_refused() {
    let outcome = run(&meshes::torus(8, 6, 1), 40);
    let other = meshes::torus(8, 6, 2);
    let refused = Replay::new(&other, &outcome.history).expect_err("another mesh");
    assert_eq!(refused.exit_code(), 3);
}

#[test]
fn a_newer_format_is_unsupported_rather_than_damaged() {
    let mut bytes = run(&meshes::torus(8, 6, 1), 40).history.to_bytes();
    bytes[8] = 2;
    assert_eq!(read(&bytes).expect_err("format 2").exit_code(), 4);
    assert_eq!(read(b"solid cube").expect_err("no history").exit_code(), 3);
}

#[test]
fn the_header_says_what_made_it() {
    let wanted = Options::memoryless(Target::Triangles(40));
    let outcome = simplify(&meshes::torus(8, 6, 1), &wanted).expect("valid");
    let header = outcome.history.header();
    assert_eq!(header.version, env!("CARGO_PKG_VERSION"));
    let options: Options = serde_json::from_str(&header.options).expect("JSON");
    // The mesh has none.
    assert_eq!(options, wanted.normals(Normals::Carry));
}
