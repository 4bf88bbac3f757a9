//! Real meshes, from the folder that `LODMARK_MODELS` names, else `../shared/models`.

use std::path::{Path, PathBuf};

use lodmark::{
    io,
    mesh::{self, Mesh},
};

use super::oracle::say;

/// The file of a model; a line that says why a test is skipped where it is not there.
fn model_file(name: &str) -> Option<PathBuf> {
    file("LODMARK_MODELS", "../shared/models", name)
}

/// The file of a textured asset, from the folder that `LODMARK_ASSETS` names, else `../shared/assets`.
pub(crate) fn asset_file(name: &str) -> Option<PathBuf> {
    file("LODMARK_ASSETS", "../shared/assets", name)
}

fn file(variable: &str, default: &str, name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os(variable).map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join(default),
        PathBuf::from,
    );
    let path = folder.join(name);
    if !path.exists() {
        say(&format!("skipped: {} is not there", path.display()));
        return None;
    }
    Some(path)
}

/// A model as its file has it.
pub(crate) fn read_model(name: &str) -> Option<io::Loaded> {
    model_file(name).map(|path| io::read(&path).expect("a good file"))
}

/// A model, welded.
pub(crate) fn model(name: &str) -> Option<Mesh> {
    read_model(name).map(|loaded| mesh::weld(loaded.mesh).mesh)
}
