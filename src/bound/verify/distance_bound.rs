//! A proof that a whole triangle lies within a distance of a surface: by branch and bound, not by samples.
//!
//! The distance to one facet is a convex function, so that over a triangle it is largest at a corner; and no distance
//! changes faster than the point moves. A part of the triangle is settled where one facet is near enough to all three
//! corners, or where the distance at its centroid plus its radius is small enough. Where neither holds it is halved
//! across its longest side, until a centroid is found to be too far away, or the part is small. Where the distance comes
//! next to the claim between two facets, small parts are not small enough: a triangle of which nothing is known to be
//! too far away gets a second round, in which what is left of it is halved until its size is less than the slack of
//! the claim.

use glam::DVec3;

use super::nearest::{Facets, double_area};
use crate::num::{
    Each,
    math::{length, sqrt},
};

/// Limits of a round of cuts of one triangle.
#[derive(Clone, Copy)]
struct Round {
    /// Most cuts.
    cuts: usize,
    /// Length of sides that are not cut any more, as a share of the claim.
    finest: f64,
}

const ROUNDS: [Round; 2] = [
    Round {
        cuts: 1 << 15,
        finest: 1.0 / 256.0,
    },
    Round {
        cuts: 1 << 12,
        finest: 1.0 / (1_u64 << 30) as f64,
    },
];

/// Bounds of the largest distance of a triangle, in frame units.
#[derive(Clone, Copy, Debug)]
pub(super) struct DistanceBound {
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

/// A part of a triangle and a bound of its distance.
type Part = ([DVec3; 3], f64);

/// Settles whether all of a triangle is within `claim` of the surface.
pub(super) fn settle(
    surface: &Facets,
    corners: [DVec3; 3],
    claim: f64,
    guess: u32,
) -> DistanceBound {
    let mut finding = DistanceBound {
        largest: -1.0,
        point: corners[0],
        at_most: 0.0,
        undecided: 0.0,
        near: guess,
    };
    let (mut open, mut left) = (vec![(corners, f64::INFINITY)], Vec::new());
    for round in ROUNDS {
        finding.divide(surface, claim, round, &mut open, &mut left);
        if finding.largest > claim {
            break;
        }
        open.append(&mut left);
    }
    for (part, bound) in open.into_iter().chain(left) {
        finding.at_most = finding.at_most.max(bound);
        finding.undecided += double_area(part);
    }
    finding
}

impl DistanceBound {
    /// Divides the parts in `open`; those for which nothing is certain come into `left`.
    fn divide(
        &mut self,
        surface: &Facets,
        claim: f64,
        round: Round,
        open: &mut Vec<Part>,
        left: &mut Vec<Part>,
    ) {
        let (mut cuts, finest) = (0, round.finest * claim);
        while let Some((part, known)) = open.pop() {
            let [a, b, c] = part;
            let middle = (a + b + c) / 3.0;
            let (squared, near) = surface.nearest(middle, self.near, 0.0);
            self.near = near;
            let distance = sqrt(squared);
            if distance > self.largest {
                (self.largest, self.point) = (distance, middle);
            }
            let facet = surface.facet(near);
            let corner = part.each(|p| facet.squared(p));
            let one_facet = sqrt(corner[0].max(corner[1]).max(corner[2]));
            let radius = part.each(|p| length(p - middle));
            let radius = radius[0].max(radius[1]).max(radius[2]);
            let bound = one_facet.min(distance + radius).min(known);
            if bound <= claim {
                self.at_most = self.at_most.max(bound);
                continue;
            }
            let sides = [length(b - a), length(c - b), length(a - c)];
            let longest = sides[0].max(sides[1]).max(sides[2]);
            if distance > claim || longest <= finest || cuts == round.cuts || longest <= 1e-12 {
                left.push((part, bound));
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
            open.push(([p, half, r], bound));
            open.push(([half, q, r], bound));
        }
    }
}
