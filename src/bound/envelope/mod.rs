//! The certificate: nothing of the new surface is too far from the original, and nothing of the original from it.
//!
//! Section 3 of Cox & Chibelushi 2005 bounds every collapse by the surface before it; errors then add up. Here both
//! directions are tested against the original itself. [`OriginalSurface`] has the original's triangles and tests new
//! ones;
//! [`Coverage`] knows for every triangle of the original which live faces it is near to, and tests whether a change
//! leaves it near to some. Both divide triangles until every piece is within reach of a single triangle, to which the
//! distance is convex: three corners decide. A yes is a proof that includes the rounding of doubles; a no may be wrong
//! by a small part of the bound.

mod coverage;
mod facet;
mod reach;
mod surface;

pub use coverage::{Coverage, Trial, WitnessChange};
pub use facet::Facet;
pub use reach::Reach;
pub use surface::{OriginalSurface, PieceQueue};
