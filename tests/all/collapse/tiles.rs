//! Thinning in tiles: the same as one collapse after the other, for every number of threads and every target.

use lodmark::{
    Silent,
    collapse::{
        Counters, Engine, History, LiveMesh, Observer, Recorder, Replay, Rules, Schedule,
        TileOptions, Tileable, Tiling, collapse_in_tiles,
    },
    mesh::{Mesh, canonical},
    simplify::{memoryless::Memoryless, memoryless::MemorylessOptions},
    simplify::{quadric::QuadricMethod, quadric::QuadricOptions},
    view::frame_of,
};
use proptest::prelude::*;

use crate::support::{live, meshes, same_on_all_threads};

/// Small enough that a mesh of a few hundred triangles takes several rounds.
const SMALL: Tiling = Tiling {
    vertices: 60,
    triangles: 60,
};

fn in_tiles(
    live: &mut LiveMesh,
    method: &mut dyn Tileable,
    triangles: usize,
    counters: &mut Counters,
    observer: &mut dyn Observer,
) {
    let options = TileOptions {
        tiling: SMALL,
        rules: Rules::default(),
        schedule: Schedule::Eager,
        triangles,
    };
    collapse_in_tiles(live, method, options, counters, observer, &Silent)
        .expect("nobody interrupts");
}

/// What a run leaves, and its history; how many collapses it took in tiles.
fn tiled<M: Tileable>(
    mesh: &Mesh,
    method: impl Fn(&LiveMesh) -> M,
    triangles: usize,
) -> (Mesh, History, u64) {
    let frame = frame_of(mesh);
    let mut live = LiveMesh::new(mesh, frame);
    let mut method = method(&live);
    let mut recorder = Recorder::new(mesh, frame);
    let mut counters = Counters::default();
    in_tiles(
        &mut live,
        &mut method,
        triangles,
        &mut counters,
        &mut recorder,
    );
    let in_tiles = counters.collapses;
    let mut engine = Engine::new(live, Rules::default(), Schedule::Eager).with_counters(counters);
    let stop = engine.run(&mut method, triangles, &mut recorder, &Silent);
    stop.expect("nobody interrupts");
    let left = engine.live().to_mesh().expect("valid");
    (left, recorder.finish(String::new()), in_tiles)
}

fn memoryless(mesh: &Mesh, triangles: usize) -> (Mesh, History, u64) {
    let new = |live: &LiveMesh| Memoryless::new(live, MemorylessOptions::default());
    tiled(mesh, new, triangles)
}

fn quadric(mesh: &Mesh, triangles: usize) -> (Mesh, History, u64) {
    let new = |live: &LiveMesh| QuadricMethod::new(live, &QuadricOptions::default());
    tiled(mesh, new, triangles)
}

/// Closed, and open with a boundary.
fn shape(open: bool, seed: u64) -> Mesh {
    let mesh = if open {
        meshes::grid(15, seed)
    } else {
        meshes::torus(22, 12, seed)
    };
    canonical(&mesh).mesh
}

proptest! {
    #![proptest_config(crate::support::cases(12))]

    #[test]
    fn every_level_of_a_tiled_run_is_the_replay_of_a_longer_one(
        open: bool, by_planes: bool, seed: u64, levels in prop::collection::vec(20_usize..500, 1..6),
    ) {
        let mesh = shape(open, seed);
        let run = if by_planes { quadric } else { memoryless };
        let (_, history, in_tiles) = run(&mesh, 20);
        prop_assert!(in_tiles > 0);
        let mut replay = Replay::new(&mesh, &history).expect("the same mesh");
        for level in levels.into_iter().filter(|&level| level < mesh.triangles().len()) {
            replay.seek(level).expect("fits");
            prop_assert_eq!(replay.live().to_mesh().expect("a mesh"), run(&mesh, level).0, "at {}", level);
        }
    }
}

#[test]
fn thread_counts_give_equal_tiles() {
    let mesh = shape(false, 4);
    for run in [memoryless, quadric] {
        same_on_all_threads(|| run(&mesh, 30));
    }
}

#[test]
fn a_mesh_with_attributes_locks_or_few_triangles_is_left_alone() {
    let textured = canonical(&meshes::textured_torus(22, 12, 1, false)).mesh;
    assert_eq!(memoryless(&textured, 20).2, 0);
    let small = canonical(&meshes::grid(5, 1)).mesh;
    assert_eq!(memoryless(&small, 20).2, 0);
    let mesh = shape(true, 2);
    let mut live = live(&mesh);
    live.set_locked(3, true);
    let mut method = Memoryless::new(&live, MemorylessOptions::default());
    let place = live.position(3);
    let mut counters = Counters::default();
    in_tiles(&mut live, &mut method, 20, &mut counters, &mut ());
    assert_eq!(counters, Counters::default());
    assert_eq!(live.position(3), place);
}
