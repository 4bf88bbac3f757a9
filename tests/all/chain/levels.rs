//! The levels of a chain: which sizes they have, and that none is worse than a run of its own.

use lodmark::{
    Error, Mesh, Options, Preset, Silent, Target,
    chain::{Chain, Levels, Screen, chain, chain_with},
    mesh::generate,
    num::math::sqrt,
    options::{MeasureOptions, Topology, VisibilityOptions},
    simplify, views,
};

use crate::support::{Impatient, same_on_all_threads};

/// Levels that are judged quickly.
fn quick(levels: Levels) -> Levels {
    levels.screen(Screen::new(64, 60.0)).judged(48, 500)
}

fn counts(chain: &Chain) -> Vec<usize> {
    let levels = chain.levels.iter();
    levels.map(|level| level.mesh.triangles().len()).collect()
}

fn share(share: f64) -> Target {
    Target::ratio(share)
}

#[test]
fn every_level_is_bit_for_bit_a_run_of_its_own() {
    let mesh = lodmark::mesh::canonical(&generate::torus(1.0, 0.4, 12, 8)).mesh;
    let any = Target::triangles(1);
    let measure = MeasureOptions {
        octahedron: 0,
        size: 32,
        ..MeasureOptions::default()
    };
    let guided = VisibilityOptions {
        measure,
        ..VisibilityOptions::default()
    };
    for options in [
        Options::image(any).preset(Preset::Fast).size(24),
        Options::quadric(any),
        Options::new(guided, any),
    ] {
        let levels = quick(Levels::targets([share(0.25), Target::triangles(30)]));
        let found = chain(&mesh, &options, &levels).expect("levels");
        assert_eq!(found.levels[0].mesh, mesh);
        assert!(found.levels[0].options.is_none());
        for level in &found.levels[1..] {
            let target = Target::triangles(level.target as u64);
            let own = simplify(&mesh, &options.clone().target(target)).expect("a run");
            assert_eq!(level.mesh, own.mesh, "{}", options.method.name());
            assert_eq!(level.options.as_ref(), Some(&own.options));
        }
        assert_eq!(counts(&found), [192, 48, 30]);
    }
}

#[test]
fn no_number_of_threads_changes_a_chain() {
    let mesh = lodmark::mesh::canonical(&generate::torus(1.0, 0.4, 10, 6)).mesh;
    same_on_all_threads(|| {
        let levels = quick(Levels::targets([share(0.5), share(0.2)])).certify();
        let options = Options::quadric(share(1.0));
        let found = chain(&mesh, &options, &levels).expect("levels");
        let levels = found.levels.into_iter();
        levels
            .map(|level| (level.mesh, format!("{:?}", level.report)))
            .collect::<Vec<_>>()
    });
}

/// The area that only one of two meshes covers, as a share of that of the first: one by one, in 24 views.
fn silhouette_error(original: &Mesh, level: &Mesh, size: u32) -> f64 {
    let render = |mesh: &Mesh, around: &Mesh| {
        let sphere = lodmark::view::Sphere::of_mesh(around).expect("triangles");
        let directions = lodmark::view::sets::rhombicuboctahedron();
        let projection = views::Projection::Perspective;
        let set = views::ViewSet::around(&sphere, &directions, size, size, projection);
        let set = set.and_then(|set| set.with_samples(2)).expect("views");
        let frame = lodmark::num::Frame::default();
        let scene = lodmark::raster::Scene::of(&mesh.enter_frame(frame));
        let shown = |view| lodmark::raster::keys(&scene, view, &set).keys;
        set.views.iter().map(shown).collect::<Vec<_>>()
    };
    let (a, b) = (render(original, original), render(level, original));
    let (mut covered, mut differing) = (0, 0);
    for (a, b) in a.iter().zip(&b) {
        for (a, b) in a.values().iter().zip(b.values()) {
            covered += usize::from(!a.is_background());
            differing += usize::from(a.is_background() != b.is_background());
        }
    }
    differing as f64 / covered as f64
}

#[test]
fn halving_ends_where_the_silhouette_would_err_by_more_than_5_percent() {
    let mesh = lodmark::mesh::canonical(&generate::icosphere(2)).mesh;
    let options = Options::quadric(share(1.0));
    let found = chain(&mesh, &options, &quick(Levels::halving())).expect("levels");
    let counts = counts(&found);
    assert!(counts.len() > 2, "{counts:?}");
    for (pair, level) in counts.windows(2).zip(&found.levels[1..]) {
        assert_eq!(pair[1], pair[0].div_ceil(2));
        let error = silhouette_error(&mesh, &level.mesh, 48);
        assert!((error - level.report.silhouette_error).abs() < 1e-12);
        assert!(error <= 0.05, "{counts:?}: {error}");
    }
    let last = *counts.last().expect("levels");
    let next = Target::triangles(last.div_ceil(2) as u64);
    let next = simplify(&mesh, &options.target(next)).expect("a run");
    let error = silhouette_error(&mesh, &next.mesh, 48);
    assert!(last == 8 || error > 0.05, "{counts:?}, then {error}");
}

#[test]
fn halving_ends_at_8_triangles_where_the_silhouette_stays() {
    // A flat sheet loses nothing.
    let mesh = lodmark::mesh::canonical(&generate::grid(6, 6, generate::Height::Flat)).mesh;
    let options = Options::memoryless(share(1.0));
    let found = chain(&mesh, &options, &quick(Levels::halving())).expect("levels");
    assert_eq!(counts(&found), [72, 36, 18, 8]);
    let last = &found.levels[3].report;
    assert!(last.silhouette_error <= 0.05);
    // Nothing is measured nearer than where the sphere fills the screen: twice its radius, at 60 degrees.
    let distance = last.switch_distance.expect("shown");
    assert!(distance / found.radius > 2.0 - 1e-9, "{distance}");
}

#[test]
fn a_level_for_a_distance_is_the_coarsest_that_may_be_shown_there() {
    let mesh = lodmark::mesh::canonical(&generate::torus(1.0, 0.4, 12, 8)).mesh;
    let options = Options::memoryless(share(1.0));
    let levels = |levels: Levels| quick(levels).screen(Screen::new(40, 60.0).accept(1.0, 255.0));
    let far = [0.5, 8.0, 16.0];
    let found = chain(&mesh, &options, &levels(Levels::distances(far))).expect("levels");
    // Nearer than where the sphere fills the screen nothing can be shown but the input.
    assert_eq!(found.left_out, [0.5]);
    assert_eq!(found.levels.len(), 3);
    for (level, distance) in found.levels[1..].iter().zip(&far[1..]) {
        let switch = level.report.switch_distance.expect("shown");
        assert!(switch <= *distance, "{switch} for {distance}");
        // One step of the ladder further it may not.
        let step = (level.target as f64 / sqrt(sqrt(2.0))).ceil() as u64;
        let next = levels(Levels::targets([Target::triangles(step)]));
        let next = chain(&mesh, &options, &next).expect("a level");
        let next = next.levels[1].report.switch_distance;
        assert!(
            next.is_none_or(|next| next > *distance),
            "{next:?} for {distance}"
        );
    }
}

#[test]
fn a_level_that_cannot_be_reached_says_so() {
    let mesh = lodmark::mesh::canonical(&generate::torus(1.0, 0.4, 12, 8)).mesh;
    let options = Options::quadric(share(1.0)).topology(Topology::Preserve);
    // No torus has three triangles.
    let levels = quick(Levels::targets([Target::triangles(3)]));
    let found = chain(&mesh, &options, &levels).expect("a level");
    let level = &found.levels[1];
    assert!(level.mesh.triangles().len() > level.target);
    assert_ne!(level.stop, lodmark::Stop::TargetReached);
}

#[test]
fn plans_without_sense_are_refused_before_any_work() {
    let mesh = generate::icosphere(1);
    let options = Options::memoryless(share(1.0));
    let counts = |counts: &[u64]| Levels::targets(counts.iter().map(|&n| Target::triangles(n)));
    let screen = |screen: Screen| counts(&[40]).screen(screen);
    for (levels, told) in [
        (counts(&[]), "without levels"),
        (counts(&[80]), "the input has 80"),
        (counts(&[20, 40]), "before it has 20"),
        (counts(&[20, 20]), "before it has 20"),
        (counts(&[0]), "0 triangles"),
        (Levels::targets([share(1.5)]), "1.5"),
        (Levels::targets([Target::ErrorOnly]), "without a size"),
        (Levels::distances([]), "without levels"),
        (Levels::distances([3.0, 2.0]), "above the one before"),
        (Levels::distances([f64::NAN]), "above 0"),
        (screen(Screen::new(0, 60.0)), "screen height"),
        (screen(Screen::new(5_000, 60.0)), "3600"),
        (screen(Screen::new(100, f64::NAN)), "fov"),
        (screen(Screen::new(100, 180.0)), "fov"),
        (screen(Screen::default().accept(-1.0, 2.0)), "error-px"),
        (screen(Screen::default().accept(1.0, 256.0)), "error-rms"),
        (counts(&[40]).judged(0, 10), "pictures"),
    ] {
        let found = chain_with(&mesh, &options, &levels, &Impatient);
        match found {
            Err(Error::Usage(said)) => assert!(said.contains(told), "{said}: {told}"),
            other => panic!("{told}: {other:?}"),
        }
    }
    let limited = Options::image(share(1.0)).error_rms(3.0);
    let found = chain(&mesh, &limited, &counts(&[40]));
    assert!(matches!(found, Err(Error::Usage(said)) if said.contains("no error")));
    let empty = Mesh::from_slices(&[], &[]).expect("no triangles");
    let found = chain(&empty, &options, &Levels::halving());
    assert!(matches!(found, Err(Error::Usage(said)) if said.contains("without triangles")));
}

#[test]
fn a_chain_ends_when_it_is_interrupted() {
    let mesh = generate::icosphere(1);
    let options = Options::memoryless(share(1.0));
    let found = chain_with(&mesh, &options, &quick(Levels::halving()), &Impatient);
    assert!(matches!(found, Err(Error::Interrupted)));
    assert!(chain_with(&mesh, &options, &quick(Levels::halving()), &Silent).is_ok());
}

#[test]
fn degenerate_meshes_have_chains_or_are_refused() {
    let options = Options::memoryless(share(1.0));
    // All points on one line, and all at one place.
    let line: Vec<f32> = (0..24).flat_map(|i| [i as f32, 0.0, 0.0]).collect();
    let faces: Vec<u32> = (0..22).flat_map(|i| [i, i + 1, i + 2]).collect();
    for positions in [line, vec![1.0; 72]] {
        let mesh = Mesh::from_slices(&positions, &faces).expect("a mesh");
        for levels in [Levels::halving(), Levels::distances([1e-9, 1e9])] {
            let levels = levels.screen(Screen::new(16, 60.0)).judged(8, 50);
            // Whatever it is, it is no panic.
            let _ = chain(&mesh, &options, &levels);
        }
    }
}
