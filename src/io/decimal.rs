//! Numbers as text: the shortest decimal that reads back to the same bits.

use std::io::Write;

use crate::num::Precision;

/// Appends `x` with the digits its precision needs. A reader gets the same bits whether it parses 32-bit floats, or
/// 64-bit floats that it then rounds.
pub(super) fn push(text: &mut Vec<u8>, x: f64, precision: Precision) {
    let start = text.len();
    if precision == Precision::F32 {
        let narrow = x as f32;
        push_float(text, narrow, f64::from(narrow));
        // Rounding twice can end one step off where the decimal lies next to the middle of two floats.
        let read = std::str::from_utf8(&text[start..])
            .ok()
            .and_then(|t| t.parse::<f64>().ok());
        if read.is_some_and(|r| (r as f32).to_bits() == narrow.to_bits() || narrow.is_nan()) {
            return;
        }
        text.truncate(start);
        push_float(text, f64::from(narrow), f64::from(narrow));
    } else {
        push_float(text, x, x);
    }
}

fn push_float(text: &mut Vec<u8>, x: impl std::fmt::Display + std::fmt::LowerExp, magnitude: f64) {
    let size = magnitude.abs();
    // Writing to a Vec cannot fail. Without an exponent 1e30 would be 31 digits.
    let _ = if size == 0.0 || (1e-5..1e15).contains(&size) || !size.is_finite() {
        write!(text, "{x}")
    } else {
        write!(text, "{x:e}")
    };
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        // Tests write only below target/.
        #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn a_decimal_reads_back_to_the_same_bits(bits: u64) {
            let (wide, narrow) = (f64::from_bits(bits), f32::from_bits(bits as u32));
            let mut text = Vec::new();
            push(&mut text, wide, Precision::F64);
            let text = String::from_utf8(text).expect("ASCII");
            prop_assert!(wide.is_nan() || text.parse::<f64>() == Ok(wide), "{text}");
            let mut text = Vec::new();
            push(&mut text, f64::from(narrow), Precision::F32);
            let text = String::from_utf8(text).expect("ASCII");
            prop_assert!(narrow.is_nan() || text.parse::<f32>() == Ok(narrow), "{text}");
            prop_assert!(narrow.is_nan() || text.parse::<f64>().map(|x| x as f32) == Ok(narrow), "{text}");
        }
    }

    #[test]
    fn negative_zero_and_tiny_and_huge_numbers_stay_short() {
        for (x, expected) in [
            (-0.0, "-0"),
            (0.1, "0.1"),
            (1e30, "1e30"),
            (1e-30, "1e-30"),
            (12.5, "12.5"),
        ] {
            let mut text = Vec::new();
            push(&mut text, x, Precision::F32);
            assert_eq!(String::from_utf8(text).expect("ASCII"), expected);
        }
    }
}
