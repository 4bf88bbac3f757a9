//! The sides of an original triangle in whole units of weight: what lies on one lies there exactly.

use crate::num::fixed::Weights31;

/// A side of a triangle, named by the corner across from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    First,
    Second,
    Third,
}

fn is_on(side: Side, weights: Weights31) -> bool {
    let [u, v] = weights.bits();
    match side {
        Side::First => u + v == Weights31::ONE,
        Side::Second => u == 0,
        Side::Third => v == 0,
    }
}

impl Side {
    /// A side that both points lie on.
    pub(super) fn of(p: Weights31, q: Weights31) -> Option<Self> {
        [Self::Second, Self::Third, Self::First]
            .into_iter()
            .find(|&side| is_on(side, p) && is_on(side, q))
    }

    pub(super) fn has(self, p: Weights31) -> bool {
        is_on(self, p)
    }

    /// The point of this side at the share `t` (0 to 1) of the way between two others, in whole units.
    pub(super) fn between(self, p: Weights31, q: Weights31, t: f64) -> Weights31 {
        let ([u, v], [x, y]) = (p.bits(), q.bits());
        let at = |a: u32, b: u32| {
            let (a, b) = (f64::from(a), f64::from(b));
            (a + (b - a) * t).round().clamp(a.min(b), a.max(b)) as u32
        };
        let bits = match self {
            Self::First => {
                let u = at(u, x);
                [u, Weights31::ONE - u]
            }
            Self::Second => [0, at(v, y)],
            Self::Third => [at(u, x), 0],
        };
        Weights31::from_bits(bits).unwrap_or(p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_between_two_of_a_side_is_on_it_and_between_them_to_the_unit() {
        let one = Weights31::ONE;
        let on = |bits| Weights31::from_bits(bits).expect("inside");
        for (side, p, q) in [
            (Side::First, on([one, 0]), on([1, one - 1])),
            (Side::Second, on([0, 7]), on([0, one])),
            (Side::Third, on([one - 3, 0]), on([2, 0])),
        ] {
            assert_eq!(Side::of(p, q), Some(side));
            for i in 0..=1000 {
                let r = side.between(p, q, f64::from(i) / 1000.0);
                assert!(side.has(r), "{r:?}");
                for k in 0..2 {
                    let (a, b, c) = (p.bits()[k], q.bits()[k], r.bits()[k]);
                    assert!(a.min(b) <= c && c <= a.max(b), "{r:?}");
                }
            }
            assert_eq!([side.between(p, q, 0.0), side.between(p, q, 1.0)], [p, q]);
        }
        assert_eq!(Side::of(on([1, 1]), on([0, 0])), None);
        assert_eq!(Side::of(on([5, 0]), on([0, 5])), None);
    }
}
