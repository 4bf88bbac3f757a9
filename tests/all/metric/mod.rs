//! Differences between pictures, surfaces, and meshes as they appear.

pub(crate) mod appearance;
mod outline;
mod pictures;
mod report;
mod surface;
