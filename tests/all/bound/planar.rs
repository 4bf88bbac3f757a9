//! Validity regions in the plane: checked values, brute force over viewpoints, and every special case of the paper.

#![allow(
    clippy::approx_constant,
    clippy::disallowed_methods,
    clippy::float_cmp,
    clippy::print_stdout,
    reason = "what is held against the crate's math must not use it; exact results are exact; cases are counted aloud"
)]

mod case;
mod faces;
mod oblique;
mod points;
mod seen;
mod space;
mod vectors;
