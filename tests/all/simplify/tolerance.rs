//! The method `tolerance`: no run breaks its bound, whatever the mesh; histories, stops and errors.
//!
//! Distances are sampled by brute force with the code of `envelope`, which shares none with the certificate.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property, and `LODMARK_SEED` what they are drawn from.

use glam::DVec3;
use lodmark::{
    bound::tolerance::Source,
    collapse::{Changes, EdgeStar, History, LiveMesh, Method, Patch, Replay, Review, Rules, Site},
    mesh::{Mesh, canonical, content_sha256, generate},
    num::{Frame, Precision},
    simplify::{
        Normals, Options, Outcome, Stop, Target, simplify, simplify_with,
        tolerance::{Distance, ToleranceMethod, ToleranceOptions},
    },
};
use proptest::prelude::*;

use crate::support::{
    Impatient, distance_to_all, faces, lattice, mesh_of, meshes, same_on_all_threads,
};

fn within(mesh: &Mesh, own: ToleranceOptions) -> Outcome {
    let options = Options::tolerance(own, Target::ErrorOnly).normals(Normals::Carry);
    simplify(mesh, &options).expect("valid")
}

fn share(error: f64) -> ToleranceOptions {
    ToleranceOptions::new(Distance::OfDiagonal(error))
}

fn diagonal(mesh: &Mesh) -> f64 {
    let points = || faces(mesh).into_iter().flatten();
    let low = points().reduce(DVec3::min).expect("not empty");
    let high = points().reduce(DVec3::max).expect("not empty");
    (high - low).length()
}

/// The largest sampled distance from the points of a surface to another one.
fn farthest(from: &Mesh, to: &Mesh, steps: u32) -> f64 {
    let all = faces(to);
    let points = faces(from).into_iter().flat_map(|t| lattice(t, steps));
    let distances = points.map(|p| distance_to_all(p, &all));
    distances.fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(crate::support::bounded(64))]

    #[test]
    fn no_point_of_either_surface_is_farther_than_the_bound(
        kind in 0_usize..8, seed: u64, exponent in 1.0_f64..9.0, variant in 0_usize..5,
    ) {
        let mesh = canonical(&meshes::any(kind, seed)).mesh;
        let error = 0.5 * libm::exp(-exponent * 0.7);
        let mut own = share(error);
        match variant {
            0 => own.one_sided = true,
            1 => own.volume = Some(Source::Edges),
            2 => own.volume = Some(Source::Vertices),
            3 => own.growing = true,
            _ => {}
        }
        let outcome = within(&mesh, own);
        let bound = error * diagonal(&mesh) * (1.0 + 1e-12);
        let guarantee = outcome.guarantee().expect("a bound");
        prop_assert!((guarantee.distance - bound).abs() <= 1e-9 * bound);
        let there = farthest(&outcome.mesh, &mesh, 6);
        prop_assert!(there <= bound, "{there} > {bound}");
        if !own.one_sided {
            let back = farthest(&mesh, &outcome.mesh, 6);
            prop_assert!(back <= bound, "{back} > {bound}");
        }
    }

    /// Whatever was proposed before: the last word is about the mesh as it is now.
    #[test]
    fn no_collapse_is_confirmed_that_leaves_a_part_of_the_original_alone(
        kind in prop::sample::select(vec![0_usize, 1, 3]), seed: u64, share in 0.01_f64..0.15,
    ) {
        let mesh = canonical(&meshes::any(kind, seed)).mesh;
        let mut live = LiveMesh::new(&mesh, Frame::default());
        let mut method = ToleranceMethod::new(&live, self::share(share)).expect("a bound");
        let bound = share * diagonal(&mesh);
        let original = faces(&mesh);
        let mut random = crate::support::Random(seed);
        let (mut star, mut patch, mut changes) = (EdgeStar::default(), Patch::default(), Changes::default());
        for _ in 0..15 {
            let edge = random.below(live.edge_ids() as usize) as u32;
            if live.edge(edge).is_none() || !star.gather(&live, edge) {
                continue;
            }
            let Ok(site) = Site::new(&live, &star, Rules::default()) else { continue };
            let [u, w] = star.points;
            let mut noise = || (random.unit() - 0.5) * bound;
            let place = u.lerp(w, 0.5 + noise() / bound) + DVec3::new(noise(), noise(), noise());
            let Ok(position) = site.admit(site.fixed().unwrap_or(place)) else { continue };
            site.patch(position, &mut patch);
            let all = 0..live.triangle_ids();
            let stays = all.filter(|t| patch.removed.iter().all(|f| f.id != *t));
            let mut after: Vec<[DVec3; 3]> = stays.filter_map(|t| live.points(t)).collect();
            after.extend(patch.added.iter().map(|f| patch.after(&live, f)));
            let points = original.iter().flat_map(|&triangle| lattice(triangle, 4));
            let most = points.map(|p| distance_to_all(p, &after)).fold(0.0, f64::max);
            let confirmed = method.review(&live, &patch) == Review::Commit;
            prop_assert!(!confirmed || most <= bound, "{most} of {bound}");
            if confirmed {
                live.apply(&patch, &mut changes);
                method.committed(&live, &patch);
            }
        }
    }

    #[test]
    fn a_replay_of_a_bounded_run_ends_where_the_run_did(kind in 0_usize..8, seed: u64) {
        let mesh = canonical(&meshes::any(kind, seed)).mesh;
        let mut own = share(0.05);
        own.growing = seed % 2 == 0;
        let outcome = within(&mesh, own);
        let bytes = outcome.history.to_bytes();
        let history = History::from_bytes(&bytes, "run.lmh").expect("just written");
        let mut walk = Replay::new(&mesh, &history).expect("the same mesh");
        walk.seek(1).expect("fits");
        prop_assert_eq!(walk.live().to_mesh().expect("a mesh"), outcome.mesh.clone());
        // A run that stops at more triangles is a start of the longer one.
        let triangles = (mesh.triangles().len() + outcome.mesh.triangles().len()) / 2;
        let options = Options::tolerance(own, Target::Triangles(triangles.max(1) as u64));
        let shorter = simplify(&mesh, &options.normals(Normals::Carry)).expect("valid");
        walk.seek(triangles.max(1)).expect("fits");
        prop_assert_eq!(walk.live().to_mesh().expect("a mesh"), shorter.mesh);
    }
}

#[test]
fn no_number_of_threads_changes_a_bounded_result() {
    let mesh = canonical(&meshes::torus(40, 30, 3)).mesh;
    let mut with_volume = share(0.03);
    with_volume.volume = Some(Source::Edges);
    for own in [share(0.02), with_volume] {
        same_on_all_threads(|| {
            let outcome = within(&mesh, own);
            (content_sha256(&outcome.mesh), outcome.phases)
        });
    }
}

/// A flat square of `n * n` squares in steps that floats hold exactly.
fn plate(n: usize) -> Mesh {
    let at = |x: usize, y: usize| (y * (n + 1) + x) as u32;
    let positions = (0..(n + 1) * (n + 1))
        .map(|i| DVec3::new((i % (n + 1)) as f64, (i / (n + 1)) as f64, 0.0) / n as f64)
        .collect();
    let mut triangles = Vec::new();
    for y in 0..n {
        for x in 0..n {
            triangles.push([at(x, y), at(x + 1, y), at(x + 1, y + 1)]);
            triangles.push([at(x, y), at(x + 1, y + 1), at(x, y + 1)]);
        }
    }
    canonical(&Mesh::from_triangles(positions, triangles).expect("valid")).mesh
}

#[test]
fn an_open_plate_becomes_two_triangles_and_keeps_its_outline() {
    let mesh = plate(8);
    let outcome = within(&mesh, share(1e-6));
    assert_eq!(outcome.mesh.triangles().len(), 2);
    assert!(farthest(&mesh, &outcome.mesh, 8) <= 2e-3);
}

#[test]
fn a_larger_bound_leaves_fewer_triangles_and_a_huge_one_only_what_topology_needs() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    let count = |error| within(&mesh, share(error)).mesh.triangles().len();
    let counts = [1e-4, 0.005, 0.05, 10.0, 1e300].map(count);
    assert!(counts.is_sorted_by(|a, b| a >= b), "{counts:?}");
    assert!(counts[0] > 1000 && counts[1] < 400, "{counts:?}");
    assert_eq!(counts[3..], [4, 4]);
}

#[test]
fn a_bound_that_is_none_is_refused_with_what_to_try() {
    let mesh = generate::icosphere(1);
    for wrong in [0.0, -0.1, f64::NAN, f64::INFINITY, 1e-16] {
        for error in [Distance::OfDiagonal(wrong), Distance::Length(wrong)] {
            let options = Options::tolerance(ToleranceOptions::new(error), Target::ErrorOnly);
            let refused = simplify(&mesh, &options).expect_err("no distance");
            assert_eq!(refused.exit_code(), 2, "{refused}");
            assert!(refused.to_string().contains("expected"), "{refused}");
        }
    }
    let options = Options::tolerance(share(0.1), Target::Triangles(0));
    assert_eq!(simplify(&mesh, &options).expect_err("none").exit_code(), 2);
}

#[test]
fn a_length_is_the_fraction_times_the_diagonal() {
    let mesh = canonical(&meshes::torus(12, 9, 4)).mesh;
    let by_share = within(&mesh, share(0.02));
    let length = Distance::Length(0.02 * diagonal(&mesh));
    let by_length = within(&mesh, ToleranceOptions::new(length));
    assert_eq!(by_share.mesh, by_length.mesh);
    let g = by_length.guarantee().expect("a bound");
    assert!((g.of_diagonal.expect("a size") - 0.02).abs() < 1e-12 && g.two_sided);
}

#[test]
fn a_number_of_triangles_stops_before_the_bound_does() {
    let mesh = canonical(&meshes::torus(20, 15, 4)).mesh;
    let options = Options::tolerance(share(0.2), Target::Triangles(300));
    let outcome = simplify(&mesh, &options).expect("valid");
    assert_eq!(outcome.mesh.triangles().len(), 300);
    assert_eq!(outcome.stop, Stop::TargetReached);
    let strict = Options::tolerance(share(1e-4), Target::Triangles(300));
    let outcome = simplify(&mesh, &strict).expect("valid");
    let Stop::NoLegalCollapse { refusals } = outcome.stop else {
        panic!("300 triangles within a hundredth of a percent");
    };
    let own = |name: &str| ["strays", "uncovers"].contains(&name);
    let refused = refusals.iter().any(|(r, _)| own(r.name()));
    assert!(refused, "{refusals:?}");
    let copy = Options::tolerance(share(0.2), Target::Triangles(9999));
    let copy = simplify(&mesh, &copy).expect("valid");
    assert_eq!(copy.stop, Stop::TargetAboveInput);
}

#[test]
fn one_side_lets_a_spike_go_and_both_sides_keep_it() {
    // A plate with a thin spike in the middle: the plate alone is near to the whole, but not the other way round.
    let mut parts = plate(8).into_parts();
    let middle = parts
        .positions
        .iter_mut()
        .find(|p| (p.x - 0.5).abs() + (p.y - 0.5).abs() < 1e-12);
    middle.expect("a vertex").z = 0.5;
    let mesh = canonical(&Mesh::new(parts).expect("valid")).mesh;
    let mut one_sided = share(0.1);
    one_sided.one_sided = true;
    let one = within(&mesh, one_sided);
    let both = within(&mesh, share(0.1));
    let top = |m: &Mesh| m.positions().iter().map(|p| p.z).fold(0.0, f64::max);
    assert!(top(&both.mesh) > 0.3, "{}", top(&both.mesh));
    assert!(farthest(&mesh, &both.mesh, 8) <= 0.1 * diagonal(&mesh));
    assert!(one.mesh.triangles().len() <= both.mesh.triangles().len());
}

#[test]
fn needles_folds_and_sheets_that_meet_are_kept_within_the_bound() {
    let needle = DVec3::new(0.5, 1e-9, 0.0);
    let mut folded = plate(4).into_parts();
    // The right half lies on the left one.
    for p in &mut folded.positions {
        if p.x > 0.5 {
            p.x = 1.0 - p.x;
            p.z = 1e-3;
        }
    }
    let (o, x, y, z) = (DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z);
    // Two needles between usual triangles.
    let needles = [[0, 4, 2], [4, 1, 2], [0, 1, 4], [0, 3, 1]];
    let needles = mesh_of([o, x, y, -y, needle], needles);
    // Three sheets at one edge.
    let sheets = [2, 3, 4].map(|v| [[0, 5, v], [5, 1, v]]).concat();
    let sheets = mesh_of([o, x, y, z, -y, x * 0.5], sheets);
    let mut growing = share(0.02);
    growing.volume = Some(Source::Edges);
    growing.growing = true;
    for mesh in [needles, Mesh::new(folded).expect("valid"), sheets] {
        let mesh = canonical(&mesh).mesh;
        for own in [share(0.02), growing] {
            let outcome = within(&mesh, own);
            let bound = 0.02 * diagonal(&mesh);
            assert!(farthest(&outcome.mesh, &mesh, 10) <= bound);
            assert!(farthest(&mesh, &outcome.mesh, 10) <= bound);
        }
    }
}

#[test]
fn a_mesh_far_from_the_origin_or_of_another_size_is_bounded_as_well() {
    let torus = meshes::torus(14, 9, 4);
    for (size, shift) in [(1e-25, 0.0), (1e20, 0.0), (1.0, 3e5)] {
        let mut parts = torus.clone().into_parts();
        parts.precision = Precision::F64;
        for p in &mut parts.positions {
            *p = *p * size + DVec3::splat(shift);
        }
        let mesh = canonical(&Mesh::new(parts).expect("valid")).mesh;
        let outcome = within(&mesh, share(0.03));
        let bound = 0.03 * diagonal(&mesh);
        assert!(outcome.mesh.triangles().len() < mesh.triangles().len());
        for (from, to) in [(&outcome.mesh, &mesh), (&mesh, &outcome.mesh)] {
            let most = farthest(from, to, 5);
            assert!(most <= bound, "size {size}, shift {shift}");
        }
    }
}

#[test]
fn a_bounded_run_can_be_interrupted() {
    let options = Options::tolerance(share(0.01), Target::ErrorOnly);
    let stopped = simplify_with(&meshes::torus(20, 15, 1), &options, &Impatient);
    assert_eq!(stopped.expect_err("interrupted").exit_code(), 130);
}
