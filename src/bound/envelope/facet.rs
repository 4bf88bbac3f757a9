//! A triangle prepared for distances from many points.
//!
//! **Every distance is an upper bound**: it is measured to a point that was found inside the triangle, so a wrong choice
//! (rounding, a sliver) makes it too long and never too short. What rounding adds is the rounding of the difference
//! between two points, a few units in the last place of that difference: [`Facet::distance2`] may be too short by a
//! relative 1e-14 and no more. Units: those of the positions.

use std::cmp::Ordering;

use glam::DVec3;

use crate::{
    geometry::{Box3, TreeItem},
    num::{Each, math},
};

/// `sin^2` of the corner below which a triangle is a sliver: its barycentric coordinates may point at the wrong edge.
const SLIVER: f64 = 1e-8;

/// A cut of a triangle in two: the corner that is alone on its side, and the points between it and the next two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    pub(super) alone: usize,
    pub(super) between: [DVec3; 2],
}

impl Cut {
    /// The three triangles of the two parts, from what belongs to the corners and to the points between.
    pub(super) fn parts<T: Copy>(&self, corners: [T; 3], between: [T; 2]) -> [[T; 3]; 3] {
        let [apex, b, c] = [0, 1, 2].each(|step| corners[(self.alone + step) % 3]);
        let [to_b, to_c] = between;
        [[apex, to_b, to_c], [to_b, b, c], [to_b, c, to_c]]
    }
}

/// A triangle, its box, and the sums of its barycentric coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    corner: DVec3,
    sides: [DVec3; 2],
    /// Squared lengths of the sides at the corner, and their dot product.
    gram: [f64; 3],
    /// One over the determinant of the Gram matrix; 0 for a sliver.
    scale: f64,
    bounds: Box3,
}

impl Facet {
    /// Prepares a triangle; it may have no area.
    pub fn new([a, b, c]: [DVec3; 3]) -> Self {
        let sides = [b - a, c - a];
        let gram = [
            sides[0].dot(sides[0]),
            sides[0].dot(sides[1]),
            sides[1].dot(sides[1]),
        ];
        let determinant = gram[0] * gram[2] - gram[1] * gram[1];
        let sturdy = determinant > SLIVER * (gram[0] * gram[2]);
        Self {
            corner: a,
            sides,
            gram,
            scale: if sturdy { 1.0 / determinant } else { 0.0 },
            bounds: Box3::of_triangle([a, b, c]),
        }
    }

    /// False where a point is farther than `reach` from the box along an axis.
    #[inline]
    pub fn may_reach(&self, p: DVec3, reach: f64) -> bool {
        self.bounds.may_reach(p, reach)
    }

    /// Squared distance from `p` to a point of the triangle: the nearest one but for rounding.
    #[inline]
    pub fn distance2(&self, p: DVec3) -> f64 {
        let [ab, ac] = self.sides;
        let [bb, bc, cc] = self.gram;
        let ap = p - self.corner;
        let (along_b, along_c) = (ap.dot(ab), ap.dot(ac));
        if self.scale == 0.0 {
            let nearer = self
                .squared_to_ab(ap, along_b)
                .min(self.squared_to_ac(ap, along_c));
            return nearer.min(self.squared_to_bc(ap));
        }
        let v = (cc * along_b - bc * along_c) * self.scale;
        let w = (bb * along_c - bc * along_b) * self.scale;
        let u = (1.0 - v) - w;
        if u >= 0.0 && v >= 0.0 && w >= 0.0 {
            let d = ap - (ab * v + ac * w);
            return d.dot(d);
        }
        // The nearest point lies on an edge that the point is outside of.
        let mut best = f64::INFINITY;
        if w < 0.0 {
            best = self.squared_to_ab(ap, along_b);
        }
        if v < 0.0 {
            best = best.min(self.squared_to_ac(ap, along_c));
        }
        if u < 0.0 {
            best = best.min(self.squared_to_bc(ap));
        }
        best
    }

    /// Cuts a triangle at the wall on one of the edges, along the normal: where a large part of it is outside of the
    /// edge, by more than `reach`, and another part inside. The inner part can be settled by this facet alone, whatever
    /// its size.
    /// `None` for a sliver, and where the facet is not larger than `reach`: halving is better there.
    pub(super) fn cut(&self, piece: [DVec3; 3], reach: f64) -> Option<Cut> {
        let [ab, ac] = self.sides;
        let smallest = self.gram[0].min(self.gram[2]);
        if self.scale == 0.0 || smallest <= (4.0 * reach) * (4.0 * reach) {
            return None;
        }
        let normal = ab.cross(ac);
        let mut best: Option<(f64, [f64; 3])> = None;
        for (from, along) in [(DVec3::ZERO, ab), (ab, ac - ab), (ac, -ac)] {
            let Some(inward) = math::unit(normal.cross(along)) else {
                continue;
            };
            let depths = piece.each(|p| (p - self.corner - from).dot(inward));
            let [low, high] = [f64::min, f64::max].each(|f| depths.into_iter().reduce(f));
            if let (Some(low), Some(high)) = (low, high)
                && low < -reach
                && high > 0.0
                && best.is_none_or(|(least, _)| low < least)
            {
                best = Some((low, depths));
            }
        }
        let (_, depths) = best?;
        let inside = depths.each(|d| d >= 0.0);
        let alone = (0..3)
            .find(|&k| inside[k] != inside[(k + 1) % 3] && inside[k] != inside[(k + 2) % 3])?;
        let between = [1, 2].each(|step| {
            let other = (alone + step) % 3;
            let share = depths[alone] / (depths[alone] - depths[other]);
            piece[alone] + (piece[other] - piece[alone]) * share
        });
        Some(Cut { alone, between })
    }

    #[inline]
    fn squared_to_ab(&self, ap: DVec3, along: f64) -> f64 {
        to_segment(ap, self.sides[0], along, self.gram[0])
    }

    #[inline]
    fn squared_to_ac(&self, ap: DVec3, along: f64) -> f64 {
        to_segment(ap, self.sides[1], along, self.gram[2])
    }

    #[inline]
    fn squared_to_bc(&self, ap: DVec3) -> f64 {
        let [ab, ac] = self.sides;
        let (bp, bc) = (ap - ab, ac - ab);
        to_segment(bp, bc, bp.dot(bc), bc.dot(bc))
    }
}

impl TreeItem for Facet {
    #[inline]
    fn bounds(&self) -> Box3 {
        self.bounds
    }

    #[inline]
    fn squared_distance(&self, p: DVec3) -> f64 {
        self.distance2(p)
    }

    /// A total order of different triangles that depends on coordinates alone.
    fn order(&self, other: &Self) -> Ordering {
        let numbers = |f: &Self| {
            [
                f.corner,
                f.bounds.low,
                f.bounds.high,
                f.sides[0],
                f.sides[1],
            ]
            .map(|p| p.to_array())
            .concat()
        };
        let pairs = numbers(self).into_iter().zip(numbers(other));
        pairs.fold(Ordering::Equal, |order, (a, b)| order.then(a.total_cmp(&b)))
    }
}

/// Squared length of `p` minus the nearest point of the segment from the origin along `side`.
#[inline]
fn to_segment(p: DVec3, side: DVec3, along: f64, length2: f64) -> f64 {
    let d = if along <= 0.0 {
        p
    } else if along >= length2 {
        p - side
    } else {
        p - side * (along / length2)
    };
    d.dot(d)
}
