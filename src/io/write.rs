//! The way out: from a mesh to the bytes of a file.

use std::path::{Path, PathBuf};

use super::{Encoding, Format, flip, gltf, obj, ply, stl};
use crate::{Error, Result, encode::atomic, mesh::Mesh};

/// The bytes of `mesh` in an encoding, in one file that holds everything, and notes about what it cannot keep.
///
/// # Errors
/// [`Error::Unsupported`] where a coordinate does not fit into the format's numbers; of a mesh that came from glTF also
/// [`Error::Input`] where its document is damaged.
pub fn encode(mesh: &Mesh, encoding: Encoding) -> Result<(Vec<u8>, Vec<String>)> {
    let format = encoding.format();
    if matches!(format, Format::Glb | Format::Gltf) {
        return gltf::encode(mesh, format);
    }
    let turned;
    let mesh = if mesh.materials().asset.is_some() {
        turned = flip::flipped(mesh, &mut |_| true)?;
        &turned
    } else {
        mesh
    };
    match encoding {
        Encoding::Glb | Encoding::Gltf | Encoding::Obj => Ok(obj::encode(mesh)),
        Encoding::PlyAscii => Ok(ply::encode(mesh, ply::Numbers::Text)),
        Encoding::PlyLittleEndian => Ok(ply::encode(mesh, ply::Numbers::LittleEndian)),
        Encoding::PlyBigEndian => Ok(ply::encode(mesh, ply::Numbers::BigEndian)),
        Encoding::StlAscii => stl::encode(mesh, true),
        Encoding::StlBinary => stl::encode(mesh, false),
    }
}

/// Writes `mesh` to `path`, complete or not at all, in the format of the extension; the notes say what that format
/// cannot keep. PLY and STL are binary. A glTF document has its buffer in a file beside it, and the images of another
/// folder are copied.
///
/// # Errors
/// [`Error::Usage`] for an extension without a format, otherwise as [`encode`], [`Error::Io`] as [`atomic::write`].
pub fn write(path: &Path, mesh: &Mesh) -> Result<Vec<String>> {
    let format = writable_format(path)?;
    if matches!(format, Format::Glb | Format::Gltf) {
        return gltf::write(path, mesh, format);
    }
    let (bytes, notes) = encode(mesh, format.default_encoding())?;
    atomic::write(path, |file| file.write_all(&bytes))?;
    Ok(notes)
}

/// The format that [`write`](fn@write) would use for `path`: ask before long work, not after it.
///
/// # Errors
/// [`Error::Usage`] for an extension without a format.
pub fn writable_format(path: &Path) -> Result<Format> {
    Format::of_extension(path).ok_or_else(|| {
        let known = Format::ALL.iter().map(|f| format!(".{}", f.extension()));
        let known = known.collect::<Vec<_>>().join(", ");
        Error::Usage(format!(
            "{}: no known format has this extension; expected one of {known}",
            path.display()
        ))
    })
}

/// The other file that [`write`](fn@write) replaces or makes with `path`: the buffer of a `.gltf`. Probe it before long
/// work, too. `None` for other formats, and where the buffer gets another name for not being written over a file that
/// belongs to something else.
#[must_use]
pub fn written_beside(path: &Path) -> Option<PathBuf> {
    let format = Format::of_extension(path)?;
    (format == Format::Gltf).then(|| gltf::buffer_beside(path))?
}

impl Mesh {
    /// Writes a mesh file, complete or not at all, in the format of the extension (.obj, .ply, .stl, .glb or .gltf; PLY
    /// and STL binary). A mesh that came from glTF gives back its document. Reading it back changes no bit of what the format can keep.
    ///
    /// # Errors
    /// [`Error::Usage`] for another extension, [`Error::Unsupported`] where a coordinate does not fit into the numbers of
    /// STL or glTF, [`Error::Io`] where the file cannot be written.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        write(path.as_ref(), self).map(drop)
    }
}
