//! Claims about angles for a view cell.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property, and `LODMARK_SEED` what they are drawn from.

use glam::DVec3;
use lodmark::{
    Silent,
    bound::{
        correspondence::Correspondence,
        verify::{AngleReport, Property, Record, angles},
        view_cell::ViewCell,
    },
    mesh::{Mesh, canonical, generate},
    num::Precision,
};
use proptest::prelude::*;

use crate::support::{
    Random, at, bounded, code, expect, faces, folder, json, lattice, lodmark, mesh_of, meshes,
    mixture, moved, put, same_on_all_threads, stdout,
};

/// The record that says that every triangle of `low` stands for the same one of `original`.
pub(crate) fn identity(original: &Mesh, low: &Mesh) -> Vec<u8> {
    let (map, mut bytes) = (Correspondence::identity(faces(original)), Vec::new());
    map.write(original, low, &mut bytes).expect("memory");
    bytes
}

pub(crate) fn read(bytes: &[u8]) -> Record {
    Record::from_bytes(bytes, "a.corr").expect("just written")
}

fn check(original: &Mesh, low: &Mesh, cell: &ViewCell, degrees: f64) -> AngleReport {
    let record = read(&identity(original, low));
    angles(original, low, cell, degrees, Some(&record), 5_000, &Silent).expect("fits")
}

/// The largest angle over many viewpoints and points, by the cosine.
fn brute(original: &Mesh, low: &Mesh, viewpoints: &[DVec3]) -> f64 {
    let mut least = 1.0_f64;
    for (a, b) in faces(original).into_iter().zip(faces(low)) {
        for (p, s) in lattice(a, 8).zip(lattice(b, 8)) {
            for &v in viewpoints {
                let (p, s) = (p - v, s - v);
                least = least.min(p.dot(s) / (p.length() * s.length()));
            }
        }
    }
    libm::acos(least.min(1.0)).to_degrees()
}

fn terrain() -> Mesh {
    canonical(&meshes::grid(6, 11)).mesh
}

#[test]
fn a_vertex_one_percent_too_far_aside_is_found_and_one_percent_less_is_not() {
    let mesh = terrain();
    let vertex = 20;
    let p = mesh.positions()[vertex];
    // Seen from straight above, a step to the side is seen in full.
    let (height, degrees) = (50.0, 0.5_f64);
    let viewer = p + DVec3::Z * height;
    let cell = ViewCell::point(viewer).expect("a point");
    for (share, holds) in [(1.01, false), (0.99, true)] {
        let step = height * libm::tan((degrees * share).to_radians());
        let low = moved(&mesh, vertex, DVec3::new(step, 0.0, 0.0));
        let report = check(&mesh, &low, &cell, degrees);
        assert_eq!(report.holds, holds, "{report:?}");
        assert_eq!(report.gap, None);
        let worst = report.worst.expect("sightings");
        let off = (worst.angle_deg - degrees * share).abs();
        assert!(off < 1e-4, "{worst:?}");
        assert!((DVec3::from_array(worst.point) - p).length() < 1e-4);
        assert_eq!(report.violations == 0, holds);
        assert!(!holds || report.undecided_area <= 0.0, "{report:?}");
    }
}

#[test]
fn a_viewpoint_in_the_middle_of_a_cell_is_found_though_no_corner_sees_as_much() {
    let mesh = terrain();
    let vertex = 20;
    let p = mesh.positions()[vertex];
    let side = |x: f64| p + DVec3::new(x, 0.0, 20.0);
    let cell = ViewCell::segment([side(-60.0), side(60.0)]).expect("a segment");
    let low = moved(&mesh, vertex, DVec3::new(0.3, 0.0, 0.0));
    let step = f64::from(low.positions()[vertex].x as f32) - p.x;
    let truth = libm::atan2(0.5 * step, 20.0).to_degrees() * 2.0;
    let report = check(&mesh, &low, &cell, truth / 1.01);
    let worst = report.worst.expect("sightings").angle_deg;
    let off = (worst - truth).abs();
    assert!(!report.holds && off < 1e-3 * truth, "{worst} {truth}");
    let held = check(&mesh, &low, &cell, truth * 1.01);
    assert!(held.holds && held.undecided_area <= 0.0, "{held:?}");
    // The largest angle is known to a five-hundredth, but on which side of a claim it is much better.
    assert!(check(&mesh, &low, &cell, truth * 1.0001).proven);
    assert!(!check(&mesh, &low, &cell, truth / 1.0001).holds);
}

#[test]
fn without_a_record_only_the_nearest_in_angle_is_checked() {
    let mesh = terrain();
    let viewer = DVec3::new(3.0, 3.0, 40.0);
    let cell = ViewCell::point(viewer).expect("a point");
    let look = |place: &dyn Fn(DVec3) -> DVec3, degrees| {
        let placed: Vec<DVec3> = mesh.positions().iter().map(|&p| place(p)).collect();
        let low = mesh_of(placed, mesh.triangles());
        angles(&mesh, &low, &cell, degrees, None, 2_000, &Silent).expect("valid")
    };
    // Pushed away along the lines of sight: nothing to see, whatever the distance.
    let held = look(&|p| viewer + (p - viewer) * 1.25, 1e-3);
    assert!(held.holds && held.property == Property::NearestInAngle && held.pieces.is_none());
    // Moved aside: the outline is what shows.
    let report = look(&|p| p + DVec3::X, 0.5);
    let worst = report.worst.expect("sightings").angle_deg;
    assert!(!report.holds && (1.0..2.0).contains(&worst), "{worst}");
}

proptest! {
    #![proptest_config(bounded(60))]

    #[test]
    fn no_viewer_sees_more_than_the_report_says(kind in 0_u8..4, seed: u64) {
        let mesh = canonical(&meshes::grid(3, seed)).mesh;
        let mut random = Random(seed);
        let mut low = mesh.clone();
        for v in 0..mesh.positions().len() {
            let mut by = || (random.unit() - 0.5) * 0.3;
            low = moved(&low, v, DVec3::new(by(), by(), by()));
        }
        let mut at = || DVec3::new(6.0 * random.unit() - 1.5, 6.0 * random.unit() - 1.5, 3.0 + 3.0 * random.unit());
        let corners: Vec<DVec3> = (0..6).map(|_| at()).collect();
        let cell = match kind {
            0 => ViewCell::point(corners[0]),
            1 => ViewCell::segment([corners[0], corners[1]]),
            2 => ViewCell::polygon(&corners[..3]),
            _ => ViewCell::polyhedron(&corners),
        }.expect("points in no special place");
        let n = [1, 2, 3, 6][usize::from(kind)];
        let viewpoints: Vec<DVec3> = (0..60).map(|_| {
            let weights: Vec<f64> = (0..n).map(|_| random.unit()).collect();
            mixture(&corners, &weights)
        }).collect();
        let seen = brute(&mesh, &low, &viewpoints);
        let report = check(&mesh, &low, &cell, 45.0);
        let said = report.worst.expect("sightings").angle_deg;
        let most = report.at_most_deg.expect("the cell is far away");
        prop_assert!(report.gap.is_none() && seen <= most && most <= said * 1.01, "{seen} and {said} above {most}");
        let proven = check(&mesh, &low, &cell, said * 1.01);
        prop_assert!(proven.holds && proven.undecided_area <= 0.0, "{proven:?}");
        prop_assert!(!check(&mesh, &low, &cell, said / 1.01).holds);
    }
}

#[test]
fn viewpoints_on_and_in_the_mesh_are_judged_without_a_number_that_is_none() {
    let mesh = canonical(&generate::icosphere(2)).mesh;
    let on = ViewCell::point(mesh.positions()[0]).expect("a point");
    let inside = ViewCell::point(DVec3::ZERO).expect("a point");
    let through = ViewCell::segment([DVec3::splat(-2.0), DVec3::splat(2.0)]).expect("a segment");
    for cell in [&on, &inside, &through] {
        assert!(check(&mesh, &mesh, cell, 0.0).holds, "nothing moved");
    }
    // The viewer's own point moved away: seen in any direction.
    let low = moved(&mesh, 0, mesh.positions()[0] * 0.01);
    let report = check(&mesh, &low, &on, 89.0);
    assert!(!report.holds && report.worst.expect("sightings").angle_deg.is_finite());
    for degrees in [-1.0, 90.0, f64::NAN] {
        let refused = angles(&mesh, &mesh, &on, degrees, None, 1, &Silent);
        assert_eq!(refused.expect_err("no angle").exit_code(), 2);
    }
}

#[test]
fn a_cell_that_meets_what_was_moved_breaks_every_claim_however_small_the_step() {
    let triangle = |z: f64| {
        mesh_of(
            [at(-1.0, -1.0, z), at(2.0, -0.5, z), at(0.3, 1.5, z)],
            [[0, 1, 2]],
        )
    };
    let flat = triangle(0.0);
    let all = [
        ViewCell::point(at(0.1, 0.2, 0.0)),
        ViewCell::segment([at(0.1, 0.3, -1.0), at(0.35, 0.2, 2.0)]),
        ViewCell::segment([at(-0.5, -0.5, 0.0), at(7.0, 0.1, 3.0)]),
        ViewCell::polygon(&[at(0.1, 0.1, -0.3), at(0.7, 0.2, -0.2), at(0.4, 0.3, 1.0)]),
        ViewCell::cuboid(at(-0.17, -0.23, -0.31), at(0.11, 0.4, 0.29)),
        ViewCell::cuboid(DVec3::splat(-5.1), DVec3::splat(4.3)),
        ViewCell::plane(at(0.2, 0.0, 0.0), at(0.6, 0.0, 0.8)),
        ViewCell::half_space(at(0.0, 0.0, -1.0), DVec3::NEG_Z),
    ];
    for step in [0.5, 1e-2, 1e-4, 1e-6] {
        for (i, cell) in all.iter().enumerate() {
            let cell = cell.as_ref().expect("a cell");
            for moved in [triangle(step), moved(&flat, 1, at(step, 0.3 * step, -step))] {
                // Viewers on the original, and on what stands for it.
                for [from, to] in [[&flat, &moved], [&moved, &flat]] {
                    let report = check(from, to, cell, 89.0);
                    let seen = report.worst.expect("sightings").angle_deg > 89.0;
                    let broken = seen && report.at_most_deg.is_none_or(|most| most > 89.0);
                    let none = report.holds || report.proven;
                    assert!(broken && !none, "{step}, cell {i}: {report:?}");
                }
            }
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let mesh = terrain();
    let low = moved(&mesh, 3, DVec3::new(0.1, 0.0, 0.05));
    let cell = ViewCell::segment([at(0.0, 0.0, 9.0), at(6.0, 0.0, 9.0)]).expect("a segment");
    same_on_all_threads(|| check(&mesh, &low, &cell, 0.5));
}

#[test]
fn the_command_names_the_place_where_an_angle_is_too_large() {
    let dir = folder();
    let mesh = terrain();
    let low = moved(&mesh, 20, DVec3::new(0.5, 0.0, 0.0));
    put(&dir, "ref.ply", &mesh);
    put(&dir, "low.ply", &low);
    std::fs::write(dir.path().join("b.corr"), identity(&mesh, &low)).expect("writes");
    let cell = r#"{"schema": 1, "cell": {"segment": [[0, 0, 40], [6, 0, 40]]}}"#;
    std::fs::write(dir.path().join("cell.json"), cell).expect("writes");
    let run = |more: &str| {
        let meshes = "verify ref.ply low.ply --cell cell.json --samples 500";
        lodmark(&dir, &format!("{meshes} --error-deg {more}"))
    };
    let broken = run("0.1 --bound b.corr --json r.json");
    assert_eq!(code(&broken), 1);
    assert!(stdout(&broken).contains("seen from"), "{}", stdout(&broken));
    assert_eq!(json(&dir, "r.json")["property"], "correspondence");
    assert_eq!(code(&run("2 --bound b.corr")), 0);
    assert_eq!(code(&run("2")), 0);
    for (exit, claim) in [
        (
            3,
            "low.ply low.ply --cell cell.json --error-deg 1 --bound b.corr",
        ),
        (
            3,
            "ref.ply ref.ply --cell cell.json --error-deg 1 --bound b.corr",
        ),
        (
            3,
            "ref.ply low.ply --cell cell.json --error-deg 1 --bound ref.ply",
        ),
        (2, "ref.ply low.ply --error-deg 1"),
        (2, "ref.ply low.ply --error 1 --cell cell.json"),
        (2, "ref.ply low.ply --cell cell.json --error-deg 90"),
    ] {
        expect(&dir, exit, &format!("verify {claim}"));
    }
}

#[test]
fn a_face_without_area_is_proven_by_having_none() {
    // The second triangle lies on a line, and viewers stand between it and what stands for it.
    let mesh = |by: f64| {
        let line = [0.0, 1.0, 2.0].map(|x| at(x + by * (1.0 + 0.37 * x), 0.0, 0.0));
        let face = [at(0.0, 0.0, 3.0), at(1.0, 0.0, 3.0), at(0.0, 1.0, 3.0)];
        mesh_of([face, line].concat(), [[0, 1, 2], [3, 4, 5]])
    };
    let cell = ViewCell::segment([at(0.2, 0.0, 0.0), at(1.7, 0.0, 0.0)]).expect("a cell");
    let found = check(&mesh(0.0), &mesh(1e-9), &cell, 1.0);
    assert!(!found.proven, "{found:?}");
    assert!(check(&mesh(0.0), &mesh(0.0), &cell, 0.0).proven);
}

#[test]
fn a_mesh_whose_squares_are_no_numbers_is_held_to_a_claim() {
    let moved = |by: DVec3| {
        let mut parts = meshes::torus(6, 5, 1).into_parts();
        parts.precision = Precision::F64;
        parts.positions[3] += by;
        Mesh::new(parts).expect("valid")
    };
    let near = moved(DVec3::ZERO);
    let cell = ViewCell::point(DVec3::new(0.0, 0.0, 9.0)).expect("a cell");
    for far in [1e61, 1e160, 1e300] {
        let low = moved(DVec3::splat(far));
        let record = read(&identity(&near, &low));
        let there = ViewCell::point(DVec3::splat(far)).expect("a cell");
        let of_cell = (&near, &there, None);
        for (low, cell, record) in [(&low, &cell, Some(&record)), (&low, &cell, None), of_cell] {
            let refused = angles(&near, low, cell, 1.0, record, 100, &Silent);
            assert_eq!(refused.expect_err("too far").exit_code(), 3);
        }
    }
    let low = moved(DVec3::splat(1e50));
    let found = check(&near, &low, &cell, 1.0);
    assert!(!found.proven && !found.holds, "{found:?}");
}
