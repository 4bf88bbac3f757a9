//! Figure 3 of Zhang & Turk 2002 as numbers and as a picture: visibility error against the number of cameras.

use std::fmt::Write;

use crate::{
    encode::line_chart::{Axis, LineChart, Mark, Scale, Series, Side},
    visibility::ConvergenceStep,
};

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
pub(super) fn svg(steps: &[ConvergenceStep]) -> String {
    let highest = steps.iter().fold(0.0, |m, s| f64::max(m, s.error));
    let points = steps.iter().map(|s| [f64::from(s.cameras), s.error]);
    LineChart {
        title: "Visibility error against 4,098 cameras".into(),
        size: [720.0, 480.0],
        x: Axis {
            label: "cameras".into(),
            range: [4.0, 8_000.0],
            scale: Scale::Logarithmic,
        },
        left: Axis::from_zero("mean |V(t) - V'(t)| over the surface", highest),
        right: None,
        series: vec![Series {
            name: String::new(),
            points: points.collect(),
            labels: steps.iter().map(|s| s.cameras.to_string()).collect(),
            side: Side::Left,
            color: "#1f50b4",
            width: 2.0,
            opacity: 1.0,
            mark: Mark::Circle,
        }],
    }
    .to_svg()
}
