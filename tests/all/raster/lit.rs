//! Stored normals in pictures: what corners with and without one look like.

use glam::DVec3;
use lodmark::{
    mesh::{Mesh, generate},
    raster::{self, Grid, Scene},
    view::{Cull, Interpolation, Projection, Shading, Sphere, ViewSet},
};

use crate::support::{meshes::with_normals, scene_of};

const DIRECTIONS: [DVec3; 3] = [
    DVec3::new(0.8, 0.5, 1.0),
    DVec3::new(-0.7, 0.4, -0.5),
    DVec3::new(0.4, -0.9, 0.6),
];

fn views(mesh: &Mesh, projection: Projection, interpolation: Interpolation) -> ViewSet {
    let sphere = Sphere::of_mesh(mesh).expect("triangles");
    let set = ViewSet::around(&sphere, &DIRECTIONS, 64, 64, projection);
    set.expect("views").with_shading(Shading {
        interpolation,
        ..Shading::default()
    })
}

/// The luma of every view.
fn drawn(scene: &Scene, mesh: &Mesh, projection: Projection, by: Interpolation) -> Vec<Grid<u8>> {
    let set = views(mesh, projection, by);
    let views = set.views.iter();
    views.map(|v| raster::luma(scene, v, &set).tones).collect()
}

/// The largest difference of two sets of pictures, in levels.
fn largest(a: &[Grid<u8>], b: &[Grid<u8>]) -> u8 {
    let pairs = a.iter().zip(b);
    let pixels = pairs.flat_map(|(a, b)| a.values().iter().zip(b.values()));
    pixels.map(|(&a, &b)| a.abs_diff(b)).max().expect("pixels")
}

#[test]
fn a_sphere_with_radial_normals_is_lit_as_gouraud_shades_it() {
    // By symmetry the area-weighted normals of these two are radial; those of the third nearly.
    for (subdivisions, levels) in [(0, 1), (1, 1), (3, 4)] {
        let plain = generate::icosphere(subdivisions);
        let radial = with_normals(&plain, |_, p, _| Some(p));
        let perspective = Projection::Perspective;
        let lit = drawn(&scene_of(&radial), &plain, perspective, Interpolation::Lit);
        let smooth = drawn(
            &scene_of(&plain),
            &plain,
            perspective,
            Interpolation::Gouraud,
        );
        assert!(largest(&lit, &smooth) <= levels, "{subdivisions}");
        let flat = drawn(&scene_of(&plain), &plain, perspective, Interpolation::Flat);
        assert!(largest(&lit, &flat) > levels, "{subdivisions}");
    }
}

#[test]
fn faces_with_their_own_normals_under_light_from_afar_are_lit_as_if_flat() {
    for plain in [generate::cube(), generate::torus(1.0, 0.4, 12, 8)] {
        let hard = with_normals(&plain, |_, _, own| Some(own));
        let afar = Projection::Orthographic;
        let lit = drawn(&scene_of(&hard), &plain, afar, Interpolation::Lit);
        let flat = drawn(&scene_of(&plain), &plain, afar, Interpolation::Flat);
        assert_eq!(lit, flat);
    }
}

#[test]
fn a_cube_with_hard_normals_is_smooth_within_its_sides_only() {
    let cube = generate::cube();
    let scene = scene_of(&cube);
    assert!(!scene.stored_normals().is_empty(), "the cube stores them");
    let set = views(&cube, Projection::Perspective, Interpolation::Lit);
    let set = set.with_cull(Cull::Back);
    for view in &set.views {
        let picture = raster::luma(&scene, view, &set);
        let ids = raster::ids(&picture);
        let mut jumps = 0;
        for (y, x) in (0..64).flat_map(|y| (1..64).map(move |x| (y, x))) {
            let [a, b] = [ids.at(x - 1, y), ids.at(x, y)];
            if a == 0 || b == 0 {
                continue;
            }
            let step = picture.tones.at(x, y).abs_diff(picture.tones.at(x - 1, y));
            // Two triangles make a side.
            if (a - 1) / 2 == (b - 1) / 2 {
                assert!(step <= 10, "{step} between {a} and {b}");
            } else {
                jumps += u32::from(step > 12);
            }
        }
        assert!(jumps > 10, "sides differ: {jumps}");
    }
}

#[test]
fn a_normal_that_is_missing_or_has_no_direction_is_its_faces_own() {
    let plain = generate::torus(1.0, 0.4, 12, 8);
    let of = |scene: &Scene| drawn(scene, &plain, Projection::Perspective, Interpolation::Lit);
    let own = of(&scene_of(&with_normals(&plain, |_, _, own| Some(own))));
    for vague in [
        None,
        Some(DVec3::ZERO),
        Some(DVec3::new(0.0, f64::NAN, 1.0)),
        Some(DVec3::splat(1e300)),
        Some(DVec3::splat(1e-300)),
    ] {
        let scene = scene_of(&with_normals(&plain, |_, _, _| vague));
        assert!(
            scene
                .stored_normals()
                .iter()
                .flatten()
                .all(|n| *n == DVec3::ZERO)
        );
        assert!(of(&scene) == own, "{vague:?}");
    }
    assert!(
        of(&scene_of(&plain)) == own,
        "no channel is all of them missing"
    );
    // One corner alone.
    let some = with_normals(&plain, |corner, p, own| match corner % 4 {
        0 => None,
        1 => Some(own),
        _ => Some(p),
    });
    let filled = with_normals(&plain, |corner, p, own| match corner % 4 {
        0 | 1 => Some(own),
        _ => Some(p),
    });
    assert!(of(&scene_of(&some)) == of(&scene_of(&filled)));
}

#[test]
fn the_length_and_the_sign_of_a_normal_change_nothing() {
    let plain = generate::icosphere(2);
    let of = |scale: f64| {
        let mesh = with_normals(&plain, |_, p, _| {
            Some((p + DVec3::new(0.1, 0.0, 0.2)) * scale)
        });
        drawn(
            &scene_of(&mesh),
            &plain,
            Projection::Perspective,
            Interpolation::Lit,
        )
    };
    for scale in [-1.0, 4.0, 0.125] {
        assert!(of(scale) == of(1.0), "{scale}: two-sided, made unit");
    }
}
