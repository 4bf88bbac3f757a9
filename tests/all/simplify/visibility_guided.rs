//! Visibility-guided simplification: the vectors, the quadric method, hidden parts, replay.

use glam::DVec3;
use lodmark::{
    Error, Silent,
    collapse::{EdgeStar, Engine, LiveMesh, Method, MethodScratch, Rules, Schedule, Site},
    mesh::{Mesh, canonical, generate},
    simplify::{
        MethodOptions, Normals, Options, Replay, Target, Topology,
        quadric::{QuadricMethod, QuadricOptions, Weighting},
        simplify, simplify_guided,
        visibility::{VisibilityMethod, VisibilityOptions},
    },
    visibility::{self, measure},
};
use proptest::prelude::*;

use crate::{
    simplify::memoryless::{interior, star},
    support::{Random, collapse, expect, folder, live, meshes, put, same_on_all_threads},
};

/// Random visibilities, a third of them 0.
fn scattered(count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random(seed);
    (0..count)
        .map(|_| (random.unit() * 1.5 - 0.5).max(0.0))
        .collect()
}

/// The guided method on a mesh.
fn guided(mesh: &Mesh, options: &VisibilityOptions, visibility: &[f64]) -> VisibilityMethod {
    VisibilityMethod::new(&live(mesh), options, visibility).expect("as many, in range")
}

/// The method without visibility.
fn plain(mesh: &Mesh) -> QuadricMethod {
    QuadricMethod::new(&live(mesh), &QuadricOptions::default())
}

fn engine(mesh: &Mesh) -> Engine {
    Engine::new(live(mesh), Rules::default(), Schedule::Semi)
}

fn reduced(mesh: &Mesh, mut method: impl Method, triangles: usize) -> Mesh {
    let mut engine = engine(mesh);
    collapse(&mut engine, &mut method, triangles);
    engine.live().to_mesh().expect("valid")
}

#[test]
fn an_edge_is_placed_without_visibility_and_priced_with_its_square() {
    // visibility_guided.quadric: a quarter is seen of the faces at w.
    let live = interior(false);
    let at_w = |t| live.triangle(t).is_some_and(|corners| corners.contains(&1));
    let seen = (0..live.triangle_ids()).map(|t| if at_w(t) { 0.25 } else { 1.0 });
    let visibility: Vec<f64> = seen.collect();
    let options = VisibilityOptions {
        quadric: QuadricOptions {
            weighting: Weighting::Unit,
            // The star's outer edges are boundaries of the test's mesh, not of the vector's.
            boundary_weight: 0.0,
            ..QuadricOptions::default()
        },
        tie_weight: 0.0,
        ..VisibilityOptions::default()
    };
    let (e_q, e_v) = (0.054_011_934_252_198_86, 0.009_573_026_642_192_707);
    for (tie_weight, cost) in [(0.0, e_v), (1e-6, e_v + 1e-6 * e_q), (1.0, e_v + e_q)] {
        let options = VisibilityOptions {
            tie_weight,
            ..options.clone()
        };
        let method = VisibilityMethod::new(&live, &options, &visibility).expect("ten of them");
        let star: EdgeStar = star(&live, 0, 1);
        let site = Site::new(&live, &star, Rules::default()).expect("legal");
        let mut scratch = MethodScratch::default();
        let proposal = method.propose(&site, &mut scratch);
        let proposal = proposal.expect("legal");
        let v = [
            -0.026_137_273_713_825_21,
            0.013_314_889_780_954_322,
            0.251_220_690_836_399_3,
        ];
        for (found, expected) in proposal.position.position().to_array().into_iter().zip(v) {
            assert!((found - expected).abs() < 1e-11, "{found}, not {expected}");
        }
        let found = proposal.secondary;
        assert!((found - cost).abs() < 1e-12, "{found} instead of {cost}");
        assert_eq!(proposal.primary, 0);
    }
}

#[test]
fn visibilities_that_fit_no_triangle_or_no_share_are_refused() {
    let live = live(&meshes::grid(3, 1));
    for wrong in [vec![1.0; 17], vec![1.0; 19], vec![]] {
        let error = VisibilityMethod::new(&live, &VisibilityOptions::default(), &wrong);
        let text = error.expect_err("18 triangles").to_string();
        assert!(text.contains("for 18 triangles"), "{text}");
    }
    for wrong in [-0.1, 1.5, f64::NAN, f64::INFINITY] {
        let mut visibility = vec![0.5; 18];
        visibility[7] = wrong;
        let error = VisibilityMethod::new(&live, &VisibilityOptions::default(), &visibility);
        let text = error.expect_err("out of range").to_string();
        let named = text.contains("triangle 7") && text.contains("0 to 1");
        assert!(named, "{text}");
    }
}

/// Mean squared distance of the vertices with `|p| > 0.75` from the unit sphere, and the triangles out there.
fn outside(mesh: &Mesh) -> (f64, usize) {
    let far = |t: &usize| mesh.corners(*t).iter().all(|p| p.length() > 0.75);
    let triangles: Vec<usize> = (0..mesh.triangles().len()).filter(far).collect();
    let deviation = |t: &usize| {
        let [a, b, c] = mesh.corners(*t);
        let d = 1.0 - ((a + b + c) / 3.0).length();
        d * d
    };
    let sum: f64 = triangles.iter().map(deviation).sum();
    (sum / triangles.len() as f64, triangles.len())
}

#[test]
fn what_nobody_sees_goes_first_and_the_rest_keeps_its_shape() {
    let mesh = canonical(&generate::shells(2, 2)).mesh;
    let visibility: Vec<f64> = (0..mesh.triangles().len())
        .map(|t| f64::from(u8::from(mesh.corners(t)[0].length() > 0.75)))
        .collect();
    let target = 330;
    let guided = guided(&mesh, &VisibilityOptions::default(), &visibility);
    let guided = reduced(&mesh, guided, target);
    let plain = reduced(&mesh, plain(&mesh), target);
    let [guided, plain] = [guided, plain].map(|mesh| outside(&mesh));
    assert_eq!(guided.1, 320, "the outer sphere has not lost a triangle");
    assert!(plain.1 < 300, "{plain:?}");
    assert!(guided.0 < 0.7 * plain.0, "{guided:?} {plain:?}");
}

/// Down to so many triangles, by six cameras.
fn options(triangles: u64) -> Options {
    let own = VisibilityOptions {
        measure: visibility::MeasureOptions {
            octahedron: 0,
            size: 48,
            ..visibility::MeasureOptions::default()
        },
        ..VisibilityOptions::default()
    };
    Options::new(own, Target::triangles(triangles))
}

#[test]
fn options_out_of_range_are_refused_by_name() {
    let mesh = generate::icosphere(1);
    type Fault = fn(&mut VisibilityOptions);
    let faults: [(&str, Fault); 4] = [
        ("tie-weight", |own| own.tie_weight = -1.0),
        ("tie-weight", |own| own.tie_weight = f64::NAN),
        ("octahedron", |own| own.measure.octahedron = 9),
        ("boundary-weight", |own| own.quadric.boundary_weight = -1.0),
    ];
    for (said, fault) in faults {
        let mut wrong = VisibilityOptions::default();
        fault(&mut wrong);
        let options = Options::new(wrong, Target::triangles(9));
        let error = simplify(&mesh, &options).expect_err("out of range");
        assert!(matches!(error, Error::Usage(_)), "{error}");
        assert!(error.to_string().contains(said), "{error}");
    }
}

#[test]
fn a_visibility_measured_before_guides_as_one_measured_now() {
    let mesh = canonical(&generate::shells(2, 1)).mesh;
    let options = options(60);
    let MethodOptions::Visibility(own) = &options.method else {
        panic!("{options:?}");
    };
    let direct = simplify(&mesh, &options).expect("runs");
    let before = measure(&mesh, &own.measure, &Silent).expect("measures");
    // Whatever the options say: what was measured is what counts and what is recorded.
    let asked = Options::visibility(Target::Triangles(60));
    let guided = simplify_guided(&mesh, &asked, &before, &Silent).expect("runs");
    assert_eq!(guided.mesh, direct.mesh);
    assert_eq!(guided.options, direct.options);
    assert_eq!(guided.history, direct.history);
    assert_eq!(guided.v_mesh(), Some(before.mesh()));
    let text = serde_json::to_string(&guided.options).expect("JSON");
    let read: Options = serde_json::from_str(&text).expect("read back");
    // A mesh without normals carries none.
    assert_eq!(read, options.normals(Normals::Carry));
    let quadric = Options::quadric(Target::Triangles(60));
    let other = simplify_guided(&mesh, &quadric, &before, &Silent);
    assert!(matches!(other, Err(Error::Usage(_))));
    let mesh = generate::icosphere(1);
    let other = simplify_guided(&mesh, &asked, &before, &Silent);
    assert!(matches!(other, Err(Error::Usage(_))));
}

#[test]
fn every_level_of_a_guided_run_is_the_direct_run_to_it() {
    // What is repaired after the last collapse belongs to the level where the run ended.
    // And what gives way depends on the target from the start.
    let preserved = |o: Options| o.topology(Topology::Preserve);
    let options = |triangles| preserved(options(triangles).keep_folds());
    for kind in [0, 1, 3, 4] {
        let mesh = meshes::any(kind, 7);
        let outcome = simplify(&mesh, &options(4)).expect("runs");
        let mut replay = Replay::new(&mesh, &outcome.history).expect("the same mesh");
        for share in [0.3, 0.8, 0.5] {
            let triangles = (mesh.triangles().len() as f64 * share) as u64;
            replay.seek(triangles as usize).expect("fits");
            let direct = simplify(&mesh, &options(triangles)).expect("runs");
            let replayed = replay.live().to_mesh().expect("a mesh");
            assert_eq!(replayed, direct.mesh, "{kind} {share}");
        }
    }
}

proptest! {
    #![proptest_config(crate::support::cases(16))]

    #[test]
    fn where_all_is_seen_alike_it_is_the_quadric_method(kind in 0_usize..8, seed: u64, share in 0.2..0.9) {
        // With a power of two, and no second term, not a bit of the order changes.
        let mesh = meshes::any(kind, seed);
        let target = (mesh.triangles().len() as f64 * share) as usize;
        let expected = reduced(&mesh, plain(&mesh), target);
        for v in [1.0, 0.5] {
            let options = VisibilityOptions { tie_weight: 0.0, ..VisibilityOptions::default() };
            let visibility = vec![v; mesh.triangles().len()];
            prop_assert_eq!(&reduced(&mesh, guided(&mesh, &options, &visibility), target), &expected);
        }
        // Where nothing is seen the second term alone decides.
        let options = VisibilityOptions { tie_weight: 0.25, ..VisibilityOptions::default() };
        let visibility = vec![0.0; mesh.triangles().len()];
        prop_assert_eq!(&reduced(&mesh, guided(&mesh, &options, &visibility), target), &expected);
    }

    #[test]
    fn both_quadrics_are_sums_over_all_that_a_vertex_swallowed(kind in 0_usize..8, seed: u64) {
        // The quadrics of all vertices together never change, and neither do those of the vertices that are left.
        let mesh = meshes::any(kind, seed);
        let visibility = scattered(mesh.triangles().len(), seed ^ 1);
        let mut method = guided(&mesh, &VisibilityOptions::default(), &visibility);
        let mut engine = engine(&mesh);
        let probe = DVec3::new(0.3, -0.2, 0.1);
        let total = |live: &LiveMesh, method: &VisibilityMethod| {
            let alive = (0..live.vertex_ids()).filter(|&v| live.edges_at(v).next().is_some());
            alive.fold([0.0; 2], |[q, v], vertex| [
                q + method.placing().quadric(vertex).error(probe),
                v + method.ordering().quadric(vertex).error(probe),
            ])
        };
        let before = total(engine.live(), &method);
        for share in [0.8, 0.5] {
            let triangles = (mesh.triangles().len() as f64 * share) as usize;
            collapse(&mut engine, &mut method, triangles);
            // A vertex that lost its last face took its quadric along; only closed surfaces keep all.
            if matches!(kind, 1 | 4 | 5 | 6) {
                for (before, after) in before.into_iter().zip(total(engine.live(), &method)) {
                    prop_assert!((before - after).abs() <= 1e-9 * before, "{before} {after}");
                }
            }
        }
    }

    #[test]
    fn the_number_of_threads_changes_no_bit(kind in 0_usize..8, seed: u64, share in 0.1..0.9) {
        let mesh = meshes::any(kind, seed);
        let visibility = scattered(mesh.triangles().len(), seed ^ 2);
        let triangles = (mesh.triangles().len() as f64 * share) as usize;
        same_on_all_threads(|| {
            reduced(&mesh, guided(&mesh, &VisibilityOptions::default(), &visibility), triangles)
        });
    }
}

#[test]
fn the_command_takes_the_visibility_from_a_file_and_refuses_that_of_another_mesh() {
    let dir = folder();
    put(&dir, "in.ply", &generate::shells(2, 2));
    put(&dir, "other.ply", &generate::shells(2, 1));
    let measure = "visibility in.ply --cameras 18 --size 64 --partial counts.bin";
    expect(&dir, 0, measure);
    let simplify = |input: &str, more: &str, exit: i32| {
        let words = "out.ply -t 330 --method visibility --json report.json --history history.bin";
        expect(&dir, exit, &format!("simplify {input} {words} {more}"))
    };
    let files = || {
        ["out.ply", "report.json", "history.bin"]
            .map(|name| std::fs::read(dir.path().join(name)).expect("written"))
    };
    simplify("in.ply", "--visibility counts.bin", 0);
    let from_file = files();
    simplify("in.ply", "--cameras 18 --visibility-size 64", 0);
    assert_eq!(files(), from_file, "measured before or now");
    let report: serde_json::Value = serde_json::from_slice(&from_file[1]).expect("JSON");
    assert_eq!(report["options"]["method"]["measure"]["octahedron"], 1);
    let v_mesh = report["v_mesh"].as_f64();
    assert!(v_mesh.is_some_and(|v| v > 0.5 && v < 0.95));
    let said = simplify("other.ply", "--visibility counts.bin", 3);
    let named = said.contains("counts.bin") && said.contains("another mesh");
    assert!(named, "{said}");
    std::fs::write(dir.path().join("counts.bin"), b"LODMVISI").expect("writes");
    let said = simplify("in.ply", "--visibility counts.bin", 3);
    assert!(said.contains("counts.bin"), "{said}");
    simplify("in.ply", "--visibility counts.bin --cameras 6", 2);
    let words = "simplify in.ply out.ply -t 9 --method quadric --cameras 6";
    assert!(expect(&dir, 2, words).contains("--cameras"));
}
