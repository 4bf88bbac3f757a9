//! No point of a face projected inside its interval is seen to move by more than the aperture, and beyond it one is.
//! Every special case of the paper's appendices is built on purpose and counted.

use std::f64::consts::TAU;

use glam::DVec2;
use lodmark::bound::planar::{Aperture, Interval, Projection, ViewerSegment};

use super::{
    case::{CLASSES, Case, Class, SCALE, draw},
    seen::cases,
};

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
            let interval = case.interval();
            assert!(
                !interval.min.is_nan() && !interval.max.is_nan(),
                "{class:?} {number}"
            );
            empty += u32::from(interval.is_empty());
            unbounded += u32::from(interval.max.max(-interval.min) > 1e9 * SCALE);
            let t = case.judge(&name, number, interval.max, 1.0);
            case.judge(&name, number, interval.min, -1.0);
            on_face += u32::from(t > 1e-3 && t < 1.0 - 1e-3);
        }
        counted.push((class, count, empty, unbounded, on_face));
    }
    println!("class, cases, empty, unbounded, limited inside the face: {counted:?}");
    for class in [Class::Generic, Class::Parabola] {
        let (.., on_face) = counted[class as usize];
        assert!(
            on_face > count / 50,
            "{class:?}: an extremum on the face in {on_face} cases only"
        );
    }
}

#[test]
fn without_tolerance_a_face_has_no_line_but_its_own() {
    let none = Aperture::radians(0.0).expect("zero is an angle");
    let cell = ViewerSegment::on_x_axis(-1.0, 1.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(5.0, 3.0));
    let own = Projection::new(&cell, DVec2::Y, none).interval(a, b);
    assert_eq!(own, Interval { min: 3.0, max: 3.0 });
    let slanted = Projection::new(&cell, DVec2::from_angle(1.5), none).interval(a, b);
    assert!(slanted.is_empty());
    // One viewpoint that sees the face from its end sees nothing of how far its points are.
    let viewpoint = ViewerSegment::on_x_axis(2.0, 2.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(2.0, 5.0));
    let behind = Projection::new(&viewpoint, DVec2::Y, none).interval(a, b);
    assert_eq!(
        behind,
        Interval {
            min: 0.0,
            max: f64::INFINITY
        }
    );
    let around = Projection::new(&viewpoint, DVec2::Y, none).interval(-a, b);
    assert!(around.is_empty());
}

#[test]
fn the_own_line_of_a_face_is_allowed() {
    let (count, mut random) = cases(200);
    for number in 0..count {
        let mut at = || DVec2::new(random.between(-9.0, 9.0), random.between(-9.0, 9.0));
        let (a, b, e, f) = (at(), at(), at(), at());
        let along = b - a;
        let normal = along.perp() / along.length();
        let cell = ViewerSegment::between(e, f).expect("finite ends");
        for theta in [0.0, 1e-4, 0.1, 1.5] {
            let aperture = Aperture::radians(theta).expect("below a right angle");
            let interval = Projection::new(&cell, normal, aperture).interval(a, b);
            let rho = a.dot(normal);
            let slack = 1e-12 * 20.0;
            assert!(
                interval.min <= rho + slack && rho <= interval.max + slack,
                "case {number}, theta {theta}: {interval:?} without {rho}"
            );
        }
    }
}

#[test]
fn a_line_cell_limits_a_face_at_its_ends_only() {
    let (count, mut random) = cases(201);
    let line = ViewerSegment::on_x_axis(f64::NEG_INFINITY, f64::INFINITY);
    for number in 0..count {
        let mut at = || DVec2::new(random.between(-9.0, 9.0), random.between(0.1, 9.0));
        let (a, b) = (at(), at());
        let d = DVec2::from_angle(random.between(0.0, TAU));
        let theta = random.between(0.001, 1.2);
        let aperture = Aperture::radians(theta).expect("below a right angle");
        let interval = Projection::new(&line, d, aperture).interval(a, b);
        // The law of sines with the tangent half-angle, by hand: t = 2 y sin / (1 +- cos).
        let reach = |p: DVec2, d: DVec2| {
            let gamma = d.y.atan2(d.x);
            let (plus, minus) = (1.0 + (theta + gamma).cos(), 1.0 - (theta - gamma).cos());
            2.0 * p.y * theta.sin() / plus.max(minus)
        };
        let expected = Interval {
            min: [a, b]
                .iter()
                .map(|&p| p.dot(d) - reach(p, -d))
                .fold(f64::NEG_INFINITY, f64::max),
            max: [a, b]
                .iter()
                .map(|&p| p.dot(d) + reach(p, d))
                .fold(f64::INFINITY, f64::min),
        };
        let off = (interval.min - expected.min)
            .abs()
            .max((interval.max - expected.max).abs());
        assert!(
            off < 1e-11 * 20.0,
            "case {number}: {interval:?} and not {expected:?}"
        );
    }
}

#[test]
fn a_viewpoint_a_rounding_error_beside_a_face_does_not_let_it_go() {
    // Case 93379 of 10^5 faces through a viewpoint along the side of its cone.
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
        direction: DVec2::new(0.959_549_201_314_995_4, 0.281_540_992_141_027_85),
        normal: DVec2::new(0.959_549_201_314_995_4, 0.281_540_992_141_027_85),
        theta: 1.363_344_104_331_917_9,
    };
    let through = case.cell[0].dot(case.direction);
    let interval = case.interval();
    assert!(interval.max <= through + 1e-12, "{interval:?}, {through}");
}

#[test]
fn a_quick_look_at_a_point_refuses_no_offset_that_its_face_may_have() {
    let (mut refused, mut beyond) = (0, 0);
    for class in CLASSES {
        let (count, mut random) = cases(500 + class as u64);
        for number in 0..count {
            let case = draw(class, &mut random);
            let aperture = Aperture::radians(case.theta).expect("drawn below a right angle");
            let [a, b] = case.cell;
            let mut cells = vec![ViewerSegment::between(a, b).expect("finite ends")];
            if a != b {
                cells.push(ViewerSegment::line(a, b - a).expect("two points"));
            }
            for cell in cells {
                let projection = Projection::new(&cell, case.direction, aperture);
                let valid = projection.interval(case.face[0], case.face[1]);
                let may = |p: DVec2, low: f64, high: f64| {
                    projection.may_reach(
                        p,
                        Interval {
                            min: low,
                            max: high,
                        },
                    )
                };
                let t = random.unit();
                for p in [case.face[0], case.face[1], case.point(t)] {
                    let own = p.dot(case.direction);
                    for rho in [valid.min, valid.max, valid.min / 2.0 + valid.max / 2.0] {
                        if rho.is_finite() && valid.contains(rho) {
                            let s = random.unit();
                            assert!(
                                may(p, rho, rho) && may(p, rho - s, rho) && may(p, rho, rho + s),
                                "{class:?} {number}: {rho} of {valid:?}, {case:?}"
                            );
                        }
                    }
                    // The point alone, by its own interval: what lies well beyond is refused.
                    let alone = projection.interval(p, p);
                    for (end, sense) in [(alone.max, 1.0), (alone.min, -1.0)] {
                        let far = own + (end - own) * 1.5 + sense * 0.01 * SCALE;
                        if far.is_finite() && far.abs() < 1e3 * SCALE {
                            beyond += 1;
                            refused +=
                                u32::from(!may(p, far.min(far + sense), far.max(far + sense)));
                        }
                    }
                }
            }
        }
    }
    println!("{refused} of {beyond} offsets beyond are refused at a look");
    assert!(refused > beyond / 2, "{refused} of {beyond}");
}
