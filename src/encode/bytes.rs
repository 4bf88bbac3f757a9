//! The bytes of a file, within a limit where nobody knows how many there will be.

use std::{fs::File, io::Read, path::Path};

use crate::{Error, Result};

/// Most bytes that are taken from what is no regular file: a pipe or a device may never end.
pub const STREAM_LIMIT: u64 = 512 << 20;

/// Everything that `path` holds. A regular file may have any size; a pipe or device at most [`STREAM_LIMIT`] bytes.
///
/// # Errors
/// [`Error::Io`] where it cannot be read (a folder, for example); [`Error::Input`] beyond the limit.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    let failed = |e| Error::io("read", path, e);
    let mut file = File::open(path).map_err(failed)?;
    let known = file.metadata().map_err(failed)?;
    let mut bytes = Vec::new();
    // Some devices and system files claim to be regular and empty.
    if known.is_file() && known.len() > 0 {
        file.read_to_end(&mut bytes).map_err(failed)?;
        return Ok(bytes);
    }
    file.take(STREAM_LIMIT + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() as u64 > STREAM_LIMIT {
        let told = format!(
            "gives more than {STREAM_LIMIT} bytes and is no regular file; write it to a file first"
        );
        return Err(Error::input(path, told));
    }
    Ok(bytes)
}
