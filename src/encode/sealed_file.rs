//! Sealed files: the binary files of our own that carry their version and a checksum, such as histories.
//!
//! Little-endian: eight bytes of magic, format version (`u32`), content, SHA-256 of all that. A reader that has opened one
//! knows that the bytes are those that were written; their sense is still to be checked.

use std::path::Path;

use sha2::{Digest, Sha256};

use super::byte_cursor::ByteCursor;
use crate::{Error, Result};

/// Bytes of the checksum.
const CHECKSUM: usize = 32;

/// A kind of sealed file.
#[derive(Clone, Copy, Debug)]
pub struct SealedFormat {
    /// First bytes of the file.
    pub magic: [u8; 8],
    /// The format version that is written and read.
    pub version: u32,
    /// Name of the kind in messages, such as "history".
    pub name: &'static str,
    /// The commands that write such files, for the message about another file.
    pub written_by: &'static str,
    /// Advice about a damaged file, after a semicolon; empty for none.
    pub advice: &'static str,
}

impl SealedFormat {
    /// The first bytes of a file: magic and version.
    pub fn begin(&self, capacity: usize) -> Vec<u8> {
        let mut out = Vec::with_capacity(capacity);
        out.extend(self.magic);
        out.extend(self.version.to_le_bytes());
        out
    }

    /// Opens a file: checks magic, version and checksum. `path` is for messages.
    ///
    /// # Errors
    /// [`Error::Input`] where the bytes are of another kind, cut short or damaged; [`Error::Unsupported`] for another
    /// version.
    pub fn open<'a>(&self, bytes: &'a [u8], path: &'a Path) -> Result<SealedReader<'a>> {
        let mut reader = SealedReader {
            cursor: ByteCursor::new(bytes, 0),
            path,
        };
        if reader.take(self.magic.len()).ok() != Some(&self.magic) {
            return Err(reader.bad(&format!(
                "not a {}; expected a file that {} wrote",
                self.name, self.written_by
            )));
        }
        let version = reader.u32()?;
        if version != self.version {
            return Err(Error::Unsupported(format!(
                "{}: {} format {version}; this version reads format {}",
                path.display(),
                self.name,
                self.version
            )));
        }
        let begun = reader.cursor.offset();
        let content = bytes.split_last_chunk::<CHECKSUM>();
        match content {
            Some((content, checksum))
                if content.len() >= begun && Sha256::digest(content)[..] == checksum[..] =>
            {
                reader.cursor = ByteCursor::new(content, begun);
                Ok(reader)
            }
            _ => Err(reader.bad(&format!(
                "cut short or damaged: the checksum at the end does not fit{}",
                self.advice
            ))),
        }
    }
}

/// Appends the checksum that [`SealedFormat::open`] demands.
pub fn seal(mut out: Vec<u8>) -> Vec<u8> {
    let checksum = Sha256::digest(&out);
    out.extend(checksum);
    out
}

/// Appends a text as [`SealedReader::text`] reads it: its length (`u32`) and UTF-8.
pub fn push_text(out: &mut Vec<u8>, text: &str) {
    out.extend((text.len() as u32).to_le_bytes());
    out.extend(text.as_bytes());
}

/// Reads the content of a sealed file; what is missing is an [`Error::Input`] that says near which byte.
#[derive(Debug)]
pub struct SealedReader<'a> {
    cursor: ByteCursor<'a>,
    path: &'a Path,
}

impl<'a> SealedReader<'a> {
    /// The file, for messages.
    pub fn path(&self) -> &'a Path {
        self.path
    }

    /// Bytes of content that are left.
    pub fn remaining(&self) -> usize {
        self.cursor.rest().len()
    }

    /// An error that says `message` and the place.
    pub fn bad(&self, message: &str) -> Error {
        let at = self.cursor.offset();
        Error::input(self.path, format!("{message} (near byte {at})"))
    }

    /// The next `count` bytes.
    ///
    /// # Errors
    /// [`Error::Input`] where there are fewer; so with every number below.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        self.cursor.take(count).ok_or_else(|| self.bad("cut short"))
    }

    /// The next `N` bytes.
    ///
    /// # Errors
    /// As [`SealedReader::take`].
    pub fn array<const N: usize>(&mut self) -> Result<[u8; N]> {
        self.cursor.array().ok_or_else(|| self.bad("cut short"))
    }

    /// The next byte.
    ///
    /// # Errors
    /// As [`SealedReader::take`].
    pub fn u8(&mut self) -> Result<u8> {
        self.array().map(u8::from_le_bytes)
    }

    /// The next `u32`.
    ///
    /// # Errors
    /// As [`SealedReader::take`].
    pub fn u32(&mut self) -> Result<u32> {
        self.array().map(u32::from_le_bytes)
    }

    /// The next `u64`.
    ///
    /// # Errors
    /// As [`SealedReader::take`].
    pub fn u64(&mut self) -> Result<u64> {
        self.array().map(u64::from_le_bytes)
    }

    /// The next text: its length (`u32`) and UTF-8.
    ///
    /// # Errors
    /// As [`SealedReader::take`], and where it is no UTF-8.
    pub fn text(&mut self) -> Result<String> {
        let length = self.u32()? as usize;
        let bytes = self.take(length)?.to_vec();
        String::from_utf8(bytes).map_err(|_| self.bad("a text is not UTF-8"))
    }
}
