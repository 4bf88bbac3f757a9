//! Surgery on a mesh: one engine for every method that simplifies by collapsing edges.
//!
//! A [`LiveMesh`] is a mesh that shrinks; its ids are stable. Around every edge lies a [`Ring`]; putting the ring's
//! two vertices together at a position is a [`Patch`], which exists before it is committed, so that a candidate is
//! judged under the very ids it would have afterwards. [`legality`] decides which collapses are allowed, a
//! [`Method`] where the new vertex lies and what it costs, and the [`Engine`] which edge is next.

mod compact;
mod counters;
mod engine;
mod evaluator;
mod flip;
mod fold;
mod heap;
mod history;
mod history_file;
pub mod legality;
mod lists;
mod live;
mod method;
mod patch;
mod queue;
mod replay;
mod ring;
mod star;
mod tiles;
pub mod wedge;

pub use counters::Counters;
pub use engine::{End, Engine, Observer, Target};
pub use flip::{flip, unmirrored};
pub use fold::{foldedness, is_folded, ring_unfolded, unfolded};
pub use heap::{Heap, Key};
pub use history::{Entry, Header, History, Record, Recorder};
pub use legality::{Refusal, Refusals, Rules, Topology};
pub use live::{Changes, LiveMesh, NONE};
pub use method::{Admitted, Method, Proposal, Site};
pub use patch::{Move, Patch, PatchFace};
pub use queue::Schedule;
pub use replay::Replay;
pub use ring::{Anchor, BoundaryEdge, Ring, RingFace, Spoke};
pub use star::{Freedom, Star};
pub use tiles::{Divisible, Tiling, thin};
