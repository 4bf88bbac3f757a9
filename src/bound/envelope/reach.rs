//! The distance within which a surface counts as near: the bound less the largest rounding.

use glam::DVec3;

/// Relative part of a bound that is given up, far above the rounding of a distance.
const MARGIN: f64 = 1e-9;
/// Units in the last place of the largest coordinate that are given up: a halving of a piece moves its border by no more
/// than one, a cut by no more than four, and pieces are divided some tens of times.
const ULPS: f64 = 1024.0;
/// Pieces smaller than this share of the bound are not divided any more.
const FINEST: f64 = 1.0 / 64.0;
/// Pieces larger than this many bounds are cut at walls: halving them down to the bound would take too long. Smaller ones
/// are halved, which makes rounder pieces (a twelfth of the time on the bunny at 0.1 % of its diagonal).
const LARGE: f64 = 64.0;

/// A bound on distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// The bound, less rounding.
    pub length: f64,
    /// Its square: computed distances must be below it.
    pub squared: f64,
    /// Squared length of the longest side at which pieces are given up.
    pub finest2: f64,
    /// Squared length of the longest side from which pieces are cut at walls.
    pub large2: f64,
}

impl Reach {
    /// The bound `length` for positions whose coordinates are at most `largest`; `None` where rounding is as large
    /// as the bound, or the bound is no number.
    pub fn new(length: f64, largest: f64) -> Option<Self> {
        let own = length * (1.0 - MARGIN) - (ULPS * f64::EPSILON) * largest;
        if !(own > 0.0 && own < f64::INFINITY) || own < 0.5 * length {
            return None;
        }
        Some(Self {
            length: own,
            squared: own * own,
            finest2: (FINEST * own) * (FINEST * own),
            large2: (LARGE * own) * (LARGE * own),
        })
    }
}

/// Halves a triangle at the middle of its longest side; the squared length of that side is given back with it.
#[inline]
pub(super) fn halve([a, b, c]: [DVec3; 3]) -> (f64, DVec3, usize) {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let (x, y, z) = (ab.dot(ab), bc.dot(bc), ca.dot(ca));
    // The side opposite to corner `k` is the longest.
    if x >= y && x >= z {
        (x, (a + b) * 0.5, 2)
    } else if y >= z {
        (y, (b + c) * 0.5, 0)
    } else {
        (z, (c + a) * 0.5, 1)
    }
}
