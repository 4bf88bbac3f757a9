//! The files of a chain: a mesh for every level, images that they share, and the manifest last.

use std::path::{Path, PathBuf};

use super::{
    Chain,
    manifest::{LevelFile, Manifest},
};
use crate::{
    Error, Result,
    encode::{atomic, bytes, hash, json},
    io::{self, Format},
    mesh::content_sha256,
};

/// Names of the files of a chain that was written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written {
    /// The file of every level, in the folder.
    pub levels: Vec<PathBuf>,
    /// The manifest.
    pub manifest: PathBuf,
    /// Its content.
    pub content: serde_json::Value,
    /// One sentence for everything that the format could not keep, and for files of an earlier chain that stay.
    pub notes: Vec<String>,
}

/// The name of the file of a level; `name` is that of a mesh file.
///
/// # Errors
/// [`Error::Usage`] for a name without a stem or an extension that a mesh can be written by.
pub fn level_name(name: &Path, level: usize) -> Result<String> {
    let format = io::writable_format(name)?;
    Ok(format!("{}_LOD{level}.{}", stem(name)?, format.extension()))
}

/// The name of the manifest; `name` is that of a mesh file.
///
/// # Errors
/// [`Error::Usage`] for a name without a stem.
pub fn manifest_name(name: &Path) -> Result<String> {
    Ok(format!("{}.lod.json", stem(name)?))
}

fn stem(name: &Path) -> Result<String> {
    let stem = name.file_stem().map(|s| s.to_string_lossy().into_owned());
    stem.ok_or_else(|| {
        let told = format!("{}: expected the name of a mesh file", name.display());
        Error::Usage(told)
    })
}

/// Writes a chain into a folder, which is made if missing: `NAME_LOD0.EXT`, `NAME_LOD1.EXT`, ... and `NAME.lod.json`, where
/// `name` is `NAME.EXT`. Each file is complete or not there, and the manifest, which has the hashes of the others, comes last.
/// Images that a glTF document holds are written once, beside the levels, which name them.
///
/// # Errors
/// [`Error::Usage`] for a name without a known extension; as [`io::write`].
pub fn write(chain: &Chain, folder: &Path, name: &Path) -> Result<Written> {
    level_name(name, 0)?;
    atomic::folder(folder)?;
    let stem = stem(name)?;
    let mut written = Written::default();
    let is_document = matches!(io::writable_format(name)?, Format::Glb | Format::Gltf);
    let shared = match chain.levels.first() {
        Some(input) if is_document => io::share_images(&input.mesh, folder, &stem)?,
        _ => io::SharedImages::default(),
    };
    written.notes.extend(shared.notes.iter().cloned());
    let mut files = Vec::with_capacity(chain.levels.len());
    for (number, level) in chain.levels.iter().enumerate() {
        let name = level_name(name, number)?;
        let path = folder.join(&name);
        let notes = match shared.named_by(&level.mesh)? {
            Some(mesh) => io::write(&path, &mesh)?,
            None => io::write(&path, &level.mesh)?,
        };
        let notes = notes.into_iter().map(|note| format!("{name}: {note}"));
        written.notes.extend(notes);
        files.push(LevelFile {
            content_sha256: content_sha256(&level.mesh),
            file_sha256: hash::bytes_sha256(&bytes::read(&path)?),
            name,
        });
        written.levels.push(path);
    }
    let next = folder.join(level_name(name, files.len())?);
    if next.exists() {
        written.notes.push(format!(
            "{}: of an earlier chain with more levels; it stays as it is",
            next.display()
        ));
    }
    written.manifest = folder.join(manifest_name(name)?);
    let manifest = Manifest::new(&stem, chain, &files, &shared.names);
    json::write(&written.manifest, &manifest)?;
    written.content = serde_json::to_value(&manifest)
        .map_err(|e| Error::Internal(format!("a manifest has no JSON form: {e}")))?;
    Ok(written)
}

impl Chain {
    /// Writes the levels and the manifest into a folder, which is made if missing: for the name `bunny.glb` the files
    /// `bunny_LOD0.glb`, `bunny_LOD1.glb`, ... and `bunny.lod.json`. Existing ones are replaced.
    ///
    /// # Errors
    /// [`Error::Usage`] for a name without a known extension, and what writing a mesh says.
    pub fn write(&self, folder: impl AsRef<Path>, name: impl AsRef<Path>) -> Result<()> {
        write(self, folder.as_ref(), name.as_ref()).map(drop)
    }
}
