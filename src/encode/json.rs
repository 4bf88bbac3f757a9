//! JSON reports, in which equal values give equal bytes, and the reading of JSON files with a schema.
//!
//! Two spaces of indentation, keys in the order of the structure (sorted in a [`serde_json::Value`]), one newline at
//! the end, floats as the shortest decimal that reads back to the same bits, and `null` for those that are not finite.

use std::{fs::File, io::Read, path::Path};

use serde::{Deserialize, Serialize};

use super::atomic;
use crate::{Error, Result};

/// The text of a report.
///
/// # Errors
/// [`Error::Internal`] where the value has no JSON form, such as a map whose keys are no strings.
pub fn to_text(report: &impl Serialize) -> Result<String> {
    let mut text = serde_json::to_string_pretty(report)
        .map_err(|e| Error::Internal(format!("a report has no JSON form: {e}")))?;
    text.push('\n');
    Ok(text)
}

/// Writes a report; an existing file is replaced as a whole.
///
/// # Errors
/// As [`to_text`] and [`atomic::write`].
pub fn write(path: &Path, report: &impl Serialize) -> Result<()> {
    atomic::write_bytes(path, to_text(report)?.as_bytes())
}

/// Reads a whole text file of at most `limit` bytes; `kind` is named in errors.
///
/// # Errors
/// [`Error::Io`]; [`Error::Input`] for more bytes, or bytes that are no UTF-8.
pub fn read_text(path: &Path, limit: u64, kind: &str) -> Result<String> {
    let mut bytes = Vec::new();
    // By what is read, not by what is claimed: a pipe or device has no size.
    File::open(path)
        .and_then(|file| file.take(limit + 1).read_to_end(&mut bytes))
        .map_err(|e| Error::io("read", path, e))?;
    if bytes.len() as u64 > limit {
        let told = format!("more than {limit} bytes; expected a {kind} of at most that");
        return Err(Error::input(path, told));
    }
    String::from_utf8(bytes).map_err(|e| {
        let told = format!("{}; expected a {kind} (JSON)", e.utf8_error());
        Error::input(path, told)
    })
}

/// The number of the schema of a JSON text. Read first, so that a later schema fails with its number and not with a field
/// that this version does not know.
///
/// # Errors
/// Those of `serde_json`.
pub fn schema_of(text: &str) -> serde_json::Result<u32> {
    #[derive(Deserialize)]
    struct Version {
        schema: u32,
    }
    serde_json::from_str(text).map(|version: Version| version.schema)
}
