//! The view-bounded method: what it promises is what an independent check finds, for every kind of cell and mesh.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property, and `LODMARK_SEED` what they are drawn from.

use glam::DVec3;
use lodmark::{
    Silent,
    bound::{
        verify::{AngleReport, Record, angles},
        view_cell::ViewCell,
    },
    collapse::Replay,
    mesh::{Mesh, canonical, generate},
    num::Precision,
    simplify::{Options, Outcome, Stop, Target, simplify, view_bounded::ViewBoundedOptions},
};
use proptest::prelude::*;
use sha2::{Digest, Sha256};

use crate::support::{
    angle_between, at, bounded, expect, folder, json, meshes, put, same_on_all_threads,
};

fn run_to(mesh: &Mesh, cell: &ViewCell, degrees: f64, target: Target) -> Outcome {
    let own = ViewBoundedOptions::new(cell.clone(), degrees);
    simplify(mesh, &Options::view_bounded(own, target)).expect("valid")
}

fn run(mesh: &Mesh, cell: &ViewCell, degrees: f64) -> Outcome {
    run_to(mesh, cell, degrees, Target::ErrorOnly)
}

fn verified(mesh: &Mesh, outcome: &Outcome, cell: &ViewCell, degrees: f64) -> AngleReport {
    let map = outcome.correspondence().expect("this method keeps account");
    let mut bytes = Vec::new();
    map.write(mesh, &outcome.mesh, &mut bytes).expect("memory");
    let record = Record::from_bytes(&bytes, "a.corr").expect("just written");
    let (low, record) = (&outcome.mesh, Some(&record));
    angles(mesh, low, cell, degrees, record, 3_000, &Silent).expect("fits")
}

/// One cell of every kind, in front of a model of size 2 around the origin.
fn cells() -> Vec<ViewCell> {
    let at = |x: f64, y: f64| DVec3::new(x, y, 5.0);
    let all = [
        ViewCell::point(at(0.3, 0.1)),
        ViewCell::segment([at(-1.0, 0.0), at(1.0, 0.5)]),
        ViewCell::polygon(&[at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]),
        ViewCell::cuboid(at(-1.0, -1.0), DVec3::new(1.0, 1.0, 7.0)),
        ViewCell::half_space(at(0.0, 0.0), DVec3::NEG_Z),
        ViewCell::line(at(0.0, 0.0), DVec3::X),
        ViewCell::plane(at(0.0, 0.0), DVec3::Z),
    ];
    all.map(|cell| cell.expect("a cell")).into()
}

#[test]
fn every_kind_of_cell_bounds_what_it_says() {
    let mesh = canonical(&generate::icosphere(4)).mesh;
    for cell in cells() {
        let outcome = run(&mesh, &cell, 0.2);
        let left = outcome.mesh.triangles().len();
        assert!(left < mesh.triangles().len() / 2, "{cell:?}: {left}");
        assert!(matches!(outcome.stop, Stop::NoLegalCollapse { refusals } if refusals.by_bound()));
        let report = verified(&mesh, &outcome, &cell, 0.2);
        assert!(report.holds, "{cell:?}: {report:?}");
        // The bound is used up, not wasted.
        let seen = report.worst.expect("sightings").angle_deg;
        assert!(seen > 0.1, "{cell:?}: {report:?}");
    }
}

#[test]
fn a_larger_angle_leaves_fewer_triangles_and_a_direction_is_worth_more_than_a_length() {
    let mesh = canonical(&generate::torus(1.0, 0.4, 48, 24)).mesh;
    let cells = cells();
    let left = |cell: &ViewCell, degrees| run(&mesh, cell, degrees).mesh.triangles().len();
    let counts = [0.05, 0.2, 0.8].map(|degrees| left(&cells[1], degrees));
    assert!(counts[0] > counts[1] && counts[1] > counts[2], "{counts:?}");
    // A half-space from the same distance is bounded by lengths alone, for viewers at all sides.
    assert!(left(&cells[0], 0.2) < left(&cells[4], 0.2));
}

#[test]
fn a_mesh_far_from_the_origin_keeps_its_bound_to_the_last_digits() {
    // Bumps of a ten-thousandth: displacements that the rounding of coordinates as large as 10^8 would blur.
    let offset = DVec3::new(1e8, -3e8, 2e8);
    let mut parts = meshes::grid(12, 3).into_parts();
    parts.precision = Precision::F64;
    for p in &mut parts.positions {
        *p = *p * DVec3::new(1.0 / 6.0, 1.0 / 6.0, 1e-4) + offset;
    }
    let mesh = canonical(&Mesh::new(parts).expect("valid")).mesh;
    for (i, cell) in cells().iter().enumerate() {
        let shape = cell.relative_to(-offset);
        let degrees = 2e-4;
        let outcome = run(&mesh, &shape, degrees);
        let left = outcome.mesh.triangles().len();
        assert!(left < mesh.triangles().len(), "cell {i}");
        let report = verified(&mesh, &outcome, &shape, degrees);
        let most = report.at_most_deg.unwrap_or(f64::INFINITY);
        let bounded = report.holds && most <= degrees * (1.0 + 1e-4);
        assert!(bounded, "cell {i}: {report:?}");
        // Looked at again from the offset, where differences are exact, by nothing but the record's corners.
        let map = outcome.correspondence().expect("this method keeps account");
        let corners = shape.corners().unwrap_or_default();
        let eyes: Vec<DVec3> = corners.iter().map(|v| v - offset).collect();
        for face in 0..map.face_count() as u32 {
            let to = outcome.mesh.corners(face as usize).map(|p| p - offset);
            for piece in map.pieces(face) {
                let from = mesh.corners(piece.triangle as usize).map(|p| p - offset);
                for corner in piece.corners {
                    let at =
                        |[a, b, c]: [DVec3; 3], [u, v]: [f64; 2]| a * (1.0 - u - v) + b * u + c * v;
                    let (p, s) = (at(from, corner.source.get()), at(to, corner.target.get()));
                    for &eye in &eyes {
                        let seen = angle_between(eye, p, s).to_degrees();
                        assert!(seen <= degrees * (1.0 + 1e-6), "cell {i}: {seen}");
                    }
                }
            }
        }
    }
}

#[test]
fn an_angle_of_nothing_collapses_nothing_and_one_of_90_degrees_is_refused() {
    let mesh = canonical(&generate::icosphere(2)).mesh;
    let cell = &cells()[0];
    let outcome = run(&mesh, cell, 0.0);
    assert_eq!(outcome.mesh.triangles().len(), mesh.triangles().len());
    assert!(verified(&mesh, &outcome, cell, 0.0).holds);
    let wide = run(&mesh, cell, 89.99);
    assert!(wide.mesh.triangles().len() < 40);
    assert!(verified(&mesh, &wide, cell, 89.99).holds);
    for degrees in [-0.1, 90.0, f64::NAN] {
        let own = ViewBoundedOptions::new(cell.clone(), degrees);
        let refused = simplify(&mesh, &Options::view_bounded(own, Target::ErrorOnly));
        assert_eq!(refused.expect_err("out of range").exit_code(), 2);
    }
}

#[test]
fn what_a_cell_touches_stays_as_it_is() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    let through = [at(0.2, 0.1, -2.0), at(0.2, 0.1, 2.0)];
    let through = ViewCell::segment(through).expect("a segment");
    let on = ViewCell::point(mesh.positions()[7]).expect("a point");
    let inside = ViewCell::cuboid(DVec3::splat(-0.1), DVec3::splat(0.1)).expect("a box");
    for cell in [&through, &on, &inside] {
        let outcome = run(&mesh, cell, 2.0);
        assert!(outcome.mesh.triangles().len() < mesh.triangles().len());
        assert!(verified(&mesh, &outcome, cell, 2.0).holds, "{cell:?}");
    }
    let everything = ViewCell::cuboid(DVec3::splat(-3.0), DVec3::splat(3.0)).expect("a box");
    let outcome = run(&mesh, &everything, 2.0);
    assert_eq!(outcome.mesh.triangles().len(), mesh.triangles().len());
}

#[test]
fn a_target_stops_before_the_bound_and_a_target_above_the_input_copies_it() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    let cell = &cells()[1];
    let outcome = run_to(&mesh, cell, 5.0, Target::Triangles(600));
    assert_eq!(outcome.mesh.triangles().len(), 600);
    assert_eq!(outcome.stop, Stop::TargetReached);
    assert!(verified(&mesh, &outcome, cell, 5.0).holds);
    let copy = run_to(&mesh, cell, 5.0, Target::Triangles(9999));
    assert_eq!((&copy.mesh, copy.stop), (&mesh, Stop::TargetAboveInput));
    assert!(verified(&mesh, &copy, cell, 0.0).holds);
    let mut replay = Replay::new(&mesh, &outcome.history).expect("its own input");
    replay.seek(600).expect("fits");
    assert_eq!(replay.live().to_mesh().expect("a mesh"), outcome.mesh);
}

proptest! {
    #![proptest_config(bounded(40))]

    #[test]
    fn open_seamed_tangled_and_needle_meshes_keep_their_bound(
        kind in 0_usize..8, seed: u64, which in 0_usize..7, degrees in 0.01..20.0_f64,
    ) {
        let mesh = meshes::any(kind, seed);
        // Needles: everything is squeezed.
        let squeezed: Vec<DVec3> = mesh.positions().iter()
            .map(|p| if seed.is_multiple_of(3) { DVec3::new(p.x, p.y * 1e-4, p.z) } else { *p } * 0.3).collect();
        let mesh = Mesh::from_triangles(squeezed, mesh.triangles().to_vec()).expect("valid");
        let mesh = canonical(&mesh).mesh;
        let cell = &cells()[which];
        let outcome = run(&mesh, cell, degrees);
        let report = verified(&mesh, &outcome, cell, degrees);
        prop_assert!(report.holds, "{:?}", report);
    }
}

/// A record with another value in the place of a word, and its checksum.
fn altered(bytes: &[u8], at: usize, word: u32) -> Vec<u8> {
    let mut bytes = bytes[..bytes.len() - 32].to_vec();
    bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
    bytes.extend(Sha256::digest(&bytes));
    bytes
}

/// Where the weights in original triangles are in a record: two words each.
fn sources(bytes: &[u8], triangles: usize) -> Vec<usize> {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four"));
    let (mut at, mut found) = (92, Vec::new());
    for _ in 0..triangles {
        let pieces = word(at);
        at += 4;
        for _ in 0..pieces {
            let corners = word(at + 4) as usize;
            found.extend((0..corners).map(|c| at + 8 + 16 * c));
            at += 8 + 16 * corners;
        }
    }
    assert_eq!(at + 32, bytes.len());
    found
}

proptest! {
    #![proptest_config(bounded(200))]

    #[test]
    fn a_corner_that_is_one_unit_off_leaves_a_gap_that_is_found(
        at: prop::sample::Index, second: bool, up: bool,
    ) {
        let mesh = canonical(&generate::icosphere(2)).mesh;
        let cell = &cells()[1];
        let outcome = run(&mesh, cell, 4.0);
        let map = outcome.correspondence().expect("this method keeps account");
        let mut bytes = Vec::new();
        map.write(&mesh, &outcome.mesh, &mut bytes).expect("memory");
        let places = sources(&bytes, mesh.triangles().len());
        prop_assert!(places.len() > 3 * mesh.triangles().len(), "nothing was cut");
        let place = at.get(&places) + if second { 4 } else { 0 };
        let word = u32::from_le_bytes(bytes[place..place + 4].try_into().expect("four"));
        let word = if up { word.checked_add(1) } else { word.checked_sub(1) };
        let check = |bytes: &[u8]| {
            let record = Record::from_bytes(bytes, "a.corr").ok()?;
            Some(angles(&mesh, &outcome.mesh, cell, 4.0, Some(&record), 9, &Silent).expect("fits"))
        };
        prop_assert!(check(&bytes).expect("as written").gap.is_none());
        // Outside of the triangle it is not even read.
        if let Some(report) = word.and_then(|word| check(&altered(&bytes, place, word))) {
            prop_assert!(report.gap.is_some() && !report.holds, "{report:?}");
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let mesh = canonical(&generate::torus(1.0, 0.4, 24, 16)).mesh;
    same_on_all_threads(|| {
        let outcome = run(&mesh, &cells()[2], 0.3);
        let mut bytes = outcome.history.to_bytes();
        let map = outcome.correspondence().expect("this method keeps account");
        map.write(&mesh, &outcome.mesh, &mut bytes).expect("memory");
        bytes
    });
}

#[test]
fn the_command_bounds_verifies_and_refuses() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(3));
    let cell = r#"{"schema": 1, "cell": {"segment": [[-1, 0, 5], [1, 0, 5]]}}"#;
    std::fs::write(dir.path().join("c.json"), cell).expect("writes");
    let simplify = |more: &str, exit| {
        let words = "simplify in.ply out.ply --method view-bounded";
        expect(&dir, exit, &format!("{words} {more}"))
    };
    let bounded = "--cell c.json --error-deg 0.5 --bound-out b.corr --strict";
    let said = simplify(bounded, 0);
    let told = said.contains("breaks the bound or a rule") && said.contains("bound:");
    assert!(told, "{said}");
    let verify = "verify in.ply out.ply --cell c.json --bound b.corr --samples 1000";
    expect(&dir, 0, &format!("{verify} --error-deg 0.5"));
    expect(&dir, 1, &format!("{verify} --error-deg 0.2"));
    // Half a degree is what one pixel takes up on a screen of two hundred or so.
    simplify(
        "--cell c.json --error-px 1 --screen-height 114 --fov 57 --json r.json",
        0,
    );
    let method = &json(&dir, "r.json")["options"]["method"];
    let degrees = method["error-deg"].as_f64().expect("resolved");
    assert!((degrees - 0.5457).abs() < 1e-3, "{degrees}");
    assert!(method["cell"]["segment"].is_array());
    for wrong in [
        "--cell c.json",
        "--error-deg 1",
        "-t 100",
        "--cell c.json --error-px 1",
        "--cell c.json --error-deg 1 --error-px 1 --screen-height 9",
        "--cell c.json --error-deg 90",
        "--cell c.json --error-deg 1 --preset fast",
    ] {
        simplify(wrong, 2);
    }
    simplify("--cell none.json --error-deg 1", 5);
    simplify("--cell in.ply --error-deg 1", 3);
    expect(
        &dir,
        2,
        "simplify in.ply o.ply --method quadric -t 9 --cell c.json",
    );
}
