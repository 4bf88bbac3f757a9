//! Validity regions in the plane: checked values, brute force over viewpoints, and every special case of the paper.

#![allow(
    clippy::approx_constant,
    clippy::disallowed_methods,
    clippy::float_cmp,
    clippy::print_stdout,
    reason = "what is held against the crate's math must not use it; exact results are exact; cases are counted aloud"
)]

#[path = "planar/case.rs"]
mod case;
#[path = "planar/faces.rs"]
mod faces;
#[path = "planar/oblique.rs"]
mod oblique;
#[path = "planar/points.rs"]
mod points;
#[path = "planar/seen.rs"]
mod seen;
#[path = "planar/space.rs"]
mod space;
#[path = "planar/vectors.rs"]
mod vectors;
