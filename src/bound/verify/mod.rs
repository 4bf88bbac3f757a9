//! The verifier: holds results to what is claimed about them, by its own samples and its own proofs.
//!
//! It shares no code with what makes the claims (nor with `metric`): own search for nearest points, own angles, own
//! reading of files; only `mesh` and `num` are common. [`distance`] checks that two surfaces are nowhere farther apart
//! than claimed.

mod distance;
mod nearest;
mod proof;
mod spread;

pub use distance::{Claim, Direction, DistanceReport, Witness, distance};
