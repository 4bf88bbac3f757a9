//! Visibility as a colour: Figure 2 of Zhang & Turk 2002.

/// Red, green and blue for a visibility in [0, 1]: white at 0, red at 1/3, yellow at 2/3, green at 1, and in between
/// what lies between (section 3, end).
pub fn color(visibility: f64) -> [u8; 3] {
    let scaled = 3.0 * visibility.clamp(0.0, 1.0);
    let level = |x: f64| (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let beyond = |third: f64| scaled - third;
    let white = 1.0 - scaled;
    let green = if scaled < 1.0 { white } else { beyond(1.0) };
    [1.0 - beyond(2.0), green, white].map(level)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thirds_are_white_red_yellow_and_green() {
        for (v, expected) in [
            (0.0, [255, 255, 255]),
            (1.0 / 6.0, [255, 128, 128]),
            (1.0 / 3.0, [255, 0, 0]),
            (0.5, [255, 128, 0]),
            (2.0 / 3.0, [255, 255, 0]),
            (5.0 / 6.0, [128, 255, 0]),
            (1.0, [0, 255, 0]),
            (f64::NAN, [0, 0, 0]),
        ] {
            assert_eq!(color(v), expected, "V = {v}");
        }
    }
}
