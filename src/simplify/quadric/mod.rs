//! Quadric error metrics: Garland & Heckbert 1997 and 1998.

mod method;

pub use method::{Quadric, QuadricMethod, QuadricOptions, Uncertainty, Weighting};
