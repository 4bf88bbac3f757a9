//! Projections along a direction that is not the normal of the lines: the judges of the neighbours, on lines slanted in
//! every way that changes the formulas.

use std::f64::consts::TAU;

use glam::DVec2;
use lodmark::bound::planar::{Interval, Projection, ViewerSegment};

use super::{
    case::{
        CLASSES, Case, SCALE, allows_own_lines, draw, limits_at_ends_only, projection,
        refuses_most, turned,
    },
    seen::cases,
};
use crate::support::{Random, aperture};

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
    let side = random.sign();
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
    let found = found.normalize_or_zero() * -random.sign();
    // Face and direction may be parallel, and steeper lines leave nothing of the digits.
    (found.dot(d).abs() > 1e-3).then_some(found)
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
            let (interval, inside) = case.judge_interval(&format!("{name}, {class:?}"), number);
            judged += 1;
            empty += u32::from(interval.is_empty());
            on_face += u32::from(inside);
        }
        counted.push((slant, judged, empty, on_face));
    }
    println!("slant, cases, empty, limited inside the face: {counted:?}");
    for (slant, judged, empty, on_face) in counted {
        assert!(judged > 700 * cases(0).0 / 1000, "{slant:?}: {judged}");
        assert!(empty < judged, "{slant:?}: no case has a line");
        let few = matches!(slant, Slant::Generic | Slant::AlongCone) && on_face <= judged / 50;
        assert!(!few, "{slant:?}: {on_face} extrema on the face");
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
        let (interval, _) = case.judge_interval("endless", number);
        limited += u32::from(interval.max.abs() < 1e3 && interval.min.abs() < 1e3);
    }
    assert!(limited > count / 2, "{limited} of {count}");
}

#[test]
fn a_line_cell_limits_a_face_on_a_slanted_line_at_its_ends_only() {
    limits_at_ends_only(311, 1.2);
}

#[test]
fn the_own_line_of_a_face_is_allowed_to_every_direction() {
    allows_own_lines(312, 1.5);
}

#[test]
fn a_direction_and_its_opposite_and_a_line_and_itself_give_one_answer() {
    let (count, mut random) = cases(313);
    for number in 0..count {
        let case = draw(CLASSES[number as usize % CLASSES.len()], &mut random);
        let [a, b] = case.cell;
        let cell = ViewerSegment::between(a, b).expect("finite ends");
        let aperture = aperture(case.theta);
        let d = case.direction;
        let of = |projection: Projection| projection.interval(case.face[0], case.face[1]);
        let interval = |d: DVec2, n: DVec2| {
            of(Projection::oblique(&cell, d, n, aperture).expect("not parallel"))
        };
        let bits = |i: Interval| (i.min.to_bits(), i.max.to_bits());
        let across = of(Projection::new(&cell, d, aperture));
        assert_eq!(bits(interval(d, d)), bits(across), "case {number}");
        let n = turned(d, random.between(-1.5, 1.5));
        assert_eq!(bits(interval(d, n)), bits(interval(-d, n)), "case {number}");
        let (one, other) = (interval(d, n), interval(d, -n));
        let near = |x: f64, y: f64| x == y || (x - y).abs() <= 1e-9 * (SCALE + x.abs());
        let mirrored = near(one.min, -other.max) && near(one.max, -other.min);
        assert!(mirrored, "case {number}: {one:?} and {other:?}");
    }
}

/// The distance of the ends of an interval from an offset.
fn off(interval: Interval, rho: f64) -> f64 {
    (interval.min - rho).abs().max((interval.max - rho).abs())
}

#[test]
fn without_tolerance_a_face_has_no_slanted_line_but_its_own() {
    let interval = |cell: &ViewerSegment, d: DVec2, n: DVec2, a: DVec2, b: DVec2| {
        projection(cell, d, n, 0.0).interval(a, b)
    };
    let cell = ViewerSegment::on_x_axis(-1.0, 1.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(5.0, 3.0));
    let slanted = DVec2::new(0.6, 0.8);
    let own = interval(&cell, slanted, DVec2::Y, a, b);
    assert!(off(own, 3.0) < 1e-15 && own.max == own.min, "{own:?}");
    assert!(interval(&cell, DVec2::Y, slanted, a, b).is_empty());
    // One viewpoint that sees the face from its end sees nothing of how far its points are, up to itself.
    let viewpoint = ViewerSegment::on_x_axis(2.0, 2.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(2.0, 5.0));
    for slanted in [slanted, DVec2::new(-0.6, 0.8)] {
        let here = 2.0 * slanted.x;
        let from = |a: DVec2| interval(&viewpoint, DVec2::Y, slanted, a, b);
        let behind = from(a);
        assert!((behind.min - here).abs() < 1e-14 && behind.max == f64::INFINITY);
        assert!(off(from(DVec2::new(2.0, -3.0)), here) < 1e-14);
        assert!(from(DVec2::new(1.0, -3.0)).is_empty());
    }
}

#[test]
fn a_face_along_the_direction_through_the_viewpoint_does_not_go_beside_it() {
    for (slant, degrees) in [(0.5, 1.0_f64), (-0.7, 0.1), (1.1, 40.0)] {
        let normal = turned(DVec2::Y, slant);
        for x in [1.0, 4.0] {
            let cell = ViewerSegment::on_x_axis(x, x);
            let projection = projection(&cell, DVec2::Y, normal, degrees.to_radians());
            let around = projection.interval(DVec2::new(x, -1.0), DVec2::new(x, 2.0));
            assert!(off(around, x * normal.x) < 1e-14, "{x} {slant}: {around:?}");
        }
    }
}

#[test]
fn no_line_along_the_direction_is_projected_on() {
    let cell = ViewerSegment::on_x_axis(-1.0, 1.0);
    let (nan, steep) = (DVec2::new(f64::NAN, 0.0), DVec2::new(1e-310, 1.0));
    for normal in [DVec2::Y, DVec2::ZERO, nan, steep] {
        let refused = Projection::oblique(&cell, DVec2::X, normal, aperture(0.02));
        let error = refused.expect_err("parallel");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("right angles"), "{error}");
    }
}

#[test]
fn a_quick_look_at_a_point_refuses_no_slanted_line_that_its_face_may_have() {
    let (count, mut random) = cases(314);
    refuses_most((0..count).filter_map(|number| {
        let class = CLASSES[number as usize % CLASSES.len()];
        let case = draw(class, &mut random);
        let slant = SLANTS[number as usize / CLASSES.len() % SLANTS.len()];
        let normal = normal(&case, slant, &mut random)?;
        let told = format!("{class:?} {slant:?} {number}");
        Some(Case { normal, ..case }.look(&told, &mut random))
    }));
}
