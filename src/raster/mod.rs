//! The rasterizer: exact, integer, and the same for every order in which triangles arrive.
//!
//! A vertex is transformed in `f64`, snapped to sub-pixel integers ([`Projector`]), and from there on
//! everything is integer: edge functions, the top-left rule, scanline spans by exact division, depth by exact
//! division. A pixel is the minimum over `(depth, triangle id)`. Shading happens per triangle or per vertex in `f64`
//! with `+ - * / sqrt` and becomes an 8-bit level before images are compared.
//!
//! Whole pictures: [`luma`], [`rgb`], [`keys`] and what follows from them. Pictures that follow a change of the mesh:
//! [`Unrender`], with the published method in [`BucketEngine`] and the fast one
//! in [`LayerEngine`].

mod buckets;
mod clip;
mod coverage;
mod deepest;
mod draw;
mod face;
mod lanes;
mod layer_commit;
mod layer_view;
mod layers;
mod look;
mod paint;
mod pictures;
mod plane;
mod prepare;
mod project;
mod region;
mod rerender;
mod samples;
mod scene;
mod setup;
mod shade;
mod small;
mod stacks;
mod unrender;
mod zbuffer;

pub use draw::{Picture, coverage, depths, ids, keys, luma, rgb};
pub use face::{Face, Pieces};
pub use layers::{LayerEngine, LayerScratch};
pub use paint::Paint;
pub use plane::Plane;
pub use project::{Projector, ScreenVertex};
pub use region::Region;
pub use rerender::{BucketEngine, BucketScratch};
pub use samples::{luma_sums, mean_luma, mean_rgb, sum_samples};
pub use scene::Scene;
pub use setup::Setup;
pub use shade::{FaceGeometry, Shader};
pub use unrender::{Added, Change, Glance, Model, Unrender};
pub use zbuffer::ZBuffer;
