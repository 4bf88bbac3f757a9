//! Levels of detail: a chain of meshes from fine to coarse, and the distances from which on each may be shown.
//!
//! `levels` is the plan: sizes, distances, or halving. `run` makes every level by a run of its own, which is what
//! `lodmark simplify` gives for as many triangles, bit for bit, and `judge` measures it. `switch_distance` renders the
//! original and the levels as they are seen on a `screen` from afar (`sighting`); `certificate` proves a distance instead.
//! `files` writes the levels and the `manifest`.

mod certificate;
mod files;
mod judge;
mod levels;
mod manifest;
mod run;
mod screen;
mod sighting;
mod switch_distance;

pub use files::{Written, level_name, manifest_name, write};
pub use judge::LevelReport;
pub use levels::Levels;
pub use run::{Chain, Level, chain, chain_with};
pub use screen::{ASPECT, Screen, ScreenShares};
