//! Visibility from all around.

use crate::{
    Progress, Result, Silent,
    mesh::Mesh,
    visibility::{MeasureOptions, Visibility, measure},
};

/// Measures the share of all views around `mesh` that see each of its triangles (Zhang & Turk 2002).
///
/// O(cameras x (triangles + pixels)), with 258 cameras and ID buffers of 480 x 480 pixels.
///
/// # Errors
/// [`Error::Usage`](crate::Error::Usage) where the mesh has no triangle, and
/// [`Error::Unsupported`](crate::Error::Unsupported) where its triangles would make too many pieces.
pub fn visibility(mesh: &Mesh) -> Result<Visibility> {
    visibility_with(mesh, &MeasureOptions::default(), &Silent)
}

/// [`visibility`](fn@visibility) with other options, watched by `progress`.
///
/// # Errors
/// As [`visibility`](fn@visibility), [`Error::Usage`](crate::Error::Usage) for an option out of range, and
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub fn visibility_with(
    mesh: &Mesh,
    options: &MeasureOptions,
    progress: &dyn Progress,
) -> Result<Visibility> {
    measure(mesh, options, progress)
}
