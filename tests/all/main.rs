//! Every integration test in one binary: a folder per room.

mod architecture;
mod bound;
mod chain;
mod cli;
mod collapse;
mod encode;
mod front_door;
mod golden;
mod io;
mod mesh;
mod metric;
mod raster;
mod simplify;
mod support;
mod validate;
mod view;
mod visibility;
