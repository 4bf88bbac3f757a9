//! Writing a file as a whole or not at all.

use std::{
    ffi::OsString,
    fs::{self, File},
    io::{BufWriter, Write},
    path::Path,
};

use crate::{Error, Result};

/// Writes `path` through a temporary file in the same folder that replaces it once it is complete; on failure the
/// temporary file is removed and an existing `path` stays as it was.
///
/// # Errors
/// [`Error::Io`]; [`Error::Usage`] where `path` names no file.
pub fn write(path: &Path, write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<()> {
    let name = path
        .file_name()
        .ok_or_else(|| Error::Usage(format!("{} names no file to write", path.display())))?;
    let mut temporary_name = OsString::from(".");
    temporary_name.push(name);
    temporary_name.push(format!(".{}.tmp", std::process::id()));
    let temporary = path.with_file_name(temporary_name);
    let written = File::create(&temporary).and_then(|file| {
        let mut buffered = BufWriter::new(file);
        write(&mut buffered)?;
        buffered.into_inner()?.sync_all()
    });
    written
        .and_then(|()| fs::rename(&temporary, path))
        .map_err(|source| {
            // Nothing to do where this fails too: the first failure is the one to tell.
            let _ = fs::remove_file(&temporary);
            Error::io("write", path, source)
        })
}
