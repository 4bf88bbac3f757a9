//! View-bounded simplification: no point of the original surface is seen under a larger angle from the point that replaces it
//! than allowed, by any viewer in a cell (after Eisemann & Décoret 2007; notes, 4.9).
//!
//! Collapses come in the order of the memoryless method and are placed by it; where its place is refused, the midpoint and
//! the ends are tried, the cheapest first. A collapse is legal where it keeps every point within the angle of where its whole history
//! has put it, exactly and not by adding up steps: see [`Correspondence`]. Deviation from the notes: not a sum of
//! displacements but the displacement itself decides, and beside its length its direction (see [`AngleLimit`]).
//! A mesh that is far from the origin for its size is moved there first, exactly, so that the rounding of large
//! coordinates has no part in what is decided. The bound is on positions; texture coordinates are carried along as by
//! every other method. Angles: degrees in options, radians inside.

mod method;
mod options;
mod report;
mod run;

pub use method::ViewBounded;
pub use options::ViewBoundedOptions;
pub use report::ViewBoundedReport;
