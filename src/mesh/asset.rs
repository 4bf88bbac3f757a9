//! [`Asset`]: the document that a mesh was read from, so that whatever simplification does not touch is written again.

use std::path::PathBuf;

use glam::DAffine3;

/// A glTF document with its buffers, and the primitives that the triangles of the mesh come from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asset {
    /// The sections of the document in its order: name, and JSON text as it stands in the file.
    pub sections: Vec<(String, String)>,
    /// The bytes of every buffer, in its order; empty where a buffer has none (a fallback of compressed views).
    pub buffers: Vec<Vec<u8>>,
    /// The primitives that are part of the mesh.
    pub parts: Vec<AssetPart>,
    /// Names of the attributes behind [`ChannelKind::Custom`](super::ChannelKind::Custom), by number.
    pub customs: Vec<String>,
    /// The folder that relative names of images refer to.
    pub folder: PathBuf,
}

/// A primitive of an [`Asset`] that is part of the mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct AssetPart {
    /// Its name among those of [`Materials::names`](super::Materials::names): no other part has it.
    pub name: String,
    /// Index of its mesh in the document.
    pub mesh: usize,
    /// Index of the primitive in its mesh.
    pub primitive: usize,
    /// From the coordinates that the primitive stores to those of the mesh; can be inverted.
    pub placement: DAffine3,
    /// Number of times that the default scene shows it.
    pub instances: usize,
}
