//! Camera placement: what a matrix shows, and that it shows the same in every frame.

use super::*;

proptest! {
    #![proptest_config(crate::support::cases(256))]

    #[test]
    fn every_point_of_the_sphere_is_inside_the_image_and_between_near_and_far(
        center in fine(1..2), radius in 0.5..1.0, direction in fine(1..2), at in fine(1..2),
        (index, count) in (0_usize..20, 20_usize..21), size in [1_u32..600, 1_u32..600],
        orthographic in any::<bool>(),
    ) {
        prop_assume!(direction[0].length() > 1e-3 && at[0].length() > 1e-3);
        let s = Sphere { center: center[0], radius };
        let projection = if orthographic { Projection::Orthographic } else { Projection::Perspective };
        let view = View::around(&s, direction[0], [index, count], size, projection).expect("a view");
        let [x, y, z, w] = clip(&view, s.center + at[0].normalize() * radius);
        prop_assert!(w > 0.0);
        let slack = 1e-12;
        prop_assert!(x.abs() <= w + slack && y.abs() <= w + slack, "({x}, {y}) in +-{w}");
        prop_assert!(-slack <= z && z <= w + slack, "{z} in 0..{w}");
        let [x, y, _, w] = clip(&view, s.center);
        prop_assert!((x / w).abs() < 1e-12 && (y / w).abs() < 1e-12, "the centre is at ({x}, {y})");
    }

    #[test]
    fn clip_coordinates_have_the_same_bits_in_every_frame(
        points in fine(3..4), exponent in -300_i32..300, orthographic in any::<bool>(),
    ) {
        let frame = Frame { exponent };
        let s = Sphere::of_points(&points).expect("points");
        let projection = if orthographic { Projection::Orthographic } else { Projection::Perspective };
        let set = ViewSet::around(&s, &named_sets::dodecahedron(), 256, 256, projection).expect("views");
        let entered = set.enter_frame(frame);
        for (view, inside) in set.views.iter().zip(&entered.views) {
            for &p in &points {
                prop_assert_eq!(
                    clip(view, p).map(f64::to_bits),
                    clip(inside, frame.enter(p)).map(f64::to_bits)
                );
            }
            prop_assert_eq!(inside.near.to_bits(), frame.enter_length(view.near).to_bits());
        }
        prop_assert_eq!(&entered.leave_frame(frame), &set);
        // Cameras placed in the frame are the cameras placed outside.
        let placed = ViewSet::around(
            &s.enter_frame(frame), &named_sets::dodecahedron(), 256, 256, projection,
        ).expect("views");
        prop_assert_eq!(placed, entered);
    }
}

#[test]
fn a_mesh_that_is_one_point_has_a_frame_and_finite_views() {
    for x in [0.0, 1e30, 1e-30] {
        let mesh = Mesh::from_triangles(vec![DVec3::splat(x); 3], vec![[0, 1, 2]]).expect("valid");
        let frame = frame_of(&mesh);
        let inside = mesh.enter_frame(frame).positions()[0].x;
        assert!(x == 0.0 && frame == Frame::default() || (0.5..1.0).contains(&inside));
        let s = Sphere::of_mesh(&mesh).expect("a triangle");
        assert!(ViewSet::costs(&s).is_ok(), "{x}");
    }
}

#[test]
fn a_camera_that_cannot_exist_is_not_made() {
    let around = |d| View::around(&unit_sphere(), d, [0, 1], [8, 8], Projection::Perspective);
    assert!(around(DVec3::ZERO).is_none());
    assert!(around(DVec3::splat(f64::NAN)).is_none());
    let at =
        |up, near, far| View::perspective([DVec3::Z * 2.0, DVec3::ZERO, up], [near, far], [8, 8]);
    assert!(at(DVec3::Y, 1.0, 3.0).is_some());
    assert!(at(DVec3::Z, 1.0, 3.0).is_none(), "up along the axis");
    assert!(at(DVec3::Y, 0.0, 3.0).is_none());
    assert!(at(DVec3::Y, 3.0, 3.0).is_none());
    assert!(at(DVec3::Y, 1.0, f64::INFINITY).is_none());
}

#[test]
fn a_camera_on_the_z_axis_has_x_to_the_right_and_y_up() {
    let perspective = View::perspective(
        [DVec3::Z * 2.0, DVec3::ZERO, DVec3::Y],
        [1.0, 3.0],
        [512, 256],
    )
    .expect("a view");
    // Depth 2, half the height 2 tan 30; w counts in powers of two of near.
    let [x, y, z, w] = clip(&perspective, DVec3::new(0.1, 0.2, 0.0));
    let half = 2.0 / sqrt(3.0);
    assert!((y / w - 0.2 / half).abs() < 1e-15, "{}", y / w);
    assert!((x / w - 0.1 / (2.0 * half)).abs() < 1e-15, "{}", x / w);
    // Depth between near 1 and far 3: (1 - 1/2) / (1 - 1/3).
    assert!((z / w - 0.75).abs() < 1e-15);
    let flat = View::orthographic(&unit_sphere(), DVec3::Z, DVec3::Y, [100, 100]).expect("a view");
    assert!(same(
        clip(&flat, DVec3::new(0.25, -0.5, 1.0)),
        [0.25, -0.5, 0.0, 1.0]
    ));
    assert!(same(
        clip(&flat, DVec3::new(0.0, 0.0, -1.0)),
        [0.0, 0.0, 1.0, 1.0]
    ));
}

#[test]
fn views_are_rolled_evenly_around_their_axes() {
    let s = unit_sphere();
    for d in [
        DVec3::Z,
        DVec3::Y,
        DVec3::NEG_Y,
        DVec3::new(0.0, 0.9, 0.435_889_894_354_067_4),
    ] {
        let up = |i| {
            let v =
                View::around(&s, d, [i, 8], [64, 64], Projection::Orthographic).expect("a view");
            DVec3::from_slice(&v.matrix[1][..3])
        };
        for i in 0..8 {
            assert!((up(i).length() - 1.0).abs() < 1e-14);
            let cosine = up(i).dot(up((i + 1) % 8));
            assert!((cosine - sqrt(0.5)).abs() < 1e-14, "{d}: {cosine}");
        }
        assert!((up(0) + up(4)).length() < 1e-14);
    }
    let first =
        View::around(&s, DVec3::Z, [0, 8], [64, 64], Projection::Orthographic).expect("a view");
    assert!(same(first.matrix[1], [0.0, 1.0, 0.0, 0.0]));
    let second =
        View::around(&s, DVec3::Z, [1, 4], [64, 64], Projection::Orthographic).expect("a view");
    assert!(
        (second.matrix[1][0] + 1.0).abs() < 1e-15,
        "counter-clockwise: up is -x after a quarter"
    );
}

#[test]
fn a_window_from_twice_the_radius_is_the_middle_of_the_whole_picture() {
    let s = Sphere {
        center: DVec3::new(0.3, -2.0, 5.0),
        radius: 0.75,
    };
    let directions = named_sets::rhombicuboctahedron();
    let projection = Projection::Perspective;
    let whole = ViewSet::around(&s, &directions, 300, 300, projection).expect("views");
    let window = Window {
        side: 100,
        pixel: 2.0 / sqrt(3.0) / 300.0,
        samples: 2,
    };
    let part = ViewSet::from_distance(&s, &directions, 1.5, window).expect("views");
    assert_eq!((part.width, part.height, part.samples), (100, 100, 2));
    for (a, b) in whole.views.iter().zip(&part.views) {
        for p in [DVec3::ZERO, DVec3::X, DVec3::new(0.1, -0.2, 0.3)] {
            let [x, y, _, w] = clip(a, s.center + 0.5 * p);
            let [u, v, _, h] = clip(b, s.center + 0.5 * p);
            assert!((300.0 * x / w - 100.0 * u / h).abs() < 1e-9);
            assert!((300.0 * y / w - 100.0 * v / h).abs() < 1e-9);
        }
    }
    for distance in [0.0, 0.75, -3.0, f64::NAN, f64::INFINITY] {
        assert!(ViewSet::from_distance(&s, &directions, distance, window).is_err());
    }
}
