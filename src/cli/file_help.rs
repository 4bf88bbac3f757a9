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

/// Weights of vertices: a whole file, and a colour channel.
pub(super) const WEIGHTS: &str = "\
Weights say where triangles stay: a number from 0 to 1 for every vertex of IN. 1 keeps the vertex where it is, whatever \
else gives way; w below makes its collapses 1 / (1 - w) times as dear, by whichever method (0.9: ten times). They are a \
NumPy array of float32 in the order of IN, as many as `lodmark inspect IN` says, or as are left when vertices at one \
place are united (each then counts where the first is). Two lines of Python write one for 289 vertices:
  import numpy as np; w = np.zeros(289, 'f4'); w[0:17] = 1; w[17:68] = 0.9
  np.save('weights.npy', w)
And then: lodmark simplify IN OUT --ratio 0.1 --weights weights.npy
Or a channel of the vertex colours that a painter left: --weights COLOR_0.r (or .g, .b, .a; glTF, PLY and OBJ).";

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
