//! Views: cameras with their culling, shading and light, alone and in sets.
//!
//! Positions and lengths are in the units of the mesh that is drawn (for the methods: frame units). Cameras are placed
//! around the minimum bounding [`Sphere`] of the mesh, from the directions of a named set ([`mod@sets`]), or read from a
//! [`mod@file`].

mod camera;
pub mod file;
mod framing;
mod from_distance;
pub mod sets;
mod sphere;

pub use camera::{
    Cull, Eye, Interpolation, Light, Matrix, SIDE_LIMIT, Shading, Specular, View, ViewSet,
};
pub use framing::Projection;
pub use from_distance::Window;
pub use sets::{BACKGROUND, ViewsName, resolve};
pub use sphere::{Sphere, frame_of};
