//! Drawing from scratch: vertices to sub-pixels, triangles to fragments, fragments to samples, samples to pixels.
//!
//! In the order of the way: [`Projector`] transforms and snaps, [`Face`] clips what cannot be snapped, [`Setup`] holds
//! the edge functions of a triangle and visits the samples it covers (small triangles have a way of their own that finds
//! the same), [`ZBuffer`] keeps the nearest triangle of every sample, [`Shader`] and [`Paint`] say what it looks like
//! there, and [`luma`], [`rgb`] and [`luma_sums`] make pictures of it.

mod clip;
mod coverage;
mod face;
mod paint;
mod picture;
pub(super) mod projector;
mod samples;
mod setup;
mod shade;
pub(super) mod small_triangle;
mod zbuffer;

pub use face::{Drawn, Face};
pub use paint::Paint;
pub use picture::{Picture, coverage, depths, ids, keys, luma, rgb};
pub use projector::{Projector, ScreenVertex};
pub use samples::{luma_sums, mean_luma, mean_rgb, sum_samples};
pub use setup::Setup;
pub use shade::{FaceGeometry, Shader};
pub use zbuffer::ZBuffer;

use super::{Grid, PixelRect, SampleKey, Scene};
