//! V(t) and V(M) themselves.

use glam::DVec3;
use lodmark::{
    Error, Silent,
    mesh::{self, Mesh, generate},
    num::{fixed::SubpixelBits, math},
    raster,
    view::{Projection, Sphere, ViewSet, frame_of, sets::octahedron},
    visibility::{Alignment, CameraWeights, MeasureOptions, UnseenRule, measure},
};
use proptest::prelude::*;

use super::{nested, small};
use crate::support::{Impatient, model, same_on_all_threads, scene_of};

/// Equation 4.3 as it is written, with pixels alone, on pictures that the raster stage draws.
fn brute_force(mesh: &Mesh, k: u32, size: u32) -> Vec<f64> {
    let frame = frame_of(mesh);
    let mesh = mesh.clone().enter_frame(frame).in_frame_units().clone();
    let sphere = Sphere::of_mesh(&mesh).expect("triangles");
    let directions = octahedron(k);
    let set =
        ViewSet::around(&sphere, &directions, size, size, Projection::Orthographic).expect("views");
    let scene = scene_of(&mesh);
    let count = mesh.triangles().len();
    let (mut seen, mut all) = (vec![0.0; count], vec![0.0; count]);
    for (view, towards) in set.views.iter().zip(&directions) {
        let ids = raster::ids(&raster::keys(&scene, view, &set));
        let mut shown = vec![false; count + 1];
        for &id in ids.values() {
            shown[id as usize] = true;
        }
        for t in 0..count {
            let [a, b, c] = mesh.corners(t);
            let weight = (b - a).cross(c - a).normalize().dot(*towards).max(0.0);
            all[t] += weight;
            if shown[t + 1] {
                seen[t] += weight;
            }
        }
    }
    seen.iter().zip(&all).map(|(s, a)| s / a).collect()
}

#[test]
fn pixels_alone_give_the_measure_of_the_equation() {
    for mesh in [
        generate::torus(1.0, 0.4, 24, 12),
        generate::interlocking_tori(16, 8),
        nested(1).0,
    ] {
        let options = MeasureOptions {
            octahedron: 1,
            size: 64,
            unseen: UnseenRule::Pixels,
            edge_limit: None,
            ..MeasureOptions::paper()
        };
        let found = measure(&mesh, &options, &Silent).expect("measures");
        let expected = brute_force(&mesh, 1, 64);
        for (t, (a, b)) in found.triangles().iter().zip(&expected).enumerate() {
            assert!((a - b).abs() < 1e-8, "triangle {t}: {a} instead of {b}");
        }
        let area = |t: usize| {
            let [a, b, c] = mesh.corners(t);
            (b - a).cross(c - a).length()
        };
        let areas: f64 = (0..expected.len()).map(area).sum();
        let weighted = |(t, v): (usize, &f64)| area(t) * v;
        let mean = expected.iter().enumerate().map(weighted).sum::<f64>() / areas;
        assert!((found.mesh() - mean).abs() < 1e-8);
    }
}

/// A square with a small one in its middle, below another square at distance 1 that faces it; the two triangles of the
/// small one come first.
fn parallel_squares(half: f64) -> Mesh {
    let inner = 0.02 * half.max(1.0);
    let ring =
        |h: f64, z: f64| [(-h, -h), (h, -h), (h, h), (-h, h)].map(|(x, y)| DVec3::new(x, y, z));
    let mut positions = Vec::new();
    positions.extend(ring(inner, 0.0));
    positions.extend(ring(half, 0.0));
    positions.extend(ring(half, 1.0));
    let mut triangles = vec![[0, 1, 2], [0, 2, 3]];
    for i in 0..4 {
        let j = (i + 1) % 4;
        triangles.extend([[i, 4 + i, 4 + j], [i, 4 + j, j]]);
    }
    triangles.extend([[8, 10, 9], [8, 11, 10]]);
    Mesh::from_triangles(positions, triangles).expect("a mesh")
}

#[test]
fn the_middle_of_a_square_under_another_sees_what_its_form_factor_leaves() {
    // Half side over gap, and 1 - the form factor from the centre to the other square.
    for (half, expected) in [
        (0.25, 0.926_522_365_187_478_7),
        (0.5, 0.760_543_529_539_226_4),
        (1.0, 0.445_873_576_020_428_1),
        (2.0, 0.168_971_499_843_262_43),
        (4.0, 0.048_575_877_414_520_41),
    ] {
        let mesh = parallel_squares(half);
        for fractional in [false, true] {
            let options = MeasureOptions {
                fractional,
                ..MeasureOptions::default()
            };
            let found = measure(&mesh, &options, &Silent).expect("measures");
            for v in &found.triangles()[..2] {
                assert!(
                    (v - expected).abs() < 0.02,
                    "half side {half}: {v} instead of {expected}"
                );
            }
        }
    }
}

#[test]
fn a_convex_shape_hides_no_part_of_itself() {
    for mesh in [
        generate::cube(),
        generate::tetrahedron(),
        generate::icosphere(2),
    ] {
        for options in [
            small(1, 64),
            MeasureOptions {
                size: 64,
                octahedron: 1,
                ..MeasureOptions::paper()
            },
        ] {
            let found = measure(&mesh, &options, &Silent).expect("measures");
            assert!(found.mesh() > 0.995, "{}", found.mesh());
            assert_eq!(found.never_seen(), 0);
        }
    }
}

#[test]
fn triangles_too_small_for_a_pixel_do_not_count_as_hidden() {
    let mesh = generate::icosphere(5);
    let with = |unseen| {
        let options = MeasureOptions {
            unseen,
            ..small(1, 40)
        };
        measure(&mesh, &options, &Silent).expect("measures").mesh()
    };
    assert!(with(UnseenRule::Pixels) < 0.2);
    assert!(with(UnseenRule::Neighbors) > 0.95);
    assert!(
        with(UnseenRule::Plane) > 0.95,
        "{}",
        with(UnseenRule::Plane)
    );
}

#[test]
fn what_lies_inside_is_not_seen_from_outside() {
    for subdivisions in [1, 4] {
        let (mesh, outer) = nested(subdivisions);
        for options in [
            small(1, 48),
            MeasureOptions {
                fractional: true,
                ..small(1, 48)
            },
        ] {
            let found = measure(&mesh, &options, &Silent).expect("measures");
            for (t, &outer) in outer.iter().enumerate() {
                assert_eq!(found.views()[t] > 0, outer, "triangle {t}");
                assert_eq!(found.triangles()[t] > 0.0, outer, "triangle {t}");
            }
            let hidden = outer.iter().filter(|&&o| !o).count();
            assert_eq!(found.never_seen(), hidden);
            assert!(found.never_seen_area() > 0.1 && found.never_seen_area() < 0.5);
        }
    }
}

#[test]
fn a_large_triangle_is_not_visible_as_a_whole_where_a_corner_of_it_is() {
    // A lid over half of a square: whole triangles are "seen" from everywhere.
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let positions = vec![
        p(-1.0, -1.0, 0.0),
        p(1.0, -1.0, 0.0),
        p(1.0, 1.0, 0.0),
        p(-1.0, 1.0, 0.0),
        p(-1.0, -1.0, 0.01),
        p(0.0, -1.0, 0.01),
        p(0.0, 1.0, 0.01),
        p(-1.0, 1.0, 0.01),
    ];
    let triangles = vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
    let mesh = Mesh::from_triangles(positions, triangles).expect("a mesh");
    let square = |options: MeasureOptions| {
        let found = measure(&mesh, &options, &Silent).expect("measures");
        (found.triangles()[0] + found.triangles()[1]) / 2.0
    };
    let whole = MeasureOptions {
        edge_limit: None,
        ..small(2, 200)
    };
    assert!(square(whole) > 0.95, "{}", square(whole));
    for better in [
        small(2, 200),
        MeasureOptions {
            fractional: true,
            ..whole
        },
    ] {
        assert!((square(better) - 0.5).abs() < 0.04, "{}", square(better));
    }
}

#[test]
fn a_part_of_a_triangle_counts_no_more_than_all_of_it() {
    let mesh = generate::interlocking_tori(16, 8);
    let options = small(1, 64);
    let fractional = MeasureOptions {
        fractional: true,
        ..options
    };
    let all = measure(&mesh, &options, &Silent).expect("measures");
    let parts = measure(&mesh, &fractional, &Silent).expect("measures");
    let pairs = || all.triangles().iter().zip(parts.triangles());
    assert!(pairs().all(|(a, p)| p <= a));
    assert!(pairs().any(|(a, p)| *p < a - 0.05));
    assert_eq!(all.views(), parts.views());
}

proptest! {
    #![proptest_config(crate::support::cases(8))]

    #[test]
    fn the_way_a_triangle_is_turned_does_not_change_its_two_sided_visibility(flips in any::<u64>()) {
        let mesh = nested(1).0;
        let mut turned = mesh.clone().into_parts();
        for (t, corners) in turned.triangles.iter_mut().enumerate() {
            if flips.rotate_left(t as u32 % 61) & 1 == 1 {
                corners.swap(1, 2);
            }
        }
        let turned = Mesh::new(turned).expect("a mesh");
        let options = MeasureOptions { two_sided: true, ..small(1, 48) };
        let a = measure(&mesh, &options, &Silent).expect("measures");
        let b = measure(&turned, &options, &Silent).expect("measures");
        prop_assert_eq!(a.triangles(), b.triangles());
        // A closed mesh that is turned the right way needs no second side.
        let front = measure(&mesh, &small(1, 48), &Silent).expect("measures");
        for (two, one) in a.triangles().iter().zip(front.triangles()) {
            prop_assert!((two - one).abs() < 0.05, "{} and {}", two, one);
        }
    }

    #[test]
    fn another_unit_of_length_changes_no_visibility(exponent in -40..100_i32) {
        // Coordinates near 1e-17 become subnormal floats, and lose bits, where the unit is below 2^-60.
        let mesh = generate::interlocking_tori(12, 6);
        let mut scaled = mesh.clone().into_parts();
        for p in &mut scaled.positions {
            *p *= math::scale_by_power_of_two(1.0, exponent);
        }
        let scaled = Mesh::new(scaled).expect("a mesh");
        let a = measure(&mesh, &small(0, 48), &Silent).expect("measures");
        let b = measure(&scaled, &small(0, 48), &Silent).expect("measures");
        prop_assert_eq!(a, b);
    }
}

#[test]
fn shapes_of_no_size_or_area_are_measured() {
    let at = |points: &[[f64; 3]], triangles: Vec<[u32; 3]>| {
        let positions = points.iter().map(|&p| DVec3::from_array(p)).collect();
        Mesh::from_triangles(positions, triangles).expect("a mesh")
    };
    let point = at(&[[5.0; 3]; 3], vec![[0, 1, 2]]);
    let line = at(&[[0.0; 3], [1.0; 3], [2.0; 3]], vec![[0, 1, 2], [0, 0, 1]]);
    for mesh in [point, line] {
        for options in [
            small(1, 32),
            MeasureOptions {
                size: 1,
                ..MeasureOptions::paper()
            },
        ] {
            let found = measure(&mesh, &options, &Silent).expect("measures");
            assert!(found.triangles().iter().all(|v| (0.0..=1.0).contains(v)));
            assert!((0.0..=1.0).contains(&found.mesh()));
        }
    }
    let nothing = measure(&Mesh::default(), &MeasureOptions::default(), &Silent);
    assert!(matches!(nothing, Err(Error::Usage(_))));
}

#[test]
fn a_needle_of_more_pieces_than_fit_in_memory_is_refused() {
    let positions = (0..200_000).map(|i| DVec3::new(f64::from(i) * 1e-6, 0.0, f64::from(i % 2)));
    let triangles = (0..199_998).map(|i| [i, i + 1, i + 2]).collect();
    let mesh = Mesh::from_triangles(positions.collect(), triangles).expect("a mesh");
    let options = MeasureOptions {
        edge_limit: Some(1.0),
        ..small(0, 4_096)
    };
    let refused = measure(&mesh, &options, &Silent);
    assert!(matches!(refused, Err(Error::Unsupported(_))), "{refused:?}");
}

#[test]
fn an_option_out_of_range_is_refused() {
    let default = MeasureOptions::default();
    for options in [
        MeasureOptions {
            octahedron: 6,
            ..default
        },
        MeasureOptions { size: 0, ..default },
        MeasureOptions {
            size: 4_097,
            ..default
        },
        MeasureOptions {
            edge_limit: Some(0.5),
            ..default
        },
        MeasureOptions {
            edge_limit: Some(f64::NAN),
            ..default
        },
        MeasureOptions {
            edge_limit: Some(f64::INFINITY),
            ..default
        },
    ] {
        let refused = measure(&generate::cube(), &options, &Silent);
        assert!(matches!(refused, Err(Error::Usage(_))), "{options:?}");
    }
}

#[test]
fn the_paper_and_the_default_are_two_methods() {
    let (paper, default) = (MeasureOptions::paper(), MeasureOptions::default());
    assert_eq!((paper.cameras(), paper.size), (258, 480));
    assert_eq!(paper.alignment, Alignment::Axes);
    assert_eq!(paper.weights, CameraWeights::Equal);
    assert_eq!(paper.unseen, UnseenRule::Neighbors);
    assert_eq!((default.cameras(), default.size), (258, 480));
    assert_eq!(default.alignment, Alignment::Generic);
    assert_eq!(default.weights, CameraWeights::Area);
    assert_eq!(default.unseen, UnseenRule::Plane);
    assert_eq!(default.subpixel_bits, SubpixelBits::Eight);
}

#[test]
fn no_number_of_threads_changes_a_bit() {
    let mesh = generate::interlocking_tori(24, 12);
    let options = MeasureOptions {
        fractional: true,
        two_sided: true,
        ..small(2, 64)
    };
    same_on_all_threads(|| measure(&mesh, &options, &Silent).expect("measures"));
}

#[test]
fn an_interruption_is_heard() {
    let stopped = measure(&generate::cube(), &MeasureOptions::default(), &Impatient);
    assert!(matches!(stopped, Err(Error::Interrupted)));
}

#[test]
fn the_bunny_is_as_visible_as_was_measured_before() {
    let Some(mesh) = model("bunny.ply") else {
        return;
    };
    let mesh = mesh::canonical(&mesh).mesh;
    let paper = MeasureOptions {
        octahedron: 1,
        ..MeasureOptions::paper()
    };
    let found = measure(&mesh, &paper, &Silent).expect("measures").mesh();
    assert!((found - 0.916).abs() < 0.01, "{found}");
    let found = measure(&mesh, &small(1, 480), &Silent)
        .expect("measures")
        .mesh();
    assert!((found - 0.900).abs() < 0.02, "{found}");
}
