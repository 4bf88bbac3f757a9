//! Which format a file has, and the way in and out of all of them.

use std::{fmt, path::Path};

use super::{obj_read, obj_write, ply_read, ply_write, stl_read, stl_write};
use crate::{
    Error, Result,
    encode::{atomic, bytes},
    mesh::Mesh,
};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// Polygon File Format (Stanford).
    Ply,
    /// Stereolithography.
    Stl,
}

impl Format {
    /// Every format, in alphabetical order.
    pub const ALL: [Self; 3] = [Self::Obj, Self::Ply, Self::Stl];

    /// The extension without its dot.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
        }
    }

    /// The format that the extension of `path` names, in any case of letters.
    #[must_use]
    pub fn of_extension(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        Self::ALL
            .into_iter()
            .find(|f| extension.eq_ignore_ascii_case(f.extension()))
    }

    /// The format that the first bytes and the length give away; OBJ has no such sign.
    #[must_use]
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
            Some(Self::Ply)
        } else if stl_read::is_binary(bytes) || stl_read::is_ascii(bytes) {
            Some(Self::Stl)
        } else {
            None
        }
    }

    /// The encoding that [`write()`] uses.
    #[must_use]
    pub const fn default_encoding(self) -> Encoding {
        match self {
            Self::Obj => Encoding::Obj,
            Self::Ply => Encoding::PlyLittleEndian,
            Self::Stl => Encoding::StlBinary,
        }
    }
}

impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::PlyAscii => "PLY, text",
            Self::PlyLittleEndian => "PLY, binary little-endian",
            Self::PlyBigEndian => "PLY, binary big-endian",
            Self::StlAscii => "STL, text",
            Self::StlBinary => "STL, binary",
        })
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
        })
    }
}

/// A format down to its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Encoding {
    /// OBJ, which is text.
    Obj,
    /// PLY as text.
    PlyAscii,
    /// PLY in little-endian binary.
    PlyLittleEndian,
    /// PLY in big-endian binary.
    PlyBigEndian,
    /// STL as text.
    StlAscii,
    /// STL in (little-endian) binary.
    StlBinary,
}

impl Encoding {
    /// The format this is an encoding of.
    #[must_use]
    pub const fn format(self) -> Format {
        match self {
            Self::Obj => Format::Obj,
            Self::PlyAscii | Self::PlyLittleEndian | Self::PlyBigEndian => Format::Ply,
            Self::StlAscii | Self::StlBinary => Format::Stl,
        }
    }
}

/// What a reader makes of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The mesh, as the file orders it: not welded, degenerate triangles included.
    pub mesh: Mesh,
    /// The encoding that the file turned out to have.
    pub encoding: Encoding,
    /// What the mesh does not keep of the file, one sentence each.
    pub notes: Vec<String>,
}

/// Reads the mesh file at `path`; its format is that of the extension, unless the content says otherwise.
///
/// # Errors
/// As [`bytes::read`], [`Error::Unsupported`] for glTF, otherwise as [`read_bytes`].
pub fn read(path: &Path) -> Result<Loaded> {
    let bytes = bytes::read(path)?;
    let named = Format::of_extension(path);
    let found = Format::of_content(&bytes);
    let is_gltf = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("glb") || e.eq_ignore_ascii_case("gltf"));
    match (named, found) {
        (Some(named), Some(found)) if named != found => {
            let mut loaded = read_bytes(found, &bytes, path)?;
            loaded.notes.insert(
                0,
                format!("the name says {named}, but the content is {found}: read as {found}"),
            );
            Ok(loaded)
        }
        (Some(format), _) | (None, Some(format)) => read_bytes(format, &bytes, path),
        (None, None) if is_gltf || bytes.starts_with(b"glTF") => Err(Error::Unsupported(format!(
            "{}: glTF cannot be read yet; convert it to .obj or .ply",
            path.display()
        ))),
        (None, None) => match read_bytes(Format::Obj, &bytes, path) {
            Ok(mut loaded) => {
                loaded
                    .notes
                    .insert(0, "the name does not say the format: read as OBJ".into());
                Ok(loaded)
            }
            Err(_) => Err(Error::input(
                path,
                "neither the name nor the content says which format this is; expected an OBJ, PLY or STL mesh in a \
                 file named .obj, .ply or .stl",
            )),
        },
    }
}

/// Reads a mesh of a known format from memory; `path` only appears in messages (`-` where there is none).
/// O(n log n) in the number of bytes.
///
/// # Errors
/// [`Error::Input`], with the line or the byte where the content is not what the format demands.
pub fn read_bytes(format: Format, bytes: &[u8], path: impl AsRef<Path>) -> Result<Loaded> {
    if bytes.is_empty() {
        return Err(Error::input(
            path,
            format!("the file is empty; expected {format} content"),
        ));
    }
    match format {
        Format::Obj => obj_read::read(bytes),
        Format::Ply => ply_read::read(bytes),
        Format::Stl => stl_read::read(bytes),
    }
    .map_err(|message| Error::input(path, message))
}

/// The bytes of `mesh` in an encoding, and notes about what it cannot keep.
///
/// # Errors
/// [`Error::Unsupported`] where a coordinate does not fit into the format's numbers.
pub fn encode(mesh: &Mesh, encoding: Encoding) -> Result<(Vec<u8>, Vec<String>)> {
    match encoding {
        Encoding::Obj => Ok(obj_write::encode(mesh)),
        Encoding::PlyAscii => Ok(ply_write::encode(mesh, ply_write::Numbers::Text)),
        Encoding::PlyLittleEndian => Ok(ply_write::encode(mesh, ply_write::Numbers::LittleEndian)),
        Encoding::PlyBigEndian => Ok(ply_write::encode(mesh, ply_write::Numbers::BigEndian)),
        Encoding::StlAscii => stl_write::encode(mesh, true),
        Encoding::StlBinary => stl_write::encode(mesh, false),
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
/// [`Error::Usage`] for an extension without a format.
pub fn writable_format(path: &Path) -> Result<Format> {
    Format::of_extension(path).ok_or_else(|| {
        let known = Format::ALL
            .map(|f| format!(".{}", f.extension()))
            .join(", ");
        Error::Usage(format!(
            "{}: no known format has this extension; expected one of {known}",
            path.display()
        ))
    })
}
