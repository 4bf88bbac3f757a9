//! What became of every point of a surface that was simplified, and whether it may have become that.
//!
//! A [`Correspondence`] maps the original triangles, cut into convex pieces, onto live faces; a collapse, laid out as a
//! [`Fan`], cuts and maps them further. An [`Allowance`] decides about each piece with what stands for it: an
//! [`AngleLimit`] by the angle between them for viewers in a cell (Eisemann & Décoret 2007; notes, 4.9). The map is
//! continuous and covers every original triangle exactly once, so a bound for all pieces is one for all points.

mod angle;
mod clip;
mod fan;
mod file;
mod pairs;
mod pieces;

pub use angle::AngleLimit;
pub use fan::{Collapse, Face, Fan};
pub use pairs::pairs;
pub use pieces::{Allowance, Corner, Correspondence, Piece, Scratch};
