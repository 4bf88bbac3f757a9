//! The way out: from a mesh to the bytes of a file.

use std::path::Path;

use super::{Encoding, Format, obj, ply, stl};
use crate::{Error, Result, encode::atomic, mesh::Mesh};

/// The refusal to write glTF.
const NO_GLTF: &str = "glTF cannot be written yet; write .obj or .ply";

/// The bytes of `mesh` in an encoding, and notes about what it cannot keep.
///
/// # Errors
/// [`Error::Unsupported`] where a coordinate does not fit into the format's numbers.
pub fn encode(mesh: &Mesh, encoding: Encoding) -> Result<(Vec<u8>, Vec<String>)> {
    match encoding {
        Encoding::Glb | Encoding::Gltf => Err(Error::Unsupported(NO_GLTF.into())),
        Encoding::Obj => Ok(obj::encode(mesh)),
        Encoding::PlyAscii => Ok(ply::encode(mesh, ply::Numbers::Text)),
        Encoding::PlyLittleEndian => Ok(ply::encode(mesh, ply::Numbers::LittleEndian)),
        Encoding::PlyBigEndian => Ok(ply::encode(mesh, ply::Numbers::BigEndian)),
        Encoding::StlAscii => stl::encode(mesh, true),
        Encoding::StlBinary => stl::encode(mesh, false),
    }
}

/// Writes `mesh` to `path`, complete or not at all, in the format of the extension; the notes say what that format
/// cannot keep. PLY and STL are binary.
///
/// # Errors
/// [`Error::Usage`] for an extension without a format, [`Error::Unsupported`] as [`encode`], [`Error::Io`] as
/// [`atomic::write`].
pub fn write(path: &Path, mesh: &Mesh) -> Result<Vec<String>> {
    let format = writable_format(path)?;
    let (bytes, notes) = encode(mesh, format.default_encoding())?;
    atomic::write(path, |file| file.write_all(&bytes))?;
    Ok(notes)
}

/// The format that [`write`](fn@write) would use for `path`: ask before long work, not after it.
///
/// # Errors
/// [`Error::Usage`] for an extension without a format, [`Error::Unsupported`] for one that is only read.
pub fn writable_format(path: &Path) -> Result<Format> {
    let format = Format::of_extension(path).ok_or_else(|| {
        let known = Format::ALL.iter().map(|f| format!(".{}", f.extension()));
        let known = known.collect::<Vec<_>>().join(", ");
        Error::Usage(format!(
            "{}: no known format has this extension; expected one of {known}",
            path.display()
        ))
    })?;
    match format {
        Format::Glb | Format::Gltf => {
            Err(Error::Unsupported(format!("{}: {NO_GLTF}", path.display())))
        }
        Format::Obj | Format::Ply | Format::Stl => Ok(format),
    }
}

impl Mesh {
    /// Writes a mesh file, complete or not at all, in the format of the extension (.obj, .ply or .stl; PLY and STL
    /// binary). Reading it back changes no bit of what the format can keep.
    ///
    /// # Errors
    /// [`Error::Usage`] for another extension, [`Error::Unsupported`] where a coordinate does not fit into the numbers of
    /// STL, [`Error::Io`] where the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        write(path.as_ref(), self).map(drop)
    }
}
