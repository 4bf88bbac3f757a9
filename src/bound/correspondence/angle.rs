//! A limit on the angle between a piece of surface and what stands for it, for an observer anywhere in a view cell.
//!
//! First by distance (notes, 4.7): what lies within `d sin T` of a point at the distance `d` subtends at most `T`. Where
//! that fails, by direction, which allows much more along the lines of sight: for points `P` of a piece, displacements
//! `D` and viewpoints `V`, the tangent of the angle is `|D x (P - V)| / ((P - V) . (P + D - V))`. Over a piece and a
//! convex part of the cell the numerator is at most that for the piece's centre, which is bilinear in piece and part
//! and so largest at corners, plus `|D|` times the piece's radius; the denominator is at least the product of the least
//! depths of both pieces along one direction less half the square of `D` across it. So a part is decided by corners
//! alone, and halved where that does not decide it: an angle that is too large at a corner refuses at once. The angle
//! of a pair of points takes its maximum over a polyhedron on its faces, as the set of viewpoints with a larger angle
//! is connected and contains the points themselves, which are outside (the distance is not 0).
//! Units: any in which surface and cell are near the origin, compared with their sizes. Rounding: a ten-millionth of a
//! limit is given away for it, and of lengths the 10^13th part of the largest coordinate.

use glam::DVec3;

use super::Allowance;
use crate::{
    bound::view_cell::{Shape, ViewCell},
    num::{
        Frame,
        math::{cos, length, sin, unit},
    },
};

/// The part of every limit that is given away, and a part of the largest coordinate.
const MARGIN: f64 = 1e-7;
const ABSOLUTE: f64 = 1e-13;
/// Most times that a part of a cell is halved.
const DEPTH: u32 = 10;
/// Parts that are looked at for one piece.
const PARTS: u32 = 64;

/// The limit of an angle for a view cell.
#[derive(Clone, Debug)]
pub struct AngleLimit {
    radii: Vec<f64>,
    tangent: f64,
    /// The largest error of a displacement by rounding.
    absolute: f64,
    /// Convex parts that together hold a viewpoint with the largest angle; none for a cell without an end.
    parts: Vec<Vec<DVec3>>,
}

impl AngleLimit {
    /// The limit `angle` (radians, in [0, pi/2)) for viewers in `cell` of a surface, in the same units; the rounding of
    /// coordinates is paid for, so that there should be no common offset to them. O(n).
    pub fn new(originals: &[[DVec3; 3]], cell: &ViewCell, angle: f64) -> Self {
        let sine = sin(angle);
        // An endless cell is told by one of its points, wherever that is.
        let place = match cell.shape() {
            Shape::Line { point, .. }
            | Shape::Plane { point, .. }
            | Shape::HalfSpace { point, .. } => Some(point),
            _ => None,
        };
        let largest = originals
            .iter()
            .flatten()
            .chain(place)
            .fold(0.0_f64, |most, p| most.max(p.abs().max_element()));
        let absolute = Frame::for_size(largest).leave_length(ABSOLUTE, 1);
        let radius = |&corners: &[DVec3; 3]| {
            let allowed = cell.distance_to_triangle(corners) * sine;
            (allowed * (1.0 - MARGIN) - absolute).max(0.0)
        };
        Self {
            radii: originals.iter().map(radius).collect(),
            tangent: sine / cos(angle) * (1.0 - MARGIN),
            absolute,
            parts: parts(cell),
        }
    }

    /// Decides a convex part of the cell; `left` limits the work.
    fn holds_for(&self, part: &[DVec3], piece: &Moved<'_>, depth: u32, left: &mut u32) -> bool {
        if *left == 0 {
            return false;
        }
        *left -= 1;
        let mut numerator = 0.0_f64;
        for &v in part {
            let centre = piece.centre - v;
            let rounding = self.absolute * length(centre);
            for (&p, &s) in piece.from.iter().zip(piece.to) {
                let (d, r) = (s - p, p - v);
                let exact = d.cross(r);
                let along = r.dot(s - v);
                // This very viewpoint, and this very point.
                if along <= 0.0 || exact.dot(exact) > self.tangent * self.tangent * (along * along)
                {
                    return false;
                }
                numerator = numerator.max(length(d.cross(centre)) + rounding);
            }
        }
        numerator += piece.displacement * piece.radius;
        let middle = part.iter().fold(DVec3::ZERO, |sum, &v| sum + v) / part.len() as f64;
        let Some(g) = unit(piece.centre - middle) else {
            return false;
        };
        let nearest = |points: &[DVec3]| {
            points
                .iter()
                .fold(f64::INFINITY, |low, p| low.min(p.dot(g)))
        };
        let viewer = part
            .iter()
            .fold(f64::NEG_INFINITY, |high, v| high.max(v.dot(g)));
        let (a, b) = (nearest(piece.from) - viewer, nearest(piece.to) - viewer);
        let mut across = 0.0_f64;
        for (&p, &s) in piece.from.iter().zip(piece.to) {
            let d = (s - p) - g * (s - p).dot(g);
            across = across.max(d.dot(d));
        }
        let denominator = a * b - 0.5 * across;
        if a > 0.0 && b > 0.0 && numerator <= self.tangent * denominator {
            return true;
        }
        if depth == 0 {
            return false;
        }
        let Some([one, other]) = halves(part) else {
            return false;
        };
        self.holds_for(&one, piece, depth - 1, left)
            && self.holds_for(&other, piece, depth - 1, left)
    }
}

/// A piece and what stands for it.
struct Moved<'a> {
    from: &'a [DVec3],
    to: &'a [DVec3],
    centre: DVec3,
    radius: f64,
    displacement: f64,
}

impl Allowance for AngleLimit {
    fn allows(&self, triangle: u32, from: &[DVec3], to: &[DVec3]) -> bool {
        let pairs = || from.iter().zip(to);
        let displacement = pairs().fold(0.0_f64, |d, (&p, &s)| d.max(length(s - p)));
        if displacement <= self.radius(triangle) {
            return true;
        }
        // Where the cell touches the triangle, no angle bounds a displacement.
        if self.parts.is_empty() || self.radius(triangle) <= 0.0 {
            return false;
        }
        let centre = from.iter().fold(DVec3::ZERO, |sum, &p| sum + p) / from.len() as f64;
        let piece = Moved {
            from,
            to,
            centre,
            radius: from.iter().fold(0.0_f64, |r, &p| r.max(length(p - centre))),
            displacement,
        };
        let mut left = PARTS;
        let mut parts = self.parts.iter();
        parts.all(|part| self.holds_for(part, &piece, DEPTH, &mut left))
    }

    fn radius(&self, triangle: u32) -> f64 {
        self.radii[triangle as usize]
    }
}

/// A cell in points, segments and triangles or convex polygons.
fn parts(cell: &ViewCell) -> Vec<Vec<DVec3>> {
    match cell.shape() {
        Shape::Point(at) => vec![vec![*at]],
        Shape::Segment(ends) => vec![ends.to_vec()],
        Shape::Polygon { corners, .. } => vec![corners.clone()],
        Shape::Polyhedron { corners, faces, .. } => faces
            .iter()
            .map(|f| f.iter().map(|&v| corners[v as usize]).collect())
            .collect(),
        Shape::Line { .. } | Shape::Plane { .. } | Shape::HalfSpace { .. } => Vec::new(),
    }
}

/// Two halves of a convex polygon (in order) or segment; `None` for a point.
fn halves(part: &[DVec3]) -> Option<[Vec<DVec3>; 2]> {
    let n = part.len();
    if n < 2 {
        return None;
    }
    if n == 2 {
        let middle = (part[0] + part[1]) * 0.5;
        return Some([vec![part[0], middle], vec![middle, part[1]]]);
    }
    // Across the longest side, from its middle to the corner or side across.
    let side = |i: usize| {
        let d = part[(i + 1) % n] - part[i];
        d.dot(d)
    };
    let mut longest = 0;
    for i in 1..n {
        if side(i) > side(longest) {
            longest = i;
        }
    }
    let turned: Vec<DVec3> = (0..n).map(|k| part[(longest + k) % n]).collect();
    let middle = (turned[0] + turned[1]) * 0.5;
    let (mut one, mut other) = (vec![middle], vec![middle]);
    if n.is_multiple_of(2) {
        let half = n / 2;
        let across = (turned[half] + turned[(half + 1) % n]) * 0.5;
        one.extend_from_slice(&turned[1..=half]);
        one.push(across);
        other.push(across);
        other.extend_from_slice(&turned[half + 1..]);
        other.push(turned[0]);
    } else {
        let apex = n / 2 + 1;
        one.extend_from_slice(&turned[1..=apex]);
        other.extend_from_slice(&turned[apex..]);
        other.push(turned[0]);
    }
    Some([one, other])
}
