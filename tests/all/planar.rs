//! Validity regions in the plane: checked values, brute force over viewpoints, and every special case of the paper.

#[path = "planar/faces.rs"]
mod faces;
#[path = "planar/points.rs"]
mod points;
#[path = "planar/seen.rs"]
mod seen;
#[path = "planar/space.rs"]
mod space;
#[path = "planar/vectors.rs"]
mod vectors;
