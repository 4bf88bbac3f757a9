//! The minimum bounding sphere of a mesh: what every camera is placed around (Lindstrom & Turk 2000, section 3.2).
//!
//! Of the vertices that triangles use, not of the surface's box: a sphere that is not minimal changes every image.
//! Method: pivoting after Gaertner 1999. The farthest point joins the support of the sphere so far, and the smallest
//! sphere of those at most five points is found by trying every support of one to four of them. Farthest points are
//! compared by distance, then by coordinates, and supports are sorted before they are solved, so that the result
//! depends on the *set* of points alone: neither on their order nor on duplicates. All of it happens in a frame
//! scaled by the extent of the points, so that 1e200 does not overflow and 1e-200 does not vanish.

use std::cmp::Ordering;

use glam::DVec3;

use crate::{
    mesh::Mesh,
    num::{
        Frame,
        math::{self, scale_by_power_of_two},
    },
};

/// A sphere; lengths in the units of the points it was made from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The centre.
    pub center: DVec3,
    /// The radius, at least 0.
    pub radius: f64,
}

/// Pivots after which the best sphere so far is taken; a dozen are usual, hundreds were never seen.
const PIVOT_LIMIT: usize = 1_000;

impl Sphere {
    /// The smallest sphere that contains every vertex a triangle uses; `None` without triangles.
    ///
    /// `|p - center| <= radius` holds for each of them, computed as [`math::length`] does. The radius is minimal up to
    /// rounding (some 1e-15 of it), and infinite where it exceeds the largest `f64`.
    /// O(vertices + triangles) for each of a dozen pivots.
    pub fn of_mesh(mesh: &Mesh) -> Option<Self> {
        Self::of_points(&referenced(mesh))
    }

    /// The smallest sphere that contains `points`, all of them finite; `None` where there are none.
    ///
    /// As [`Sphere::of_mesh`]; the same bits for every order of the points and with any of them repeated.
    pub fn of_points(points: &[DVec3]) -> Option<Self> {
        let (frame, sphere) = solve_scaled(points)?;
        Some(sphere.leave_frame(frame))
    }

    /// The same sphere in units of `frame`; exact unless a number becomes subnormal.
    pub fn enter_frame(self, frame: Frame) -> Self {
        Self {
            center: frame.enter(self.center),
            radius: frame.enter_length(self.radius),
        }
    }

    /// Undoes [`Sphere::enter_frame`].
    pub fn leave_frame(self, frame: Frame) -> Self {
        Self {
            center: frame.leave(self.center),
            radius: frame.leave_length(self.radius, 1),
        }
    }
}

/// The working frame of a mesh: the one in which the radius of its minimum bounding sphere lies in [0.5, 1).
///
/// Nothing overflows on the way, whatever the coordinates. A mesh that is one point gets the frame of its largest
/// coordinate; one without triangles, or at the origin, the identity. Costs as much as [`Sphere::of_mesh`].
pub fn frame_of(mesh: &Mesh) -> Frame {
    let points = referenced(mesh);
    let Some((frame, sphere)) = solve_scaled(&points) else {
        return Frame::default();
    };
    if sphere.radius > 0.0 {
        Frame {
            exponent: frame.exponent + Frame::for_size(sphere.radius).exponent,
        }
    } else {
        Frame::for_size(points[0].abs().max_element())
    }
}

/// Every vertex that a triangle uses, once.
fn referenced(mesh: &Mesh) -> Vec<DVec3> {
    let mut used = vec![false; mesh.positions().len()];
    for &v in mesh.triangles().iter().flatten() {
        used[v as usize] = true;
    }
    let points = mesh.positions().iter().zip(used);
    points.filter_map(|(&p, used)| used.then_some(p)).collect()
}

/// The minimum sphere in a frame in which the extent of the points is about 1, and that frame.
fn solve_scaled(points: &[DVec3]) -> Option<(Frame, Sphere)> {
    let &first = points.first()?;
    let wider = |(low, high): (DVec3, DVec3), &p: &DVec3| (low.min(p), high.max(p));
    let (low, high) = points.iter().fold((first, first), wider);
    // Half the extent cannot overflow; the whole one cannot vanish among subnormal numbers.
    let half = (high * 0.5 - low * 0.5).max_element();
    let whole = (high - low).max_element();
    let frame = Frame::for_size(if half > 0.0 { half } else { whole });
    // + 0: one zero, no -0.
    let scaled: Vec<DVec3> = if frame.exponent == 0 {
        points.iter().map(|&p| p + DVec3::ZERO).collect()
    } else {
        let enter = |&p| frame.enter(p) + DVec3::ZERO;
        points.iter().map(enter).collect()
    };
    let start = frame.enter(low * 0.5) + frame.enter(high * 0.5);
    Some((frame, solve(&scaled, start)))
}

/// The minimum sphere of points with an extent near 1; `start` is any point that depends on their set alone.
fn solve(points: &[DVec3], start: DVec3) -> Sphere {
    let mut support = vec![farthest(points, start).0];
    let (mut center, mut lower) = (support[0], 0.0);
    let (mut next, mut reach) = farthest(points, center);
    let (mut best, mut best_reach) = (center, reach);
    for _ in 0..PIVOT_LIMIT {
        if reach <= lower {
            break;
        }
        support.push(next);
        let solved = smallest(&mut support);
        if solved.squared_radius <= lower {
            break; // rounding: the farthest point is outside by less than can be resolved
        }
        (center, lower, support) = (solved.center, solved.squared_radius, solved.support);
        (next, reach) = farthest(points, center);
        if reach < best_reach {
            (best, best_reach) = (center, reach);
        }
    }
    let mut radius = math::sqrt(best_reach);
    while radius * radius < best_reach {
        radius = radius.next_up();
    }
    Sphere {
        center: best,
        radius,
    }
}

/// The point farthest from `from` (of several: the greatest by coordinates) with its squared distance.
fn farthest(points: &[DVec3], from: DVec3) -> (DVec3, f64) {
    let (mut point, mut reach) = (from, -1.0);
    for &p in points {
        let distance = (p - from).dot(p - from);
        if distance >= reach && (distance > reach || by_coordinates(&p, &point).is_gt()) {
            (point, reach) = (p, distance);
        }
    }
    (point, reach)
}

/// A total order of positions.
fn by_coordinates(a: &DVec3, b: &DVec3) -> Ordering {
    a.x.total_cmp(&b.x)
        .then(a.y.total_cmp(&b.y))
        .then(a.z.total_cmp(&b.z))
}

/// The smallest sphere of a few points.
struct Smallest {
    center: DVec3,
    squared_radius: f64,
    support: Vec<DVec3>,
}

/// The smallest sphere of one to five points, which are sorted: the centre whose farthest point is nearest, among the
/// centres of the spheres through one to four of them. Fewer supports first, so that ties drop what is redundant.
fn smallest(points: &mut Vec<DVec3>) -> Smallest {
    points.sort_unstable_by(by_coordinates);
    points.dedup();
    let mut best = Smallest {
        center: points[0],
        squared_radius: f64::INFINITY,
        support: Vec::new(),
    };
    let mut chosen = Vec::with_capacity(4);
    for size in 1..=4 {
        for subset in 1_u32..1 << points.len() {
            if subset.count_ones() != size {
                continue;
            }
            chosen.clear();
            let members = (0..points.len()).filter(|i| subset >> i & 1 == 1);
            chosen.extend(members.map(|i| points[i]));
            let Some(center) = circumcenter(&chosen) else {
                continue;
            };
            let (_, squared_radius) = farthest(points, center);
            if squared_radius < best.squared_radius {
                best = Smallest {
                    center,
                    squared_radius,
                    support: chosen.clone(),
                };
            }
        }
    }
    best
}

/// The centre, in their affine hull, of the sphere through one to four points; `None` where they do not span it.
fn circumcenter(points: &[DVec3]) -> Option<DVec3> {
    let offset = match *points {
        [_] => DVec3::ZERO,
        [a, b] => (b - a) * 0.5,
        [a, b, c] => {
            let (u, v) = (b - a, c - a);
            let n = u.cross(v);
            (v.cross(n) * u.dot(u) + n.cross(u) * v.dot(v)) / (2.0 * n.dot(n))
        }
        [a, b, c, d] => {
            let (u, v, w) = (b - a, c - a, d - a);
            let volume = u.dot(v.cross(w));
            (v.cross(w) * u.dot(u) + w.cross(u) * v.dot(v) + u.cross(v) * w.dot(w)) / (2.0 * volume)
        }
        _ => return None,
    };
    let center = points[0] + offset;
    center.is_finite().then_some(center)
}

/// Radius of a sphere to place cameras by: the sphere's own or, where it is a point, one by the point's magnitude.
pub(super) fn usable_radius(sphere: &Sphere) -> f64 {
    if sphere.radius > 0.0 {
        return sphere.radius;
    }
    let size = sphere.center.abs().max_element();
    scale_by_power_of_two(1.0, Frame::for_size(size).exponent)
}
