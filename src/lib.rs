//! Simplify 3D meshes by what they look like, with the same bits on every machine and no GPU.

mod error;
mod progress;

pub mod io;
pub mod mesh;
pub mod num;
pub mod raster;
pub mod view;

pub use error::{Error, Result};
pub use progress::{Progress, Silent};
