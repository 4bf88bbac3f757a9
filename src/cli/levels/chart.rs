//! Image and geometric errors over the number of triangles: Figure 4 of Zhang & Turk 2002.
//!
//! As there, a colour for each method, image errors as thin lines with diamonds (left axis), mean distances as wide
//! lines (right axis). Triangles are on a logarithmic scale, because levels are about half of one another.

use super::judge::Level;
use crate::encode::line_chart::{Axis, LineChart, Mark, Scale, Series, Side};

/// Blue and red as in the paper, then others that are told apart easily.
const COLORS: [&str; 4] = ["#1f50b4", "#c82828", "#288c3c", "#8c5a14"];

/// The chart as the text of an SVG file.
pub(super) fn svg(title: &str, levels: &[Level]) -> String {
    let most = |f: fn(&Level) -> f64| levels.iter().map(f).fold(0.0_f64, f64::max);
    let triangles = |l: &Level| l.triangles as f64;
    let least = levels.iter().map(triangles).fold(f64::INFINITY, f64::min);
    let distance = |l: &Level| 100.0 * l.distance_mean.unwrap_or(0.0);
    let measured = levels.iter().any(|l| l.distance_mean.is_some());
    let mut names: Vec<&str> = Vec::new();
    for level in levels {
        if !names.contains(&level.method) {
            names.push(level.method);
        }
    }
    let mut series = Vec::new();
    for (name, color) in names.into_iter().zip(COLORS.into_iter().cycle()) {
        let own = || levels.iter().filter(|l| l.method == name);
        let images = Series {
            name: format!("{name}: image error"),
            points: own().map(|l| [triangles(l), l.image_error]).collect(),
            labels: Vec::new(),
            side: Side::Left,
            color,
            width: 1.5,
            opacity: 1.0,
            mark: Mark::Diamond,
        };
        series.push(images.clone());
        if own().any(|l| l.distance_mean.is_some()) {
            series.push(Series {
                name: format!("{name}: mean distance"),
                points: own().map(|l| [triangles(l), distance(l)]).collect(),
                side: Side::Right,
                width: 5.0,
                opacity: 0.5,
                mark: Mark::None,
                ..images
            });
        }
    }
    LineChart {
        title: title.into(),
        size: [960.0, 600.0],
        x: Axis {
            label: "triangles".into(),
            // Not empty, even where all levels are equal.
            range: [0.9 * least.max(1.0), 1.1 * most(triangles).max(1.0)],
            scale: Scale::Logarithmic,
        },
        left: Axis::from_zero(
            "image error (equation 5.11), levels",
            most(|l| l.image_error),
        ),
        right: measured
            .then(|| Axis::from_zero("mean distance, % of the diagonal", most(distance))),
        series,
    }
    .to_svg()
}
