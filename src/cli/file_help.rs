//! The files that commands take, shown whole in their `--help`; of binary ones, which commands write and read them.

use crate::{bound::view_cell, view};

/// Joins the paragraphs of a help text.
pub(super) fn paragraphs(parts: &[&str]) -> String {
    parts.join("\n\n")
}

/// One whole cell file of every kind.
pub(super) fn cells() -> String {
    format!(
        "A cell file says where viewers may be, in the units of the mesh. It is JSON and holds one of these lines \
         (a polyhedron is the convex hull of its points; the viewers of a half-space are on the side that its normal \
         points away from):\n{}",
        view_cell::file::EXAMPLES.trim_end()
    )
}

/// A whole view file.
pub(super) fn views() -> String {
    format!(
        "A view file is JSON; `lodmark render` writes one as scene.json. Each view has its matrix, the bits of 16 numbers \
         row by row, and \"eye\": {{\"point\": [x, y, z]}}, or {{\"axis\": [x, y, z]}} where it is orthographic. One whole \
         file:\n{}",
        view::file::EXAMPLE.trim_end()
    )
}

/// Histories of runs.
pub(super) const HISTORY: &str = "\
A history is a binary file with every collapse of a run, its options and the hash of its input: `lodmark simplify \
--history` writes it, and `lodmark replay` reads it.";

/// Counts of visibility.
pub(super) const PARTIAL: &str = "\
The counts of a visibility measurement are a binary file: `lodmark visibility --partial` writes it, of all views or of \
some, `lodmark merge-visibility` puts several together, and `lodmark visibility --from`, `lodmark simplify --visibility` \
and `lodmark levels --visibility` read those of all views.";

/// The map from parts of the original to parts of a simplified mesh.
pub(super) const CORRESPONDENCE: &str = "\
The record of which part of OUT stands for which part of IN is a binary file: `lodmark simplify --bound-out` writes it, \
and `lodmark verify --bound` and `lodmark bound --correspondence` read it.";
