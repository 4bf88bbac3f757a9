//! Visibility: how much of every triangle an observer far away can see (Zhang & Turk 2002).
//!
//! Orthographic [`cameras`](MeasureOptions::octahedron) all around the mesh draw ID buffers. F(t, v) says whether view v sees
//! triangle t; the measure V(t) of equation 4.3 is the share of the views in front of t that see it, head-on views
//! counting most; V(M) of equation 3.2 is its mean over the surface. [`measure`] does all of it. A [`PartialVisibility`] holds what
//! some of the views have seen, as integers, so that views can be spread over machines and put together in any
//! order.
//!
//! Two sets of [`MeasureOptions`]: the default corrects what the paper leaves to chance, [`MeasureOptions::paper`] follows it to the
//! letter. Deviations are told where they are made.
//!
//! The room `validate` proves the ID buffers right by ray casting.

mod cameras;
mod color;
mod convergence;
mod counts;
mod depth_test;
mod hidden;
mod measure;
mod options;
mod partial;
mod partial_file;
pub mod ply;
mod seen_parts;
mod subdivide;
mod visibility_table;

pub use color::color;
pub use convergence::{ConvergenceStep, convergence};
pub use hidden::remove_hidden;
pub use measure::{Visibility, measure};
pub use options::{Alignment, CameraWeights, MeasureOptions, UnseenRule};
pub use partial::PartialVisibility;
pub use visibility_table::VisibilityTable;
