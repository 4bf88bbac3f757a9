//! No point of a face projected inside its interval is seen to move by more than the aperture, and beyond it one is.
//! Every special case of the paper's appendices is built on purpose and counted.

use glam::DVec2;
use lodmark::bound::planar::{Interval, Projection, ViewerSegment};

use super::{
    case::{
        CLASSES, Case, Class, SCALE, allows_own_lines, draw, limits_at_ends_only, refuses_most,
    },
    seen::cases,
};
use crate::support::aperture;

#[test]
fn no_point_of_a_face_is_seen_to_move_more_than_its_interval_claims() {
    let mut counted = Vec::new();
    let (count, _) = cases(0);
    for class in CLASSES {
        let (_, mut random) = cases(100 + class as u64);
        let (mut empty, mut unbounded, mut on_face) = (0, 0, 0);
        let name = format!("{class:?}");
        // Each class is as many cases again.
        for number in 0..count {
            let case = draw(class, &mut random);
            let (interval, inside) = case.judge_interval(&name, number);
            empty += u32::from(interval.is_empty());
            unbounded += u32::from(interval.max.max(-interval.min) > 1e9 * SCALE);
            on_face += u32::from(inside);
        }
        counted.push((class, count, empty, unbounded, on_face));
    }
    println!("class, cases, empty, unbounded, limited inside the face: {counted:?}");
    for class in [Class::Generic, Class::Parabola] {
        let (.., inner) = counted[class as usize];
        assert!(inner > count / 50, "{class:?}: {inner} extrema on the face");
    }
}

#[test]
fn without_tolerance_a_face_has_no_line_but_its_own() {
    let interval = |cell: &ViewerSegment, d: DVec2, a: DVec2, b: DVec2| {
        Projection::new(cell, d, aperture(0.0)).interval(a, b)
    };
    let cell = ViewerSegment::on_x_axis(-1.0, 1.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(5.0, 3.0));
    assert_eq!(interval(&cell, DVec2::Y, a, b), Interval::at(3.0));
    assert!(interval(&cell, DVec2::from_angle(1.5), a, b).is_empty());
    // One viewpoint that sees the face from its end sees nothing of how far its points are.
    let viewpoint = ViewerSegment::on_x_axis(2.0, 2.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(2.0, 5.0));
    let behind = interval(&viewpoint, DVec2::Y, a, b);
    assert_eq!(behind, Interval::new(0.0, f64::INFINITY));
    assert!(interval(&viewpoint, DVec2::Y, -a, b).is_empty());
}

#[test]
fn the_own_line_of_a_face_is_allowed() {
    allows_own_lines(200, 0.0);
}

#[test]
fn a_line_cell_limits_a_face_at_its_ends_only() {
    limits_at_ends_only(201, 0.0);
}

#[test]
fn a_viewpoint_a_rounding_error_beside_a_face_does_not_let_it_go() {
    // Case 93379 of 10^5 faces through a viewpoint along the side of its cone.
    let direction = DVec2::new(0.959_549_201_314_995_4, 0.281_540_992_141_027_85);
    let case = Case {
        cell: [
            DVec2::new(-19.704_283_887_876_15, -1.189_390_026_670_972_5),
            DVec2::new(-20.905_475_581_530_172, -2.793_957_439_535_063),
        ],
        face: [
            DVec2::new(-19.431_069_141_748_946, -4.687_402_356_827_183),
            DVec2::new(-19.859_274_439_878_135, 0.794_978_934_542_536_2),
        ],
        endless: false,
        direction,
        normal: direction,
        theta: 1.363_344_104_331_917_9,
    };
    let through = case.cell[0].dot(case.direction);
    let interval = case.interval();
    assert!(interval.max <= through + 1e-12, "{interval:?}, {through}");
}

#[test]
fn a_quick_look_at_a_point_refuses_no_offset_that_its_face_may_have() {
    refuses_most(CLASSES.into_iter().flat_map(|class| {
        let (count, mut random) = cases(500 + class as u64);
        (0..count).map(move |number| {
            let case = draw(class, &mut random);
            case.look(&format!("{class:?} {number}"), &mut random)
        })
    }));
}
