//! Faces in space: exact above a plane of viewers, conservative elsewhere.

use glam::{DVec2, DVec3};
use lodmark::bound::{
    face::{conservative_interval, face_interval},
    planar::{Aperture, Interval},
    view_cell::ViewCell,
};

use super::seen::{cases, largest_of_two};
use crate::support::{aperture, at};

fn angle(v: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (a, b) = (a - v, b - v);
    a.cross(b).length().atan2(a.dot(b))
}

/// The largest angle that a sampled viewer on a plane sees between two points above it.
fn seen(point: DVec3, normal: DVec3, a: DVec3, b: DVec3) -> f64 {
    let height = (a - point).dot(normal);
    let foot = a - normal * height;
    let e = normal.any_orthonormal_vector();
    let f = normal.cross(e);
    let from = |s: f64, t: f64| {
        let along = |t: f64| ((t - 0.5) * std::f64::consts::PI * 0.99999).tan() * height;
        foot + e * along(s) + f * along(t)
    };
    largest_of_two(|s, t| angle(from(s, t), a, b), [24, 24], 3).0
}

#[test]
fn no_viewer_below_a_face_sees_more_than_its_interval_claims() {
    let (count, mut random) = cases(300);
    for number in 0..count {
        let (point, normal) = (random.vector(3.0), random.direction());
        let corners = [(); 3].map(|()| {
            let p = random.vector(5.0);
            let height = (p - point).dot(normal);
            p + normal * (random.between(0.5, 6.0) - height)
        });
        let d = random.direction();
        let theta = random.between(0.003, 0.8);
        let cell = ViewCell::half_space(point, normal).expect("a unit normal");
        let found = face_interval(&cell, &corners, d, aperture(theta));
        assert!(found.exact);
        let (mut inside, [a, b, c]) = (corners.to_vec(), corners);
        for _ in 0..3 {
            let (s, t) = (random.unit(), random.unit());
            inside.push(a + ((b - a) * s + (c - a) * (1.0 - s)) * t);
        }
        for (rho, sign) in [(found.offsets.max, 1.0), (found.offsets.min, -1.0)] {
            let worst = |rho: f64| {
                let seen = inside.iter().map(|&p| {
                    let way = rho - p.dot(d);
                    let seen = || seen(point, normal, p, p + d * way);
                    if way * sign <= 0.0 { 0.0 } else { seen() }
                });
                seen.fold(0.0, f64::max)
            };
            let at = worst(rho);
            assert!(at <= theta * (1.0 + 1e-6), "case {number}: {at} > {theta}");
            let ways = corners.map(|p| (rho - p.dot(d)).abs());
            let step = ways.into_iter().fold(0.0, f64::max);
            let beyond = worst(rho + sign * (step * 1e-3 + 1e-6));
            let least = theta * (1.0 - 1e-6);
            assert!(beyond > least, "case {number}: {beyond} <= {theta} beyond");
        }
    }
}

#[test]
fn a_conservative_interval_holds_no_offset_that_someone_sees() {
    let (count, mut random) = cases(301);
    for number in 0..count {
        let ends = [random.vector(3.0), random.vector(3.0)];
        let away = random.direction() * random.between(6.0, 20.0);
        let corners = [(); 3].map(|()| away + random.vector(2.0));
        let d = random.direction();
        let theta = random.between(0.003, 0.8);
        let cell = ViewCell::segment(ends).expect("two points");
        let found = face_interval(&cell, &corners, d, aperture(theta));
        assert!(!found.exact);
        let distance = cell.distance_to_triangle(corners);
        let expected = conservative_interval(distance, &corners, d, aperture(theta));
        assert_eq!(found.offsets, expected);
        for rho in [found.offsets.min, found.offsets.max] {
            if found.offsets.is_empty() {
                continue;
            }
            let seen = |s: f64, t: f64| {
                let v = ends[0] + (ends[1] - ends[0]) * s;
                // Along two edges and across.
                let p = corners[0] + (corners[1] - corners[0]) * t;
                let q = corners[2] + (p - corners[2]) * s;
                let moved = |p: DVec3| p + d * (rho - p.dot(d));
                angle(v, p, moved(p)).max(angle(v, q, moved(q)))
            };
            let (worst, _) = largest_of_two(seen, [16, 16], 3);
            assert!(worst <= theta * (1.0 + 1e-9), "{number}: {worst} > {theta}");
        }
    }
}

#[test]
fn a_face_that_reaches_into_its_cell_stays_in_its_plane() {
    let corners = [at(0.0, 0.0, -1.0), at(0.0, 0.0, 2.0), at(3.0, 0.0, 2.0)];
    let half_space = ViewCell::half_space(DVec3::ZERO, DVec3::Z).expect("a normal");
    let plane = ViewCell::plane(DVec3::ZERO, DVec3::Z).expect("a normal");
    let near = ViewCell::cuboid(DVec3::splat(-2.0), DVec3::splat(0.5)).expect("a box");
    // Along y the face lies in its own plane only, and a box around a corner leaves nothing but that plane.
    for (cell, exact) in [(&half_space, true), (&plane, true), (&near, false)] {
        let found = face_interval(cell, &corners, DVec3::Y, aperture(0.02));
        assert_eq!((found.offsets, found.exact), (Interval::at(0.0), exact));
    }
    // Along x its part in the cell has more than one offset.
    let found = face_interval(&half_space, &corners, DVec3::X, aperture(0.02));
    assert!(found.offsets.is_empty());
}

#[test]
fn a_plane_of_viewers_sees_to_both_sides() {
    let aperture = Aperture::degrees(5.0).expect("below 90");
    let plane = ViewCell::plane(DVec3::ZERO, DVec3::Z).expect("a normal");
    let above = [at(0.0, 0.0, 2.0), at(1.0, 0.0, 3.0), at(0.0, 2.0, 4.0)];
    let below = above.map(|p| DVec3::new(p.x, p.y, -p.z));
    let d = DVec2::from_angle(0.7);
    let (up, down) = (DVec3::new(d.x, 0.0, d.y), DVec3::new(d.x, 0.0, -d.y));
    let space = ViewCell::half_space(DVec3::ZERO, DVec3::Z).expect("a normal");
    let expected = face_interval(&space, &above, up, aperture).offsets;
    for (face, direction) in [(&above, up), (&below, down)] {
        let found = face_interval(&plane, face, direction, aperture);
        assert_eq!(found.offsets, expected);
    }
}
