//! Every integration test in one binary: a module per stage.

mod architecture;
mod findings;
mod hostile;
mod io;
mod io_errors;
mod mesh;
