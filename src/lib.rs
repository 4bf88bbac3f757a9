//! Simplify 3D meshes by what they look like, with the same bits on every machine and no GPU.

mod error;
mod progress;

#[cfg(feature = "cli")]
pub mod cli;
pub mod collapse;
pub mod io;
pub mod mesh;
pub mod metric;
pub mod num;
pub mod output;
pub mod raster;
pub mod simplify;
pub mod view;

pub use error::{Error, Result};
pub use progress::{Progress, Silent};
