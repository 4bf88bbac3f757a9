//! One candidate or more against a reference.

use crate::{
    Error, Progress, Result, Silent,
    mesh::Mesh,
    metric::report::{self, CandidateReport, CompareOptions, Comparison},
};

/// Measures how much `candidate` differs from `reference`: pictures in 24 views, distances both ways, folds, silhouettes.
///
/// The pictures are those of Lindstrom & Turk 2000, section 5, and drive no method. Meshes are taken as they are: one
/// that is not welded has its seams counted as boundaries.
///
/// # Errors
/// [`Error::Usage`] for a mesh without triangles; [`Error::Unsupported`] where the candidate lies too far away to be
/// drawn together with the reference.
pub fn compare(reference: &Mesh, candidate: &Mesh) -> Result<CandidateReport> {
    let found = compare_with(reference, &[candidate], &CompareOptions::default(), &Silent)?;
    let first = found.candidates.into_iter().next();
    first.ok_or_else(|| Error::Internal("a candidate without a report".into()))
}

/// [`compare`](fn@compare) for several candidates and with other options, watched by `progress`.
///
/// # Errors
/// As [`compare`](fn@compare), [`Error::Usage`] for options out of range, [`Error::Input`] and [`Error::Io`] for a view
/// file that cannot be used, and [`Error::Interrupted`].
pub fn compare_with(
    reference: &Mesh,
    candidates: &[&Mesh],
    options: &CompareOptions,
    progress: &dyn Progress,
) -> Result<Comparison> {
    report::compare(reference, candidates, options, progress)
}
