//! The verifier: true claims pass, planted ones are caught, and its proofs are proofs.

mod angle;
mod distance;
mod record;

pub(super) use angle::{identity, read};
