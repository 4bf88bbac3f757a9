//! Guarantees where geometry is at its worst: needles, borders, edges of three faces, viewers on and inside a mesh, no
//! angle and almost a right one, cells without an end. What other files cover is not repeated here.

use std::{f64::consts::FRAC_PI_6, fs};

use glam::DVec3;
use lodmark::{
    Silent,
    bound::{
        nearest_triangle::{NearestTriangle, originals},
        planar::Aperture,
        region::{profile, profile_normal, shell},
        surface::{Effort, Measure, measure},
        verify::{AngleReport, Claim, angles, distance},
        view_cell::ViewCell,
    },
    io,
    mesh::{Mesh, MeshParts, canonical, generate},
    num::Precision,
};
use tempfile::TempDir;

use super::verify::{identity, read};
use crate::support::{
    Random, angle_between, at, distance_to_all, expect, faces, folder, lattice, lodmark, mesh_of,
    mixture, put, stdout,
};

fn seen_from(v: DVec3, p: DVec3, s: DVec3) -> f64 {
    angle_between(v, p, s).to_degrees()
}

/// Three faces at one edge, two of them with a needle between them, and open borders all around.
fn awkward(move_of: impl Fn(usize) -> DVec3) -> Mesh {
    let positions = [
        at(0.0, 0.0, 0.0),
        at(1.0, 0.0, 0.0),
        at(0.5, 1.0, 0.0),
        at(0.5, -1.0, 0.25),
        at(0.5, 0.125, 1.0),
        at(0.5, 1e-9, 0.0),
    ];
    let positions = (0..6).map(|i| positions[i] + move_of(i)).collect();
    let triangles = vec![[0, 5, 2], [5, 1, 2], [0, 1, 5], [1, 0, 3], [0, 1, 4]];
    exact(positions, triangles)
}

/// In double precision: without an angle even rounding is seen.
fn exact(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(MeshParts {
        positions,
        triangles,
        precision: Precision::F64,
        ..MeshParts::default()
    })
    .expect("indices")
}

/// Every triangle stands for the one with its number.
fn held(original: &Mesh, low: &Mesh, cell: &ViewCell, degrees: f64) -> AngleReport {
    let record = read(&identity(original, low));
    angles(original, low, cell, degrees, Some(&record), 500, &Silent).expect("fits")
}

#[test]
fn needles_and_third_faces_at_an_edge_hide_no_angle_from_the_verifier() {
    let mesh = awkward(|_| DVec3::ZERO);
    let mut random = Random(31);
    for case in 0..24 {
        let mut by = || random.unit() - 0.5;
        let size = [0.2, 1e-3, 1e-6][case % 3];
        let steps = [0; 6].map(|_| at(by(), by(), by()) * size);
        // One vertex alone, the needle's tip among them, or all.
        let moves = |i| case % 7 == 6 || i == case % 6;
        let low = awkward(|i| if moves(i) { steps[i] } else { DVec3::ZERO });
        let ends = [at(-1.0 + by(), by(), 4.0), at(1.0, by(), 3.0 + by())];
        let cell = ViewCell::segment(ends).expect("a segment");
        let mut seen = 0.0_f64;
        for t in 0..mesh.triangles().len() {
            let both = lattice(mesh.corners(t), 8).zip(lattice(low.corners(t), 8));
            for (p, s) in both {
                for i in 0..=16 {
                    seen = seen.max(seen_from(ends[0].lerp(ends[1], f64::from(i) / 16.0), p, s));
                }
            }
        }
        let report = held(&mesh, &low, &cell, 45.0);
        let (most, worst) = (report.at_most_deg, report.worst.expect("sightings"));
        let bounded = most.is_some_and(|most| seen <= most * (1.0 + 1e-9));
        assert!(bounded, "case {case}: {seen}, {report:?}");
        let there = [worst.viewpoint, worst.point, worst.replacement].map(DVec3::from_array);
        let there = seen_from(there[0], there[1], there[2]);
        assert!((there - worst.angle_deg).abs() < 1e-6 * there + 1e-9);
        assert!(seen <= worst.angle_deg * 1.01 + 1e-8, "case {case}: {seen}");
        assert!(held(&mesh, &low, &cell, worst.angle_deg * 1.01).proven);
        assert!(!held(&mesh, &low, &cell, worst.angle_deg / 1.01).holds);
    }
}

#[test]
fn a_third_face_at_an_edge_counts_in_a_distance() {
    let mesh = awkward(|_| DVec3::ZERO);
    for vertex in 0..6 {
        let by = at(0.03, -0.05, 0.08);
        let low = awkward(|i| if i == vertex { by } else { DVec3::ZERO });
        let check = |claim| distance(&mesh, &low, claim, false, 300, &Silent).expect("triangles");
        let report = check(Claim::Absolute(1.0));
        for (d, [from, to]) in report.directions.iter().zip([[&low, &mesh], [&mesh, &low]]) {
            let (others, upper) = (faces(to), d.upper_bound);
            let points = faces(from).into_iter().flat_map(|t| lattice(t, 12));
            let distances = points.map(|p| distance_to_all(p, &others));
            let most = distances.fold(0.0, f64::max);
            let near = most <= upper * (1.0 + 1e-9) && upper <= by.length() * 1.001;
            assert!(near, "vertex {vertex}: {most}, {d:?}");
        }
        let farthest = report.directions.iter().map(|d| d.farthest.distance);
        let farthest = farthest.fold(0.0, f64::max);
        assert!(!check(Claim::Absolute(farthest / 1.01)).holds);
        assert!(!check(Claim::Relative(0.0)).holds, "vertex {vertex} moved");
    }
}

#[test]
fn no_viewer_inside_a_closed_mesh_sees_a_move_beyond_the_bound() {
    let mesh = canonical(&generate::icosphere(2)).mesh;
    let step = at(0.02, -0.01, 0.0);
    let moved: Vec<DVec3> = mesh.positions().iter().map(|&p| p + step).collect();
    let low = mesh_of(moved, mesh.triangles());
    let nearest = NearestTriangle::new(&low).expect("not empty");
    let mut random = Random(7);
    for cell in [
        ViewCell::point(DVec3::ZERO),
        ViewCell::segment([at(-0.4, 0.1, 0.0), at(0.3, 0.2, -0.2)]),
        ViewCell::polygon(&[at(-0.3, 0.0, 0.1), at(0.4, 0.0, 0.0), at(0.0, 0.4, 0.2)]),
        ViewCell::cuboid(DVec3::splat(-0.25), DVec3::splat(0.3)),
    ] {
        let cell = cell.expect("a cell");
        let (angle, effort) = (Measure::Angle(&cell), Effort::default());
        let found = measure(originals(&mesh), &nearest, angle, effort, &Silent);
        let found = found.expect("nobody interrupts");
        // Nobody is nearer than 0.3 to the sphere, whose faces are 0.97 from the middle and farther.
        let range = f64::MIN_POSITIVE..libm::asin(step.length() / 0.3);
        assert!(range.contains(&found.bound), "{cell:?}: {found:?}");
        let worst = found.worst.expect("it moved");
        let from = worst.viewpoint.expect("no viewer is on the mesh");
        assert!(cell.distance_to_point(from) < 1e-9, "{cell:?}: {from}");
        let seen = seen_from(from, worst.point, worst.replacement).to_radians();
        assert!((seen - worst.value).abs() < 1e-9 && seen <= found.bound);
        // The same through the verifier, whose pairs are the vertices that moved.
        let report = held(&mesh, &low, &cell, 20.0);
        let corners = cell.corners().expect("an end").to_vec();
        let mut brute = 0.0_f64;
        for _ in 0..4_000 {
            let weights: Vec<f64> = corners.iter().map(|_| random.unit() + 1e-9).collect();
            let eye = mixture(&corners, &weights);
            let p = mesh.positions()[random.below(mesh.positions().len())];
            brute = brute.max(seen_from(eye, p, p + step));
        }
        let most = report.at_most_deg.expect("nobody is on the mesh");
        assert!(brute <= most + 1e-6 && report.proven, "{brute} {report:?}");
    }
}

#[test]
fn viewers_on_what_stands_for_the_original_are_found_where_none_is_on_the_original() {
    let triangle = |z: f64| {
        mesh_of(
            [at(-1.0, -1.0, z), at(2.0, -0.5, z), at(0.3, 1.5, z)],
            [[0, 1, 2]],
        )
    };
    for step in [0.5, 1e-2, 1e-4, 1e-6] {
        for (low, high) in [
            (at(-0.17, -0.23, -0.31), at(0.11, 0.4, 0.0)),
            (DVec3::splat(-5.1), at(4.3, 4.7, 0.0)),
        ] {
            // The cell ends half way between the two.
            let cell = ViewCell::cuboid(low, high + DVec3::Z * (0.5 * step)).expect("a box");
            let report = held(&triangle(step), &triangle(0.0), &cell, 89.0);
            assert!(!report.holds && !report.proven, "{step}: {report:?}");
        }
    }
}

#[test]
fn without_an_angle_no_step_aside_passes_and_with_nearly_a_right_one_no_wider_one() {
    let mesh = awkward(|_| DVec3::ZERO);
    let eye = at(0.5, 0.25, 4.0);
    let cell = ViewCell::point(eye).expect("a point");
    // Theta = 0: to the side is seen, however little; away from the only viewer is not.
    for step in [1e-2, 1e-6] {
        let aside = awkward(|i| if i == 2 { DVec3::X * step } else { DVec3::ZERO });
        let report = held(&mesh, &aside, &cell, 0.0);
        assert!(!report.holds && report.violations > 0, "{report:?}");
    }
    // All faces stay in the planes through the viewer, up to rounding.
    let away = { mesh.positions().iter() }.map(|&p| eye + (p - eye) * 1.25);
    let away = exact(away.collect(), mesh.triangles().to_vec());
    let report = held(&mesh, &away, &cell, 0.0);
    assert!(report.holds, "{report:?}");
    // A vertex that goes nearly around the viewer.
    let mut last = 0.0;
    for degrees in [60.0_f64, 89.0, 89.9, 89.999] {
        let turn = (degrees - 30.0).to_radians();
        let start = at(-libm::sin(FRAC_PI_6), 0.0, -libm::cos(FRAC_PI_6));
        let end = at(libm::sin(turn), 0.0, -libm::cos(turn));
        let corners = |p: DVec3| vec![p, p + at(0.0, 1e-3, 0.0), p * 1.001];
        let face = |p| exact(corners(p), vec![[0, 1, 2]]);
        let cell = ViewCell::point(DVec3::ZERO).expect("a point");
        let said = held(&face(start), &face(end), &cell, 0.0).worst;
        let said = said.expect("sightings").angle_deg;
        assert!((said - degrees).abs() < 0.1 && said > last, "{said}");
        last = said;
        let held = |degrees| held(&face(start), &face(end), &cell, degrees);
        assert!(held(0.5 * (said + 90.0)).proven, "{said}");
        assert!(!held(said - 1e-4).holds);
    }
}

fn cells_without_end() -> [(&'static str, ViewCell); 3] {
    let point = at(0.25, -0.5, 3.0);
    let normal = at(0.2, 0.1, -1.0);
    [
        ("line", ViewCell::line(point, at(1.0, 0.3, 0.1))),
        ("plane", ViewCell::plane(point, normal)),
        ("half_space", ViewCell::half_space(point, normal)),
    ]
    .map(|(name, cell)| (name, cell.expect("a cell")))
}

#[test]
fn no_viewer_of_an_endless_cell_sees_a_move_inside_a_drawn_region() {
    let (point, degrees) = (at(0.1, 0.2, 0.0), 12.0);
    let aperture = Aperture::degrees(degrees).expect("below 90");
    let mut random = Random(0xe4d);
    for (name, cell) in cells_without_end() {
        let normal = profile_normal(&cell, point);
        let figure = profile(&cell, point, normal, aperture, 90, None).expect("a figure");
        let surface = shell(&cell, point, aperture, 1, None).expect("a surface");
        let outline = figure.outline.iter().chain(surface.positions());
        let mut attained = 0.0_f64;
        for &moved in outline {
            // Viewers at all distances from where the cell is nearest.
            for _ in 0..300 {
                let far = libm::pow(10.0, random.unit() * 4.0 - 2.0);
                let mut step = || (random.unit() * 2.0 - 1.0) * far;
                let way = at(step(), step(), step());
                let base = at(0.25, -0.5, 3.0);
                let eye = match name {
                    "line" => base + at(1.0, 0.3, 0.1) * (way.x + way.y),
                    _ => {
                        let n = at(0.2, 0.1, -1.0).normalize();
                        let deep = if name == "plane" {
                            0.0
                        } else {
                            way.dot(n).abs()
                        };
                        base + way - n * (way.dot(n) + deep)
                    }
                };
                let seen = seen_from(eye, point, moved);
                // The surface is in single precision.
                assert!(seen <= degrees * (1.0 + 1e-5), "{name}: {seen} from {eye}");
                attained = attained.max(seen);
            }
        }
        assert!(attained > 0.9 * degrees, "{name}: {attained}");
    }
}

/// Cell files, and meshes of which one is all the others' trouble at once.
fn scene() -> TempDir {
    let dir = folder();
    put(&dir, "ref.ply", &awkward(|_| DVec3::ZERO));
    put(&dir, "low.ply", &awkward(|_| at(0.0, 0.0, 0.0078125)));
    let (low, high) = (at(0.25, 0.25, -1.0), at(0.5, 0.5, 1.0));
    let cells = [
        ("on", ViewCell::point(at(0.25, 0.0, 0.0))),
        ("cut", ViewCell::cuboid(low, high)),
        (
            "far",
            ViewCell::segment([at(0.0, 0.0, 4.0), at(1.0, 0.0, 4.0)]),
        ),
    ];
    let cells = cells.map(|(name, cell)| (name, cell.expect("a cell")));
    for (name, cell) in cells.into_iter().chain(cells_without_end()) {
        let text = lodmark::bound::view_cell::file::to_json(&cell).expect("JSON");
        fs::write(dir.path().join(format!("{name}.json")), text).expect("writes");
    }
    dir
}

#[test]
fn every_command_has_an_answer_to_an_awkward_scene() {
    let dir = scene();
    for cell in ["on", "cut", "far", "line", "plane", "half_space"] {
        for degrees in ["0", "1", "89.9999"] {
            let claim = format!("--cell {cell}.json --error-deg {degrees}");
            let to = "ref.ply out.ply --method view-bounded --bound-out b.corr";
            expect(&dir, 0, &format!("simplify {to} {claim}"));
            let by = "ref.ply out.ply --samples 200 --bound b.corr";
            expect(&dir, 0, &format!("verify {by} {claim}"));
        }
        let bound = |low| format!("bound ref.ply {low} --cell {cell}.json");
        let moved = lodmark(&dir, &bound("low.ply"));
        let said = stdout(&moved);
        assert!(moved.status.success(), "{cell}: {moved:?}");
        // Whoever stands on what moved sees half a turn.
        let half_turn = said.contains("guaranteed        180.0000");
        assert_eq!(half_turn, ["on", "cut"].contains(&cell), "{cell}: {said}");
        assert!(!said.contains("NaN"), "{said}");
        expect(&dir, 0, &bound("ref.ply"));
        for (out, figure) in [("r.svg", true), ("r.ply", false)] {
            let of = format!("--cell {cell}.json --point 0.125,0.125,0.5 --error-deg 3");
            expect(&dir, 0, &format!("bound-region {out} {of}"));
            if figure {
                let text = fs::read_to_string(dir.path().join(out)).expect("written");
                assert!(text.contains("<polygon") && !text.contains("NaN"), "{text}");
                // The cell is drawn even where it has no end, and the side of its viewers.
                assert!(text.contains("<polyline") || cell == "on", "{text}");
                assert_eq!(text.contains("fill-opacity"), cell == "half_space");
            } else {
                let mesh = io::read(&dir.path().join(out)).expect("reads").mesh;
                assert!(mesh.triangles().len() == 20 * 256);
            }
        }
    }
    let within = |error| format!("simplify ref.ply t.ply --method tolerance --error {error}");
    for error in ["0.01", "1e300"] {
        expect(&dir, 0, &within(error));
        expect(
            &dir,
            0,
            &format!("verify ref.ply t.ply --samples 200 --error {error}"),
        );
    }
    // No angle at all: the moved mesh may never be shown, the same one always.
    for (low, said) in [
        ("low.ply", "at no distance"),
        ("ref.ply", "distance of 0 on"),
    ] {
        let output = stdout(&lodmark(
            &dir,
            &format!("bound ref.ply {low} --switch-deg 0"),
        ));
        assert!(output.contains(said), "{output}");
    }
    let said = expect(&dir, 2, &within("1e-300"));
    assert!(said.contains("1e-300") && said.len() < 300, "{said}");
}
