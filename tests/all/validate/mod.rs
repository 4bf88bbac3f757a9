//! ID buffers against rays: this crate's own, Embree's, and those of a rasterizer with planted bugs.

pub(crate) mod embree;
mod planted_bugs;
pub(crate) mod rays;
