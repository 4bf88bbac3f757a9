//! The front door: functions and options of the root that no room has in that form.
//!
//! They compose rooms as the command does and promise what their signatures say; the rooms behind them are free to
//! change.

mod render;
pub mod verify;
mod visibility;

pub use render::{RenderOptions, Rendering, ViewImages, render, render_with};
pub use visibility::{visibility, visibility_with};
