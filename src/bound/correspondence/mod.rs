//! What became of every point of a surface that was simplified, and whether it may have become that.
//!
//! A [`Correspondence`] maps the original triangles, cut into convex pieces, onto live faces; a collapse, laid out as a
//! [`Fan`], cuts and maps them further. An [`Allowance`] decides about each piece with what stands for it: an
//! [`AngleLimit`] by the angle between them for viewers in a cell (Eisemann & Décoret 2007; notes, 4.9). The pieces of a
//! triangle fit together without a gap, so a bound for all pieces is one for all points.

mod angle;
mod file;
mod layout;
mod outline;
mod pairs;
mod pieces;
mod sectors;
mod sides;

pub use angle::AngleLimit;
pub use layout::{Collapse, Face, Fan};
pub use pairs::pairs;
pub use pieces::{Allowance, Answer, Corner, Correspondence, Piece, Scratch};
