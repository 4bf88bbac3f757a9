//! No viewpoint of a segment sees more than its extent claims, and one sees as much.

use glam::DVec2;
use lodmark::bound::planar::{
    Aperture, Rays, ViewerSegment, segment_error, segment_extent, segment_extents, viewpoint_extent,
};

use super::seen::{angle, cases, largest};
use crate::support::aperture;

struct Case {
    cell: [DVec2; 2],
    point: DVec2,
    direction: DVec2,
    theta: f64,
}

impl Case {
    fn cell(&self) -> ViewerSegment {
        ViewerSegment::between(self.cell[0], self.cell[1]).expect("finite ends")
    }

    fn viewpoint(&self, s: f64) -> DVec2 {
        self.cell[0] + (self.cell[1] - self.cell[0]) * s
    }

    /// The largest angle that sampling finds between the point and itself moved by `length`.
    fn sampled(&self, length: f64, samples: u32) -> f64 {
        let moved = self.point + self.direction * length;
        largest(|s| angle(self.viewpoint(s), self.point, moved), samples).0
    }
}

fn draw(stream: u64) -> impl Iterator<Item = Case> {
    let (count, mut random) = cases(stream);
    (0..count).map(move |i| {
        let mut at =
            |size: f64| DVec2::new(random.between(-size, size), random.between(-size, size));
        let (a, b, point) = (at(5.0), at(5.0), at(12.0));
        let theta = match i % 4 {
            0 => random.between(0.001, 0.01),
            3 => random.between(0.5, 1.5),
            _ => random.between(0.01, 0.5),
        };
        Case {
            // Some cells are one viewpoint.
            cell: [a, if i % 16 == 5 { a } else { b }],
            point,
            direction: DVec2::from_angle(random.between(0.0, std::f64::consts::TAU)),
            theta,
        }
    })
}

#[test]
fn no_viewpoint_of_a_segment_sees_more_than_the_extent_claims() {
    let (mut limited, mut inner, mut unbounded) = (0, 0, 0);
    for (i, case) in draw(1).enumerate() {
        let (theta, aperture) = (case.theta, aperture(case.theta));
        let extent = segment_extent(&case.cell(), case.point, case.direction, aperture);
        if extent.length == f64::INFINITY {
            unbounded += 1;
            assert!(extent.viewpoint.is_none(), "case {i}");
            for length in [1e-3, 1.0, 30.0, 1e4, 1e7] {
                let more = case.sampled(length, 160) - theta * (1.0 + 1e-9);
                assert!(more <= 1e-12, "case {i}: {more} more at {length}");
            }
            continue;
        }
        limited += 1;
        let viewpoint = extent.viewpoint.expect("a limit has its viewpoint");
        let ends = case.cell.iter().any(|&e| e.distance(viewpoint) < 1e-9);
        inner += usize::from(!ends);
        let moved = case.point + case.direction * extent.length;
        let there = angle(viewpoint, case.point, moved);
        let off = (there - theta).abs();
        assert!(off < 1e-6 * theta, "case {i}: {there} and not {theta}");
        let seen = case.sampled(extent.length, 160);
        assert!(seen <= theta * (1.0 + 1e-8), "case {i}: {seen} > {theta}");
        let beyond = |samples| case.sampled(extent.length * (1.0 + 1e-4), samples);
        let found = [160, 2000, 100_000].into_iter().any(|n| beyond(n) > theta);
        assert!(found, "case {i}: nobody sees {theta} beyond the claim");
    }
    let many = limited > inner && inner > limited / 20 && unbounded > limited / 50;
    assert!(many, "{limited} {inner} {unbounded}");
}

#[test]
fn no_viewpoint_of_a_line_sees_more_than_the_extent_claims() {
    for (i, case) in draw(2).enumerate() {
        if case.cell[0] == case.cell[1] {
            continue;
        }
        let theta = case.theta;
        let along = case.cell[1] - case.cell[0];
        let line = ViewerSegment::line(case.cell[0], along).expect("two points");
        let extent = segment_extent(&line, case.point, case.direction, aperture(theta));
        // Viewpoints of the whole line, as the tangent of an angle about the foot of the point.
        let unit = along / along.length();
        let foot = case.cell[0] + unit * (case.point - case.cell[0]).dot(unit);
        let height = case.point.distance(foot);
        let sampled = |length: f64| {
            let moved = case.point + case.direction * length;
            let seen = |s: f64| {
                let turn = (s - 0.5) * std::f64::consts::PI * 0.999_999;
                angle(foot + unit * (height * turn.tan()), case.point, moved)
            };
            largest(seen, 400).0
        };
        let seen = sampled(extent.length);
        assert!(seen <= theta * (1.0 + 1e-6), "case {i}: {seen} > {theta}");
        let beyond = sampled(extent.length * (1.0 + 1e-4));
        assert!(beyond > theta, "case {i}: {beyond} <= {theta}");
    }
}

#[test]
fn the_worst_viewpoint_of_a_moved_point_is_found() {
    let mut touching = 0;
    for (i, case) in draw(3).enumerate() {
        let moved = case.point + case.direction * (case.theta * 20.0);
        let worst = segment_error(&case.cell(), case.point, moved);
        let viewpoint = worst.viewpoint.expect("an angle is seen from somewhere");
        let (most, seen) = (worst.angle, |v| angle(v, case.point, moved));
        let sampled = largest(|s| seen(case.viewpoint(s)), 400).0;
        if most == std::f64::consts::PI {
            touching += 1;
            let away = viewpoint.distance(case.point) + viewpoint.distance(moved);
            assert!((away - case.point.distance(moved)).abs() < 1e-9, "case {i}");
            continue;
        }
        assert!(sampled <= most + 1e-9, "case {i}: {sampled} > {most}");
        assert!(most <= sampled * (1.0 + 1e-4), "{i}: {most} > {sampled}");
        assert!((seen(viewpoint) - most).abs() < 1e-9, "case {i}");
    }
    assert!(touching > 5, "only {touching} points touch their cell");
}

#[test]
fn a_column_of_extents_has_the_bits_of_one_by_one() {
    let all: Vec<Case> = draw(4).collect();
    let cell = all[0].cell();
    let aperture = aperture(0.02);
    let column = |f: fn(&Case) -> f64| all.iter().map(f).collect::<Vec<f64>>();
    let (x, y) = (&column(|c| c.point.x), &column(|c| c.point.y));
    let (dx, dy) = (&column(|c| c.direction.x), &column(|c| c.direction.y));
    let rays = Rays { x, y, dx, dy };
    let (mut lengths, mut viewpoints) = (vec![0.0; all.len()], vec![0.0; all.len()]);
    segment_extents(&cell, rays, aperture, &mut lengths, &mut viewpoints).expect("equal columns");
    for (i, case) in all.iter().enumerate() {
        let one = segment_extent(&cell, case.point, case.direction, aperture);
        assert_eq!(one.length.to_bits(), lengths[i].to_bits(), "case {i}");
        match one.viewpoint {
            Some(v) => assert_eq!(v, cell.viewpoint(viewpoints[i]), "case {i}"),
            None => assert!(viewpoints[i].is_nan(), "case {i}"),
        }
    }
    let error = segment_extents(&cell, rays, aperture, &mut lengths[1..], &mut viewpoints);
    assert!(error.is_err_and(|e| e.exit_code() == 2));
}

#[test]
fn a_point_at_a_viewpoint_may_not_move() {
    let aperture = aperture(0.17);
    let cell = ViewerSegment::on_x_axis(-1.0, 1.0);
    for x in [-1.0, -0.3, 0.0, 1.0] {
        for gamma in [0.0, 0.4, 1.57, 3.0, 4.0] {
            let d = DVec2::from_angle(gamma);
            let extent = segment_extent(&cell, DVec2::new(x, 0.0), d, aperture);
            assert_eq!(extent.length, 0.0, "{x} {gamma}");
            assert_eq!(extent.viewpoint, Some(DVec2::new(x, 0.0)));
        }
    }
    let here = viewpoint_extent(DVec2::ONE, DVec2::ONE, DVec2::X, aperture);
    assert_eq!(here, 0.0);
}

#[test]
fn a_point_on_the_line_beside_its_segment_is_not_taken_for_one_in_it() {
    let theta = 0.1_f64;
    let cell = ViewerSegment::on_x_axis(-1.0, 1.0);
    let extent = |d| segment_extent(&cell, DVec2::new(4.0, 0.0), d, aperture(theta));
    let across = extent(DVec2::Y);
    let off = (across.length - 3.0 * theta.tan()).abs();
    assert!(off < 1e-12, "{across:?}");
    assert_eq!(across.viewpoint, Some(DVec2::X));
    assert_eq!(extent(DVec2::X).length, f64::INFINITY);
    assert_eq!(extent(-DVec2::X).length, 3.0);
}

#[test]
fn without_tolerance_no_point_may_move_across_the_sight() {
    let length = |first: f64, last: f64, point: DVec2, d: DVec2| {
        let cell = ViewerSegment::on_x_axis(first, last);
        segment_extent(&cell, point, d, aperture(0.0)).length
    };
    let (x, y, tilted) = (DVec2::X, DVec2::Y, DVec2::from_angle(0.3));
    for d in [y, x, -y, -x, tilted] {
        for end in [1.0, f64::INFINITY] {
            assert_eq!(length(-end, end, DVec2::new(0.2, 3.0), d), 0.0, "{d}");
        }
    }
    for (d, expected) in [(y, f64::INFINITY), (-y, 3.0), (x, 0.0)] {
        assert_eq!(length(2.0, 2.0, DVec2::new(2.0, 3.0), d), expected);
    }
}

#[test]
fn an_angle_that_bounds_nothing_is_refused() {
    for angle in [90.0, 120.0, -0.1, f64::NAN, f64::INFINITY] {
        let error = Aperture::degrees(angle).expect_err("no half-aperture");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("less than 90"), "{error}");
    }
    assert!(Aperture::radians(std::f64::consts::FRAC_PI_2).is_err());
    let wide = Aperture::degrees(89.9999).expect("below 90");
    let cell = ViewerSegment::on_x_axis(-1.0, 1.0);
    let extent = segment_extent(&cell, DVec2::Y, DVec2::X, wide);
    let moved = DVec2::new(extent.length, 1.0);
    let seen = largest(|s| angle(DVec2::X * (2.0 * s - 1.0), DVec2::Y, moved), 400);
    assert!((seen.0 - wide.angle()).abs() < 1e-9, "{seen:?} {extent:?}");
}

#[test]
fn a_cell_without_place_is_refused() {
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(ViewerSegment::between(DVec2::ZERO, DVec2::new(bad, 0.0)).is_err());
        assert!(ViewerSegment::line(DVec2::new(bad, 0.0), DVec2::X).is_err());
    }
    assert!(ViewerSegment::line(DVec2::ZERO, DVec2::ZERO).is_err());
    let tiny = ViewerSegment::between(DVec2::ZERO, DVec2::new(1e-200, 1e-200)).expect("two points");
    assert!(tiny.ends()[1] > 1.4e-200, "{tiny:?}");
}
