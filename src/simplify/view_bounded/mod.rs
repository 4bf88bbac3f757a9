//! View-bounded simplification: no point of the original surface is seen under a larger angle than allowed from the
//! point that replaces it, by any viewer in a cell.

mod method;

pub use method::{ViewBounded, ViewBoundedOptions};
