//! Locks hold whatever else gives way.

use std::collections::BTreeSet;

use glam::DVec3;
use lodmark::{
    mesh::{Mesh, generate},
    simplify::{Options, Outcome, Target, image::Preset, simplify},
};

use crate::support::meshes;

fn bits(p: &DVec3) -> [u64; 3] {
    p.to_array().map(f64::to_bits)
}

/// The places of vertices that `is_locked` picks, and whether all of them are left.
fn all_left(before: &Mesh, after: &Mesh, is_locked: impl Fn(&DVec3) -> bool) -> (usize, bool) {
    let left: BTreeSet<_> = after.positions().iter().map(bits).collect();
    let locked: Vec<_> = before.positions().iter().filter(|p| is_locked(p)).collect();
    let all = locked.iter().all(|p| left.contains(&bits(p)));
    (locked.len(), all)
}

fn run(mesh: &Mesh, options: Options) -> Outcome {
    simplify(mesh, &options).expect("valid")
}

#[test]
fn a_locked_border_keeps_every_vertex_below_any_target() {
    let mesh = generate::grid(12, 12, generate::Height::Waves);
    let is_rim = |p: &DVec3| p.x.abs() == 1.0 || p.y.abs() == 1.0;
    for options in [
        Options::memoryless(Target::Triangles(2)),
        Options::quadric(Target::Triangles(2)),
        Options::image(Target::Triangles(2)).preset(Preset::Fast),
    ] {
        let outcome = run(&mesh, options.clone().lock_border());
        assert_eq!(all_left(&mesh, &outcome.mesh, is_rim), (48, true));
        assert_eq!(outcome.locked_vertices, 48);
        let free = run(&mesh, options);
        assert!(!all_left(&mesh, &free.mesh, is_rim).1);
        assert_eq!(free.locked_vertices, 0);
    }
}

#[test]
fn locked_seams_and_borders_of_materials_keep_every_vertex_of_theirs_and_nothing_else() {
    let on_edge = |p: &DVec3| {
        let at = p.abs();
        let most = at.max_element();
        at.to_array().iter().filter(|&&x| x > most - 1e-9).count() > 1
    };
    let least = |with_charts| {
        let mesh = meshes::cube(6, with_charts, !with_charts);
        let options = Options::memoryless(Target::Triangles(12));
        let options = if with_charts {
            [options.clone().lock_seams(), options.lock_materials()]
        } else {
            [options.clone().lock_materials(), options.lock_seams()]
        };
        let [held, other] = options.map(|options| run(&mesh, options));
        let (count, all) = all_left(&mesh, &held.mesh, on_edge);
        assert!(all && held.locked_vertices == count, "{count}");
        assert_eq!(other.locked_vertices, 0);
        assert_eq!(other.mesh.triangles().len(), 12);
    };
    least(true);
    least(false);
}
