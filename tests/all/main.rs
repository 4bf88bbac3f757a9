//! Every integration test in one binary: a module per stage.

mod architecture;
mod generate;
mod view;
