//! Projections along a direction that is not the normal of the lines: the judges of the neighbours, on lines slanted in
//! every way that changes the formulas.

use std::f64::consts::TAU;

use glam::DVec2;
use lodmark::bound::planar::{Aperture, Disc, Interval, Projection, ViewerSegment};

use super::{
    case::{CLASSES, Case, SCALE, draw, turned},
    seen::cases,
};
use crate::support::Random;

/// How the lines stand to the direction. In the frame of a viewpoint at the origin with the direction along y, their
/// normal is y + kx.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slant {
    /// Anything up to 69 degrees.
    Generic,
    /// cos(theta) = k sin(theta): along the side of the cone, one root is the viewpoint.
    AlongCone,
    /// sin + k cos + tan(g) (cos - k sin) = 0: a hyperbola of monotone branches.
    Hyperbola,
    /// The line of the face, which no viewer sees it move on.
    OwnLine,
    /// Nearly parallel to the direction.
    Steep,
    /// Across the direction but for rounding.
    Across,
}

const SLANTS: [Slant; 6] = [
    Slant::Generic,
    Slant::AlongCone,
    Slant::Hyperbola,
    Slant::OwnLine,
    Slant::Steep,
    Slant::Across,
];

/// A normal of the kind, `None` where the face has none.
fn normal(case: &Case, slant: Slant, random: &mut Random) -> Option<DVec2> {
    let (d, [a, b]) = (case.direction, case.face);
    let x = DVec2::new(d.y, -d.x);
    let side = if random.next().is_multiple_of(2) {
        1.0
    } else {
        -1.0
    };
    let (sin, cos) = (side * case.theta).sin_cos();
    let along = b - a;
    let found = match slant {
        Slant::Generic => turned(d, random.between(-1.2, 1.2)),
        Slant::AlongCone => d * sin + x * cos,
        Slant::Hyperbola => {
            let w = DVec2::new(along.dot(x), along.dot(d));
            d * (cos * w.x - sin * w.y) - x * (sin * w.x + cos * w.y)
        }
        Slant::OwnLine => along.perp(),
        Slant::Steep => turned(x * side, random.between(0.001, 0.05)),
        Slant::Across => d + x * (side * 1e-15),
    };
    let found = found.normalize_or_zero();
    let turned_back = if random.next().is_multiple_of(2) {
        -found
    } else {
        found
    };
    // Face and direction may be parallel, and steeper lines leave nothing of the digits.
    (found.dot(d).abs() > 1e-3).then_some(turned_back)
}

#[test]
fn no_point_of_a_face_on_a_slanted_line_is_seen_to_move_more_than_its_interval_claims() {
    let mut counted = Vec::new();
    for slant in SLANTS {
        let (count, mut random) = cases(300 + slant as u64);
        let (mut judged, mut empty, mut on_face) = (0, 0, 0);
        let name = format!("{slant:?}");
        for number in 0..count {
            let class = CLASSES[number as usize % CLASSES.len()];
            let case = draw(class, &mut random);
            let Some(normal) = normal(&case, slant, &mut random) else {
                continue;
            };
            let case = Case { normal, ..case };
            let interval = case.interval();
            assert!(
                !interval.min.is_nan() && !interval.max.is_nan(),
                "{name} {number}"
            );
            judged += 1;
            empty += u32::from(interval.is_empty());
            let name = format!("{name}, {class:?}");
            let t = case.judge(&name, number, interval.max, 1.0);
            case.judge(&name, number, interval.min, -1.0);
            on_face += u32::from(t > 1e-3 && t < 1.0 - 1e-3);
        }
        counted.push((slant, judged, empty, on_face));
    }
    println!("slant, cases, empty, limited inside the face: {counted:?}");
    for (slant, judged, empty, on_face) in counted {
        assert!(judged > 700 * cases(0).0 / 1000, "{slant:?}: {judged}");
        assert!(empty < judged, "{slant:?}: no case has a line");
        if slant == Slant::Generic || slant == Slant::AlongCone {
            assert!(
                on_face > judged / 50,
                "{slant:?}: an extremum on the face in {on_face} cases only"
            );
        }
    }
}

#[test]
fn no_viewers_without_end_see_a_face_move_on_a_slanted_line_more_than_its_interval_claims() {
    let (count, mut random) = cases(310);
    let mut limited = 0;
    for number in 0..count {
        let mut at = |low: f64| {
            let (x, y) = (random.between(-9.0, 9.0), random.between(low, 9.0));
            DVec2::new(x, y)
        };
        let (a, b) = (at(0.3), at(0.3));
        let mirror = if number % 2 == 0 { 1.0 } else { -1.0 };
        let below = if number % 3 == 0 { -1.0 } else { 1.0 };
        let end = at(0.0).x;
        let case = Case {
            cell: [DVec2::new(end, 0.0), DVec2::new(end + mirror, 0.0)],
            endless: true,
            face: [a, b].map(|p| DVec2::new(p.x, p.y * below)),
            direction: DVec2::from_angle(random.between(0.0, TAU)),
            normal: DVec2::ZERO,
            theta: random.between(0.01, 1.2),
        };
        let normal = turned(case.direction, random.between(-1.2, 1.2));
        let case = Case { normal, ..case };
        let interval = case.interval();
        case.judge("endless", number, interval.max, 1.0);
        case.judge("endless", number, interval.min, -1.0);
        limited += u32::from(interval.max.abs() < 1e3 && interval.min.abs() < 1e3);
    }
    assert!(limited > count / 2, "{limited} of {count}");
}

#[test]
fn a_line_cell_limits_a_face_on_a_slanted_line_at_its_ends_only() {
    let (count, mut random) = cases(311);
    let line = ViewerSegment::on_x_axis(f64::NEG_INFINITY, f64::INFINITY);
    for number in 0..count {
        let mut at = || DVec2::new(random.between(-9.0, 9.0), random.between(0.1, 9.0));
        let (a, b) = (at(), at());
        let d = DVec2::from_angle(random.between(0.0, TAU));
        let n = turned(d, random.between(-1.2, 1.2));
        let theta = random.between(0.001, 1.2);
        let aperture = Aperture::radians(theta).expect("below a right angle");
        let projection = Projection::oblique(&line, d, n, aperture).expect("not parallel");
        let interval = projection.interval(a, b);
        // t = 2 y sin / (1 +- cos) by hand, as for lines across; moved by t a point has t d.n more offset.
        let moved = |p: DVec2, d: DVec2| {
            let gamma = d.y.atan2(d.x);
            let (plus, minus) = (1.0 + (theta + gamma).cos(), 1.0 - (theta - gamma).cos());
            (p + d * (2.0 * p.y * theta.sin() / plus.max(minus))).dot(n)
        };
        let expected = Interval {
            min: moved(a, -d).max(moved(b, -d)),
            max: moved(a, d).min(moved(b, d)),
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
fn the_own_line_of_a_face_is_allowed_to_every_direction() {
    let (count, mut random) = cases(312);
    for number in 0..count {
        let mut at = || DVec2::new(random.between(-9.0, 9.0), random.between(-9.0, 9.0));
        let (a, b, e, f) = (at(), at(), at(), at());
        let normal = (b - a).perp().normalize();
        let direction = turned(normal, random.between(-1.5, 1.5));
        let cell = ViewerSegment::between(e, f).expect("finite ends");
        for theta in [0.0, 1e-4, 0.1, 1.5] {
            let aperture = Aperture::radians(theta).expect("below a right angle");
            let interval = Projection::oblique(&cell, direction, normal, aperture)
                .expect("not parallel")
                .interval(a, b);
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
fn a_direction_and_its_opposite_and_a_line_and_itself_give_one_answer() {
    let (count, mut random) = cases(313);
    for number in 0..count {
        let case = draw(CLASSES[number as usize % CLASSES.len()], &mut random);
        let [a, b] = case.cell;
        let cell = ViewerSegment::between(a, b).expect("finite ends");
        let aperture = Aperture::radians(case.theta).expect("drawn below a right angle");
        let d = case.direction;
        let interval = |d: DVec2, n: DVec2| {
            Projection::oblique(&cell, d, n, aperture)
                .expect("not parallel")
                .interval(case.face[0], case.face[1])
        };
        let bits = |i: Interval| (i.min.to_bits(), i.max.to_bits());
        let across = Projection::new(&cell, d, aperture).interval(case.face[0], case.face[1]);
        assert_eq!(bits(interval(d, d)), bits(across), "case {number}");
        let n = turned(d, random.between(-1.5, 1.5));
        assert_eq!(bits(interval(d, n)), bits(interval(-d, n)), "case {number}");
        let (one, other) = (interval(d, n), interval(d, -n));
        let near = |x: f64, y: f64| x == y || (x - y).abs() <= 1e-9 * (SCALE + x.abs());
        assert!(
            near(one.min, -other.max) && near(one.max, -other.min),
            "case {number}: {one:?} and {other:?}"
        );
    }
}

#[test]
fn without_tolerance_a_face_has_no_slanted_line_but_its_own() {
    let none = Aperture::radians(0.0).expect("zero is an angle");
    let interval = |cell: ViewerSegment, d: DVec2, n: DVec2, a: DVec2, b: DVec2| {
        Projection::oblique(&cell, d, n, none)
            .expect("not parallel")
            .interval(a, b)
    };
    let cell = ViewerSegment::on_x_axis(-1.0, 1.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(5.0, 3.0));
    let slanted = DVec2::new(0.6, 0.8);
    let own = interval(cell, slanted, DVec2::Y, a, b);
    assert!(
        (own.min - 3.0).abs() < 1e-15 && own.max == own.min,
        "{own:?}"
    );
    assert!(interval(cell, DVec2::Y, slanted, a, b).is_empty());
    // One viewpoint that sees the face from its end sees nothing of how far its points are, up to itself.
    let viewpoint = ViewerSegment::on_x_axis(2.0, 2.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(2.0, 5.0));
    for slanted in [slanted, DVec2::new(-0.6, 0.8)] {
        let here = 2.0 * slanted.x;
        let behind = interval(viewpoint, DVec2::Y, slanted, a, b);
        assert!((behind.min - here).abs() < 1e-14 && behind.max == f64::INFINITY);
        let around = interval(viewpoint, DVec2::Y, slanted, DVec2::new(2.0, -3.0), b);
        assert!((around.min - here).abs() < 1e-14 && (around.max - here).abs() < 1e-14);
        assert!(interval(viewpoint, DVec2::Y, slanted, DVec2::new(1.0, -3.0), b).is_empty());
    }
}

#[test]
fn a_face_along_the_direction_through_the_viewpoint_does_not_go_beside_it() {
    for (slant, degrees) in [(0.5, 1.0), (-0.7, 0.1), (1.1, 40.0)] {
        let normal = turned(DVec2::Y, slant);
        let aperture = Aperture::degrees(degrees).expect("below 90");
        for x in [1.0, 4.0] {
            let cell = ViewerSegment::on_x_axis(x, x);
            let projection =
                Projection::oblique(&cell, DVec2::Y, normal, aperture).expect("not parallel");
            let around = projection.interval(DVec2::new(x, -1.0), DVec2::new(x, 2.0));
            let through = x * normal.x;
            assert!(
                (around.min - through).abs() < 1e-14 && (around.max - through).abs() < 1e-14,
                "{around:?} and not {through}"
            );
        }
    }
}

#[test]
fn no_line_along_the_direction_is_projected_on() {
    let cell = ViewerSegment::on_x_axis(-1.0, 1.0);
    let aperture = Aperture::degrees(1.0).expect("below 90");
    for (direction, normal) in [
        (DVec2::X, DVec2::Y),
        (DVec2::X, DVec2::ZERO),
        (DVec2::X, DVec2::new(f64::NAN, 0.0)),
        (DVec2::X, DVec2::new(1e-310, 1.0)),
    ] {
        let error = Projection::oblique(&cell, direction, normal, aperture).expect_err("parallel");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("right angles"), "{error}");
    }
}

#[test]
fn a_quick_look_at_a_point_refuses_no_slanted_line_that_its_face_may_have() {
    let (mut refused, mut beyond) = (0, 0);
    let (count, mut random) = cases(314);
    for number in 0..count {
        let class = CLASSES[number as usize % CLASSES.len()];
        let case = draw(class, &mut random);
        let slant = SLANTS[number as usize / CLASSES.len() % SLANTS.len()];
        let Some(normal) = normal(&case, slant, &mut random) else {
            continue;
        };
        let aperture = Aperture::radians(case.theta).expect("drawn below a right angle");
        let [a, b] = case.cell;
        let mut cells = vec![ViewerSegment::between(a, b).expect("finite ends")];
        if a != b {
            cells.push(ViewerSegment::line(a, b - a).expect("two points"));
        }
        for cell in cells {
            let projection =
                Projection::oblique(&cell, case.direction, normal, aperture).expect("not parallel");
            let valid = projection.interval(case.face[0], case.face[1]);
            let t = random.unit();
            for p in [case.face[0], case.face[1], case.point(t)] {
                for rho in [valid.min, valid.max, valid.min / 2.0 + valid.max / 2.0] {
                    if rho.is_finite() && valid.contains(rho) {
                        let s = random.unit();
                        let wide = Interval {
                            min: rho - s,
                            max: rho,
                        };
                        let radius = random.between(0.0, 2.0);
                        let centre = p + turned(DVec2::new(radius, 0.0), random.between(0.0, TAU));
                        assert!(
                            projection.may_reach(p, wide)
                                && projection.may_reach(p, Interval { min: rho, max: rho })
                                && projection.may_reach_any(
                                    Disc {
                                        centre,
                                        radius: radius * 1.000_001
                                    },
                                    wide
                                ),
                            "{class:?} {slant:?} {number}: {rho} of {valid:?}, {case:?}"
                        );
                    }
                }
                let own = p.dot(normal);
                let alone = projection.interval(p, p);
                let scale = case.direction.dot(normal).abs();
                for (end, sense) in [(alone.max, 1.0), (alone.min, -1.0)] {
                    let far = own + (end - own) * 1.5 + sense * 0.01 * SCALE * scale;
                    if far.is_finite() && far.abs() < 1e3 * SCALE * scale {
                        beyond += 1;
                        let only = Interval { min: far, max: far };
                        refused += u32::from(!projection.may_reach(p, only));
                    }
                }
            }
        }
    }
    println!("{refused} of {beyond} offsets beyond are refused at a look");
    assert!(refused > beyond / 2, "{refused} of {beyond}");
}
