//! Whole files or none: what is written appears under its name only when it is complete.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, BufWriter, Write},
    path::{Path, PathBuf},
};

use crate::{Error, Result};

/// Writes a file: `content` goes to a temporary file in the same folder, which then replaces `path` in one step. Where
/// anything fails, `path` is as it was and the temporary file is gone. An existing file keeps its permissions, a link
/// keeps pointing to the (new) content, and a device or pipe is written to directly.
///
/// # Errors
/// [`Error::Io`] where the folder or file cannot be written, or `content` says so.
pub fn write(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut content = Some(content);
    replace(path, &mut |file| {
        content.take().map_or(Ok(()), |content| content(file))
    })
}

/// [`write()`] for bytes that are there.
///
/// # Errors
/// [`Error::Io`] where the folder or file cannot be written.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    write(path, |file| file.write_all(bytes))
}

/// Makes a folder and those above it where they are missing.
///
/// # Errors
/// [`Error::Io`].
pub fn folder(path: &Path) -> Result<()> {
    fs::create_dir_all(path).map_err(|e| Error::io("create", path, e))
}

/// A function that gives a file its content, called once.
type Content<'a> = &'a mut dyn FnMut(&mut dyn Write) -> io::Result<()>;

/// [`write()`] without a type of its own for every content.
fn replace(path: &Path, content: Content<'_>) -> Result<()> {
    let failed = |source| Error::io("write", path, source);
    // Replacing a link would leave its target behind with the old content.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let existing = replaceable(&target).map_err(failed)?;
    if existing.as_ref().is_some_and(|found| !found.is_file()) {
        return File::create(&target)
            .and_then(|mut device| fill(&mut device, content))
            .map_err(failed);
    }
    let (mut file, temporary) = Temporary::beside(&target).map_err(failed)?;
    fill(&mut file, content)
        .and_then(|()| file.sync_all())
        .and_then(|()| match existing {
            Some(found) => file.set_permissions(found.permissions()),
            None => Ok(()),
        })
        .map_err(failed)?;
    // Some systems refuse to rename an open file.
    drop(file);
    temporary.rename(&target).map_err(failed)
}

/// Whether [`write()`] can begin: ask before long work. Nothing is left behind.
///
/// # Errors
/// As [`write()`].
pub fn probe(path: &Path) -> Result<()> {
    let failed = |source| Error::io("write", path, source);
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    match replaceable(&target).map_err(failed)? {
        // Opening a pipe would wait for its reader.
        Some(found) if !found.is_file() => Ok(()),
        _ => Temporary::beside(&target).map(drop).map_err(failed),
    }
}

/// The file that is already there; an error where it cannot be replaced.
fn replaceable(target: &Path) -> io::Result<Option<fs::Metadata>> {
    let Ok(found) = fs::metadata(target) else {
        return Ok(None);
    };
    if found.is_dir() {
        let told = "it is a folder; expected the name of a file in it";
        return Err(io::Error::other(told));
    }
    if found.is_file() && found.permissions().readonly() {
        let told = "the existing file is read-only; make it writable or choose another name";
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, told));
    }
    Ok(Some(found))
}

fn fill(file: &mut File, content: Content<'_>) -> io::Result<()> {
    let mut buffered = BufWriter::with_capacity(1 << 16, file);
    content(&mut buffered)?;
    buffered.flush()
}

/// A file that is removed on every way out but that of its renaming.
struct Temporary(Option<PathBuf>);

impl Temporary {
    /// Creates one in the folder of `target`, under a name nobody uses.
    fn beside(target: &Path) -> io::Result<(File, Self)> {
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if target.file_name().is_none() {
            return Err(io::Error::other("it does not end in the name of a file"));
        }
        for attempt in 0..1000 {
            let name = folder.join(format!(".lodmark-{}-{attempt}.tmp", std::process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&name) {
                Ok(file) => return Ok((file, Self(Some(name)))),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::other(
            "the folder holds 1000 abandoned temporary files .lodmark-*.tmp; remove them",
        ))
    }

    /// Gives the file its name. From then on the old name may be that of another thread's file: it is not removed.
    fn rename(mut self, target: &Path) -> io::Result<()> {
        if let Some(name) = &self.0 {
            fs::rename(name, target)?;
        }
        self.0 = None;
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(name) = &self.0 {
            let _ = fs::remove_file(name);
        }
    }
}
