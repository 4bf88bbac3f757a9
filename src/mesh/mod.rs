//! Meshes: an indexed triangle mesh with corner attributes and materials, and what is known about it.
//!
//! [`Mesh`] is validated when it is made, so everything downstream can index without checking. Positions are in
//! file units; the stages that care about magnitude work in a [`Frame`](crate::num::Frame).

mod adjacency;
mod attributes;
mod canonical;
mod digest;
mod findings;
pub mod generate;
mod indexed;
mod region;
mod topology;
mod unite;
mod weld;

pub use adjacency::{Edge, Edges, VertexTriangles};
pub use attributes::{Attributes, Channel, ChannelKind};
pub use canonical::{Canonical, canonical};
pub use digest::{content_digest, content_sha256};
pub use findings::{Bounds, Finding, Findings};
pub use indexed::{Materials, Mesh, MeshParts};
pub(crate) use unite::{compare_rows, unite};
pub use weld::{Welded, weld};
