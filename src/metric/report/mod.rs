//! The one report that holds candidates against a reference: pictures, distances, folds and silhouettes.
//!
//! Pictures are judged as Lindstrom & Turk 2000, section 5 does ([`super::appearance`]) and as equation 5.11 of Zhang &
//! Turk 2002 does; every picture of the reference is drawn once for all candidates. Distances go both ways
//! ([`super::surface`]).
//! Units: meshes and eyes in file units, lengths also as fractions of the diagonal of the reference's bounding box,
//! picture errors in levels, 0 to 255. Work is done in the frame of the reference.

mod errors;
mod judge;
mod options;

pub use errors::{
    CandidateReport, Comparison, DistanceReport, ErrorReport, ImageError, MeshShape, PictureReport,
    ViewReport,
};
pub use judge::{Judge, compare};
pub use options::CompareOptions;
