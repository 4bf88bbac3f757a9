//! Formats and encodings, and the signs by which a file shows its own.

use std::{fmt, path::Path};

use super::stl;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// glTF 2.0 in its binary container.
    Glb,
    /// glTF 2.0 as JSON.
    Gltf,
    /// Wavefront OBJ.
    Obj,
    /// Polygon File Format (Stanford).
    Ply,
    /// Stereolithography.
    Stl,
}

impl Format {
    /// Every format, in alphabetical order.
    pub const ALL: [Self; 5] = [Self::Glb, Self::Gltf, Self::Obj, Self::Ply, Self::Stl];

    /// The extension without its dot.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Gltf => "gltf",
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

    /// The format that the first bytes and the length give away; OBJ and glTF as JSON have no such sign.
    #[must_use]
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(b"glTF") {
            Some(Self::Glb)
        } else if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
            Some(Self::Ply)
        } else if stl::is_binary(bytes) || stl::is_ascii(bytes) {
            Some(Self::Stl)
        } else {
            None
        }
    }

    /// The encoding that [`write()`](super::write()) uses.
    #[must_use]
    pub const fn default_encoding(self) -> Encoding {
        match self {
            Self::Glb => Encoding::Glb,
            Self::Gltf => Encoding::Gltf,
            Self::Obj => Encoding::Obj,
            Self::Ply => Encoding::PlyLittleEndian,
            Self::Stl => Encoding::StlBinary,
        }
    }
}

impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Glb => "GLB",
            Self::Gltf => "glTF",
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
            Self::Glb => "GLB",
            Self::Gltf => "glTF",
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
    /// glTF in its binary container.
    Glb,
    /// glTF as JSON.
    Gltf,
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
            Self::Glb => Format::Glb,
            Self::Gltf => Format::Gltf,
            Self::Obj => Format::Obj,
            Self::PlyAscii | Self::PlyLittleEndian | Self::PlyBigEndian => Format::Ply,
            Self::StlAscii | Self::StlBinary => Format::Stl,
        }
    }
}
