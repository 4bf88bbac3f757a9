//! Figure 3 of Zhang & Turk 2002 as numbers and as a picture: visibility error against the number of cameras.

use std::fmt::Write;

use plotters::prelude::*;

use crate::{Error, Result, visibility::ConvergenceStep};

/// The steps as comma-separated values.
pub(super) fn csv(steps: &[ConvergenceStep]) -> String {
    let mut text = "cameras,error,v_mesh\n".to_string();
    for step in steps {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{},{},{}", step.cameras, step.error, step.mesh);
    }
    text
}

/// The steps as an SVG picture; cameras on a logarithmic axis.
pub(super) fn svg(steps: &[ConvergenceStep]) -> Result<String> {
    let mut text = String::new();
    draw(steps, &mut text)
        .map_err(|e| Error::Internal(format!("the chart cannot be drawn: {e}")))?;
    Ok(text)
}

fn draw(steps: &[ConvergenceStep], text: &mut String) -> Result<(), String> {
    let failed = |e: &dyn std::fmt::Display| e.to_string();
    let highest = steps.iter().fold(0.0, |m, s| f64::max(m, s.error));
    let top = if highest > 0.0 { 1.1 * highest } else { 1.0 };
    let root = SVGBackend::with_string(text, (720, 480)).into_drawing_area();
    root.fill(&WHITE).map_err(|e| failed(&e))?;
    let mut chart = ChartBuilder::on(&root)
        .margin(16)
        .caption("Visibility error against 4,098 cameras", ("sans-serif", 20))
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d((5_f64..5_000.0).log_scale(), 0.0..top)
        .map_err(|e| failed(&e))?;
    chart
        .configure_mesh()
        .x_desc("cameras")
        .y_desc("mean |V(t) - V'(t)| over the surface")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.3}"))
        .light_line_style(WHITE)
        .draw()
        .map_err(|e| failed(&e))?;
    let points = || steps.iter().map(|s| (f64::from(s.cameras), s.error));
    chart
        .draw_series(LineSeries::new(points(), BLUE.stroke_width(2)))
        .map_err(|e| failed(&e))?;
    chart
        .draw_series(points().map(|p| Circle::new(p, 4, BLUE.filled())))
        .map_err(|e| failed(&e))?;
    chart
        .draw_series(steps.iter().map(|s| {
            let label = format!("{}", s.cameras);
            Text::new(label, (f64::from(s.cameras), s.error), ("sans-serif", 13))
        }))
        .map_err(|e| failed(&e))?;
    root.present().map_err(|e| failed(&e))
}
