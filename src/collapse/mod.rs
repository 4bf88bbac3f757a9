//! Surgery on a mesh: one engine for every method that simplifies by collapsing edges.
//!
//! A [`LiveMesh`] is a mesh that shrinks; its ids are stable. Around every edge lies an [`EdgeStar`]; putting the edge's
//! two vertices together at a position is a [`Patch`], which exists before it is committed, so that a candidate is
//! judged under the very ids it would have afterwards. [`legality`] decides which collapses are allowed, a
//! [`Method`] where the new vertex lies and what it costs, and the [`Engine`] which edge is next.
//!
//! The way of an edge from the queue to its commit:
//! 1. `engine`: the edge with the smallest [`Key`] stands at the front of the queue (`engine/queue`).
//! 2. Where its key is not exact, the engine gathers its [`EdgeStar`] from the lists of the mesh (`live`).
//! 3. [`Site::new`] asks [`legality`] where the rules allow the new vertex at all.
//! 4. [`Method::propose`] places it; [`Site::admit`] rounds it to the file's precision and tests shapes and folds
//!    (`fold`); the method prices the collapse, from its [`Patch`] where the cost needs the faces afterwards. The edge
//!    goes back to the queue under the exact key.
//! 5. At the front again, the star becomes the [`Patch`] that is committed: faces that go, faces that come, and the
//!    wedges of the new vertex (`wedge`), by [`Method::wedge_values`] where the method gives some.
//! 6. [`Method::review`] has the last word, then [`LiveMesh::apply`] changes the lists.
//! 7. [`Method::committed`] and [`Observer::committed`] follow; a [`Recorder`] keeps a [`Record`] of the patch.
//! 8. `engine` marks the edges around the new vertex as stale and re-keys those that the [`Schedule`] wants at once.

mod compact;
mod counters;
mod edge_star;
mod engine;
mod flip;
mod fold;
mod history;
mod history_file;
pub mod legality;
mod live;
mod locks;
mod method;
mod observer;
mod patch;
mod pinch;
mod refusal;
mod replay;
mod star;
mod tiles;
pub mod wedge;
mod weights;

pub use counters::{Counters, Stop};
pub use edge_star::{BoundaryEdge, EdgeStar, Spoke, StarFace};
pub use engine::{Engine, Heap, Key, Schedule};
pub use flip::{check_uv_orientation, flip};
pub use fold::{check_collapse_folds, check_folds, fold_amount, is_folded};
pub use history::{Entry, Header, History, Record, Recorder};
pub use legality::{Admitted, Anchor, Concession, Rules, Site, Topology};
pub use live::{LiveMesh, NONE};
pub use locks::Locks;
pub use method::{Estimates, Evaluation, Method, MethodScratch, Plan, Proposal, Review};
pub use observer::Observer;
pub use patch::{Changes, Move, Patch, PatchFace};
pub(crate) use pinch::Forest;
pub use refusal::{Reason, Refusal, Refusals};
pub use replay::Replay;
pub use star::{Freedom, Star};
pub use tiles::{TileOptions, Tileable, Tiling, collapse_in_tiles};
pub use weights::Price;
