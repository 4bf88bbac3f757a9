//! The methods of simplification, their options and their outcome.
//!
//! [`simplify`] takes a mesh and [`Options`] and gives an [`Outcome`]: the mesh, the history of its making and why it
//! ended; [`simplify_guided`] does so by a visibility that was measured before. [`memoryless`] and [`quadric`] are the baselines; the placements in them are pure functions that other
//! methods use as well: [`mod@image`] the first, [`visibility`] the second.

pub mod billboards;
pub mod image;
pub mod memoryless;
mod options;
mod outcome;
pub mod quadric;
mod repair_folds;
mod replacement;
mod run;
pub mod tolerance;
pub mod view_bounded;
pub mod visibility;

pub use crate::collapse::Stop;
/// What an [`Outcome`] carries to rebuild any level, and what rebuilds it.
pub use crate::collapse::{History, Replay};
pub use image::Comparison;
pub use options::{Amount, MethodOptions, Options};
pub use outcome::{Outcome, Phase};
pub use replacement::{NearestTriangle, originals};
pub use run::{simplify, simplify_guided};
