//! Why a pixel differs: ID buffers held against a second way to them, every difference with its reason.
//!
//! Today the other way is ray casting ([`rays`]), which judges this crate's own rasterizer; buffers that a GPU drew are
//! to be judged by the same classes.

pub mod rays;
