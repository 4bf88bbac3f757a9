//! Gaps between the pieces of an original triangle, found in whole numbers and without a tolerance.
//!
//! Corners are multiples of 2^-31 of the triangle's sides. Every side of a piece must be the side of another one in the
//! opposite direction, bit for bit, or lie on a side of the triangle; and those must make up the whole side, counted by
//! their directions. Then the winding numbers of all pieces around any point add up to that of the triangle: 1 inside. So
//! every point lies in a piece, in one of the triangles from its first corner, and wherever pieces lie over each other,
//! others are turned over to make up for it; what is claimed of pieces is claimed of all their triangles, either way up.

use super::record::{ONE, Record};

type Point = [u32; 2];

/// The kind of gap that the pieces of a triangle leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Gap {
    /// A side of a piece inside the triangle is not the side of another piece in the opposite direction.
    Inside,
    /// The sides of pieces along a side of the triangle do not make it up once.
    Border,
}

/// Holds the pieces of an original triangle to it; the answer is the first thing that is wrong.
pub(super) fn check(record: &Record, triangle: u32) -> Option<Gap> {
    let mut inside: Vec<(Point, Point, i64)> = Vec::new();
    let mut border: Vec<(u32, u32, i64)> = Vec::new();
    for piece in record.of(triangle) {
        let corners = record.piece(piece).1;
        for (i, p) in corners.iter().enumerate() {
            let q = corners[(i + 1) % corners.len()];
            let (p, q) = ([p[0], p[1]], [q[0], q[1]]);
            if p == q {
                continue;
            }
            match (0..3).find_map(|side| Some((side, along(side, p)?, along(side, q)?))) {
                Some((side, from, to)) => border.extend([(side, from, -1), (side, to, 1)]),
                None if p < q => inside.push((p, q, 1)),
                None => inside.push((q, p, -1)),
            }
        }
    }
    inside.sort_unstable();
    let alone = |same: &[(Point, Point, i64)]| same.iter().map(|s| s.2).sum::<i64>() != 0;
    if inside.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).any(alone) {
        return Some(Gap::Inside);
    }
    // What begins and ends nowhere but at the ends of a side is that side.
    border.extend((0..3).flat_map(|side| [(side, 0, 1), (side, ONE, -1)]));
    border.sort_unstable();
    let open = |same: &[(u32, u32, i64)]| same.iter().map(|s| s.2).sum::<i64>() != 0;
    let gap = border.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).any(open);
    gap.then_some(Gap::Border)
}

/// The place of a point along a side of the triangle that it lies on; `None` off that side.
fn along(side: u32, [u, v]: Point) -> Option<u32> {
    match side {
        0 => (v == 0).then_some(u),
        1 => (u64::from(u) + u64::from(v) == u64::from(ONE)).then_some(v),
        _ => (u == 0).then(|| ONE - v),
    }
}
