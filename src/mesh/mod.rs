//! Meshes: an indexed triangle mesh with corner attributes and materials, and what is known about it.
//!
//! [`Mesh`] is validated when it is made, so everything downstream can index without checking. Positions are in
//! file units; the stages that care about magnitude work in a [`Frame`](crate::num::Frame).

mod adjacency;
mod attributes;
pub mod generate;
mod indexed;

pub use adjacency::{Edge, Edges, VertexTriangles};
pub use attributes::{Attributes, Channel, ChannelKind};
pub use indexed::{Materials, Mesh, MeshParts};
