//! The verifier: holds results to what is claimed about them, by its own samples and its own proofs.
//!
//! It shares no code with what makes the claims, on purpose, and none with `metric` or `geometry`: own tree over
//! triangles and nearest points (`nearest`), own angles, own reading of files; a mistake in those rooms cannot hide
//! itself here. Only `mesh`, `num` and the shape of a view cell are common. [`distance`] checks that two surfaces are
//! nowhere farther apart than claimed, [`angles`] that no viewer in a cell sees a point and what stands for it, by a
//! [`Record`], under more than an angle.

mod angle;
mod angle_bound;
mod angle_tally;
mod cell_contact;
mod distance;
mod distance_bound;
mod gaps;
mod nearest;
mod piece_bounds;
mod record;
mod samples;
mod viewpoints;

pub use angle::{AngleReport, Property, Sighting, angles};
pub use distance::{Claim, Direction, DistanceReport, Witness, distance};
pub use gaps::Gap;
pub use record::Record;
