//! The numbers of a PLY body, one after the other, from text or from either byte order.

use super::header::Scalar;
use crate::{
    encode::byte_cursor::ByteCursor,
    io::words::{Words, shown},
};

/// Why there is no next number.
#[derive(Clone, Copy, Debug)]
pub(super) enum Fault {
    /// The file ends here.
    End,
    /// The word of this many bytes that was taken last is not a number of the type.
    NotANumber(usize),
    /// A list of this length is negative, not whole, or longer than the rest of the file.
    Length(f64),
}

/// A sequence of numbers. `f64` holds every value of every type exactly.
pub(super) trait Source {
    /// The next number.
    fn number(&mut self, kind: Scalar) -> Result<f64, Fault>;

    /// Skips `count` numbers.
    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), Fault>;

    /// Bytes that are left.
    fn remaining(&self) -> u64;

    /// Fewest bytes a number takes.
    fn smallest(kind: Scalar) -> u64;

    /// The place of the next number in words.
    fn place(&self) -> String;

    /// The last `length` bytes that were taken, as far as a message should show them.
    fn shown(&self, length: usize) -> String;

    /// Bytes that are left and are not white space at the end of a text.
    fn excess(&mut self) -> u64;
}

/// White-space separated numbers; the division into lines is only used in messages.
pub(super) struct Text<'a>(pub Words<'a>);

impl Source for Text<'_> {
    fn number(&mut self, kind: Scalar) -> Result<f64, Fault> {
        let word = self.0.next().ok_or(Fault::End)?;
        let parsed = std::str::from_utf8(word).ok().and_then(|word| match kind {
            // Parsed as what it is stored as: rounding twice could end one step off.
            Scalar::F32 => word.parse::<f32>().ok().map(f64::from),
            _ => word.parse::<f64>().ok(),
        });
        parsed.ok_or(Fault::NotANumber(word.len()))
    }

    fn skip(&mut self, _: Scalar, count: u64) -> Result<(), Fault> {
        for _ in 0..count {
            self.0.next().ok_or(Fault::End)?;
        }
        Ok(())
    }

    fn remaining(&self) -> u64 {
        // The last number needs no separator.
        self.0.remaining() as u64 + 1
    }

    fn smallest(_: Scalar) -> u64 {
        2
    }

    fn place(&self) -> String {
        format!("line {}", self.0.line())
    }

    fn shown(&self, length: usize) -> String {
        shown(self.0.behind(length))
    }

    fn excess(&mut self) -> u64 {
        self.0.skip_space();
        self.0.remaining() as u64
    }
}

/// Packed numbers in one byte order.
pub(super) struct Binary<'a, const BIG: bool>(pub ByteCursor<'a>);

impl<const BIG: bool> Binary<'_, BIG> {
    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let mut raw = self.0.array::<N>().ok_or(Fault::End)?;
        if BIG {
            raw.reverse();
        }
        Ok(raw)
    }
}

impl<const BIG: bool> Source for Binary<'_, BIG> {
    #[inline]
    fn number(&mut self, kind: Scalar) -> Result<f64, Fault> {
        Ok(match kind {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            Scalar::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Scalar::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    fn skip(&mut self, kind: Scalar, count: u64) -> Result<(), Fault> {
        let size = count.saturating_mul(kind.size() as u64);
        let size = usize::try_from(size).map_err(|_| Fault::End)?;
        self.0.take(size).map(drop).ok_or(Fault::End)
    }

    fn remaining(&self) -> u64 {
        self.0.rest().len() as u64
    }

    fn smallest(kind: Scalar) -> u64 {
        kind.size() as u64
    }

    fn place(&self) -> String {
        format!("byte {}", self.0.offset())
    }

    fn shown(&self, length: usize) -> String {
        format!("{length} bytes")
    }

    fn excess(&mut self) -> u64 {
        self.remaining()
    }
}
