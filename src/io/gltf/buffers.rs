//! Buffers, wherever they lie, and views of them.

use std::{
    path::{Component, Path, PathBuf},
    sync::{
        OnceLock,
        atomic::{AtomicU64, Ordering},
    },
};

use super::{
    document::{Buffer, Document, Meshopt, named},
    meshopt::{self, Filter, Mode},
    placed, wrong,
};
use crate::{Result, encode::bytes};

/// Values that any file may ask for, and those it may ask for with every byte of its buffers. Primitives may share
/// accessors, so that a small file can declare a surface without end.
const FREE_VALUES: u64 = 1 << 23;
const VALUES_PER_BYTE: u64 = 64;

/// The bytes of every buffer of a document. `folder` is the one that its names refer to, if it came from a file.
///
/// # Errors
/// [`Error::Input`] for a buffer that is shorter than declared or lies outside of the folder; [`Error::Io`] where its
/// file cannot be read.
pub(super) fn read(
    document: &Document,
    binary: Option<&[u8]>,
    folder: Option<&Path>,
) -> Result<Vec<Vec<u8>>> {
    let mut found = Vec::with_capacity(document.buffers.len());
    for (i, buffer) in document.buffers.iter().enumerate() {
        let mut bytes = match (&buffer.uri, binary) {
            _ if is_fallback(buffer) => {
                found.push(Vec::new());
                continue;
            }
            (Some(uri), _) => {
                resolve(uri, folder).map_err(|error| placed(error, &format!("buffers[{i}]")))?
            }
            (None, Some(binary)) if i == 0 => {
                binary[..buffer.byte_length.min(binary.len())].to_vec()
            }
            // An extension may fill it: whoever uses it learns that it is empty.
            (None, _) => {
                found.push(Vec::new());
                continue;
            }
        };
        if bytes.len() < buffer.byte_length {
            return Err(wrong(format!(
                "buffers[{i}] declares {} bytes, but has {}; the file is cut off",
                buffer.byte_length,
                bytes.len()
            )));
        }
        bytes.truncate(buffer.byte_length);
        found.push(bytes);
    }
    Ok(found)
}

fn is_fallback(buffer: &Buffer) -> bool {
    let meshopt = buffer.extensions.meshopt.as_ref();
    meshopt.is_some_and(|extension| extension.fallback)
}

/// The bytes that a URI stands for.
fn resolve(uri: &str, folder: Option<&Path>) -> Result<Vec<u8>> {
    let Some(embedded) = uri.strip_prefix("data:") else {
        let Some(folder) = folder else {
            return Err(wrong(format!(
                "the bytes are in the file `{}`, but the document came from memory; embed them, or read it by its name",
                shown(uri)
            )));
        };
        return bytes::read(&folder.join(relative(uri)?));
    };
    let Some((kind, text)) = embedded.split_once(',') else {
        return Err(wrong(
            "the data URI has no comma; expected `data:;base64,...`",
        ));
    };
    if kind.ends_with(";base64") {
        base64(text.as_bytes())
    } else {
        Ok(unescaped(text))
    }
}

/// The path that a URI names, which stays inside of the folder of the document.
pub(super) fn relative(uri: &str) -> Result<PathBuf> {
    let outside = || {
        wrong(format!(
            "the URI `{}` leaves the folder of the document; expected a relative name inside it: copy the file there",
            shown(uri)
        ))
    };
    let first = uri.split('/').next().unwrap_or_default();
    if uri.is_empty() || first.contains(':') {
        return Err(outside());
    }
    let path = String::from_utf8(unescaped(uri)).map_err(|_| outside())?;
    let mut depth = 0_i64;
    for part in Path::new(&path).components() {
        match part {
            Component::Normal(_) => depth += 1,
            Component::ParentDir => depth -= 1,
            Component::CurDir => {}
            Component::RootDir | Component::Prefix(_) => return Err(outside()),
        }
        if depth < 0 {
            return Err(outside());
        }
    }
    Ok(path.into())
}

/// The first hundred characters of a URI, as a message shows it.
fn shown(uri: &str) -> String {
    uri.chars().take(100).collect()
}

/// Replaces `%20` and the like by the bytes that they stand for.
fn unescaped(text: &str) -> Vec<u8> {
    let mut found = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        let digit = |i: usize| char::from(*after.get(i)?).to_digit(16);
        rest = match (byte, digit(0), digit(1)) {
            (b'%', Some(high), Some(low)) => {
                found.push((16 * high + low) as u8);
                &after[2..]
            }
            _ => {
                found.push(byte);
                after
            }
        };
    }
    found
}

/// Decodes base64 (RFC 4648); the padding may be missing.
fn base64(text: &[u8]) -> Result<Vec<u8>> {
    let end = text.iter().rposition(|&b| b != b'=').map_or(0, |at| at + 1);
    let mut found = Vec::with_capacity(end / 4 * 3 + 2);
    let (mut bits, mut held) = (0_u32, 0);
    for (at, &byte) in text[..end].iter().enumerate() {
        let digit = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => {
                return Err(wrong(format!(
                    "character {at} of the data URI is not one of base64; the text may be damaged"
                )));
            }
        };
        (bits, held) = (bits << 6 | u32::from(digit), held + 6);
        if held >= 8 {
            held -= 8;
            found.push((bits >> held) as u8);
        }
    }
    Ok(found)
}

/// The buffer views of a document. Compressed ones are decoded when they are first asked for.
pub(super) struct Views<'a> {
    document: &'a Document,
    buffers: &'a [Vec<u8>],
    decoded: Vec<OnceLock<Vec<u8>>>,
    /// Values that may still be read.
    left: AtomicU64,
}

impl<'a> Views<'a> {
    /// Views of the given buffers, one for every buffer of the document.
    pub(super) fn new(document: &'a Document, buffers: &'a [Vec<u8>]) -> Self {
        let bytes: usize = buffers.iter().map(Vec::len).sum();
        Self {
            document,
            buffers,
            decoded: document.views.iter().map(|_| OnceLock::new()).collect(),
            left: AtomicU64::new(FREE_VALUES + VALUES_PER_BYTE * bytes as u64),
        }
    }

    /// The bytes of a view, decoded.
    ///
    /// # Errors
    /// [`Error::Input`] where there is no such view, or it goes beyond its buffer, or its compressed bytes are damaged.
    pub(super) fn bytes(&self, view: usize) -> Result<&[u8]> {
        let found = named(&self.document.views, view, "bufferViews", || {
            "the document".into()
        })?;
        let Some(meshopt) = &found.extensions.meshopt else {
            return self.range(found.buffer, found.byte_offset, found.byte_length, view);
        };
        let cell = &self.decoded[view];
        if let Some(bytes) = cell.get() {
            return Ok(bytes);
        }
        let stream = self.range(
            meshopt.buffer,
            meshopt.byte_offset,
            meshopt.byte_length,
            view,
        )?;
        let bytes = decode(meshopt, stream)
            .map_err(|error| placed(error, &format!("bufferViews[{view}]")))?;
        if bytes.len() < found.byte_length {
            return Err(wrong(format!(
                "bufferViews[{view}] declares {} bytes, but decoding gives {}",
                found.byte_length,
                bytes.len()
            )));
        }
        Ok(cell.get_or_init(|| bytes))
    }

    fn range(&self, buffer: usize, offset: usize, length: usize, view: usize) -> Result<&[u8]> {
        let bytes = named(self.buffers, buffer, "buffers", || {
            format!("bufferViews[{view}]")
        })?;
        let range = offset
            .checked_add(length)
            .and_then(|end| bytes.get(offset..end));
        range.ok_or_else(|| {
            wrong(format!(
                "bufferViews[{view}]: {length} bytes at byte {offset} of buffers[{buffer}], which has {}; the file may \
                 be cut off",
                bytes.len()
            ))
        })
    }

    /// Takes `values` from what the file may ask for.
    ///
    /// # Errors
    /// [`Error::Input`] where it asks for more than its size justifies.
    pub(super) fn spend(&self, values: usize) -> Result<()> {
        let take = |left: u64| left.checked_sub(values as u64);
        self.left
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, take)
            .map(drop)
            .map_err(|_| {
                wrong(
                    "the file declares far more than its size justifies (many primitives that share accessors?); \
                     store shared meshes once",
                )
            })
    }
}

/// Decodes a compressed view.
fn decode(meshopt: &Meshopt, stream: &[u8]) -> Result<Vec<u8>> {
    let mode = match meshopt.mode.as_str() {
        "ATTRIBUTES" => Mode::Attributes,
        "TRIANGLES" => Mode::Triangles,
        "INDICES" => Mode::Indices,
        other => return Err(wrong(format!("unknown mode `{}`", shown(other)))),
    };
    let filter = match meshopt.filter.as_deref() {
        None | Some("NONE") => Filter::None,
        Some("OCTAHEDRAL") => Filter::Octahedral,
        Some("QUATERNION") => Filter::Quaternion,
        Some("EXPONENTIAL") => Filter::Exponential,
        Some("COLOR") => Filter::Color,
        Some(other) => return Err(wrong(format!("unknown filter `{}`", shown(other)))),
    };
    meshopt::decode(mode, filter, meshopt.count, meshopt.byte_stride, stream)
}
