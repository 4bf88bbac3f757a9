//! Quadric error metrics: Garland & Heckbert 1997 (planes, boundary constraint planes), 1998 (area weights),
//! optionally the probabilistic quadrics of Trettner & Kobbelt 2020.
//!
//! A vertex carries the sum of the squared distances to the planes of its faces; an edge the sum of its ends', so a
//! face with both ends counts twice, as in the papers. The new vertex minimises it where the minimum is well
//! conditioned; otherwise it is the best point of the edge. Costs: length^2 (unit weights) or length^4 (area
//! weights), in frame units.

mod method;
mod options;
mod placement;
mod run;

pub use method::QuadricMethod;
pub use options::{QuadricOptions, Uncertainty, Weighting};
pub use placement::Quadric;
