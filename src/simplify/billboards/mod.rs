//! View-dependent billboard clouds (Eisemann & Décoret 2007, section 6): a scene on a few textured quads, which no
//! viewer in a cell can tell from it by more than an angle across the horizon.
//!
//! Walls are projected on vertical planes along the plane's normal or another direction, within the exact intervals of
//! [`planar`](crate::bound::planar); horizontal faces on horizontal planes within their bound in space
//! ([`face_interval`](crate::bound::face::face_interval)). [`billboards`] chooses the planes, [`Quad::texture`] draws
//! what is on one. As in the paper the angle is bounded across the horizon: up and down a vertical plane may displace
//! by more, which [`Cloud::displacement`] tells. Limits: one cell, no visibility, colours but no textures of the scene.

mod bearing;
mod cloud;
mod displacement;
pub mod files;
mod flat;
mod options;
mod plan;
mod quad;
mod select;
mod sweep;
mod tree;
mod viewers_in_plan;

pub use cloud::{Cloud, billboards};
pub use displacement::Displacement;
pub use options::{BillboardOptions, Limit};
pub use plan::Up;
pub use quad::{Quad, Texture};
