//! Memoryless simplification: Lindstrom & Turk 1998 (placement) and 1999 (cost).
//!
//! The new vertex is the solution of up to three linear constraints, tried in order: keep the volume, keep the area
//! at the boundary, minimise the sum of squared tetrahedra (volume) and triangles (boundary) that the faces sweep,
//! minimise the distances to the link. A constraint counts where its direction differs by at least one degree from
//! those before it. Coordinates are relative to the edge's midpoint: the constants are triple products, which cancel
//! badly far from the origin. Deviations: boundary before volume where there is one (keeps outlines; as CGAL does;
//! [`ConstraintOrder::Paper`] has the published order), and where the constraints determine no point, or one that
//! the rules forbid, the best of midpoint and ends (measured on the dragon at 8,190 triangles: 2 % less mean distance
//! than giving the edge up, and a fifth fewer evaluations). Costs have the dimension length^6, in frame units.

mod method;
mod objective;
mod options;
mod run;
mod vertex_sums;

pub use method::Memoryless;
pub use objective::{Objective, Placement, propose};
pub use options::{ConstraintOrder, MemorylessOptions};
pub(super) use run::{distance_rules, volume_rules};
