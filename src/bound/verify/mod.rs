//! The verifier: holds results to what is claimed about them, by its own samples and its own proofs.
//!
//! It shares no code with what makes the claims (nor with `metric`): own search for nearest points, own angles, own
//! reading of files; only `mesh`, `num` and the shape of a view cell are common. [`distance`] checks that two surfaces are
//! nowhere farther apart than claimed, [`angles`] that no viewer in a cell sees a point and what stands for it, by a
//! [`Record`], under more than an angle.

mod angle;
mod cover;
mod distance;
mod mapped;
mod meeting;
mod nearest;
mod proof;
mod record;
mod sight;
mod sighting;
mod spread;
mod worst;

pub use angle::{AngleReport, Property, Sighting, angles};
pub use cover::Gap;
pub use distance::{Claim, Direction, DistanceReport, Witness, distance};
pub use record::Record;
