//! Exact numbers: sums and products of doubles without rounding, overflow or underflow.
//!
//! A number is an integer in limbs of 64 bits times a power of 2^64, so that alignment is by whole limbs. Schoolbook
//! multiplication: the numbers of this stage are short (a coordinate has two limbs, a determinant a dozen), and few
//! pixels need them at all.

use std::{
    cmp::Ordering,
    ops::{Add, Mul, Neg, Sub},
};

use crate::num::math::scale_by_power_of_two;

/// A finite sum of products of doubles, exactly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Exact {
    negative: bool,
    /// Least significant first; neither end is 0, and 0 has no limbs.
    limbs: Vec<u64>,
    /// The first limb counts multiples of 2^(64 place).
    place: i32,
}

impl Exact {
    /// Drops zeros at both ends.
    fn new(negative: bool, mut limbs: Vec<u64>, place: i32) -> Self {
        while limbs.last() == Some(&0) {
            limbs.pop();
        }
        let zeros = limbs.iter().take_while(|&&limb| limb == 0).count();
        limbs.drain(..zeros);
        Self {
            negative: negative && !limbs.is_empty(),
            place: if limbs.is_empty() {
                0
            } else {
                place + zeros as i32
            },
            limbs,
        }
    }

    /// -1, 0 or 1 as an ordering against 0.
    pub(super) fn sign(&self) -> Ordering {
        match (self.limbs.is_empty(), self.negative) {
            (true, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            (_, false) => Ordering::Greater,
        }
    }

    /// The number to within 2^-52 of itself.
    pub(super) fn approximate(&self) -> f64 {
        let top = |i: usize| match self.limbs.len().checked_sub(i) {
            Some(at) => self.limbs.get(at).copied().unwrap_or(0) as f64,
            None => 0.0,
        };
        let mantissa = top(1) + top(2) * scale_by_power_of_two(1.0, -64);
        let place = self.place + self.limbs.len() as i32 - 1;
        let size = scale_by_power_of_two(mantissa, 64 * place);
        if self.negative { -size } else { size }
    }

    /// Places of the first limb and one past the last.
    fn places(&self) -> (i32, i32) {
        (self.place, self.place + self.limbs.len() as i32)
    }

    fn limb(&self, place: i32) -> u64 {
        let at = usize::try_from(place - self.place).ok();
        at.and_then(|i| self.limbs.get(i).copied()).unwrap_or(0)
    }

    /// `|self| + |other|` with the sign of `self`.
    fn add_sizes(&self, other: &Self) -> Self {
        let (first, last) = union(self.places(), other.places());
        let mut carry = 0_u128;
        let limbs = (first..=last).map(|place| {
            carry += u128::from(self.limb(place)) + u128::from(other.limb(place));
            let limb = carry as u64;
            carry >>= 64;
            limb
        });
        Self::new(self.negative, limbs.collect(), first)
    }

    /// `|self| - |other|` where that is not negative, with the sign of `self`.
    fn subtract_sizes(&self, other: &Self) -> Self {
        let (first, last) = union(self.places(), other.places());
        let mut borrow = false;
        let limbs = (first..last).map(|place| {
            let (limb, below) = self.limb(place).overflowing_sub(other.limb(place));
            let (limb, still) = limb.overflowing_sub(u64::from(borrow));
            borrow = below || still;
            limb
        });
        Self::new(self.negative, limbs.collect(), first)
    }

    fn compare_sizes(&self, other: &Self) -> Ordering {
        let (first, last) = union(self.places(), other.places());
        let from_top = (first..last).rev();
        let mut orders = from_top.map(|place| self.limb(place).cmp(&other.limb(place)));
        orders
            .find(|order| order.is_ne())
            .unwrap_or(Ordering::Equal)
    }
}

/// The places of two numbers; those of one where the other is 0.
fn union(a: (i32, i32), b: (i32, i32)) -> (i32, i32) {
    match (a.0 == a.1, b.0 == b.1) {
        (true, _) => b,
        (_, true) => a,
        _ => (a.0.min(b.0), a.1.max(b.1)),
    }
}

impl From<f64> for Exact {
    /// The number itself; 0 for infinities and NaN, which no mesh or view holds.
    fn from(x: f64) -> Self {
        let bits = x.to_bits();
        let (biased, fraction) = ((bits >> 52) as i32 & 0x7ff, bits & ((1 << 52) - 1));
        let (mantissa, exponent) = match biased {
            0x7ff => (0, 0),
            0 => (fraction, -1_074),
            _ => (fraction | 1 << 52, biased - 1_075),
        };
        let place = exponent.div_euclid(64);
        let shifted = u128::from(mantissa) << exponent.rem_euclid(64);
        let limbs = vec![shifted as u64, (shifted >> 64) as u64];
        Self::new(x.is_sign_negative(), limbs, place)
    }
}

impl From<i64> for Exact {
    fn from(x: i64) -> Self {
        Self::new(x < 0, vec![x.unsigned_abs()], 0)
    }
}

impl Add for &Exact {
    type Output = Exact;

    fn add(self, other: Self) -> Exact {
        if self.negative == other.negative {
            return self.add_sizes(other);
        }
        match self.compare_sizes(other) {
            Ordering::Less => other.subtract_sizes(self),
            _ => self.subtract_sizes(other),
        }
    }
}

impl Neg for &Exact {
    type Output = Exact;

    fn neg(self) -> Exact {
        Exact::new(!self.negative, self.limbs.clone(), self.place)
    }
}

impl Sub for &Exact {
    type Output = Exact;

    fn sub(self, other: Self) -> Exact {
        self + &-other
    }
}

impl Mul for &Exact {
    type Output = Exact;

    fn mul(self, other: Self) -> Exact {
        let mut limbs = vec![0_u64; self.limbs.len() + other.limbs.len()];
        for (i, &a) in self.limbs.iter().enumerate() {
            let mut carry = 0_u128;
            for (limb, &b) in limbs[i..].iter_mut().zip(&other.limbs) {
                carry += u128::from(a) * u128::from(b) + u128::from(*limb);
                *limb = carry as u64;
                carry >>= 64;
            }
            limbs[i + other.limbs.len()] = carry as u64;
        }
        let negative = self.negative != other.negative;
        Exact::new(negative, limbs, self.place + other.place)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Whole numbers of up to 60 bits at exponents that make limbs overlap in part, in full and not at all.
    fn number() -> impl Strategy<Value = (i64, u32)> {
        (prop_oneof![-4..5_i64, -(1 << 53)..(1_i64 << 53)], 0..4_u32)
    }

    /// `value * 2^(7 shift)`, small enough for products of two to fit i128 exactly.
    fn both((value, shift): (i64, u32)) -> (Exact, i128) {
        let scale = 1_i64 << (2 * shift);
        let x = value as f64 * scale as f64;
        (x.into(), i128::from(value) * i128::from(scale))
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

        #[test]
        fn sums_and_products_are_those_of_wide_integers(a in number(), b in number(), c in number()) {
            let ((a, wide_a), (b, wide_b), (c, wide_c)) = (both(a), both(b), both(c));
            let wide = wide_a * wide_b - wide_c;
            let exact = &(&a * &b) - &c;
            prop_assert_eq!(exact.sign(), wide.cmp(&0));
            prop_assert!((exact.approximate() - wide as f64).abs() <= wide.unsigned_abs() as f64 * 4e-16);
            prop_assert_eq!(&exact + &c, &b * &a);
            prop_assert_eq!((&exact - &exact).sign(), Ordering::Equal);
        }

        #[test]
        fn nothing_is_lost_between_the_largest_and_the_smallest_double(x in any::<f64>(), y in any::<f64>()) {
            prop_assume!(x.is_finite() && y.is_finite());
            let (a, b) = (Exact::from(x), Exact::from(y));
            prop_assert_eq!((&a - &b).sign(), x.partial_cmp(&y).unwrap());
            prop_assert_eq!((a.approximate() - x).abs().to_bits(), 0);
            // (a + b)(a - b) = a^2 - b^2
            prop_assert_eq!(&(&a + &b) * &(&a - &b), &(&a * &a) - &(&b * &b));
            let tiny = Exact::from(f64::from_bits(1));
            prop_assert_eq!((&(&a + &tiny) - &a).sign(), Ordering::Greater);
        }
    }
}
