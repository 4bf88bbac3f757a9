//! Measures of the difference between two meshes or two sets of images.
//!
//! [`appearance`] draws two meshes over a set of views and compares the pictures.
//! [`luma`] is what simplification minimises: the exact squared difference of luma images (Lindstrom & Turk 2000,
//! equations 1 and 2). [`surface`] is the classical geometric distance, measured as Metro does. [`silhouette`]
//! explains why images keep shape: it counts in how many views an edge lies on the silhouette (Figure 7). [`outline`] says
//! how far two silhouettes are apart.
//! [`folds`] counts what pictures may hide. [`difference`] says whether two images are equal, and where and how much
//! they are not.

pub mod appearance;
pub mod difference;
mod difference_strip;
pub mod folds;
pub mod luma;
pub mod outline;
pub mod report;
pub mod silhouette;
pub mod surface;

pub use difference_strip::difference_strip;

pub use folds::{FoldReference, Orientation};
