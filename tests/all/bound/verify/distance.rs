//! Claims about distances.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property, and `LODMARK_SEED` what they are drawn from.

use glam::DVec3;
use lodmark::{
    Silent,
    bound::verify::{Claim, DistanceReport, distance},
    mesh::{Mesh, generate},
};
use proptest::prelude::*;

use crate::support::{
    Random, at, bounded, code, distance_to_all, expect, faces, folder, json, lodmark, mesh_of,
    moved, put, same_on_all_threads, stdout,
};

fn check(reference: &Mesh, low: &Mesh, claim: Claim) -> DistanceReport {
    distance(reference, low, claim, false, 2_000, &Silent).expect("both have triangles")
}

/// A rectangle with a diagonal of 5.
fn sheet(z: f64) -> Mesh {
    let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].map(|(x, y)| at(x, y, z));
    mesh_of(corners, [[0, 1, 2], [0, 2, 3]])
}

#[test]
fn parallel_sheets_are_as_far_apart_as_their_planes() {
    let (low, high) = (sheet(0.0), sheet(0.125));
    let held = check(&low, &high, Claim::Absolute(0.125));
    assert!(held.holds, "{held:?}");
    for d in &held.directions {
        assert!((d.farthest.distance - 0.125).abs() < 1e-15, "{d:?}");
    }
    assert!((held.diagonal - 5.0).abs() < 1e-12);
    let broken = check(&low, &high, Claim::Relative(0.125 / 5.0 / 1.01));
    assert!(!broken.holds && broken.directions.iter().all(|d| d.violations > 2_000));
}

#[test]
fn a_claim_that_holds_with_a_margin_is_proven() {
    let held = check(&sheet(0.0), &sheet(0.125), Claim::Absolute(0.126));
    assert!(held.holds && held.proven, "{held:?}");
    let sphere = generate::icosphere(3);
    assert!(check(&sphere, &sphere, Claim::Relative(1e-6)).proven);
}

#[test]
fn a_vertex_one_percent_too_far_out_is_found_and_one_percent_less_is_not() {
    let sphere = generate::icosphere(3);
    let claim = 0.03125;
    for vertex in [0, 100, 641] {
        let outward = sphere.positions()[vertex].normalize();
        let check = |share: f64| {
            let low = moved(&sphere, vertex, outward * (share * claim));
            check(&sphere, &low, Claim::Absolute(claim))
        };
        let broken = check(1.01);
        assert!(!broken.holds, "{broken:?}");
        let worst = &broken.directions[0].farthest;
        assert!((DVec3::from_array(worst.point).length() - 1.0 - 1.01 * claim).abs() < 1e-6);
        let held = check(0.99);
        assert!(held.holds && held.proven, "{held:?}");
    }
}

#[test]
fn a_peak_between_vertices_is_found_without_a_sample_on_it() {
    // The hole in the roof is farthest from its middle, where no vertex, edge midpoint or sample need be.
    let roof = sheet(0.0);
    let mut positions = roof.positions().to_vec();
    positions.extend([(1.0, 1.0), (1.5, 1.0), (1.5, 1.5), (1.0, 1.5)].map(|(x, y)| at(x, y, 0.0)));
    let side = |(i, j): (u32, u32)| [[i, j, j + 4], [i, j + 4, i + 4]];
    let sides = [(0, 1), (1, 2), (2, 3), (3, 0)].map(side);
    let frame = mesh_of(positions, sides.concat());
    let one_way = |claim, one_sided, samples| {
        let claim = Claim::Absolute(claim);
        distance(&roof, &frame, claim, one_sided, samples, &Silent).expect("valid")
    };
    let report = |claim| one_way(claim, false, 1);
    assert!(!report(0.25 / 1.01).holds);
    let held = report(0.25 * 1.01);
    assert!(held.holds && held.proven, "{held:?}");
    // Nothing is looked at closely under a claim that is far too large; what is proven is true all the same.
    let loose = report(100.0);
    assert!(loose.directions[1].upper_bound >= 0.25, "{loose:?}");
    // Every point of the frame lies on the roof.
    let one_sided = one_way(1e-2, true, 100);
    assert!(one_sided.holds && one_sided.proven && one_sided.directions.len() == 1);
}

#[test]
fn a_claim_stays_undecided_where_two_faces_are_equally_far_and_nearly_too_far() {
    // Two walls that end in points, and a sheet between these: along x = 0 both are as far, at the upper side farthest.
    let wall = |x: f64| {
        [
            at(x, 0.0, 0.0),
            at(3.0 * x, 2.0, -1.0),
            at(3.0 * x, -2.0, -1.0),
        ]
    };
    let walls = mesh_of([wall(-1.0), wall(1.0)].concat(), [[0, 1, 2], [3, 4, 5]]);
    for (left, right, upper) in [(-0.5, 0.37, 0.3), (-0.123, 0.456, 0.4), (-0.31, 0.2, 0.5)] {
        let corners = [
            at(left, upper, 0.0),
            at(0.05, -0.1, 0.0),
            at(right, upper, 0.0),
        ];
        let sheet = mesh_of(corners, [[0, 1, 2]]);
        let most = libm::sqrt(1.0 + upper * upper);
        let check = |share: f64| {
            let claim = Claim::Absolute(most * (1.0 + share));
            distance(&walls, &sheet, claim, true, 50, &Silent).expect("valid")
        };
        for share in [1e-3, 1e-5, 1e-7] {
            let found = check(share);
            assert!(found.proven, "{share}: {found:?}");
            let proven = found.directions[0].upper_bound;
            assert!(proven >= most * (1.0 - 1e-12), "{proven} below {most}");
            let found = check(-share);
            assert!(!found.proven, "{share}: {found:?}");
        }
    }
}

#[test]
fn samples_crowd_on_no_triangle() {
    // Every third triangle of a row is raised; they are of all sizes, and the last one stays.
    let mut random = Random::new(7, 3);
    let (mut flat, mut raised, mut faces) = (Vec::new(), Vec::new(), Vec::new());
    let (mut area, mut length, mut shares) = (0.0, 0.0, [0.0; 2]);
    for t in 0..31_u32 {
        let size = 0.2 + random.unit();
        let x = 3.0 * f64::from(t);
        let corners = [(x, 0.0), (x + size, 0.0), (x, size)].map(|(x, y)| at(x, y, 0.0));
        let up = f64::from(u8::from(t % 3 == 1));
        flat.extend(corners);
        raised.extend(corners.map(|p| p + DVec3::Z * up));
        faces.push([3 * t, 3 * t + 1, 3 * t + 2]);
        area += size * size;
        length += size;
        shares[0] += size * size * up;
        shares[1] += size * up;
    }
    let flat = mesh_of(flat, &faces[..]);
    let raised = mesh_of(raised, faces);
    let claim = Claim::Absolute(0.5);
    let found = distance(&flat, &raised, claim, true, 9_000, &Silent).expect("valid");
    // Eight ninths by area, one by length, and all corners: of ten raised triangles.
    let expected = 8_000.0 * shares[0] / area + 1_000.0 * shares[1] / length + 30.0;
    let violations = found.directions[0].violations as f64;
    let off = (violations - expected).abs();
    assert!(off < 0.005 * 9_000.0, "{violations} of {expected}");
}

#[test]
fn what_no_cut_decides_is_not_said_to_be_proven() {
    // Along all of x = 0 both walls are as far as the claim: no part across that line is near one of them as a whole.
    let wall = |x: f64| [at(x, -9.0, 0.0), at(x, 9.0, 0.0), at(3.0 * x, 0.0, -1.0)];
    let walls = mesh_of([wall(-1.0), wall(1.0)].concat(), [[0, 1, 2], [3, 4, 5]]);
    let corners = [at(-0.5, 0.0, 0.0), at(0.4, 0.1, 0.0), at(-0.1, 2.0, 0.0)];
    let sheet = mesh_of(corners, [[0, 1, 2]]);
    let claim = Claim::Absolute(1.0);
    let found = distance(&walls, &sheet, claim, true, 50, &Silent).expect("valid");
    assert!(found.holds && !found.proven, "{found:?}");
    assert_eq!(found.directions.len(), 1);
    let only = &found.directions[0];
    assert!(!only.is_proven && only.upper_bound > 1.0 && only.undecided_area > 0.0);
}

#[test]
fn needles_points_and_segments_are_surfaces_too() {
    let positions = [DVec3::ZERO, DVec3::X, at(2.0, 1e-12, 0.0), DVec3::Z * 3.0];
    let needle = mesh_of(positions, [[0, 1, 2]]);
    let point = mesh_of(positions, [[3, 3, 3]]);
    let report = check(&needle, &point, Claim::Absolute(4.0));
    assert!(report.holds && report.proven, "{report:?}");
    let [to_needle, to_point] = &report.directions[..] else {
        panic!("{report:?}");
    };
    assert!((to_needle.farthest.distance - 3.0).abs() < 1e-9);
    assert!((to_point.farthest.distance - libm::sqrt(13.0)).abs() < 1e-9);
    assert!(!check(&needle, &point, Claim::Absolute(3.5)).holds);
}

#[test]
fn claims_without_a_meaning_are_refused() {
    let sheet = sheet(0.0);
    for claim in [-1.0, f64::NAN, f64::INFINITY] {
        let refused = distance(&sheet, &sheet, Claim::Relative(claim), false, 1, &Silent);
        assert_eq!(refused.expect_err("no claim").exit_code(), 2);
    }
    let empty = Mesh::default();
    for (a, b) in [(&sheet, &empty), (&empty, &sheet)] {
        let refused = distance(a, b, Claim::Relative(0.1), false, 1, &Silent);
        assert_eq!(refused.expect_err("nothing to measure").exit_code(), 3);
    }
    let itself = check(&sheet, &sheet, Claim::Relative(0.0));
    assert!(itself.holds, "no distance at all");
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let (a, b) = (generate::icosphere(3), generate::icosphere(1));
    same_on_all_threads(|| {
        distance(&a, &b, Claim::Relative(0.01), false, 100_000, &Silent).expect("valid")
    });
}

fn soup(random: &mut Random, triangles: usize) -> Mesh {
    let mut coordinate = || (random.unit() * 8.0).floor() / 4.0 + random.unit() * 0.125;
    let mut point = || at(coordinate(), coordinate(), coordinate());
    let positions: Vec<DVec3> = (0..3 * triangles).map(|_| point()).collect();
    let corners = (0..triangles as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    mesh_of(positions, corners.collect::<Vec<_>>())
}

proptest! {
    #![proptest_config(bounded(60))]

    #[test]
    fn no_point_is_farther_than_proven_and_the_farthest_one_is_as_far_as_said(seed: u64) {
        let slow = |p: DVec3, mesh: &Mesh| distance_to_all(p, &faces(mesh));
        let mut random = Random::new(seed, 1);
        let counts = [1 + random.below(4), 1 + random.below(6)];
        let (a, b) = (soup(&mut random, counts[0]), soup(&mut random, counts[1]));
        let report = distance(&a, &b, Claim::Relative(random.unit()), false, 300, &Silent).expect("valid");
        for (d, (from, to)) in report.directions.iter().zip([(&b, &a), (&a, &b)]) {
            let said = d.farthest.distance;
            let there = slow(DVec3::from_array(d.farthest.point), to);
            prop_assert!((there - said).abs() < 1e-4 * report.diagonal, "{there} {d:?}");
            let corners = from.corners(d.farthest.triangle as usize);
            let single = Mesh::from_triangles(corners.to_vec(), vec![[0, 1, 2]]).expect("valid");
            prop_assert!(slow(DVec3::from_array(d.farthest.point), &single) < 1e-4 * report.diagonal);
            prop_assert!(d.upper_bound >= said && d.holds == (said <= report.claimed * (1.0 + 1e-9) + 2e-10 * report.diagonal));
            for _ in 0..20 {
                let [p, q, r] = from.corners(random.below(from.triangles().len()));
                let (u, v) = (random.unit(), random.unit());
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let measured = slow(p + (q - p) * u + (r - p) * v, to);
                prop_assert!(measured <= d.upper_bound + 1e-9 * report.diagonal, "{measured} {d:?}");
            }
            if d.holds {
                prop_assert!(d.undecided_area > 0.0 || d.upper_bound <= report.claimed * (1.0 + 1e-8) + 1e-9);
            }
        }
    }
}

#[test]
fn the_command_ends_with_the_code_of_its_verdict() {
    let dir = folder();
    let sphere = generate::icosphere(2);
    put(&dir, "ref.ply", &sphere);
    let outward = sphere.positions()[5].normalize();
    put(&dir, "low.ply", &moved(&sphere, 5, outward * 0.101));
    let run = |error: &str| {
        let words = "verify ref.ply low.ply --samples 1000 --json r.json";
        let output = lodmark(&dir, &format!("{words} --error-abs {error}"));
        (code(&output), stdout(&output))
    };
    let (exit, said) = run("0.1");
    assert!(exit == 1 && said.contains("the claim is broken"), "{said}");
    let report = json(&dir, "r.json");
    assert_eq!(report["holds"], false);
    assert_eq!(report["directions"][0]["from"], "simplified");
    let (exit, said) = run("0.102 --one-sided");
    assert!(exit == 0 && said.contains("proven"), "{said}");
    expect(&dir, 2, "verify ref.ply low.ply");
    expect(&dir, 2, "verify ref.ply low.ply --error -1");
    expect(&dir, 2, "verify ref.ply low.ply --error 0.1 --error-abs 1");
    expect(&dir, 5, "verify ref.ply none.ply --error 0.1");
}

#[test]
fn a_face_without_area_is_near_by_having_none() {
    let sides = [-1.0, 1.0].map(|x| [at(x, -1.0, 0.0), at(x, 1.0, 0.0), at(3.0 * x, 0.0, 0.0)]);
    // A line across the gap, whose middle is 1 from both sides.
    let line = [-0.712_345_612_345, 0.587_654_398_765, 0.1234].map(|x| at(x, 0.0, 0.0));
    let corners = [sides[0], sides[1], line].concat();
    let reference = mesh_of(&corners[..6], [[0, 1, 2], [3, 4, 5]]);
    let low = mesh_of(corners, [[0, 1, 2], [3, 4, 5], [6, 7, 8]]);
    for (claim, proven) in [(0.999_94, false), (1.01, true)] {
        let found = distance(&reference, &low, Claim::Absolute(claim), true, 9, &Silent);
        assert_eq!(found.expect("both have triangles").proven, proven);
    }
}
