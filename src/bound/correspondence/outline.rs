//! The outlines of the union of several pieces of one original triangle, in the plane of a layout.
//!
//! Sides that two pieces have in opposite directions, bit for bit in the triangle, cancel out; what is left are closed
//! outlines. Nothing here depends on rounding: whatever the pieces are, the sides of the outlines add up to theirs.

use glam::DVec2;

use super::sides::Side;
use crate::num::{Each, fixed::Weights31};

/// Sides of the pieces of one triangle in one layout: a map that needs more is a tangle.
const SIDES: usize = 2_048;

/// Units by which a corner may lie on the wrong side of a line: roundings of several cuts.
const ROUNDED: i64 = 256;

/// A corner of a piece in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OutlineCorner {
    pub(super) source: Weights31,
    pub(super) plane: DVec2,
    /// On the rim of the layout, where the triangle across the side goes on and has this corner as well.
    pub(super) fixed: bool,
}

/// Buffers.
#[derive(Clone, Debug, Default)]
pub(super) struct OutlineScratch {
    sides: Vec<[OutlineCorner; 2]>,
    path: Vec<OutlineCorner>,
}

/// The outlines of pieces one after the other, with their ends; `None` for a tangle.
pub(super) fn outlines<'a>(
    pieces: impl Iterator<Item = &'a [OutlineCorner]>,
    scratch: &mut OutlineScratch,
    corners: &mut Vec<OutlineCorner>,
    ends: &mut Vec<usize>,
) -> Option<()> {
    let OutlineScratch { sides, path } = scratch;
    sides.clear();
    corners.clear();
    ends.clear();
    for piece in pieces {
        for (i, &p) in piece.iter().enumerate() {
            let q = piece[(i + 1) % piece.len()];
            let back = sides
                .iter()
                .position(|[a, b]| a.source == q.source && b.source == p.source);
            if let Some(back) = back {
                sides.remove(back);
            } else if p.source != q.source {
                sides.push([p, q]);
            }
        }
        if sides.len() > SIDES {
            return None;
        }
    }
    while let Some(first) = sides.first().copied() {
        sides.remove(0);
        path.clear();
        path.push(first[0]);
        let mut end = first[1];
        loop {
            if let Some(met) = path.iter().position(|c| c.source == end.source) {
                let start = corners.len();
                corners.extend(path.drain(met..));
                simplify(corners, start);
                if corners.len() > start {
                    ends.push(corners.len());
                }
                if path.is_empty() {
                    break;
                }
            }
            let next = sides.iter().position(|[a, _]| a.source == end.source)?;
            let [from, to] = sides.remove(next);
            path.push(from);
            end = to;
        }
    }
    Some(())
}

/// Leaves out corners of the outline from `start` on that its sides do not need: inside a side of the triangle, where no
/// other piece has one, and not on the rim. An outline of which nothing is left covers nothing.
fn simplify(corners: &mut Vec<OutlineCorner>, start: usize) {
    let mut i = start;
    while corners.len() > start + 2 && i < corners.len() {
        let n = corners.len() - start;
        let [before, after] = [n - 1, 1].each(|k| corners[start + (i - start + k) % n].source);
        let inside = Side::of(before, after).is_some_and(|side| side.has(corners[i].source));
        if (inside && !corners[i].fixed) || before == after {
            corners.remove(i);
            i = start.max(i.saturating_sub(2));
        } else {
            i += 1;
        }
    }
    if corners.len() < start + 3 {
        corners.truncate(start);
    }
}

/// Leaves out what adds nothing to a part: repeated corners, ways there and back, and parts along a side of the triangle.
pub(super) fn tidy(part: &[OutlineCorner], into: &mut Vec<OutlineCorner>) {
    into.clear();
    for &corner in part {
        if into.last().is_some_and(|c| c.source == corner.source) {
            continue;
        }
        if into.len() > 1 && into[into.len() - 2].source == corner.source {
            into.pop();
            continue;
        }
        into.push(corner);
    }
    loop {
        let n = into.len();
        if n > 1 && into[0].source == into[n - 1].source {
            into.pop();
        } else if n > 2 && into[0].source == into[n - 2].source {
            into.truncate(n - 2);
        } else if n > 2 && into[1].source == into[n - 1].source {
            into.remove(0);
        } else {
            break;
        }
    }
    let along = |c: &[OutlineCorner]| {
        Side::of(c[0].source, c[1].source).is_some_and(|side| c.iter().all(|c| side.has(c.source)))
    };
    if into.len() < 3 || along(into) {
        into.clear();
    }
}

/// Turns a part so that all triangles from its first corner lie the right way up in the original triangle; false where no
/// corner sees all others, up to rounding.
pub(super) fn turn_to_fan(part: &mut [OutlineCorner]) -> bool {
    let n = part.len();
    let place = &|i: usize| part[i % n].source.bits().each(i64::from);
    // Twice the least area of a triangle from a corner, with what rounding may have taken from it given back.
    let least = |first: usize| {
        let from = move |i: usize| {
            let ([a, b], [c, d]) = (place(first), place(first + i));
            [c - a, d - b]
        };
        (2..n).map(move |i| {
            let ([a, b], [c, d]) = (from(i - 1), from(i));
            let size = [a, b, c, d].each(i64::abs).into_iter().max().unwrap_or(0);
            i128::from(a) * i128::from(d) - i128::from(b) * i128::from(c)
                + i128::from(ROUNDED) * i128::from(size)
        })
    };
    let first = (0..n).find(|&first| least(first).all(|area| area >= 0));
    if let Some(first) = first {
        part.rotate_left(first);
    }
    first.is_some()
}
