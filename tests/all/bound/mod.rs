//! Guaranteed bounds: validity regions, cells of viewers, envelopes, recorded maps, and the verifier that shares no code with them.

mod correspondence;
mod edge_cases;
pub(crate) mod envelope;
mod planar;
mod points;
mod surface;
pub(crate) mod tolerance_volume;
mod verify;
mod view_cell;
