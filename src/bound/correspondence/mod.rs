//! A map from every point of an original surface to the simplified one, and limits on where points may go.
//!
//! A [`Correspondence`] maps the original triangles, cut into convex pieces, onto live faces; a collapse, laid out as a
//! [`Layout`], cuts and maps them further. An [`Allowance`] decides about each piece with what stands for it: an
//! [`AngleLimit`] by the angle between them for viewers in a cell (Eisemann & Décoret 2007; notes, 4.9). The pieces of a
//! triangle fit together without a gap, so a bound for all pieces is one for all points.

mod angle;
mod file;
mod layout;
mod outline;
mod pairs;
mod piece;
mod pieces;
mod projection;
mod sectors;
mod sides;

pub use angle::AngleLimit;
pub use layout::{Collapse, Face, Layout};
pub use pairs::pairs;
pub use piece::{Allowance, Answer, Corner, Piece};
pub use pieces::{Correspondence, PieceScratch};
