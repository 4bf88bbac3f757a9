//! Quadric error metrics: Garland & Heckbert 1997 (planes, boundary constraint planes), 1998 (area weights),
//! optionally the probabilistic quadrics of Trettner & Kobbelt 2020, or distances in space and in the values of texture
//! coordinates and colours (1998, `attributes`).
//!
//! A vertex carries the sum of the squared distances to the planes of its faces; an edge the sum of its ends', so a
//! face with both ends counts twice, as in the papers. The new vertex minimises it where the minimum is well
//! conditioned; otherwise it is the best point of the edge. Costs: length^2 (unit weights) or length^4 (area
//! weights), in frame units.

mod attribute_quadric;
mod attributes;
mod method;
mod options;
mod placement;
mod run;

pub use attribute_quadric::{AttributeQuadric, Values};
pub use attributes::AttributeQuadrics;
pub use method::QuadricMethod;
pub use options::{QuadricOptions, Uncertainty, Weighting};
pub use placement::Quadric;
