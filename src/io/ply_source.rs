//! The numbers of a PLY body, one after the other, from text or from either byte order.

use super::ply_header::Scalar;

/// Why there is no next number.
#[derive(Clone, Copy, Debug)]
pub(super) enum Fault {
    /// The file ends here.
    End,
    /// These bytes (from, to) are not a number of the type.
    NotANumber(usize, usize),
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

    /// Where the next number begins, in words.
    fn place(&self) -> String;

    /// The bytes from one offset to another, as far as a message should show them.
    fn shown(&self, from: usize, to: usize) -> String;

    /// Bytes that are left and are not white space at the end of a text.
    fn excess(&mut self) -> u64;
}

/// White-space separated numbers; the division into lines is only used in messages.
pub(super) struct Text<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    /// Number of the line on which `at` lies.
    pub line: usize,
}

impl Text<'_> {
    fn skip_space(&mut self) {
        while let Some(&b) = self.bytes.get(self.at) {
            if !b.is_ascii_whitespace() {
                break;
            }
            self.line += usize::from(b == b'\n');
            self.at += 1;
        }
    }

    fn word(&mut self) -> Result<(usize, usize), Fault> {
        self.skip_space();
        let start = self.at;
        while self
            .bytes
            .get(self.at)
            .is_some_and(|b| !b.is_ascii_whitespace())
        {
            self.at += 1;
        }
        if self.at == start {
            Err(Fault::End)
        } else {
            Ok((start, self.at))
        }
    }
}

impl Source for Text<'_> {
    fn number(&mut self, kind: Scalar) -> Result<f64, Fault> {
        let (from, to) = self.word()?;
        let parsed = std::str::from_utf8(&self.bytes[from..to])
            .ok()
            .and_then(|word| match kind {
                // Parsed as what it is stored as: rounding twice could end one step off.
                Scalar::F32 => word.parse::<f32>().ok().map(f64::from),
                _ => word.parse::<f64>().ok(),
            });
        parsed.ok_or_else(|| {
            // The place in the message is that of the word.
            self.at = from;
            Fault::NotANumber(from, to)
        })
    }

    fn skip(&mut self, _: Scalar, count: u64) -> Result<(), Fault> {
        for _ in 0..count {
            self.word()?;
        }
        Ok(())
    }

    fn remaining(&self) -> u64 {
        // The last number needs no separator.
        (self.bytes.len() - self.at) as u64 + 1
    }

    fn smallest(_: Scalar) -> u64 {
        2
    }

    fn place(&self) -> String {
        format!("line {}", self.line)
    }

    fn shown(&self, from: usize, to: usize) -> String {
        String::from_utf8_lossy(&self.bytes[from..to])
            .chars()
            .take(40)
            .collect()
    }

    fn excess(&mut self) -> u64 {
        self.skip_space();
        (self.bytes.len() - self.at) as u64
    }
}

/// Packed numbers in one byte order.
pub(super) struct Binary<'a, const BIG: bool> {
    pub bytes: &'a [u8],
    pub at: usize,
}

impl<const BIG: bool> Binary<'_, BIG> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let mut raw = *self.bytes[self.at..].first_chunk::<N>().ok_or(Fault::End)?;
        self.at += N;
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
        if size > self.remaining() {
            return Err(Fault::End);
        }
        self.at += size as usize;
        Ok(())
    }

    fn remaining(&self) -> u64 {
        (self.bytes.len() - self.at) as u64
    }

    fn smallest(kind: Scalar) -> u64 {
        kind.size() as u64
    }

    fn place(&self) -> String {
        format!("byte {}", self.at)
    }

    fn shown(&self, from: usize, to: usize) -> String {
        format!("{:?}", &self.bytes[from..to])
    }

    fn excess(&mut self) -> u64 {
        self.remaining()
    }
}
