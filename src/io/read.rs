//! The way in: from the bytes of a file to a mesh.

use std::path::Path;

use super::{Encoding, Format, gltf, obj, ply, stl};
use crate::{
    Error, Result,
    encode::bytes,
    mesh::{Mesh, canonical, weld},
};

/// A mesh as it was read, with what is known of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The mesh, as the file orders it: not welded, degenerate triangles included.
    pub mesh: Mesh,
    /// The encoding that the file turned out to have.
    pub encoding: Encoding,
    /// One sentence for everything in the file that the mesh does not keep.
    pub notes: Vec<String>,
}

/// Reads the mesh file at `path`: chooses the format by its content, its name, or for want of both by trying OBJ, and
/// reads it once.
///
/// # Errors
/// As [`bytes::read`], otherwise as [`read_bytes`].
pub fn read(path: &Path) -> Result<Loaded> {
    let bytes = bytes::read(path)?;
    let (named, found) = (Format::of_extension(path), Format::of_content(&bytes));
    let loaded = read_bytes(found.or(named).unwrap_or(Format::Obj), &bytes, path);
    let note = match (named, found) {
        (Some(named), Some(found)) if named != found => {
            format!("the name says {named}, but the content is {found}: read as {found}")
        }
        (None, None) if loaded.is_err() => {
            return Err(Error::input(
                path,
                "neither the name nor the content says which format this is; expected an OBJ, PLY, STL or glTF \
                 mesh in a file named .obj, .ply, .stl, .glb or .gltf",
            ));
        }
        (None, None) => "the name does not say the format: read as OBJ".into(),
        _ => return loaded,
    };
    let mut loaded = loaded?;
    loaded.notes.insert(0, note);
    Ok(loaded)
}

/// Reads a mesh of a known format from memory; `path` appears in messages (`-` where there is none), and its folder is
/// where the buffers of a glTF document lie that are not in it. O(n log n) in the number of bytes.
///
/// # Errors
/// [`Error::Input`], with the line or the byte where the content is not what the format demands; of glTF also
/// [`Error::Unsupported`] for what it requires and this version does not know, and [`Error::Io`] for buffers.
pub fn read_bytes(format: Format, bytes: &[u8], path: impl AsRef<Path>) -> Result<Loaded> {
    if bytes.is_empty() {
        return Err(Error::input(
            path,
            format!("the file is empty; expected {format} content"),
        ));
    }
    let found = match format {
        Format::Glb | Format::Gltf => return gltf::read(bytes, path.as_ref()),
        Format::Obj => obj::read(bytes),
        Format::Ply => ply::read(bytes),
        Format::Stl => stl::read(bytes),
    };
    found.map_err(|message| Error::input(path, message))
}

impl Mesh {
    /// Reads a mesh file (OBJ, PLY, STL or glTF), welded and in canonical order as the methods want it: vertices at bit-equal
    /// places are one, triangles that repeat a vertex and vertices without triangles are gone, and the order does not
    /// depend on that of the file.
    ///
    /// # Errors
    /// [`Error::Io`] where the file cannot be read, [`Error::Input`] where it is damaged, and [`Error::Unsupported`] for
    /// formats that are not read yet.
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        let stored = Self::read_as_stored(path)?;
        Ok(canonical(&weld(stored).mesh).mesh)
    }

    /// Reads a mesh file as it is: neither welded nor reordered, degenerate triangles included.
    ///
    /// # Errors
    /// As [`Mesh::read`].
    pub fn read_as_stored(path: impl AsRef<Path>) -> Result<Self> {
        Ok(read(path.as_ref())?.mesh)
    }
}
