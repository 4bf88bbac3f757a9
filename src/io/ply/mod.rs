//! PLY (G. Turk, 1994), text and binary, in and out.
//!
//! A file is read header first ([`header`]), then vertices and faces ([`vertices`], [`faces`]) from one sequence of numbers
//! ([`numbers`]). The texts of all errors about a broken body stand in [`errors`]; those about a broken header stand beside
//! what they expect.

mod errors;
mod faces;
mod header;
mod numbers;
mod read;
mod vertices;
mod write;

pub(super) use read::read;
pub(super) use write::{Numbers, encode};
