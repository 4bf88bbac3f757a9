//! Square roots, lengths and the few transcendental functions, each with the same bits on every platform.
//!
//! `sqrt` is correctly rounded by IEEE 754 everywhere; the others come from the `libm` crate, whose software
//! implementations do not depend on the platform (std's do). Angles are radians.

use glam::DVec3;

/// Correctly rounded square root. Negative input gives NaN.
#[inline]
#[expect(clippy::disallowed_methods, reason = "this is the one caller")]
pub fn sqrt(x: f64) -> f64 {
    x.sqrt()
}

/// Euclidean length of `v`.
#[inline]
pub fn length(v: DVec3) -> f64 {
    sqrt(v.dot(v))
}

/// `v / |v|`, or `None` where `v` has no direction (zero, or a component that is not finite).
#[inline]
pub fn unit(v: DVec3) -> Option<DVec3> {
    let l = length(v);
    (l > 0.0 && l < f64::INFINITY).then(|| v / l)
}

/// The smallest and the largest of some numbers: infinity and minus infinity where there is none.
pub fn range(numbers: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let all = numbers.into_iter();
    all.fold(none, |[low, high], x| [low.min(x), high.max(x)])
}

/// Sine.
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// Cosine.
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// Tangent.
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}

/// Angle of the point `(x, y)`, in (-pi, pi].
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Arc sine, in [-pi/2, pi/2]; NaN beyond -1 and 1.
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

/// Arc cosine, in [0, pi]; NaN beyond -1 and 1.
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// Cube root.
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

/// Logarithm to base 10.
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}

/// `x` to a whole power, by squaring in one written order.
pub fn power(x: f64, exponent: u32) -> f64 {
    let (mut result, mut square, mut rest) = (1.0, x, exponent);
    while rest > 0 {
        if rest & 1 == 1 {
            result *= square;
        }
        square *= square;
        rest >>= 1;
    }
    result
}

/// `x * 2^exponent`, exact unless the result overflows or becomes subnormal.
#[inline]
pub fn scale_by_power_of_two(x: f64, exponent: i32) -> f64 {
    libm::ldexp(x, exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_multiplies_as_often_as_the_exponent_says() {
        for (x, n, expected) in [
            (3.0, 0, 1.0),
            (3.0, 1, 3.0),
            (2.0, 10, 1024.0),
            (-1.5, 3, -3.375),
            (0.0, 7, 0.0),
        ] {
            assert_eq!(power(x, n).to_bits(), f64::to_bits(expected), "{x}^{n}");
        }
    }

    #[test]
    fn a_vector_without_direction_has_no_unit_vector() {
        for x in [0.0, f64::NAN, f64::INFINITY] {
            assert!(unit(DVec3::new(x, 0.0, 0.0)).is_none(), "{x}");
        }
        let found = unit(DVec3::new(0.0, 3.0, 4.0));
        assert_eq!(found, Some(DVec3::new(0.0, 0.6, 0.8)));
    }
}
