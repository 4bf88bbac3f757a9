//! Image and geometric errors over the number of triangles: Figure 4 of Zhang & Turk 2002.
//!
//! As there, a colour for each method, image errors as thin lines with diamonds (left axis), mean distances as wide
//! lines (right axis). Triangles are on a logarithmic scale, because levels are about half of one another.

use plotters::{
    coord::combinators::IntoLogRange,
    prelude::{
        ChartBuilder, EmptyElement, IntoDrawingArea, LineSeries, PathElement, Polygon, RGBColor,
        SVGBackend,
    },
    style::{BLACK, Color, WHITE},
};

use super::judge::Level;
use crate::{Error, Result};

/// Width and height in pixels.
const SIZE: (u32, u32) = (960, 600);

/// Blue and red as in the paper, then others that are told apart easily.
const COLORS: [RGBColor; 4] = [
    RGBColor(31, 80, 180),
    RGBColor(200, 40, 40),
    RGBColor(40, 140, 60),
    RGBColor(140, 90, 20),
];

/// The chart as the text of an SVG file.
pub(super) fn svg(title: &str, levels: &[Level]) -> Result<String> {
    let mut text = String::new();
    draw(&mut text, title, levels)
        .map_err(|e| Error::Internal(format!("the chart cannot be drawn: {e}")))?;
    Ok(text)
}

fn draw(
    text: &mut String,
    title: &str,
    levels: &[Level],
) -> std::result::Result<(), Box<dyn std::error::Error>> {
    let most = |f: fn(&Level) -> f64| levels.iter().map(f).fold(0.0_f64, f64::max);
    let least = levels
        .iter()
        .map(|l| l.triangles as f64)
        .fold(f64::INFINITY, f64::min);
    // Not empty, even where all is equal or 0.
    let x = || (0.9 * least..1.1 * most(|l| l.triangles as f64)).log_scale();
    let above = |y: f64| if y > 0.0 { 1.05 * y } else { 1.0 };
    let distance = |l: &Level| 100.0 * l.distance_mean.unwrap_or(0.0);
    let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(title, ("sans-serif", 18))
        .margin(14)
        .x_label_area_size(44)
        .y_label_area_size(72)
        .right_y_label_area_size(72)
        .build_cartesian_2d(x(), 0.0..above(most(|l| l.image_error)))?
        .set_secondary_coord(x(), 0.0..above(most(distance)));
    chart
        .configure_mesh()
        .x_desc("triangles")
        .y_desc("image error (equation 5.11), levels")
        .x_labels(6)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .draw()?;
    if levels.iter().any(|l| l.distance_mean.is_some()) {
        chart
            .configure_secondary_axes()
            .y_desc("mean distance, % of the diagonal")
            .draw()?;
    }
    let mut names: Vec<&str> = Vec::new();
    for level in levels {
        if !names.contains(&level.method) {
            names.push(level.method);
        }
    }
    for (name, color) in names.into_iter().zip(COLORS.into_iter().cycle()) {
        let own = || levels.iter().filter(move |l| l.method == name);
        let images: Vec<(f64, f64)> = own().map(|l| (l.triangles as f64, l.image_error)).collect();
        chart
            .draw_series(LineSeries::new(images.iter().copied(), color))?
            .label(format!("{name}: image error"))
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 24, y)], color));
        chart.draw_series(images.iter().map(|&at| {
            let diamond = vec![(0, -5), (5, 0), (0, 5), (-5, 0)];
            EmptyElement::at(at) + Polygon::new(diamond, color.filled())
        }))?;
        if own().any(|l| l.distance_mean.is_some()) {
            let wide = color.mix(0.5).stroke_width(5);
            let points = own().map(|l| (l.triangles as f64, distance(l)));
            chart
                .draw_secondary_series(LineSeries::new(points, wide))?
                .label(format!("{name}: mean distance"))
                .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 24, y)], wide));
        }
    }
    chart
        .configure_series_labels()
        .background_style(WHITE)
        .border_style(BLACK)
        .draw()?;
    root.present()?;
    Ok(())
}
