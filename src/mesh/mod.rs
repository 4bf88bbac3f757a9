//! Meshes: an indexed triangle mesh with corner attributes and materials, and what is known about it.
//!
//! [`Mesh`] is validated when it is made, so everything downstream can index without checking. Positions are in
//! file units; the stages that care about magnitude work in a [`Frame`](crate::num::Frame).

mod adjacency;
mod asset;
mod attributes;
mod canonical;
mod connectivity;
mod digest;
mod findings;
mod framed;
pub mod generate;
mod group_equal;
mod indexed;
mod part_near_boxes;
mod weld;

pub use adjacency::{Edge, Edges, VertexTriangles};
pub use asset::{Asset, AssetPart};
pub use attributes::{Attributes, Channel, ChannelKind};
pub use canonical::{Canonical, canonical};
pub use digest::{content_digest, content_sha256};
pub use findings::{Bounds, Finding, Findings};
pub use framed::FramedMesh;
pub(crate) use group_equal::{compare_rows, group_equal};
pub use indexed::{Materials, Mesh, MeshParts};
pub use weld::{Welded, weld};
