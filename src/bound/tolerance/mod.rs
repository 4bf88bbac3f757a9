//! Tolerance volumes: where the new vertex of a collapse may lie so that the new faces stay near the old ones.
//!
//! Cox & Chibelushi 2005. A [`Neighborhood`] is what lies around the edge; every old triangle makes a [`Prism`] of half
//! the height of the bound to either side. A new vertex lies in a prism and in the convex kernel, and not where a new
//! face would pierce the cap of a prism: not in the [`shadows`] of the caps. What is left is a [`Volume`] of convex
//! [`Polyhedron`]s. [`Neighborhood::deviation`] measures how far new faces are from the old ones. The bound is one per
//! collapse and one-sided; what holds against the original is certified by [`envelope`](super::envelope).

mod half_space;
mod measure;
mod neighborhood;
mod polyhedron;
mod prism;
mod quadratic;
mod shadow;
mod volume;

pub use half_space::HalfSpace;
pub use neighborhood::{Neighborhood, OldFace};
pub use polyhedron::Polyhedron;
pub use prism::Prism;
pub use quadratic::Quadratic;
pub use shadow::shadows;
pub use volume::{MOST_POLYHEDRA, Source, Volume};
