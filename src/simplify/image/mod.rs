//! Image-driven simplification: Lindstrom & Turk 2000, section 4.
//!
//! Edges collapse in the order in which that changes the pictures: the cost is equation 8, the change of the
//! sum of squared luma differences over all views, as an exact integer that may be negative and is not clamped. The new
//! vertex is placed by the memoryless method (section 4.1), whose own cost is the second key: hidden edges all cost 0,
//! and it keeps hidden parts in shape. But for the paper's preset, volume that a collapse sweeps is charged for as well:
//! see [`ImageDriven::with_swept_price`]. Evaluation is lazy as in section 4.2.2, but for the edges of a new vertex unless
//! the preset is the paper's, where also every evaluation is in all views (see [`ImageDriven::with_view_stride`]); the
//! pictures follow every collapse, by layers or as in section 4.2.3. Polishing by moves
//! and flips, which the paper does not have, comes after the last collapse. Pictures are lit with the normals that the mesh
//! stores, if it does and nobody says otherwise (see [`DrivingShading`]).

mod distance_penalty;
mod fallback;
mod held_out_views;
mod method;
mod options;
mod original_model;
mod pictures;
mod polish;
mod preset;
mod reference_images;
mod report;
mod run;
mod slots;

pub use distance_penalty::DistancePenalty;
pub use fallback::Comparison;
pub use held_out_views::HeldOutViews;
pub use method::{ImageDriven, ImageScratch};
pub use options::{DrivingShading, EngineName, ImageOptions, Size, Start};
pub use original_model::OriginalModel;
pub use pictures::{PictureScratch, Pictures};
pub use polish::{Limits, Polish, PolishCounters, Turn, polish};
pub use preset::Preset;
pub use reference_images::ReferenceImages;
pub use report::ImageReport;
