//! Validity regions of points: published values, and that no viewpoint of a cell beats a claim.

#![expect(
    clippy::float_cmp,
    clippy::print_stderr,
    reason = "published digits, values that are exact, and figures for the record"
)]

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use lodmark::bound::{
    point::{Aperture, Extent, angle_from, error, extent, extent_from},
    view_cell::{Shape, ViewCell},
};

use crate::support::{Random, angle_between, aperture, at, bound_count, mixture, rows, square};

#[track_caller]
fn near(found: f64, expected: f64, relative: f64) {
    let off = (found - expected).abs();
    assert!(off <= relative * expected.abs(), "{found} for {expected}");
}

fn toward(gamma: f64) -> DVec3 {
    at(libm::cos(gamma), libm::sin(gamma), 0.0)
}

#[test]
fn the_extent_for_one_viewpoint_is_that_of_the_corrected_equation_6() {
    // Viewpoint, point, direction, angle, and how far.
    for [vx, vy, vz, mx, my, mz, dx, dy, dz, theta, t] in rows(
        "0 0 0  0  0 10   1   0   0    0.1   1.0033467208545053
         1 2 3  4 -1  2   0   0.6 0.8  0.05  0.26202160827883486
         0 0 0  3  0  4   0.6 0   0.8  0.2   inf
         0 0 0  2  1  0  -1   0   0    0.3   0.9555245108532735
         0 0 0  2  1  0  -0.8944271909999159 -0.4472135954999579 0  0.3  2.23606797749979",
    ) {
        let (v, m, d) = (at(vx, vy, vz), at(mx, my, mz), at(dx, dy, dz));
        let found = extent_from(v, m, d, aperture(theta));
        let cell = ViewCell::point(v).expect("a point");
        let over = extent(&cell, m, d, aperture(theta));
        if t.is_finite() {
            near(found, t, 1e-13);
            near(over.length, t, 1e-13);
            assert_eq!(over.viewpoint, Some(v));
        } else {
            assert_eq!(found, t);
            assert_eq!(over.viewpoint, None);
        }
    }
}

#[test]
fn the_extent_for_a_line_is_that_of_the_corrected_equation_9() {
    for (m, gamma, theta, t) in [
        (at(0., 1., 0.), 0.0, 0.2, 0.20066934417090107),
        (at(0.5, 2., 0.), 1.2, 0.1, 0.31505643837213265),
        (at(-1., 3., 0.), -2.5, 0.35, 1.0508735603487234),
        (at(0., 1., 0.), FRAC_PI_2, 0.3, 0.8389742600304104),
        (at(0., 1., 0.), -FRAC_PI_2, 0.3, 0.4562185987402219),
    ] {
        let line = ViewCell::line(DVec3::ZERO, 3.0 * DVec3::X).expect("a line");
        let plane = ViewCell::plane(DVec3::ZERO, DVec3::Y).expect("a plane");
        let half = ViewCell::half_space(DVec3::ZERO, DVec3::Y).expect("a half-space");
        for cell in [line, plane, half] {
            let found = extent(&cell, m, toward(gamma), aperture(theta));
            near(found.length, t, 1e-12);
        }
    }
}

#[test]
fn the_extent_for_a_segment_is_the_published_one() {
    for (ends, m, gamma, theta, t) in [
        ([-1., 1.], at(0., 2., 0.), 0.3, 0.1, 0.20787141472027246),
        ([2., 5.], at(0., 1., 0.), 2.9, 0.2, 20.1439602542857),
        ([-3., -2.], at(1., 1.5, 0.), -0.4, 0.15, 0.7657104726602177),
        ([0., 0.5], at(0., 4., 0.), 1.5, 0.05, 1.3929028049595897),
    ] {
        let cell = ViewCell::segment(ends.map(|x| at(x, 0.0, 0.0))).expect("a segment");
        let found = extent(&cell, m, toward(gamma), aperture(theta));
        near(found.length, t, 1e-12);
    }
}

#[test]
fn the_error_over_a_segment_is_the_published_one() {
    for [first, last, mx, my, sx, sy, expected] in rows(
        "-2 2   0 1  1 2    0.7853981633974483
          0 5  -1 1  1 1    1.5707963267948966
          3 4   0 1  1 0.5  0.08096147072083958",
    ) {
        let (m, s) = (at(mx, my, 0.0), at(sx, sy, 0.0));
        let ends = [first, last].map(|x| at(x, 0.0, 0.0));
        let cell = ViewCell::segment(ends).expect("a segment");
        near(error(&cell, m, s).radians, expected, 1e-13);
        near(error(&cell, s, m).radians, expected, 1e-13);
    }
}

#[test]
fn the_extent_for_a_polygon_is_the_published_one() {
    let cell = ViewCell::polygon(&square()).expect("a square");
    for [mx, my, mz, dx, dy, dz, theta, t] in rows(
        "0  0 2     0    0     1    0.1   0.4960742455718246
         0  0 2     0    0    -1    0.1   0.37278742011150395
         0  0 2     1    0     0    0.1   0.20016683350215514
         3  1 2     0.6  0.8   0    0.15  0.5080415684989794
         5 -4 1    -0.36 0.48  0.8  0.08  0.4322567056049239
         0  0 0.5   0    0     1    0.6   1.2969627005148379",
    ) {
        let (m, d) = (at(mx, my, mz), at(dx, dy, dz));
        let found = extent(&cell, m, d, aperture(theta));
        near(found.length, t, 1e-9);
        // The error of a point at the extent is the aperture.
        let seen = error(&cell, m, m + d * found.length);
        near(seen.radians, theta, 1e-12);
    }
}

/// Viewpoints of a cell by numbers, so that a search can go on around the best of them.
struct Sampler<'a> {
    cell: &'a ViewCell,
}

impl Sampler<'_> {
    fn dimensions(&self) -> usize {
        self.cell.corners().map_or(3, <[DVec3]>::len)
    }

    /// From numbers in [0, 1]: weights of the corners, or places on a cell without end.
    fn viewpoint(&self, numbers: &[f64]) -> DVec3 {
        let far = |x: f64| libm::tan((x - 0.5) * 0.999 * PI);
        match self.cell.shape() {
            Shape::Line { point, direction } => *point + *direction * far(numbers[0]),
            Shape::Plane { point, normal } | Shape::HalfSpace { point, normal } => {
                let x = normal.any_orthonormal_vector();
                let deep = match self.cell.shape() {
                    Shape::HalfSpace { .. } => far(0.5 + 0.5 * numbers[2].min(1.0)),
                    _ => 0.0,
                };
                *point + x * far(numbers[0]) + normal.cross(x) * far(numbers[1]) - *normal * deep
            }
            _ => {
                let weights: Vec<f64> = numbers.iter().map(|&x| x * x * x).collect();
                mixture(self.cell.corners().expect("bounded"), &weights)
            }
        }
    }

    /// The largest value of a function over sampled viewpoints, refined around the best.
    fn largest(&self, random: &mut Random, value: impl Fn(DVec3) -> f64) -> f64 {
        let n = self.dimensions();
        let mut best = (f64::NEG_INFINITY, vec![0.0; n]);
        for round in 0..160 {
            let reach = libm::exp(-0.12 * f64::from(round - 60));
            let mut next = |&x: &f64| match round {
                0..60 => random.unit(),
                _ => (x + reach * random.between(-1.0, 1.0)).clamp(0.0, 1.0),
            };
            let numbers: Vec<f64> = best.1.iter().map(&mut next).collect();
            if numbers.iter().sum::<f64>() <= 0.0 {
                continue;
            }
            let found = value(self.viewpoint(&numbers));
            if found > best.0 {
                best = (found, numbers);
            }
        }
        best.0
    }
}

const CLASSES: [&str; 7] = [
    "point",
    "segment",
    "line",
    "polygon",
    "plane",
    "polyhedron",
    "half_space",
];

fn random_cell(class: &str, random: &mut Random) -> ViewCell {
    loop {
        let cell = match class {
            "point" => ViewCell::point(random.vector(1.0)),
            "segment" => ViewCell::segment([random.vector(1.0), random.vector(1.0)]),
            "line" => ViewCell::line(random.vector(1.0), random.direction()),
            "polygon" => {
                // Corners on an ellipse are convex.
                let (c, u, v) = (random.vector(1.0), random.vector(1.0), random.vector(1.0));
                let n = 3 + (4.0 * random.unit()) as usize;
                let corner = |i: usize| {
                    let angle = 2.0 * PI * i as f64 / n as f64;
                    c + u * libm::cos(angle) + v * libm::sin(angle)
                };
                ViewCell::polygon(&(0..n).map(corner).collect::<Vec<_>>())
            }
            "plane" => ViewCell::plane(random.vector(1.0), random.direction()),
            "polyhedron" => {
                let n = 4 + (5.0 * random.unit()) as usize;
                ViewCell::polyhedron(&(0..n).map(|_| random.vector(1.0)).collect::<Vec<_>>())
            }
            _ => ViewCell::half_space(random.vector(1.0), random.direction()),
        };
        if let Ok(cell) = cell {
            return cell;
        }
    }
}

/// Cases for each class of cell: as many as `LODMARK_BOUND_CASES` says.
fn trials() -> u32 {
    bound_count(1_000)
}

/// An angle in (0, 90) degrees: small ones, middle ones, and ones close to 90.
fn random_angle(random: &mut Random) -> f64 {
    let x = random.unit();
    match (3.0 * random.unit()) as u32 {
        0 => 1e-4 * libm::pow(1e3, x),
        1 => 0.05 + 1.4 * x,
        _ => FRAC_PI_2 - 1e-4 * libm::pow(1e3, x),
    }
}

/// A point outside the cell, near it and far from it, and a direction; now and then towards it or along an edge of it.
fn random_task(cell: &ViewCell, random: &mut Random) -> (DVec3, DVec3) {
    loop {
        let point = random.vector(1.0) * libm::pow(10.0, random.unit() + 0.2);
        if cell.contains(point) {
            continue;
        }
        let corner = cell.corners().map_or(DVec3::ZERO, |c| c[0]);
        let direction = match (8.0 * random.unit()) as u32 {
            0 => (corner - point).normalize(),
            1 => match cell.shape() {
                Shape::Plane { normal, .. }
                | Shape::HalfSpace { normal, .. }
                | Shape::Polygon { normal, .. } => *normal,
                Shape::Line { direction, .. } => *direction,
                _ => (cell.corners().map_or(DVec3::X, |c| c[c.len() - 1]) - point).normalize(),
            },
            _ => random.direction(),
        };
        return (point, direction);
    }
}

#[test]
fn no_sampled_viewpoint_beats_a_claimed_extent() {
    let (mut unbounded, mut worst) = (0_u32, 0.0_f64);
    for (class, seed) in CLASSES.into_iter().zip(1_000..) {
        let mut random = Random(seed);
        for case in 0..trials() {
            let cell = random_cell(class, &mut random);
            let (point, direction) = random_task(&cell, &mut random);
            let theta = random_angle(&mut random);
            let told = format!("{class} {case}: {cell:?} {point} {direction} {theta}");
            let Extent { length, viewpoint } = extent(&cell, point, direction, aperture(theta));
            let sampler = Sampler { cell: &cell };
            if length.is_infinite() {
                unbounded += 1;
                // The angle between the ray to the point and the direction bounds every move.
                let of_ray = |v| angle_from(DVec3::ZERO, point - v, direction);
                let seen = sampler.largest(&mut random, of_ray);
                assert!(seen <= theta + 1e-7, "{told}: {seen}");
                continue;
            }
            let mut moved = point + direction * length;
            let from = viewpoint.expect("one that limits it");
            let off = cell.distance_to_point(from);
            assert!(off <= 1e-9 * (1.0 + from.length()), "{told}: {from}");
            // Towards a viewer the point may move up to the viewer, where it is seen under every angle and none.
            if (moved - from).length() < 1e-6 * (point - from).length() {
                moved = point + direction * (length * (1.0 - 1e-6));
            } else {
                let claimed = angle_between(from, point, moved);
                let off = (claimed - theta).abs();
                assert!(off <= 1e-7 * theta, "{told}: {claimed} from {from}");
            }
            let seen = sampler.largest(&mut random, |v| angle_between(v, point, moved));
            worst = worst.max(seen / theta - 1.0);
            assert!(seen <= theta * (1.0 + 1e-7), "{told}: {seen}");
        }
    }
    eprintln!(
        "{unbounded} unbounded; a sampled angle was above the aperture by at most {worst:e} of it"
    );
    assert!(unbounded > trials() / 10, "{unbounded}");
}

#[test]
fn no_sampled_viewpoint_beats_a_claimed_error() {
    let mut worst = 0.0_f64;
    for (class, seed) in CLASSES.into_iter().zip(2_000..) {
        let mut random = Random(seed);
        for case in 0..trials() {
            let cell = random_cell(class, &mut random);
            let (point, direction) = random_task(&cell, &mut random);
            let moved = point + direction * libm::pow(10.0, -6.0 * random.unit() + 1.0);
            let told = format!("{class} {case}: {cell:?} {point} {moved}");
            let found = error(&cell, point, moved);
            // Positions are rounded, which a viewer close to them sees.
            let noise = 1e-14 / cell.distance_to_hull(&[point, moved]).max(1e-14);
            let sampler = Sampler { cell: &cell };
            let radians = found.radians;
            if let Some(from) = found.viewpoint {
                let off = cell.distance_to_point(from);
                assert!(off <= 1e-9 * (1.0 + from.length()), "{told}: {from}");
                let claimed = angle_between(from, point, moved);
                let off = (claimed - radians).abs();
                assert!(off <= 1e-7 * claimed + noise, "{told}: {claimed} at {from}");
            } else {
                assert!(radians <= 0.0 || radians >= PI, "{told}");
            }
            let seen = sampler.largest(&mut random, |v| angle_between(v, point, moved));
            if radians > 1e-6 {
                worst = worst.max(seen / radians - 1.0);
            }
            let most = radians * (1.0 + 1e-7) + noise;
            assert!(seen <= most, "{told}: {seen} above {found:?}");
        }
    }
    eprintln!("a sampled angle was above the error by at most {worst:e} of it");
}

#[test]
fn an_angle_of_90_degrees_or_more_or_below_0_is_refused() {
    for degrees in [90.0, 180.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = Aperture::degrees(degrees).expect_err("out of range");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("less than 90"), "{error}");
    }
    assert!(Aperture::degrees(89.999_999).is_ok());
}

#[test]
fn without_an_angle_only_moves_that_nobody_sees_are_valid() {
    let zero = aperture(0.0);
    let eye = ViewCell::point(DVec3::ZERO).expect("a point");
    let ahead = ViewCell::segment([DVec3::ZERO, at(1.0, 0.0, 0.0)]).expect("a segment");
    let m = at(3.0, 0.0, 0.0);
    for (cell, direction, length) in [
        (&eye, DVec3::Y, 0.0),
        (&eye, DVec3::X, f64::INFINITY),
        (&eye, -DVec3::X, 3.0),
        (&ahead, DVec3::X, f64::INFINITY),
        (&ahead, -DVec3::X, 2.0),
        (&ahead, DVec3::Z, 0.0),
    ] {
        assert_eq!(extent(cell, m, direction, zero).length, length);
    }
    for cell in [
        ViewCell::line(DVec3::ZERO, DVec3::X),
        ViewCell::plane(DVec3::ZERO, DVec3::X),
        ViewCell::half_space(DVec3::ZERO, DVec3::X),
    ] {
        let found = extent(&cell.expect("a cell"), at(1.0, 1.0, 0.0), DVec3::X, zero);
        assert_eq!(found.length, 0.0);
    }
}

#[test]
fn a_point_in_the_cell_may_not_move_and_its_error_is_half_a_turn() {
    for cell in [
        ViewCell::point(DVec3::ZERO),
        ViewCell::segment([-DVec3::X, DVec3::X]),
        ViewCell::line(DVec3::ZERO, DVec3::Y),
        ViewCell::polygon(&square()),
        ViewCell::plane(DVec3::ZERO, DVec3::Z),
        ViewCell::cuboid(-DVec3::ONE, DVec3::ONE),
        ViewCell::half_space(DVec3::ZERO, DVec3::Z),
    ] {
        let cell = cell.expect("a cell");
        for theta in [0.0, 0.1, 1.5] {
            let found = extent(&cell, DVec3::ZERO, at(0.6, 0.0, 0.8), aperture(theta));
            assert_eq!(found.length, 0.0, "{cell:?}");
        }
        // At one end, and between the ends.
        for from in [DVec3::ZERO, at(0.0, 0.0, -0.5)] {
            assert_eq!(error(&cell, from, DVec3::Z).radians, PI, "{cell:?}");
        }
        assert_eq!(error(&cell, DVec3::ZERO, DVec3::ZERO).radians, 0.0);
    }
}

#[test]
fn a_move_straight_away_from_every_viewer_is_not_seen() {
    let cell = ViewCell::segment([DVec3::ZERO, DVec3::X]).expect("a segment");
    let m = at(5.0, 0.0, 0.0);
    let length = |d| extent(&cell, m, d, aperture(0.1)).length;
    assert_eq!(length(DVec3::X), f64::INFINITY);
    assert_eq!(error(&cell, m, at(9.0, 0.0, 0.0)).radians, 0.0);
    // Along a line that runs through the cell's line the other way round it ends at the nearest viewer.
    near(length(-DVec3::X), 4.0, 1e-15);
    assert_eq!(length(DVec3::ZERO), f64::INFINITY);
}
