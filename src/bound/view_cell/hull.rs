//! Convex polygons that are checked, and the convex hull of a few points in space.
//!
//! The hull is found by trying every triple: O(n^4) for at most 64 points, 5 ms. Points within `FLATNESS` of the size
//! of the set from a plane lie in it; where that makes the faces contradict each other, the points are refused.
//! Everything is computed in units in which the set has a size near 1.

use std::collections::BTreeSet;

use glam::DVec3;

use super::{Shape, shape::FLATNESS};
use crate::{
    Error, Result,
    num::{
        Frame,
        math::{length, unit},
    },
};

/// The points relative to the first, in units of their size (largest box side below 1).
fn relative(points: &[DVec3]) -> Vec<DVec3> {
    let (mut low, mut high) = (points[0], points[0]);
    for &p in points {
        low = low.min(p);
        high = high.max(p);
    }
    // Halves: the difference itself could be infinite.
    let half = 0.5 * high - 0.5 * low;
    let frame = Frame::for_size(half.max_element());
    let half = |&p: &DVec3| frame.enter(0.5 * p - 0.5 * points[0]);
    points.iter().map(half).collect()
}

/// A checked polygon with its normal by the right-hand rule.
pub(super) fn polygon(corners: &[DVec3]) -> Result<Shape> {
    let refused = |what: String| Error::Usage(what);
    let p = relative(corners);
    // Newell's normal: twice the area, however the corners are chosen.
    let mut area = DVec3::ZERO;
    for (i, &a) in p.iter().enumerate() {
        area += a.cross(p[(i + 1) % p.len()]);
    }
    let Some(normal) = unit(area).filter(|_| length(area) > FLATNESS) else {
        return Err(refused(
            "the polygon has no area: its corners lie on a line or its sides cross; give a segment as the cell".into(),
        ));
    };
    if let Some(i) = p.iter().position(|q| q.dot(normal).abs() > FLATNESS) {
        return Err(refused(format!(
            "corner {i} of the polygon lies off the plane of the others; expected corners in one plane: give a \
             polyhedron as the cell"
        )));
    }
    let mut kept = Vec::new();
    let mut turned = 0.0;
    for (i, &b) in p.iter().enumerate() {
        let (a, c) = (p[(i + p.len() - 1) % p.len()], p[(i + 1) % p.len()]);
        let (into, out) = (b - a, c - b);
        let turn = into.cross(out).dot(normal);
        if turn < -FLATNESS {
            return Err(refused(format!(
                "the polygon is not convex at corner {i}; expected a convex polygon with its corners in order"
            )));
        }
        turned += crate::num::math::atan2(turn, into.dot(out));
        if turn > 0.0 {
            kept.push(corners[i]);
        }
    }
    // Once around: a star whose corners all turn left goes around twice or more.
    if turned > 1.5 * std::f64::consts::TAU {
        return Err(refused(
            "the sides of the polygon cross; expected a convex polygon with its corners in order"
                .into(),
        ));
    }
    let corners = kept;
    Ok(Shape::Polygon { corners, normal })
}

/// The convex hull of points that are not in one plane.
pub(super) fn polyhedron(points: &[DVec3]) -> Result<Shape> {
    let p = relative(points);
    let mut seen = BTreeSet::new();
    let (mut faces, mut normals) = (Vec::new(), Vec::new());
    for i in 0..p.len() {
        for j in i + 1..p.len() {
            for k in j + 1..p.len() {
                let across = (p[j] - p[i]).cross(p[k] - p[i]);
                let Some(mut normal) = unit(across).filter(|_| length(across) > FLATNESS) else {
                    continue;
                };
                let heights: Vec<f64> = p.iter().map(|&q| (q - p[i]).dot(normal)).collect();
                let above = heights.iter().any(|&h| h > FLATNESS);
                let below = heights.iter().any(|&h| h < -FLATNESS);
                if above && below {
                    continue;
                }
                if !(above || below) {
                    return Err(Error::Usage(
                        "the corners of the polyhedron lie in one plane; give a polygon as the cell".into(),
                    ));
                }
                if above {
                    normal = -normal;
                }
                let flat: Vec<usize> = (0..p.len())
                    .filter(|&q| heights[q].abs() <= FLATNESS)
                    .collect();
                if seen.insert(flat.clone()) {
                    faces.push(around(&p, &flat, normal));
                    normals.push(normal);
                }
            }
        }
    }
    if faces.is_empty() {
        return Err(Error::Usage(
            "the corners of the polyhedron lie on a line; give a segment as the cell".into(),
        ));
    }
    check_edges(&faces)?;
    let used: BTreeSet<usize> = faces.iter().flatten().copied().collect();
    let kept: Vec<usize> = used.into_iter().collect();
    let renumbered = |face: &Vec<usize>| {
        let number = |q: &usize| kept.binary_search(q).map_or(0, |n| n as u32);
        face.iter().map(number).collect()
    };
    Ok(Shape::Polyhedron {
        faces: faces.iter().map(renumbered).collect(),
        corners: kept.iter().map(|&q| points[q]).collect(),
        normals,
    })
}

/// The corners of the convex hull of coplanar points, counter-clockwise seen from where `normal` points, from the
/// smallest number on.
fn around(p: &[DVec3], flat: &[usize], normal: DVec3) -> Vec<usize> {
    // Gift wrapping from the point that is farthest along a side: it is a corner.
    let side = p[flat[1]] - p[flat[0]];
    let farther = |a: usize, b: usize| {
        let order = (p[b] - p[a]).dot(side);
        let across = (p[b] - p[a]).dot(normal.cross(side));
        order > FLATNESS * FLATNESS || (order >= -FLATNESS * FLATNESS && across > 0.0)
    };
    let mut start = flat[0];
    for &q in flat {
        if farther(start, q) {
            start = q;
        }
    }
    let mut hull = vec![start];
    for _ in 0..flat.len() {
        let from = *hull.last().unwrap_or(&start);
        let mut next = None;
        for &q in flat.iter().filter(|&&q| q != from) {
            let Some(best) = next else {
                next = Some(q);
                continue;
            };
            let (u, v): (DVec3, DVec3) = (p[best] - p[from], p[q] - p[from]);
            let turn = u.cross(v).dot(normal);
            // To the right of the best so far, or on its ray and farther away.
            if turn < -FLATNESS * FLATNESS || (turn <= FLATNESS * FLATNESS && length(v) > length(u))
            {
                next = Some(q);
            }
        }
        match next {
            Some(q) if q != start => hull.push(q),
            _ => break,
        }
    }
    let first = (0..hull.len()).min_by_key(|&i| hull[i]).unwrap_or(0);
    hull.rotate_left(first);
    hull
}

/// Every directed edge once, and its reverse once.
fn check_edges(faces: &[Vec<usize>]) -> Result<()> {
    let mut edges = BTreeSet::new();
    let mut doubled = false;
    for face in faces {
        for (i, &a) in face.iter().enumerate() {
            doubled |= !edges.insert((a, face[(i + 1) % face.len()]));
        }
    }
    if doubled || !edges.iter().all(|&(a, b)| edges.contains(&(b, a))) {
        return Err(Error::Usage(format!(
            "corners of the polyhedron are nearly in one plane, but not within {FLATNESS:e} of its size: its faces \
             cannot be told apart; move or leave out the corner that spoils a face"
        )));
    }
    Ok(())
}
