//! The rasterizer against ray casting: a second way to every ID buffer, and the reason for every pixel that differs.
//!
//! A ray goes through the centre of a pixel, which nothing has snapped, and meets triangles that nothing has snapped,
//! clipped or divided: positions and matrix are taken as the exact numbers they are. The triangle that a ray hits is decided in
//! exact arithmetic (`intersect`, `exact`), with the top-left rule as a symbolic move of the ray; a bounding-volume
//! hierarchy (obvhs) only leaves out triangles that the ray cannot meet (`hierarchy`). Nothing is shared with the
//! coverage, depth, clipping and projection code of [`crate::raster`], so that each is a check of the other.
//!
//! [`RayCaster::keys`] makes the picture, [`RayCaster::classify`] says of every pixel whether it differs and why
//! ([`Class`]), and [`Tally`] counts.

mod cast;
mod claim;
mod classify;
mod exact;
mod grid;
mod hierarchy;
mod intersect;
mod outline;
mod tally;

pub use cast::RayCaster;
pub use classify::{Class, Classified, Shown, TOLERANCE, Witness};
pub use tally::{Tally, WITNESSES, cap};
