//! Every integration test in one binary: a module per stage.

mod architecture;
mod metric;
mod metric_surface;
mod output;
