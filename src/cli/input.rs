//! Reading a mesh as every command does: notes to the user, bit-equal positions welded.

use std::path::{Path, PathBuf};

use super::terminal::Terminal;
use crate::{
    Error, Result,
    encode::atomic,
    io,
    mesh::{self, Mesh},
};

/// Reads a mesh; `weld` unites vertices whose positions are equal bits. Triangles keep their order and number.
pub(super) fn read(path: &Path, weld: bool, terminal: &Terminal) -> Result<Mesh> {
    read_with_notes(path, weld, terminal).map(|read| read.mesh)
}

/// A mesh as a command reads it.
pub(super) struct Read {
    pub(super) mesh: Mesh,
    /// One sentence for everything that the reader could not keep.
    pub(super) notes: Vec<String>,
    /// For every vertex that the file stores, its vertex in `mesh`.
    pub(super) vertices: Vec<u32>,
}

/// As [`read`], with what else is known.
pub(super) fn read_with_notes(path: &Path, weld: bool, terminal: &Terminal) -> Result<Read> {
    let loaded = io::read(path)?;
    for note in &loaded.notes {
        terminal.say(&format!("{}: {note}", path.display()));
    }
    let (mesh, vertices) = if weld {
        welded_with_numbers(path, loaded.mesh, terminal)
    } else {
        let numbers = 0..loaded.mesh.positions().len() as u32;
        (loaded.mesh, numbers.collect())
    };
    Ok(Read {
        mesh,
        notes: loaded.notes,
        vertices,
    })
}

/// A mesh as read from `path`, with vertices whose positions are equal bits united.
pub(super) fn welded(path: &Path, mesh: Mesh, terminal: &Terminal) -> Mesh {
    welded_with_numbers(path, mesh, terminal).0
}

/// As [`welded`], with the new number of every vertex.
fn welded_with_numbers(path: &Path, mesh: Mesh, terminal: &Terminal) -> (Mesh, Vec<u32>) {
    let welded = mesh::weld(mesh);
    if welded.merged > 0 {
        terminal.say(&format!(
            "{}: welded {} vertices at the place of another one",
            path.display(),
            welded.merged
        ));
    }
    (welded.mesh, welded.vertices)
}

/// A mesh as read from `path` in canonical order, without triangles that use a vertex twice, and where its vertices were.
pub(super) fn canonical(path: &Path, mesh: &Mesh, terminal: &Terminal) -> mesh::Canonical {
    let canonical = mesh::canonical(mesh);
    if canonical.degenerate > 0 {
        terminal.say(&format!(
            "{}: left out {} triangles that use a vertex twice",
            path.display(),
            canonical.degenerate
        ));
    }
    canonical
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

/// Refuses files that cannot be written, and one name for two of them: before long work, not after it.
pub(super) fn require_outputs<'a>(outputs: impl Iterator<Item = &'a PathBuf>) -> Result<()> {
    let mut seen: Vec<PathBuf> = Vec::new();
    for path in outputs {
        let place = place(path);
        if seen.contains(&place) && !is_device(path) {
            return Err(Error::Usage(format!(
                "{} would be written twice; give each output a name of its own",
                path.display()
            )));
        }
        atomic::probe(path)?;
        seen.push(place);
    }
    Ok(())
}

/// A path of which another spelling is equal: the file itself need not be there.
fn place(path: &Path) -> PathBuf {
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_path_buf(),
    }
}

fn is_device(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|found| !found.is_file())
}

/// A number of triangles on the command line.
pub(super) fn parse_triangles<T: TryFrom<i128>>(text: &str) -> Result<T, String> {
    let number: i128 = text
        .parse()
        .map_err(|_| "expected a whole number of triangles, at least 1".to_string())?;
    if number < 1 {
        return Err(format!(
            "{number} triangles make no mesh; expected at least 1"
        ));
    }
    T::try_from(number).map_err(|_| format!("{number} is more than any mesh has"))
}
