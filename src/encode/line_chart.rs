//! Line charts as SVG: one axis below, one or two beside, a line with its marks for every series, and a legend.
//!
//! Equal charts give equal bytes: places are written with one decimal, and no font is measured.

use std::fmt::Write as _;

use super::chart_axis::Tick;
pub use super::chart_axis::{Axis, Scale};

/// The axis that the values of a series belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// [`LineChart::left`].
    Left,
    /// [`LineChart::right`].
    Right,
}

/// The mark at every point of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// No mark.
    None,
    /// A filled circle.
    Circle,
    /// A filled square that stands on a corner.
    Diamond,
}

/// A line through points.
#[derive(Clone, Debug)]
pub struct Series {
    /// Name in the legend; empty for none.
    pub name: String,
    /// Points in the order in which the line passes them.
    pub points: Vec<[f64; 2]>,
    /// Texts above the points; there may be fewer than points.
    pub labels: Vec<String>,
    /// The axis of the second coordinate.
    pub side: Side,
    /// Colour as SVG writes it, such as `#1f50b4`.
    pub color: &'static str,
    /// Width of the line in pixels.
    pub width: f64,
    /// Opacity of the line, from 0 to 1.
    pub opacity: f64,
    /// The mark at every point.
    pub mark: Mark,
}

/// A chart.
#[derive(Clone, Debug)]
pub struct LineChart {
    /// Line of text above it.
    pub title: String,
    /// Width and height in pixels, margins included.
    pub size: [f64; 2],
    /// The axis below.
    pub x: Axis,
    /// The axis to the left.
    pub left: Axis,
    /// The axis to the right.
    pub right: Option<Axis>,
    /// The lines, the last one on top.
    pub series: Vec<Series>,
}

/// Pixels above the plot, for the title.
const ABOVE: f64 = 44.0;
/// Pixels below the plot, for its axis.
const BELOW: f64 = 60.0;
/// Pixels beside the plot where an axis stands.
const BESIDE: f64 = 80.0;
/// Pixels beside the plot where none does.
const MARGIN: f64 = 28.0;
/// Pixels between the middles of two lines of the legend.
const LINE: f64 = 20.0;
/// Width of a character of 13 pixels, for the size of the legend: wide enough for every usual font.
const CHARACTER: f64 = 7.2;
impl LineChart {
    /// The chart as the text of an SVG file.
    pub fn to_svg(&self) -> String {
        let [width, height] = self.size;
        let right = match self.right {
            Some(_) => width - BESIDE,
            None => width - MARGIN,
        };
        let mut drawing = Drawing {
            text: format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
                 {height}\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#222222\">\n<rect width=\"{width}\" \
                 height=\"{height}\" fill=\"white\"/>\n"
            ),
            x: [BESIDE, right],
            y: [height - BELOW, ABOVE],
        };
        drawing.label([width / 2.0, 26.0], "middle", 17.0, &self.title);
        drawing.axis_below(&self.x);
        drawing.axis_beside(&self.left, Side::Left);
        if let Some(axis) = &self.right {
            drawing.axis_beside(axis, Side::Right);
        }
        drawing.frame();
        for series in &self.series {
            let beside = match (series.side, &self.right) {
                (Side::Right, Some(axis)) => axis,
                _ => &self.left,
            };
            drawing.series(series, &self.x, beside);
        }
        drawing.legend(&self.series);
        drawing.text.push_str("</svg>\n");
        drawing.text
    }
}

/// The text of a picture so far, and where the plot lies: pixels of the least and the greatest value.
struct Drawing {
    text: String,
    x: [f64; 2],
    y: [f64; 2],
}

impl Drawing {
    /// Adds an element. Writing to a String cannot fail.
    fn element(&mut self, arguments: std::fmt::Arguments<'_>) {
        let _ = self.text.write_fmt(arguments);
        self.text.push('\n');
    }

    fn label(&mut self, [x, y]: [f64; 2], anchor: &str, size: f64, text: &str) {
        let text = escaped(text);
        self.element(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" font-size=\"{size}\">{text}</text>"
        ));
    }

    fn line(&mut self, [ax, ay]: [f64; 2], [bx, by]: [f64; 2], color: &str) {
        self.element(format_args!(
            "<line x1=\"{ax:.1}\" y1=\"{ay:.1}\" x2=\"{bx:.1}\" y2=\"{by:.1}\" stroke=\"{color}\"/>"
        ));
    }

    /// Draws the axis below, with lines of the grid.
    fn axis_below(&mut self, axis: &Axis) {
        let [left, right] = self.x;
        let [bottom, top] = self.y;
        for tick in axis.ticks() {
            let x = left + (right - left) * axis.share(tick.value);
            let (color, length) = strength(&tick);
            self.line([x, bottom], [x, top], color);
            self.line([x, bottom], [x, bottom + length], "#444444");
            self.label([x, bottom + 20.0], "middle", 13.0, &tick.text);
        }
        self.label(
            [(left + right) / 2.0, bottom + 44.0],
            "middle",
            14.0,
            &axis.label,
        );
    }

    /// Draws an axis beside the plot; that to the left has lines of the grid.
    fn axis_beside(&mut self, axis: &Axis, side: Side) {
        let [left, right] = self.x;
        let [bottom, top] = self.y;
        let (x, away, anchor) = match side {
            Side::Left => (left, -1.0, "end"),
            Side::Right => (right, 1.0, "start"),
        };
        for tick in axis.ticks() {
            let y = bottom + (top - bottom) * axis.share(tick.value);
            let (color, length) = strength(&tick);
            if side == Side::Left {
                self.line([left, y], [right, y], color);
            }
            self.line([x, y], [x + away * length, y], "#444444");
            self.label([x + away * 9.0, y + 4.5], anchor, 13.0, &tick.text);
        }
        let (x, y) = (x + away * 58.0, (bottom + top) / 2.0);
        let (turn, text) = (90.0 * away, escaped(&axis.label));
        self.element(format_args!(
            "<text transform=\"translate({x:.1} {y:.1}) rotate({turn})\" text-anchor=\"middle\" font-size=\"14\">{text}</text>"
        ));
    }

    fn frame(&mut self) {
        let [left, right] = self.x;
        let [bottom, top] = self.y;
        let (width, height) = (right - left, bottom - top);
        self.element(format_args!(
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"none\" \
             stroke=\"#444444\"/>"
        ));
    }

    fn series(&mut self, series: &Series, x: &Axis, y: &Axis) {
        let ([left, right], [bottom, top]) = (self.x, self.y);
        let place = |&[a, b]: &[f64; 2]| {
            [
                left + (right - left) * x.share(a),
                bottom + (top - bottom) * y.share(b),
            ]
        };
        let places: Vec<[f64; 2]> = series.points.iter().map(place).collect();
        self.stroke(series, &places);
        for &at in &places {
            self.mark(series, at);
        }
        for (&[x, y], label) in places.iter().zip(&series.labels) {
            self.label([x + 6.0, y - 8.0], "start", 12.0, label);
        }
    }

    /// Draws the line of a series through places in pixels.
    fn stroke(&mut self, series: &Series, places: &[[f64; 2]]) {
        let path: Vec<String> = places
            .iter()
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .collect();
        let (color, width, opacity) = (series.color, series.width, series.opacity);
        self.element(format_args!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" \
             stroke-opacity=\"{opacity}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"/>",
            path.join(" ")
        ));
    }

    fn mark(&mut self, series: &Series, [x, y]: [f64; 2]) {
        let color = series.color;
        match series.mark {
            Mark::None => {}
            Mark::Circle => self.element(format_args!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{color}\"/>"
            )),
            Mark::Diamond => self.element(format_args!(
                "<path d=\"M{x:.1} {y:.1}m-5 0l5 -5l5 5l-5 5z\" fill=\"{color}\"/>"
            )),
        }
    }

    /// Lists the series that have names, at the upper right of the plot.
    fn legend(&mut self, series: &[Series]) {
        let named = || series.iter().filter(|s| !s.name.is_empty());
        let Some(longest) = named().map(|s| s.name.chars().count()).max() else {
            return;
        };
        let width = 56.0 + CHARACTER * longest as f64;
        let height = LINE * named().count() as f64 + 10.0;
        let (x, y) = (self.x[1] - width - 12.0, self.y[1] + 12.0);
        self.element(format_args!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" rx=\"3\" fill=\"white\" \
             fill-opacity=\"0.9\" stroke=\"#999999\"/>"
        ));
        for (i, series) in named().enumerate() {
            let middle = y + 5.0 + LINE * (i as f64 + 0.5);
            self.stroke(series, &[[x + 10.0, middle], [x + 38.0, middle]]);
            self.mark(series, [x + 24.0, middle]);
            self.label([x + 46.0, middle + 4.5], "start", 13.0, &series.name);
        }
    }
}

/// Colour of the line of the grid, and length of the tick.
fn strength(tick: &Tick) -> (&'static str, f64) {
    if tick.text.is_empty() {
        ("#f2f2f2", 3.0)
    } else {
        ("#dddddd", 5.0)
    }
}

/// A text as SVG holds it.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_signs_of_markup_stays_text() {
        assert_eq!(escaped("a<b & c>d"), "a&lt;b &amp; c&gt;d");
    }
}
