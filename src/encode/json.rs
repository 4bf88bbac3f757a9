//! JSON reports: equal values give equal bytes.
//!
//! Two spaces of indentation, keys in the order of the structure (sorted in a [`serde_json::Value`]), one newline at
//! the end, floats as the shortest decimal that reads back to the same bits, and `null` for those that are not finite.

use std::path::Path;

use serde::Serialize;

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
    let text = to_text(report)?;
    atomic::write(path, |file| file.write_all(text.as_bytes()))
}
