//! Files, in and out.

pub mod atomic;
