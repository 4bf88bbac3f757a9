//! Numbers: the only place where a float becomes fixed point, and the only caller of `sqrt` and `libm`.
//!
//! Everything a result depends on is `f64` with `+ - * /` and [`math::sqrt`], or an integer. See the promise in
//! the crate documentation.

mod each;
pub mod fixed;
mod frame;
mod grid;
pub mod math;

pub(crate) use each::Each;
pub use frame::{Frame, Precision};
pub use grid::Grid;
