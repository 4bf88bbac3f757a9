//! A cursor over the bytes of a binary file; every binary reader but the independent verifier takes its numbers from one.

/// Reads a file's bytes from front to back; nothing is taken beyond the end, and nothing is copied but what is asked for.
#[derive(Clone, Debug)]
pub struct ByteCursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> ByteCursor<'a> {
    /// A cursor at the byte `at`, or at the end where `at` lies beyond.
    pub fn new(bytes: &'a [u8], at: usize) -> Self {
        Self {
            bytes,
            at: at.min(bytes.len()),
        }
    }

    /// Offset of the next byte from the start of the file, for messages.
    pub fn offset(&self) -> usize {
        self.at
    }

    /// Bytes that are left.
    pub fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// The next `count` bytes; `None`, and the cursor stays, where there are fewer.
    #[inline]
    pub fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let taken = self.rest().get(..count)?;
        self.at += count;
        Some(taken)
    }

    /// The next `N` bytes, as `from_le_bytes` and `from_be_bytes` take them; `None` where there are fewer.
    #[inline]
    pub fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let taken = *self.rest().first_chunk::<N>()?;
        self.at += N;
        Some(taken)
    }
}
