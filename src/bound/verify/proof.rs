//! A proof that a whole triangle lies within a distance of a surface: by branch and bound, not by samples.
//!
//! The distance to one facet is a convex function, so that over a triangle it is largest at a corner; and no distance
//! changes faster than the point moves. A part of the triangle is settled where one facet is near enough to all three
//! corners, or where the distance at its centroid plus its radius is small enough. Where neither holds it is halved
//! across its longest side, until a centroid is found to be too far away, or the part is small.

use glam::DVec3;

use super::nearest::Facets;
use crate::num::math::{length, sqrt};

/// Parts that one triangle may be cut into.
const PARTS: usize = 1 << 15;
/// Parts with sides of no more than this share of the claim are not cut any more.
const FINEST: f64 = 1.0 / 256.0;

/// What is known about a triangle, in frame units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Finding {
    /// The largest distance met, at `point`: a lower bound of the largest one.
    pub(super) largest: f64,
    pub(super) point: DVec3,
    /// An upper bound of the largest distance.
    pub(super) at_most: f64,
    /// Twice the area of the parts for which the claim is neither proven nor refuted.
    pub(super) undecided: f64,
    /// A facet near the triangle, for the next search.
    pub(super) near: u32,
}

/// Settles whether all of a triangle is within `claim` of the surface.
pub(super) fn settle(surface: &Facets, corners: [DVec3; 3], claim: f64, guess: u32) -> Finding {
    let mut finding = Finding {
        largest: -1.0,
        point: corners[0],
        at_most: 0.0,
        undecided: 0.0,
        near: guess,
    };
    let mut parts = vec![corners];
    let mut cuts = 0;
    while let Some(part) = parts.pop() {
        let [a, b, c] = part;
        let middle = (a + b + c) / 3.0;
        let (squared, near) = surface.nearest(middle, finding.near, 0.0);
        finding.near = near;
        let distance = sqrt(squared);
        if distance > finding.largest {
            (finding.largest, finding.point) = (distance, middle);
        }
        let facet = surface.facet(near);
        let corner = part.map(|p| facet.squared(p));
        let one_facet = sqrt(corner[0].max(corner[1]).max(corner[2]));
        let radius = part.map(|p| length(p - middle));
        let radius = radius[0].max(radius[1]).max(radius[2]);
        let bound = one_facet.min(distance + radius);
        if bound <= claim {
            finding.at_most = finding.at_most.max(bound);
            continue;
        }
        let sides = [length(b - a), length(c - b), length(a - c)];
        let longest = sides[0].max(sides[1]).max(sides[2]);
        if distance > claim || longest <= FINEST * claim || cuts == PARTS || longest <= 1e-12 {
            finding.at_most = finding.at_most.max(bound);
            finding.undecided += length((b - a).cross(c - a));
            continue;
        }
        cuts += 1;
        let [p, q, r] = if sides[0] >= longest {
            [a, b, c]
        } else if sides[1] >= longest {
            [b, c, a]
        } else {
            [c, a, b]
        };
        let half = (p + q) * 0.5;
        parts.push([p, half, r]);
        parts.push([half, q, r]);
    }
    finding
}
