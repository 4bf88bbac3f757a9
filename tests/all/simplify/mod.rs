//! The methods: what each promises of its results.

mod attributes;
mod billboards;
mod deviation;
mod fallback;
mod fold_repair;
pub(crate) mod image;
mod interior_views;
mod lit;
pub(crate) mod memoryless;
pub(crate) mod normals;
pub(crate) mod options;
pub(crate) mod polish;
mod progress;
mod quadric;
mod tangents;
mod targets;
mod tolerance;
mod view_bounded;
mod visibility_guided;
mod weights;
