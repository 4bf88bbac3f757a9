//! Pictures of two meshes over a set of views, compared.
#![expect(
    clippy::disallowed_methods,
    reason = "units are chosen without the crate's own functions"
)]

use glam::DVec3;
use lodmark::{
    Error, Silent,
    mesh::{Mesh, generate},
    metric::{
        appearance::{Appearance, appearance, pictures},
        luma::{SquaredError, ViewErrors},
    },
    num::Frame,
    raster::{self, Scene},
    view::{Cull, Interpolation, Shading, Sphere, ViewSet, frame_of, sets},
};
use proptest::prelude::*;

use crate::support::{Impatient, Random, meshes::with_normals, same_on_all_threads, scene_of};

/// Small views around a mesh, in its units.
fn views(mesh: &Mesh, size: u32, samples: u32) -> ViewSet {
    let sphere = Sphere::of_mesh(mesh).expect("triangles");
    let directions = &sets::rhombicuboctahedron()[..6];
    let set = ViewSet::around(&sphere, directions, size, size, Default::default());
    set.expect("views").with_samples(samples).expect("allowed")
}

/// `mesh` with every vertex moved by up to `by`, each its own way.
pub(crate) fn shaken(mesh: &Mesh, by: f64) -> Mesh {
    let mut random = Random::new(7, 1);
    let mut moved = || (random.unit() - 0.5) * 2.0 * by;
    let moved = |&p: &DVec3| p + DVec3::new(moved(), moved(), moved());
    let positions = mesh.positions().iter().map(moved).collect();
    Mesh::from_triangles(positions, mesh.triangles().to_vec()).expect("the same triangles")
}

fn judge(reference: &Mesh, candidate: &Mesh, views: &ViewSet) -> Appearance {
    let scenes = [scene_of(candidate)];
    let mut found = appearance(&scene_of(reference), &scenes, views, &Silent).expect("finite");
    found.pop().expect("one for the candidate")
}

/// The squared error of one shading over all views, sample by sample: the pixel is a sum of samples.
fn by_hand(a: &Mesh, b: &Mesh, views: &ViewSet, shading: Interpolation) -> Vec<u64> {
    let mut views = views.clone();
    for view in &mut views.views {
        view.shading.interpolation = shading;
    }
    let squares = |view| {
        let a = raster::luma(&scene_of(a), view, &views).tones;
        let b = raster::luma(&scene_of(b), view, &views).tones;
        let mut sum = 0;
        for y in 0..views.height {
            for x in 0..views.width {
                let mut difference = 0_i64;
                for i in 0..views.samples * views.samples {
                    let (dx, dy) = (i % views.samples, i / views.samples);
                    let (sx, sy) = (x * views.samples + dx, y * views.samples + dy);
                    difference += i64::from(a.at(sx, sy)) - i64::from(b.at(sx, sy));
                }
                sum += difference * difference;
            }
        }
        sum as u64
    };
    views.views.iter().map(squares).collect()
}

fn sums(errors: &ViewErrors) -> Vec<u64> {
    errors.views().iter().map(|e| e.sum).collect()
}

proptest! {
    #![proptest_config(crate::support::cases(12))]

    #[test]
    fn every_view_is_compared_sample_by_sample_in_both_shadings(
        by in 0.001_f64..0.3, samples in prop::sample::select(vec![1_u32, 2, 4]), two_sided: bool, front: bool,
    ) {
        let mesh = generate::torus(1.0, 0.4, 12, 8);
        let other = shaken(&mesh, by);
        let cull = if front { Cull::Front } else { Cull::None };
        let views = views(&mesh, 24, samples)
            .with_cull(cull)
            .with_shading(Shading { two_sided, ..Shading::default() });
        let found = judge(&mesh, &other, &views);
        prop_assert_eq!(sums(&found.flat), by_hand(&mesh, &other, &views, Interpolation::Flat));
        prop_assert_eq!(sums(&found.gouraud), by_hand(&mesh, &other, &views, Interpolation::Gouraud));
        prop_assert_eq!(found.flat.total().pixels, 6 * 24 * 24);
        prop_assert_eq!(found.flat.total().samples, samples * samples);
    }

    #[test]
    fn a_mesh_in_other_units_looks_exactly_as_different(exponent in -100_i32..100, by in 0.01_f64..0.2) {
        let mesh = generate::icosphere(2);
        let other = shaken(&mesh, by);
        let judged = |scale: f64| {
            let scaled = |mesh: &Mesh| {
                let positions = mesh.positions().iter().map(|&p| p * scale).collect();
                let mut parts = mesh.clone().into_parts();
                (parts.positions, parts.precision) = (positions, lodmark::num::Precision::F64);
                Mesh::new(parts).expect("finite")
            };
            let (mesh, other) = (scaled(&mesh), scaled(&other));
            let frame = frame_of(&mesh);
            let views = views(&mesh, 32, 2).enter_frame(frame);
            let [mesh, other] = [mesh, other].map(|m| m.enter_frame(frame).in_frame_units().clone());
            judge(&mesh, &other, &views)
        };
        prop_assert_eq!(judged(2.0_f64.powi(exponent)), judged(1.0));
    }
}

#[test]
fn stored_normals_are_compared_where_both_meshes_have_some() {
    let radial = |mesh: &Mesh| with_normals(mesh, |_, p, _| Some(p));
    let [fine, coarse] = [3, 2].map(generate::icosphere);
    let views = views(&fine, 24, 2);
    let (a, b) = (radial(&fine), radial(&coarse));
    let scenes = [&b, &coarse, &a].map(scene_of);
    let found = appearance(&scene_of(&a), &scenes, &views, &Silent).expect("finite");
    let lit = found[0].lit.as_ref().expect("both have normals");
    assert_eq!(sums(lit), by_hand(&a, &b, &views, Interpolation::Lit));
    assert!(found[1].lit.is_none(), "the candidate has none");
    let same = found[2].lit.as_ref().expect("both have normals");
    assert!(same.total().is_zero());
    let plain = judge(&fine, &b, &views);
    assert!(plain.lit.is_none(), "the reference has none");
    // The normals are no matter of the other shadings, nor of who else is judged.
    assert_eq!(
        (&plain.flat, &plain.gouraud),
        (&found[0].flat, &found[0].gouraud)
    );
    assert_eq!(judge(&a, &b, &views), found[0]);
}

#[test]
fn no_number_of_threads_changes_a_judgement() {
    // More triangles than the rasterizer draws in one piece.
    let mesh = generate::torus(1.0, 0.4, 256, 80);
    let scenes = [shaken(&mesh, 0.01), generate::icosphere(2)].map(|m| scene_of(&m));
    let (reference, views) = (scene_of(&mesh), views(&mesh, 48, 2));
    let judged = || appearance(&reference, &scenes, &views, &Silent).expect("finite");
    let one = same_on_all_threads(judged);
    // Candidates that are judged together do not see each other.
    for (scene, found) in scenes.iter().zip(&one) {
        let alone = appearance(&reference, std::slice::from_ref(scene), &views, &Silent);
        assert_eq!(alone.expect("finite"), std::slice::from_ref(found));
    }
}

#[test]
fn the_worst_picture_is_the_first_largest_and_flat_before_gouraud() {
    let errors = |sums: &[u64]| {
        let error = |&sum: &u64| SquaredError {
            sum,
            pixels: 10,
            samples: 4,
        };
        ViewErrors::new(sums.iter().map(error).collect()).expect("views")
    };
    for (flat, gouraud, view, shading) in [
        ([1, 5, 5], [5, 0, 0], 1, Interpolation::Flat),
        ([1, 5, 5], [0, 0, 6], 2, Interpolation::Gouraud),
        ([0, 0, 0], [0, 0, 0], 0, Interpolation::Flat),
    ] {
        let (flat, gouraud) = (errors(&flat), errors(&gouraud));
        let mut look = Appearance {
            flat,
            gouraud,
            lit: None,
        };
        let worst = look.worst();
        assert_eq!((worst.view, worst.shading), (view, shading));
        look.lit = Some(errors(&[0, 5, 7]));
        let worst = look.worst();
        assert_eq!((worst.view, worst.shading), (2, Interpolation::Lit));
    }
}

#[test]
fn the_pictures_of_a_view_are_those_that_were_compared() {
    let mesh = generate::cube();
    let other = shaken(&mesh, 0.2);
    let views = views(&mesh, 40, 1);
    let found = judge(&mesh, &other, &views);
    let worst = found.worst();
    let scenes = [&scene_of(&mesh), &scene_of(&other)];
    let [a, b] = pictures(scenes, &views, worst.view, worst.shading).expect("a view");
    let pairs = a.values().iter().zip(b.values());
    let squares = pairs.map(|(&a, &b)| u64::from(a.abs_diff(b)).pow(2));
    assert_eq!(squares.sum::<u64>(), worst.error.sum);
    let missing = pictures(scenes, &views, 6, Interpolation::Flat);
    assert!(matches!(missing, Err(Error::Usage(_))));
}

#[test]
fn a_vertex_out_of_this_world_is_refused_with_a_hint_at_units() {
    let mesh = generate::icosphere(1);
    let views = views(&mesh, 16, 1);
    let far = mesh.enter_frame(Frame { exponent: -2_000 });
    let refused = appearance(&scene_of(&mesh), &[Scene::of(&far)], &views, &Silent);
    let Err(Error::Unsupported(message)) = refused else {
        panic!("{refused:?}");
    };
    assert!(message.contains("units"), "{message}");
}

#[test]
fn an_interruption_ends_a_judgement() {
    let mesh = generate::cube();
    let scene = scene_of(&mesh);
    let (scenes, views) = (std::slice::from_ref(&scene), views(&mesh, 16, 1));
    let found = appearance(&scene, scenes, &views, &Impatient);
    assert!(matches!(found, Err(Error::Interrupted)));
}
