//! Bounds of whole surfaces for a view cell, and what usual tests claim instead.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property, and `LODMARK_SEED` what they are drawn from.

#![expect(clippy::float_cmp, reason = "values that are exact")]

use std::f64::consts::PI;

use glam::DVec3;
use lodmark::{
    Silent,
    bound::{
        heuristics,
        nearest_triangle::{NearestTriangle, originals},
        region::profile,
        surface::{Effort, Given, Measure, Pair, SurfaceBound, measure},
        switch_distance::{aperture_of_pixels, safe_view_distance, switch_distance},
        view_cell::ViewCell,
    },
    mesh::Mesh,
};
use proptest::prelude::*;

use crate::support::{angle_between, aperture, at, bounded, mesh_of};

fn bound(reference: &Mesh, low: &Mesh, what: Measure<'_>) -> SurfaceBound {
    let nearest = NearestTriangle::new(low).expect("not empty");
    let pairs = originals(reference);
    measure(pairs, &nearest, what, Effort::default(), &Silent).expect("nobody interrupts")
}

#[test]
fn the_safe_distance_is_the_published_one() {
    for (delta, theta, expected) in [
        (0.1, 0.001, 99.99999166666652),
        (1.0, 0.05, 19.995833159711886),
        (0.02, 0.0002, 99.99999966666667),
    ] {
        let found = safe_view_distance(delta, aperture(theta));
        assert!(((found - expected) / expected).abs() < 1e-12, "{found}");
        // The farthest viewer who sees so much stands there, and nobody behind him.
        let (m, s) = (at(-0.5 * delta, 0.0, 0.0), at(0.5 * delta, 0.0, 0.0));
        for i in 0..=90 {
            let turn = f64::from(i).to_radians();
            let v = at(libm::cos(turn), libm::sin(turn), 0.0) * found;
            assert!(angle_between(v, m, s) <= theta * (1.0 + 1e-9));
        }
        let across = angle_between(at(0.0, found, 0.0), m, s);
        assert!((across - theta).abs() < 1e-9 * theta);
    }
    assert_eq!(safe_view_distance(0.0, aperture(0.1)), 0.0);
    assert_eq!(safe_view_distance(1.0, aperture(0.0)), f64::INFINITY);
    assert_eq!(switch_distance(0.0, aperture(0.0)), 0.0);
    let near = switch_distance(1.0, aperture(0.1)) - safe_view_distance(1.0, aperture(0.1));
    assert!((near - 0.5).abs() < 1e-12);
}

#[test]
fn a_pixel_is_the_angle_that_it_takes_in_the_middle_of_the_screen() {
    let view = PI / 3.0;
    let angle = |pixels| {
        aperture_of_pixels(pixels, 1080, view)
            .expect("sensible")
            .angle()
    };
    let (one, small) = (angle(1.0), 2.0 * libm::tan(0.5 * view) / 1080.0);
    assert!((one - small).abs() < 1e-6 * small, "{one} and {small}");
    // As many pixels as the screen has take the whole field of view.
    assert!((angle(1080.0) - view).abs() < 1e-12);
    for (pixels, height, view) in [
        (-1.0, 1080, 1.0),
        (f64::NAN, 1080, 1.0),
        (1.0, 0, 1.0),
        (1.0, 1080, PI),
        (1.0, 1080, 0.0),
        (2000.0, 1080, 1.5),
    ] {
        let refused = aperture_of_pixels(pixels, height, view);
        assert_eq!(refused.expect_err("senseless").exit_code(), 2);
    }
}

/// A band of two triangles between two points of the plane z = 0, so high.
fn band(from: [f64; 2], to: [f64; 2], height: f64) -> Mesh {
    let corners = [(from, 0.0), (to, 0.0), (to, height), (from, height)];
    let positions = corners.map(|([x, y], z)| at(x, y, z));
    mesh_of(positions, [[0, 1, 2], [0, 2, 3]])
}

#[test]
fn edges_that_are_far_away_say_nothing_about_a_band_that_passes_close_by() {
    // Figure 16: both vertical edges are seen under small angles; their collapse makes the band disappear.
    let cell = ViewCell::segment([at(-0.001, 0.0, 0.0), at(0.001, 0.0, 0.0)]).expect("a segment");
    let mut last = 0.0;
    for closeness in [1.0, 0.1, 0.01] {
        let tall = band([-100.0, closeness], [100.0, closeness], 0.1);
        let flat = band([-100.0, closeness], [100.0, closeness], 0.0);
        let found = bound(&tall, &flat, Measure::Angle(&cell));
        let nearest = NearestTriangle::new(&flat).expect("not empty");
        let claims = heuristics::claims(&tall, &flat, &nearest, &cell);
        let edge = libm::atan2(0.1, 99.999);
        assert!((claims.vertices - edge).abs() < 1e-6, "{claims:?}");
        assert!((claims.edges - edge).abs() < 1e-6, "{claims:?}");
        let exact = libm::atan2(0.1, closeness);
        let range = exact * 0.999_999..=exact * 1.011;
        assert!(range.contains(&found.bound), "{found:?} for {exact}");
        assert!(found.bound / claims.vertices.max(claims.edges) > last);
        last = found.bound / claims.edges;
    }
    // The error goes to a right angle, and the ratio to infinity with the distance of the edges.
    assert!(last > 1_000.0, "{last}");
}

#[test]
fn a_face_whose_vertices_are_valid_leaves_its_validity_regions_inside() {
    // Figure 11: both ends move away from the viewer, unseen; what is between them moves across his line of sight.
    let eye = DVec3::ZERO;
    let cell = ViewCell::point(eye).expect("a point");
    let (m, n) = (at(-3.0, 1.0, 0.0), at(3.0, 1.0, 0.0));
    let (from, to) = ([m, n, n], [2.0 * m, n, n]);
    for (p, s) in from.into_iter().zip(to) {
        let seen = angle_between(eye, p, s);
        assert!(seen < 1e-9, "no test of vertices sees it");
    }
    let triangle = 0;
    let pairs = vec![Pair { from, to, triangle }];
    let (angle, effort) = (Measure::Angle(&cell), Effort::default());
    let found = measure(pairs, &Given, angle, effort, &Silent).expect("nobody interrupts");
    let mut seen = 0.0_f64;
    for i in 0..=1_000 {
        let x = f64::from(i) / 1_000.0;
        seen = seen.max(angle_between(eye, m.lerp(n, x), (2.0 * m).lerp(n, x)));
    }
    assert!(seen > 0.5, "{seen}");
    let range = seen..=1.011 * seen;
    assert!(range.contains(&found.bound), "{found:?} and {seen}");
}

#[test]
fn equal_surfaces_have_no_error_even_where_the_viewer_stands_on_them() {
    let mesh = band([-1.0, 0.0], [1.0, 0.0], 1.0);
    let inside = ViewCell::cuboid(at(-0.5, -0.5, -0.5), at(0.5, 0.5, 0.5)).expect("a box");
    let found = bound(&mesh, &mesh, Measure::Angle(&inside));
    assert_eq!((found.bound, found.worst), (0.0, None));
}

#[test]
fn a_cell_that_cuts_a_displaced_surface_has_no_bound_below_half_a_turn() {
    let mesh = band([-1.0, 0.0], [1.0, 0.0], 1.0);
    let moved = band([-1.0, 0.1], [1.0, 0.1], 1.0);
    for cell in [
        ViewCell::cuboid(at(-0.5, -0.5, -0.5), at(0.5, 0.5, 0.5)),
        ViewCell::segment([at(0.0, -1.0, 0.5), at(0.0, 1.0, 0.5)]),
        ViewCell::point(at(0.25, 0.0, 0.5)),
        ViewCell::half_space(DVec3::ZERO, at(1.0, 0.0, 0.0)),
        ViewCell::plane(at(0.0, 0.05, 0.0), DVec3::Y),
    ] {
        let cell = cell.expect("a cell");
        let found = bound(&mesh, &moved, Measure::Angle(&cell));
        let range = PI * 0.999_999..=PI;
        assert!(range.contains(&found.bound), "{cell:?}: {found:?}");
    }
}

#[test]
fn a_point_cloud_has_the_exact_error_of_its_points() {
    let points = |shift: f64| {
        let positions = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| at(x, 5.0 + shift, 0.0));
        mesh_of(positions, [])
    };
    let cell = ViewCell::segment([at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0)]).expect("a segment");
    let found = bound(&points(0.0), &points(0.25), Measure::Angle(&cell));
    let mut seen = 0.0_f64;
    for i in 0..5 {
        let (p, s) = (at(f64::from(i), 5.0, 0.0), at(f64::from(i), 5.25, 0.0));
        for k in 0..=1_000 {
            seen = seen.max(angle_between(at(f64::from(k) / 1_000.0, 0.0, 0.0), p, s));
        }
    }
    let range = seen..seen * (1.0 + 1e-6);
    assert!(range.contains(&found.bound), "{found:?} and {seen}");
}

#[test]
fn needles_and_edges_of_three_faces_have_a_bound() {
    // Three faces at one edge, a needle, a face of no size, open borders all around.
    let mesh = |shift: DVec3| {
        let positions = [
            at(0.0, 0.0, 0.0),
            at(1.0, 0.0, 0.0),
            at(0.5, 1.0, 0.0),
            at(0.5, -1.0, 0.2),
            at(0.5, 0.0, 1.0),
            at(3.0, 0.0, 0.0),
        ];
        let around = [[0, 1, 2], [1, 0, 3], [0, 1, 4]];
        let odd = [[0, 1, 5], [5, 5, 5], [2, 2, 3]];
        mesh_of(positions.map(|p| p + shift), [around, odd].concat())
    };
    let (reference, low) = (mesh(DVec3::ZERO), mesh(at(0.0, 0.0, 0.01)));
    let cell = ViewCell::segment([at(-1.0, 0.0, 6.0), at(2.0, 0.0, 6.0)]).expect("a segment");
    let found = bound(&reference, &low, Measure::Angle(&cell));
    // Nothing moves by more than 0.01, and nobody is nearer than 4.99.
    assert!(found.bound <= 1.02 * libm::asin(0.01 / 4.99), "{found:?}");
    let (p, s) = (at(0.5, 1.0, 0.0), at(0.5, 1.0, 0.01));
    let seen = angle_between(at(-1.0, 0.0, 6.0), p, s);
    assert!(found.bound > seen / 4.0, "{found:?} and {seen}");
    let distance = bound(&reference, &low, Measure::Distance);
    let range = 0.005..=0.0101;
    assert!(range.contains(&distance.bound), "{distance:?}");
}

#[test]
fn a_region_is_cut_off_at_twice_its_bounded_part() {
    let cell = ViewCell::segment([at(-1.0, 0.0, 5.0), at(1.0, 0.0, 5.0)]).expect("a segment");
    let found = profile(&cell, DVec3::ZERO, DVec3::X, aperture(0.1), 360, None).expect("a figure");
    let bounded = found.outline.iter().map(|p| p.length());
    let bounded = bounded.filter(|&t| t < found.reach * (1.0 - 1e-9));
    let ratio = found.reach / bounded.fold(0.0, f64::max);
    assert!((ratio - 2.0).abs() < 1e-9, "{ratio}");
}

fn point() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from_array)
}

fn weights() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(0.0..1.0_f64).prop_map(|w| w.map(|x| x / (w[0] + w[1] + w[2])))
}

fn mixed(corners: [DVec3; 3], w: [f64; 3]) -> DVec3 {
    corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2]
}

proptest! {
    #![proptest_config(bounded(300))]

    #[test]
    fn no_point_of_a_moved_triangle_is_seen_beyond_the_bound(
        from in prop::array::uniform3(point()),
        shifts in prop::array::uniform3(point()),
        size in 0.001..1.0_f64,
        corners in prop::array::uniform3(point()),
        samples in prop::collection::vec((weights(), weights()), 300),
    ) {
        let corners = corners.map(|c| c + at(3.0, 0.0, 0.0));
        let cell = ViewCell::polygon(&corners).expect("a triangle");
        let to = [0, 1, 2].map(|i| from[i] + shifts[i] * size);
        let pair = Pair { from, to, triangle: 7 };
        let found = measure(vec![pair], &Given, Measure::Angle(&cell), Effort::default(), &Silent).expect("goes on");
        let worst = found.worst.expect("displaced");
        prop_assert!(found.bound <= 1.010_001 * worst.value, "{found:?}");
        if let Some(v) = worst.viewpoint {
            let seen = angle_between(v, worst.point, worst.replacement);
            prop_assert!((seen - worst.value).abs() < 1e-9, "{seen} and {found:?}");
        }
        for (w, viewer) in samples {
            let seen = angle_between(mixed(corners, viewer), mixed(from, w), mixed(to, w));
            prop_assert!(seen <= found.bound, "{seen} above {found:?}");
        }
    }

    #[test]
    fn every_point_has_a_replacement_within_the_bound(
        reference in prop::collection::vec(prop::array::uniform3(point()), 1..4),
        low in prop::collection::vec(prop::array::uniform3(point()), 1..4),
        ends in prop::array::uniform2(point()),
        samples in prop::collection::vec((0_usize..10, weights()), 20),
    ) {
        let soup = |triangles: &[[DVec3; 3]]| {
            let positions = triangles.iter().flatten().map(|p| p.as_vec3().as_dvec3()).collect();
            let count = triangles.len() as u32;
            Mesh::from_triangles(positions, (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect()).expect("valid")
        };
        let (reference, low) = (soup(&reference), soup(&low));
        let ends = ends.map(|e| e + at(4.0, 0.0, 0.0));
        let cell = ViewCell::segment(ends).expect("a segment");
        let found = bound(&reference, &low, Measure::Angle(&cell));
        let distance = bound(&reference, &low, Measure::Distance);
        for (t, w) in samples {
            let p = mixed(reference.corners(t % reference.triangles().len()), w);
            // The best of all points of a fine grid on the replacement, over viewers on the segment.
            let (mut least, mut nearest, mut spacing) = (f64::INFINITY, f64::INFINITY, 0.0_f64);
            for u in 0..low.triangles().len() {
                let corners = low.corners(u);
                for i in 0..=24 {
                    for k in 0..=24 - i {
                        let w = [f64::from(i) / 24.0, f64::from(k) / 24.0, f64::from(24 - i - k) / 24.0];
                        let s = mixed(corners, w);
                        let seen = (0..=6).map(|v| angle_between(ends[0].lerp(ends[1], f64::from(v) / 6.0), p, s));
                        least = least.min(seen.fold(0.0, f64::max));
                        nearest = nearest.min((p - s).length());
                    }
                }
                let longest = (0..3).map(|i| (corners[i] - corners[(i + 1) % 3]).length()).fold(0.0, f64::max);
                spacing = spacing.max(longest / 24.0);
            }
            // The cell is at least 2 away.
            prop_assert!(least <= found.bound + spacing / 2.0, "{least} above {found:?}");
            prop_assert!(nearest <= distance.bound + spacing, "{nearest} above {distance:?}");
        }
    }
}
