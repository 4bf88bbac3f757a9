//! Every integration test in one binary: a module per stage.

mod appearance;
mod architecture;
mod billboards;
mod bound;
mod bound_command;
mod cli;
mod collapse;
mod compare;
mod correspondence;
mod embree;
mod envelope;
mod fallback;
mod findings;
mod generate;
mod golden;
mod guided;
mod history;
mod hostile;
mod image;
mod interior;
mod io;
mod io_errors;
mod levels;
mod memoryless;
mod mesh;
mod metric;
mod metric_surface;
mod oracle;
mod output;
mod planar;
mod planted_bugs;
mod point_bounds;
mod polish;
mod quadric;
mod raster;
mod rays;
mod seams;
mod shapes;
mod streams;
mod tiles;
mod tolerance;
mod tolerance_volume;
mod unfold;
mod unrender;
mod verify;
mod view;
mod view_bounded;
mod view_cell;
mod visibility;
mod zbuffer;

/// A property test of so many cases that writes nothing into the source tree when it fails.
fn cases(count: u32) -> proptest::test_runner::Config {
    proptest::test_runner::Config {
        failure_persistence: None,
        ..proptest::test_runner::Config::with_cases(count)
    }
}
