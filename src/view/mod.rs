//! Views: cameras with their culling, shading and light, alone and in sets.
//!
//! Positions and lengths are in the units of the mesh that is drawn (for the methods: frame units). Cameras are placed
//! around the minimum bounding [`Sphere`] of the mesh, from the [`directions`] of a polyhedron, or read from a
//! [`mod@file`].

mod camera;
pub mod directions;
pub mod file;
mod framing;
mod sets;
mod sphere;

pub use camera::{Cull, Eye, Interpolation, Light, Matrix, Shading, Specular, View, ViewSet};
pub use framing::Projection;
pub use sets::{BACKGROUND, SIDE_LIMIT, ViewsName, resolve};
pub use sphere::{Sphere, frame_of};
