//! Surgery on a mesh: one engine for every method that simplifies by collapsing edges.
//!
//! A [`LiveMesh`] is a mesh that shrinks; its ids are stable. Around every edge lies a [`Ring`]; putting the ring's
//! two vertices together at a position is a [`Patch`], which exists before it is committed, so that a candidate is
//! judged under the very ids it would have afterwards. [`legality`] decides which collapses are allowed, a
//! [`Method`] where the new vertex lies and what it costs, and the [`Engine`] which edge is next.

mod compact;
mod counters;
mod engine;
mod flip;
mod fold;
mod history;
mod history_file;
pub mod legality;
mod lists;
mod live;
mod method;
mod observer;
mod patch;
mod refusal;
mod replay;
mod ring;
mod star;
mod tiles;
pub mod wedge;

pub use counters::Counters;
pub use engine::{Engine, Heap, Key, Schedule, Stop};
pub use flip::{flip, unmirrored};
pub use fold::{foldedness, is_folded, ring_unfolded, unfolded};
pub use history::{Entry, Header, History, Record, Recorder};
pub use legality::{Rules, Topology};
pub use live::{Changes, LiveMesh, NONE};
pub use method::{
    Admitted, Estimates, Evaluation, Method, MethodScratch, Plan, Proposal, Review, Site,
};
pub use observer::Observer;
pub use patch::{Move, Patch, PatchFace};
pub use refusal::{Reason, Refusal, Refusals};
pub use replay::Replay;
pub use ring::{Anchor, BoundaryEdge, Ring, RingFace, Spoke};
pub use star::{Freedom, Star};
pub use tiles::{TileOptions, Tileable, Tiling, collapse_in_tiles};
