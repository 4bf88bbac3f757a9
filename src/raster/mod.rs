//! The rasterizer: exact, integer, and the same for every order in which triangles arrive.
//!
//! A vertex is transformed in `f64`, snapped to sub-pixel integers ([`Projector`]), and from there on everything is
//! integer: edge functions, the top-left rule, scanline spans by exact division, depth by exact division. A sample shows
//! the least [`SampleKey`]: the minimum over depth and id. Shading happens per triangle, vertex or corner in `f64` with
//! `+ - * / sqrt` and becomes an 8-bit level before images are compared.
//!
//! `draw` makes whole pictures: [`luma`], [`rgb`], [`keys`] and what follows from them. `unrender` lets pictures follow
//! the edits of a mesh ([`Unrender`], [`SceneEdit`]): the published method is [`BucketEngine`], the fast one
//! [`LayerEngine`].

mod draw;
mod pixel_rect;
mod sample_key;
mod scene;
mod unrender;

pub use crate::num::Grid;
pub use draw::{
    Drawn, Face, FaceGeometry, Paint, Picture, Projector, ScreenVertex, Setup, Shader, ZBuffer,
    coverage, depths, ids, keys, luma, luma_sums, mean_luma, mean_rgb, rgb, sum_samples,
};
pub use pixel_rect::PixelRect;
pub use sample_key::SampleKey;
pub use scene::{Scene, stored_normal};
pub use unrender::{
    BucketEngine, CornerValues, LayerEngine, Model, SceneEdit, Unrender, UnrenderScratch,
    ViewSubset,
};
