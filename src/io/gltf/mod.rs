//! glTF 2.0, as text and as GLB.
//!
//! Our own reader instead of the crate `gltf` 1.4.1, which refuses quantized and compressed files and loses what it does
//! not know. A document is kept whole ([`Asset`]): its sections as the text that they are, its buffers as bytes. The mesh
//! is what its default scene shows ([`scene`]): the triangles of all primitives, every mesh once, as its largest instance
//! places it ([`surface`]). Every primitive is a material of the mesh, so that its border is a feature.
//!
//! What accessors declare is checked against the bytes behind them before anything is allocated ([`accessor`]), and
//! what primitives that share accessors add up to against the size of the file ([`buffers::Views::spend`]).

mod accessor;
mod attributes;
mod buffers;
mod container;
mod document;
mod meshopt;
mod parts;
mod scene;
mod surface;
mod write;

use std::{path::Path, sync::Arc};

pub use self::write::{SharedImages, share_images};
pub(in crate::rooms::io) use self::write::{buffer_beside, encode, write};
use self::{attributes::Channels, buffers::Views, document::Document};
use crate::{
    Error, Result,
    io::{Encoding, Loaded},
    mesh::{Asset, Attributes, Mesh, MeshParts},
    num::Precision,
};

/// Reads a document and the buffers that it names beside the file `path` (`-` for none).
///
/// # Errors
/// [`Error::Input`] that says what in the document is wrong; [`Error::Unsupported`] for what it requires and this reader
/// does not know; [`Error::Io`] where the file of a buffer cannot be read.
pub(in crate::rooms::io) fn read(bytes: &[u8], path: &Path) -> Result<Loaded> {
    read_document(bytes, path).map_err(|error| match error {
        Error::Input {
            path: known,
            message,
        } if known.as_os_str() == "-" => Error::input(path, shortened(&message)),
        Error::Unsupported(message) => {
            Error::Unsupported(format!("{}: {}", path.display(), shortened(&message)))
        }
        other => other,
    })
}

fn read_document(bytes: &[u8], path: &Path) -> Result<Loaded> {
    let container = container::open(bytes)?;
    let folder = path.parent().filter(|_| path.as_os_str() != "-");
    let mut asset = Asset {
        sections: document::sections(container.text)?,
        folder: folder.map(Path::to_path_buf).unwrap_or_default(),
        ..Asset::default()
    };
    let document = Document::parse(&asset)?;
    asset.buffers = buffers::read(&document, container.binary, folder)?;
    let mut notes = container.notes;
    let mesh = mesh(&document, asset, &mut notes)?;
    Ok(Loaded {
        mesh,
        encoding: if container.is_glb {
            Encoding::Glb
        } else {
            Encoding::Gltf
        },
        notes,
    })
}

/// The mesh of a document whose buffers are there.
fn mesh(document: &Document, mut asset: Asset, notes: &mut Vec<String>) -> Result<Mesh> {
    let views = Views::new(document, &asset.buffers);
    let shown = scene::shown(document, &views)?;
    asset.parts = parts::of(document, &shown, notes)?;
    asset.customs = attributes::customs(document, &asset.parts);
    let channels = Channels::of(document, &asset.parts, &asset.customs);
    parts::note_attributes(document, &asset.parts, &channels, notes);
    let mut mesh = MeshParts {
        precision: Precision::F32,
        ..MeshParts::default()
    };
    let mut rows = Vec::new();
    for (part, material) in asset.parts.iter().zip(0..) {
        let surface = surface::read(document, &views, &channels, part)?;
        let first = mesh.positions.len();
        if first + surface.positions.len() > Mesh::LIMIT {
            return Err(wrong(format!(
                "there are more than {} vertices",
                Mesh::LIMIT
            )));
        }
        let triangles = surface.triangles.iter();
        mesh.triangles
            .extend(triangles.map(|corners| corners.map(|v| v + first as u32)));
        mesh.materials
            .of_triangle
            .resize(mesh.triangles.len(), material);
        mesh.positions.extend(surface.positions);
        rows.extend(surface.rows);
    }
    if !channels.kinds.is_empty() {
        mesh.attributes = Attributes::new(&channels.kinds, rows, mesh.triangles.clone())?;
    }
    drop(views);
    mesh.materials.names = asset.parts.iter().map(|part| part.name.clone()).collect();
    mesh.materials.asset = Some(Arc::new(asset));
    Mesh::new(mesh)
}

/// A fault of the document.
fn wrong(message: impl Into<String>) -> Error {
    Error::content(message)
}

/// The start of a sentence: names in a document may be as long as the file.
fn shortened(message: &str) -> String {
    message.chars().take(600).collect()
}

/// The same fault, with the place that it concerns.
fn placed(error: Error, place: &str) -> Error {
    match error {
        Error::Input { path, message } => Error::input(path, format!("{place}: {message}")),
        Error::Unsupported(message) => Error::Unsupported(format!("{place}: {message}")),
        other => other,
    }
}
