//! View cells: what is refused, what a file holds, and how far they are from triangles.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property, and `LODMARK_SEED` what they are drawn from.

#![expect(clippy::float_cmp, reason = "values that are exact")]

mod hostile;

use glam::DVec3;
use lodmark::{
    bound::view_cell::{Shape, ViewCell, file},
    num::Frame,
};
use proptest::prelude::*;

use crate::support::{at, bounded, distance, square};

#[test]
fn what_is_no_cell_is_refused_with_the_reason() {
    let [a, b, c, d] = square();
    let nan = at(f64::NAN, 0.0, 0.0);
    for (cell, said) in [
        (ViewCell::point(nan), "not finite"),
        (ViewCell::segment([a, a]), "same point"),
        (ViewCell::segment([a, nan]), "not finite"),
        (ViewCell::line(a, DVec3::ZERO), "length 0"),
        (ViewCell::plane(a, DVec3::ZERO), "length 0"),
        (ViewCell::half_space(a, nan), "not finite"),
        (ViewCell::polygon(&[a, b]), "3 to 64"),
        (ViewCell::polygon(&[a, b, c, nan]), "corner 3"),
        (ViewCell::polygon(&[a, b, c, a]), "corners 0 and 3"),
        (ViewCell::polygon(&[a, b, c, d + DVec3::Z]), "off the plane"),
        (ViewCell::polygon(&[a, c, b, d]), "polygon"),
        (
            ViewCell::polygon(&[a, b, c, -0.1 * d]),
            "convex at corner 3",
        ),
        (ViewCell::polygon(&[a, DVec3::ZERO, c]), "no area"),
        (ViewCell::polyhedron(&[a, b, c]), "4 to 64"),
        (ViewCell::polyhedron(&[a, b, c, d]), "one plane"),
        (
            ViewCell::polyhedron(&[a, 2.0 * a, 3.0 * a, 4.0 * a]),
            "on a line",
        ),
        (ViewCell::cuboid(a, b), "low below high"),
    ] {
        let error = cell.expect_err(said);
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains(said), "{error}");
    }
}

#[test]
fn a_star_with_five_tips_is_no_convex_polygon() {
    let tip = |i: i32| {
        let angle = f64::from(i) * 0.4 * std::f64::consts::TAU;
        at(libm::cos(angle), libm::sin(angle), 0.0)
    };
    let error = ViewCell::polygon(&[tip(0), tip(1), tip(2), tip(3), tip(4)]).expect_err("a star");
    assert!(error.to_string().contains("cross"), "{error}");
}

#[test]
fn corners_on_sides_are_dropped_and_either_sense_is_taken() {
    let [a, b, c, d] = square();
    let cell = ViewCell::polygon(&[a, 0.5 * (a + b), b, c, d]).expect("a square");
    assert_eq!(cell, ViewCell::polygon(&[a, b, c, d]).expect("a square"));
    let turned = ViewCell::polygon(&[d, c, b, a]).expect("a square");
    let Shape::Polygon { normal, .. } = turned.shape() else {
        panic!("a polygon")
    };
    assert_eq!(*normal, -DVec3::Z);
}

#[test]
fn a_box_has_six_faces_with_four_corners_and_needs_no_point_inside() {
    let cell = ViewCell::cuboid(at(1.0, 2.0, 3.0), at(2.0, 4.0, 6.0)).expect("a box");
    let mut more = cell.corners().expect("bounded").to_vec();
    more.insert(3, at(1.5, 3.0, 4.0));
    more.push(at(1.5, 2.0, 4.0));
    more.push(at(1.5, 2.0, 3.0));
    for cell in [cell.clone(), ViewCell::polyhedron(&more).expect("a hull")] {
        let Shape::Polyhedron {
            corners,
            faces,
            normals,
        } = cell.shape()
        else {
            panic!("a polyhedron")
        };
        assert_eq!((corners.len(), faces.len(), normals.len()), (8, 6, 6));
        assert!(faces.iter().all(|f| f.len() == 4), "{faces:?}");
    }
}

#[test]
fn a_cell_file_gives_back_the_cell_that_was_written() {
    let [a, b, c, d] = square();
    let tilted = at(1.0, 2.0, 3.0);
    for cell in [
        ViewCell::point(tilted),
        ViewCell::segment([a, tilted]),
        ViewCell::line(a, tilted),
        ViewCell::polygon(&[a, b, c, d]),
        ViewCell::plane(b, tilted),
        ViewCell::polyhedron(&[a, b, c, tilted]),
        ViewCell::cuboid(a, tilted),
        ViewCell::half_space(c, -tilted),
    ] {
        let cell = cell.expect("a cell");
        let text = file::to_json(&cell).expect("has a form");
        assert_eq!(file::from_json(&text, "-").expect("reads"), cell, "{text}");
        let frame = Frame { exponent: -7 };
        assert_eq!(cell.enter_frame(frame).leave_frame(frame), cell);
    }
}

#[test]
fn a_box_in_a_cell_file_is_what_the_manual_shows() {
    let text = r#"{"schema": 1, "cell": {"box": {"low": [0, 0, 0], "high": [1, 2, 3]}}}"#;
    let expected = ViewCell::cuboid(DVec3::ZERO, at(1.0, 2.0, 3.0)).expect("a box");
    assert_eq!(file::from_json(text, "-").expect("reads"), expected);
}

#[test]
fn a_damaged_cell_file_is_refused_with_what_was_expected() {
    let cells = r#"
        half_space: {"ball": [0, 0, 0]}
        3: {"point": [0, 0]}
        range: {"point": [0, 0, 1e999]}
        same point: {"segment": [[0, 0, 0], [0, 0, 0]]}
        normal: {"plane": {"point": [0, 0, 0]}}
        x: {"point": [0, 0, 1]}, "x": 1
        d: {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1], "d": 1}}"#;
    let of_cell = |line: &'static str| {
        let (said, cell) = line.trim().split_once(": ").expect("a pair");
        (format!(r#"{{"schema": 1, "cell": {cell}}}"#), said)
    };
    let whole = [
        ("", "cell file"),
        ("[]", "cell file"),
        (r#"{"schema": 2, "cell": {"ball": 1}}"#, "schema 2"),
        (r#"{"schema": 1}"#, "cell"),
    ];
    let whole = whole.map(|(text, said)| (text.to_string(), said));
    for (text, said) in cells.lines().skip(1).map(of_cell).chain(whole) {
        let error = file::from_json(&text, "cell.json").expect_err(&text);
        assert_eq!(error.exit_code(), 3, "{text}");
        let told = error.to_string();
        assert!(told.contains("cell.json") && told.contains(said), "{told}");
    }
}

/// Closest distance of two segments and of two triangles, by clamping; no code of the crate.
mod brute {
    use glam::DVec3;

    use crate::support::distance;

    fn point_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        (p - a.lerp(b, t)).length()
    }

    pub(super) fn segments([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> f64 {
        let first = point_segment(a, c, d).min(point_segment(b, c, d));
        let mut best = first
            .min(point_segment(c, a, b))
            .min(point_segment(d, a, b));
        let (u, v, w) = (b - a, d - c, a - c);
        let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
        let det = uu * vv - uv * uv;
        if det > 1e-12 * uu * vv {
            let s = (uv * v.dot(w) - vv * u.dot(w)) / det;
            let t = (uu * v.dot(w) - uv * u.dot(w)) / det;
            if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
                best = best.min((a.lerp(b, s) - c.lerp(d, t)).length());
            }
        }
        best
    }

    /// Where the segment goes through the triangle.
    pub(super) fn crosses([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> bool {
        let n = (b - a).cross(c - a);
        let (hp, hq) = ((p - a).dot(n), (q - a).dot(n));
        if hp * hq > 0.0 || hp == hq {
            return false;
        }
        let x = p.lerp(q, hp / (hp - hq));
        [(a, b), (b, c), (c, a)]
            .iter()
            .all(|&(x0, y0)| (y0 - x0).cross(x - x0).dot(n) >= 0.0)
    }

    pub(super) fn triangles(s: [DVec3; 3], t: [DVec3; 3]) -> f64 {
        let sides = |x: [DVec3; 3]| [[x[0], x[1]], [x[1], x[2]], [x[2], x[0]]];
        let mut best = f64::INFINITY;
        for i in 0..3 {
            best = best.min(distance(s[i], t)).min(distance(t[i], s));
            if crosses(sides(s)[i], t) || crosses(sides(t)[i], s) {
                return 0.0;
            }
            for j in 0..3 {
                best = best.min(segments(sides(s)[i], sides(t)[j]));
            }
        }
        best
    }
}

fn point() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from_array)
}

fn direction() -> impl Strategy<Value = DVec3> {
    point().prop_filter("points somewhere", |d| d.length() > 0.1)
}

/// The boundary as triangles.
fn fans(cell: &ViewCell) -> Vec<[DVec3; 3]> {
    let fan =
        |p: &[DVec3]| -> Vec<[DVec3; 3]> { (2..p.len()).map(|i| [p[0], p[i - 1], p[i]]).collect() };
    match cell.shape() {
        Shape::Polygon { corners, .. } => fan(corners),
        Shape::Polyhedron { corners, faces, .. } => faces
            .iter()
            .flat_map(|f| fan(&f.iter().map(|&i| corners[i as usize]).collect::<Vec<_>>()))
            .collect(),
        _ => panic!("a cell with faces"),
    }
}

proptest! {
    #![proptest_config(bounded(1_000))]

    #[test]
    fn the_distance_of_a_polyhedron_is_that_of_its_closest_features(
        points in prop::collection::vec(point(), 4..9),
        triangle in prop::array::uniform3(point()),
        away in point(),
    ) {
        let cell = ViewCell::polyhedron(&points).expect("points in general position");
        let triangle = triangle.map(|p| p + 2.0 * away);
        let found = cell.distance_to_triangle(triangle);
        let Shape::Polyhedron { faces, normals, corners } = cell.shape() else { panic!() };
        let behind = |p: DVec3, slack: f64| {
            faces.iter().zip(normals).all(|(f, &n)| (p - corners[f[0] as usize]).dot(n) <= slack)
        };
        prop_assert!(points.iter().all(|&p| behind(p, 1e-9)), "the hull holds all points");
        prop_assert!(points.iter().all(|&p| cell.contains(p)), "and knows it");
        let edges: usize = faces.iter().map(Vec::len).sum();
        prop_assert_eq!(corners.len() + faces.len(), edges / 2 + 2);
        let mut least = f64::INFINITY;
        for face in fans(&cell) {
            least = least.min(brute::triangles(face, triangle));
        }
        if triangle.iter().any(|&p| behind(p, 0.0)) {
            least = 0.0;
        }
        prop_assert!(found <= least, "{found} above {least}");
        prop_assert!(found >= least - 1e-12, "{found} far below {least}");
    }

    #[test]
    fn the_distance_of_a_segment_or_a_polygon_is_that_of_its_closest_features(
        corners in prop::array::uniform3(point()),
        triangle in prop::array::uniform3(point()),
        away in point(),
    ) {
        let triangle = triangle.map(|p| p + 2.0 * away);
        let polygon = ViewCell::polygon(&corners).expect("a triangle");
        let least = brute::triangles(corners, triangle);
        let found = polygon.distance_to_triangle(triangle);
        prop_assert!(found <= least && found >= least - 1e-12, "{found} and {least}");
        let ends = [corners[0], corners[1]];
        let segment = ViewCell::segment(ends).expect("a segment");
        let mut least = distance(ends[0], triangle).min(distance(ends[1], triangle));
        for i in 0..3 {
            least = least.min(brute::segments(ends, [triangle[i], triangle[(i + 1) % 3]]));
        }
        if brute::crosses(ends, triangle) {
            least = 0.0;
        }
        let found = segment.distance_to_triangle(triangle);
        prop_assert!(found <= least && found >= least - 1e-12, "{found} and {least}");
        let found = ViewCell::point(ends[0]).expect("a point").distance_to_triangle(triangle);
        let least = distance(ends[0], triangle);
        prop_assert!(found <= least && found >= least - 1e-12, "{found} and {least}");
    }

    #[test]
    fn a_cell_without_end_is_as_far_as_a_huge_one_with_ends(
        origin in point(),
        direction in direction(),
        triangle in prop::array::uniform3(point()),
        away in point(),
    ) {
        let triangle = triangle.map(|p| p + 2.0 * away);
        let u = direction.normalize();
        let line = ViewCell::line(origin, direction).expect("a line");
        let long = [origin - 50.0 * u, origin + 50.0 * u];
        let least = ViewCell::segment(long).expect("a segment").distance_to_triangle(triangle);
        let found = line.distance_to_triangle(triangle);
        // Both are lower bounds, the second less the rounding of coordinates of 50: 1.2e-11 has been seen.
        prop_assert!((found - least).abs() < 1e-10, "{found} and {least}");
        let heights = triangle.map(|p| (p - origin).dot(u));
        let (low, high) = (heights[0].min(heights[1]).min(heights[2]), heights[0].max(heights[1]).max(heights[2]));
        let half = ViewCell::half_space(origin, direction).expect("a half-space");
        let found = half.distance_to_triangle(triangle);
        prop_assert!(found <= low.max(0.0) && found >= low.max(0.0) - 1e-12);
        let plane = ViewCell::plane(origin, direction).expect("a plane");
        let found = plane.distance_to_triangle(triangle);
        let least = low.max(-high).max(0.0);
        prop_assert!(found <= least && found >= least - 1e-12);
    }

    #[test]
    fn a_distance_is_never_above_the_truth_where_numbers_are_extreme(
        exponent in -1000_i32..1000,
        triangle in prop::array::uniform3(point()),
    ) {
        let frame = Frame { exponent };
        let cell = ViewCell::cuboid(at(1.5, -1.0, -1.0), at(2.0, 1.0, 1.0)).expect("a box");
        let near = cell.distance_to_triangle(triangle);
        let scaled = cell.leave_frame(frame).distance_to_triangle(triangle.map(|p| frame.leave(p)));
        prop_assert!(frame.enter_length(scaled) <= near * (1.0 + 1e-12), "{scaled}");
        prop_assert!(scaled >= 0.0);
    }
}

#[test]
fn needles_and_points_have_a_distance_too() {
    let cell = ViewCell::cuboid(DVec3::ZERO, DVec3::ONE).expect("a box");
    let p = at(2.0, 0.5, 0.5);
    assert!((cell.distance_to_triangle([p, p, p]) - 1.0).abs() < 1e-12);
    let q = at(2.0, 0.5, 1.5);
    assert!((cell.distance_to_triangle([p, q, p]) - 1.0).abs() < 1e-12);
    assert_eq!(cell.distance_to_triangle([p, at(-1.0, 0.5, 0.5), p]), 0.0);
    assert_eq!(cell.distance_to_point(at(1.0, 1.0, 1.0)), 0.0);
    assert!(cell.contains(at(0.5, 0.5, 0.5)) && !cell.contains(at(1.1, 0.5, 0.5)));
}
