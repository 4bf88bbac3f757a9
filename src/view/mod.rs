//! Views: cameras with their culling, shading and light, alone and in sets.
//!
//! Positions and lengths are in the units of the mesh that is drawn (for the methods: frame units).

mod camera;

pub use camera::{Cull, Eye, Interpolation, Light, Matrix, Shading, Specular, View, ViewSet};
