//! The rasterizer: exact, integer, and the same for every order in which triangles arrive.

mod plane;

pub use plane::Plane;
