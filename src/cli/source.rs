//! Reading a mesh as every command does: notes to the user, bit-equal positions welded.

use std::path::Path;

use super::terminal::Terminal;
use crate::{
    Error, Result, io,
    mesh::{self, Mesh},
};

/// Reads a mesh; `weld` unites vertices whose positions are equal bits. Triangles keep their order and number.
pub(super) fn read(path: &Path, weld: bool, terminal: &Terminal) -> Result<Mesh> {
    let loaded = io::read(path)?;
    for note in &loaded.notes {
        terminal.say(&format!("{}: {note}", path.display()));
    }
    Ok(if weld {
        welded(path, loaded.mesh, terminal)
    } else {
        loaded.mesh
    })
}

/// A mesh as read from `path`, with vertices whose positions are equal bits united.
pub(super) fn welded(path: &Path, mesh: Mesh, terminal: &Terminal) -> Mesh {
    let welded = mesh::weld(mesh);
    if welded.merged > 0 {
        terminal.say(&format!(
            "{}: welded {} vertices at the place of another one",
            path.display(),
            welded.merged
        ));
    }
    welded.mesh
}

/// Refuses a mesh that shows nothing.
pub(super) fn require_triangles(path: &Path, mesh: &Mesh) -> Result<()> {
    if mesh.triangles().is_empty() {
        return Err(Error::input(
            path,
            "the file has no triangles; expected at least one",
        ));
    }
    Ok(())
}
