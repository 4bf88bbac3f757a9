//! Every integration test in one binary: a module per stage.

mod architecture;
mod hostile;
mod io;
mod mesh;
