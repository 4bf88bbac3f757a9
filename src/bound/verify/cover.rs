//! Whether the pieces of an original triangle cover it exactly once, in whole numbers.
//!
//! Corners are multiples of 2^-31 of the triangle's sides. The areas of the pieces must add up to that of the triangle, no
//! piece may be turned over, and no two may overlap: for each pair there is a side of one that has the other on its
//! outside. Corners were rounded to whole units every time that a collapse cut a piece, so areas hold up to a few units
//! along every side, and sides of neighbours may have drifted apart by more. So "once" is meant up to a ten-millionth of a
//! side: narrower overlaps are not found.

use super::record::{ONE, Record};

/// Units by which corners may be off on average along a side.
const ROUNDING: f64 = 4.0;
/// Units by which two neighbours may have drifted into each other: a ten-millionth of a side.
const DRIFT: f64 = 214.0;

type Point = [i64; 2];

/// What is wrong with the pieces of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Gap {
    /// The areas of the pieces do not add up to that of the triangle.
    Area,
    /// A piece is turned over or not convex.
    Turned,
    /// Two pieces overlap.
    Overlap,
}

/// Holds the pieces of an original triangle to it; the answer is the first thing that is wrong.
pub(super) fn check(record: &Record, triangle: u32) -> Option<Gap> {
    let polygons: Vec<Vec<Point>> = record
        .of(triangle)
        .map(|piece| {
            let corners = record.piece(piece).1.iter();
            corners
                .map(|c| [i64::from(c[0]), i64::from(c[1])])
                .collect()
        })
        .collect();
    let (mut area, mut boundary) = (0_i128, 0.0_f64);
    for polygon in &polygons {
        let n = polygon.len();
        for i in 0..n {
            let (p, q) = (polygon[i], polygon[(i + 1) % n]);
            area += i128::from(p[0]) * i128::from(q[1]) - i128::from(p[1]) * i128::from(q[0]);
            let side = extent(p, q);
            boundary += side;
            let r = polygon[(i + 2) % n];
            if turn(p, q, r) < -DRIFT * (side + extent(q, r) + DRIFT) {
                return Some(Gap::Turned);
            }
        }
    }
    let whole = i128::from(ONE) * i128::from(ONE);
    if ((area - whole) as f64).abs() > ROUNDING * (boundary + f64::from(ONE)) {
        return Some(Gap::Area);
    }
    overlap(&polygons).then_some(Gap::Overlap)
}

fn extent(p: Point, q: Point) -> f64 {
    ((q[0] - p[0]).abs() + (q[1] - p[1]).abs()) as f64
}

/// Twice the area of a triangle; positive to the left.
fn turn(p: Point, q: Point, r: Point) -> f64 {
    let cross = i128::from(q[0] - p[0]) * i128::from(r[1] - p[1])
        - i128::from(q[1] - p[1]) * i128::from(r[0] - p[0]);
    cross as f64
}

/// True where two polygons have more in common than their sides.
fn overlap(polygons: &[Vec<Point>]) -> bool {
    let bounds = |polygon: &[Point]| {
        polygon
            .iter()
            .fold([i64::MAX, i64::MIN, i64::MAX, i64::MIN], |b, p| {
                [
                    b[0].min(p[0]),
                    b[1].max(p[0]),
                    b[2].min(p[1]),
                    b[3].max(p[1]),
                ]
            })
    };
    let mut order: Vec<([i64; 4], &Vec<Point>)> = polygons.iter().map(|p| (bounds(p), p)).collect();
    order.sort_by_key(|(b, _)| *b);
    for (i, (b, polygon)) in order.iter().enumerate() {
        for (c, other) in &order[i + 1..] {
            if c[0] >= b[1] {
                break;
            }
            if c[2] >= b[3] || b[2] >= c[3] {
                continue;
            }
            if !apart(polygon, other) && !apart(other, polygon) {
                return true;
            }
        }
    }
    false
}

/// True where a side of `polygon` has all of `other` on its outside, up to rounding.
fn apart(polygon: &[Point], other: &[Point]) -> bool {
    let n = polygon.len();
    (0..n).any(|i| {
        let (p, q) = (polygon[i], polygon[(i + 1) % n]);
        let side = extent(p, q);
        side > 0.0
            && other
                .iter()
                .all(|&r| turn(p, q, r) <= DRIFT * (side + DRIFT))
    })
}
