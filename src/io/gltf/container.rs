//! GLB: the binary container of a glTF document and its first buffer.

use super::wrong;
use crate::{Error, Result};

/// The first bytes of a GLB file.
const MAGIC: &[u8] = b"glTF";

/// The text of a document, and the buffer that lies in the same file.
pub(super) struct Container<'a> {
    /// JSON.
    pub text: &'a str,
    /// The binary chunk of a GLB file.
    pub binary: Option<&'a [u8]>,
    /// Whether the file is a GLB.
    pub is_glb: bool,
    /// One sentence for everything that is ignored.
    pub notes: Vec<String>,
}

/// Opens a file: GLB where it starts as one, otherwise the text itself.
///
/// # Errors
/// [`Error::Input`] for a container that is cut off or does not begin with its text; [`Error::Unsupported`] for glTF 1.
pub(super) fn open(bytes: &[u8]) -> Result<Container<'_>> {
    if !bytes.starts_with(MAGIC) {
        let text = text(bytes)?;
        return Ok(Container {
            text,
            binary: None,
            is_glb: false,
            notes: Vec::new(),
        });
    }
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(wrong(format!(
            "the file ends after {} bytes; expected the 12 bytes of a GLB header",
            bytes.len()
        )));
    };
    if version != 2 {
        return Err(Error::Unsupported(format!(
            "GLB version {version} is not supported; convert the file to glTF 2.0"
        )));
    }
    let Some(body) = bytes.get(..length) else {
        return Err(wrong(format!(
            "byte 8: the header declares {length} bytes, but the file has {}; it is cut off",
            bytes.len()
        )));
    };
    let mut notes = Vec::new();
    if length < bytes.len() {
        let excess = bytes.len() - length;
        notes.push(format!(
            "{excess} bytes after the end of the GLB are ignored"
        ));
    }
    let (mut json, mut binary) = (None, None);
    let (mut at, mut number) = (12, 0);
    while at < length {
        let (kind, chunk) = chunk(body, at)?;
        match (number, kind) {
            (0, b"JSON") => json = Some(chunk),
            (0, _) => break,
            (1, b"BIN\0") => binary = Some(chunk),
            _ => notes.push(format!("byte {at}: a chunk that is not known is ignored")),
        }
        at += 8 + chunk.len();
        number += 1;
    }
    let Some(json) = json else {
        return Err(wrong("byte 12: expected the chunk `JSON` of a GLB file"));
    };
    notes.truncate(8);
    Ok(Container {
        // Some exporters pad with zeros instead of spaces.
        text: text(json)?.trim_end_matches('\0'),
        binary,
        is_glb: true,
        notes,
    })
}

/// The type and the bytes of the chunk at `at`.
fn chunk(bytes: &[u8], at: usize) -> Result<(&[u8], &[u8])> {
    let found = word(bytes, at).and_then(|length| {
        let kind = bytes.get(at + 4..at + 8)?;
        Some((kind, bytes.get(at + 8..)?.get(..length)?))
    });
    found.ok_or_else(|| {
        wrong(format!(
            "byte {at}: a chunk goes beyond the end of the file at byte {}; it is cut off",
            bytes.len()
        ))
    })
}

fn word(bytes: &[u8], at: usize) -> Option<usize> {
    let raw = bytes.get(at..)?.first_chunk::<4>()?;
    Some(u32::from_le_bytes(*raw) as usize)
}

fn text(bytes: &[u8]) -> Result<&str> {
    // Some editors begin a text with the mark of its encoding.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        wrong(format!(
            "byte {} of the JSON text is not UTF-8; expected a glTF document",
            error.valid_up_to()
        ))
    })
}
