//! Simplification within a distance of the original, guaranteed (after Cox & Chibelushi 2005).
//!
//! The paper keeps every new vertex in a tolerance volume around the faces before the collapse, under a local bound that
//! grows; its errors add up. Here a collapse is made only where the certificate of
//! [`bound::envelope`](crate::bound::envelope) holds against the *original*: every point of the new faces is within the
//! bound of the original and, unless one-sided, every point of the original within the bound of the new mesh.
//!
//! Deviations: positions are tried in the order optimum of Lindstrom & Turk, then ends and midpoint of the edge by cost;
//! the tolerance volume proposes one more where those are refused ([`ToleranceOptions::volume`]), and the growing local
//! bound is an option ([`ToleranceOptions::growing`]): on the bunny at 0.5 % of the diagonal the certificate alone leaves 627
//! triangles in 4.2 s of processor time, after a growing bound 639 in 18.5 s, with rigorous volumes 617 in 6.3 s, with
//! published ones 603 in 7.6 s. Collapses are ordered by the memoryless cost, in
//! frame units. Limits: as those of the certificate; positions have the file's precision before they are tested.

mod method;
mod options;
mod report;
mod run;

pub use method::ToleranceMethod;
pub use options::{Distance, ToleranceOptions};
pub use report::Guarantee;
