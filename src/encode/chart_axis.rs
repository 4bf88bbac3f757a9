//! Axes of charts, and the round numbers along them.

use crate::num::{Each, math};

/// Whether equal lengths of an axis are equal differences or equal ratios.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences.
    Linear,
    /// Equal ratios; the whole range lies above 0.
    Logarithmic,
}

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Name of the quantity, with its unit.
    pub label: String,
    /// Least and greatest value; they differ.
    pub range: [f64; 2],
    /// Distances along the axis.
    pub scale: Scale,
}

/// Ticks that a linear axis has at most.
const MOST_TICKS: f64 = 8.0;

/// A value of an axis where a line of the grid stands, and its text; empty for a line between two that have one.
pub(super) struct Tick {
    pub(super) value: f64,
    pub(super) text: String,
}

impl Axis {
    /// An axis from 0 to a little above the highest value; to 1 where that is not above 0.
    pub fn from_zero(label: &str, highest: f64) -> Self {
        let top = if highest > 0.0 { 1.08 * highest } else { 1.0 };
        Self {
            label: label.into(),
            range: [0.0, top],
            scale: Scale::Linear,
        }
    }

    /// Share of the axis below `value`.
    pub(super) fn share(&self, value: f64) -> f64 {
        let place = |x: f64| match self.scale {
            Scale::Linear => x,
            Scale::Logarithmic => math::log10(x),
        };
        let [low, high] = self.range.each(place);
        (place(value) - low) / (high - low)
    }

    pub(super) fn ticks(&self) -> Vec<Tick> {
        match self.scale {
            Scale::Linear => self.linear_ticks(),
            Scale::Logarithmic => self.logarithmic_ticks(),
        }
    }

    /// Multiples of the smallest of 1, 2 or 5 times a power of ten that gives at most [`MOST_TICKS`].
    fn linear_ticks(&self) -> Vec<Tick> {
        let [low, high] = self.range;
        let magnitude = math::log10((high - low) / MOST_TICKS).floor() as i32;
        let steps = |exponent| [1.0, 2.0, 5.0].each(|digit| (digit * ten_to(exponent), exponent));
        let mut steps = (magnitude..=magnitude + 1).flat_map(steps);
        let (step, exponent) = steps
            .find(|(step, _)| (high - low) / step <= MOST_TICKS)
            .unwrap_or((high - low, magnitude));
        let decimals = exponent.min(0).unsigned_abs() as usize;
        let numbers = (low / step).ceil() as i64..=(high / step).floor() as i64;
        let tick = |n| {
            let value = n as f64 * step;
            let text = with_thousands(&format!("{value:.decimals$}"));
            Tick { value, text }
        };
        numbers.map(tick).collect()
    }

    /// Multiples of powers of ten; all have texts where the range is short, only the powers where it is long.
    fn logarithmic_ticks(&self) -> Vec<Tick> {
        let [low, high] = self.range;
        let decades = math::log10(high / low);
        let exponents = math::log10(low).floor() as i32..=math::log10(high).ceil() as i32;
        exponents
            .flat_map(|exponent| (1..=9).map(move |digit| (digit, exponent)))
            .map(|(digit, exponent)| (digit, exponent, f64::from(digit) * ten_to(exponent)))
            .filter(|&(_, _, value)| (low..=high).contains(&value))
            .map(|(digit, exponent, value)| {
                let told = match digit {
                    1 => true,
                    2 | 5 => decades < 3.5,
                    3 | 7 => decades < 1.2,
                    _ => decades < 0.7,
                };
                let mut text = String::new();
                if told {
                    let decimals = exponent.min(0).unsigned_abs() as usize;
                    text = with_thousands(&format!("{value:.decimals$}"));
                }
                Tick { value, text }
            })
            .collect()
    }
}

/// A power of ten.
fn ten_to(exponent: i32) -> f64 {
    let power = math::power(10.0, exponent.unsigned_abs());
    if exponent < 0 { 1.0 / power } else { power }
}

/// A decimal number with commas between groups of three digits before the point.
fn with_thousands(number: &str) -> String {
    let (whole, rest) = number.split_at(number.find('.').unwrap_or(number.len()));
    let (sign, digits) = whole.split_at(usize::from(whole.starts_with('-')));
    let mut text = sign.to_string();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(range: [f64; 2], scale: Scale) -> String {
        let label = String::new();
        let ticks = Axis {
            label,
            range,
            scale,
        }
        .ticks()
        .into_iter();
        let texts = ticks.map(|t| t.text).filter(|text| !text.is_empty());
        texts.collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        use Scale::{Linear, Logarithmic};
        let told = "0.000 0.005 0.010 0.015 0.020 0.025 0.030";
        assert_eq!(texts([0.0, 0.031], Linear), told);
        let told = "0 1,000 2,000 3,000 4,000";
        assert_eq!(texts([0.0, 4_200.0], Linear), told);
        let told = "5 10 20 50 100 200 500 1,000 2,000 5,000";
        assert_eq!(texts([5.0, 5_000.0], Logarithmic), told);
        assert_eq!(texts([900.0, 2_500.0], Logarithmic), "900 1,000 2,000");
    }
}
