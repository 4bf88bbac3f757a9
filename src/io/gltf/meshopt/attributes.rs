//! Attributes (mode 0): bytes of the same place in consecutive elements differ little.
//!
//! | bytes | part |
//! |---|---|
//! | 1 | `0xa0` for version 0, `0xa1` for version 1 |
//! | per block | version 1: a control byte for every channel, 2 bits for each of its 4 bytes; then one plane a byte of the element |
//! | tail | padding up to 32 bytes (version 0) or 24 (version 1), the baseline element, version 1: a mode byte a channel |
//!
//! A channel is 4 bytes of the element. A plane holds what one byte changes by from element to element, in groups of 16:
//! 2 bits a group choose the width of its codes from [`VERSION_0`], [`NARROW`] or [`WIDE`], least significant first.
//! In version 1 a plane may instead be all zero, or one byte for every element of the block (not of the last group).

use crate::encode::byte_cursor::ByteCursor;

/// Elements of a group.
const GROUP: usize = 16;
/// Bytes of a block at most, and elements.
const BLOCK_BYTES: usize = 8192;
const BLOCK_ELEMENTS: usize = 256;
/// Bytes of the largest element.
const LARGEST: usize = 256;

/// Bits of a code by the 2 bits of its group.
const VERSION_0: [usize; 4] = [0, 2, 4, 8];
const NARROW: [usize; 4] = [0, 1, 2, 4];
const WIDE: [usize; 4] = [1, 2, 4, 8];

/// The arithmetic of the 4 bytes of a channel.
#[derive(Clone, Copy)]
enum Channel {
    /// Four zigzag differences of 8 bits.
    Bytes,
    /// Two zigzag differences of 16 bits.
    Halves,
    /// The changed bits of a 32-bit word, rotated.
    Word {
        /// Bits by which the encoder rotated them to the left. The specification does not say that decoding undoes it; the
        /// reference decoder does.
        rotation: u32,
    },
}

impl Channel {
    /// Reads a mode byte, which lies at `at`.
    fn from_byte(byte: u8, at: usize) -> Result<Self, String> {
        match (byte & 15, byte >> 4) {
            (0, 0) => Ok(Self::Bytes),
            (1, 0) => Ok(Self::Halves),
            (2, rotation) => Ok(Self::Word {
                rotation: u32::from(rotation),
            }),
            _ => Err(format!(
                "byte {at}: channel mode {byte:#04x}; expected 0x00, 0x01 or 0xR2 with a rotation R"
            )),
        }
    }

    /// The 4 bytes that follow `previous`.
    #[inline]
    fn next(self, previous: [u8; 4], code: [u8; 4]) -> [u8; 4] {
        match self {
            Self::Bytes => std::array::from_fn(|i| {
                let sign = 0_u8.wrapping_sub(code[i] & 1);
                previous[i].wrapping_add((code[i] >> 1) ^ sign)
            }),
            Self::Halves => {
                let half = |at: usize| {
                    let word = |from: [u8; 4]| u16::from_le_bytes([from[at], from[at + 1]]);
                    let sign = 0_u16.wrapping_sub(word(code) & 1);
                    word(previous)
                        .wrapping_add((word(code) >> 1) ^ sign)
                        .to_le_bytes()
                };
                let ([a, b], [c, d]) = (half(0), half(2));
                [a, b, c, d]
            }
            Self::Word { rotation } => {
                let changed = u32::from_le_bytes(code).rotate_right(rotation);
                (u32::from_le_bytes(previous) ^ changed).to_le_bytes()
            }
        }
    }
}

/// Elements of a full block.
fn block_elements(stride: usize) -> usize {
    (BLOCK_BYTES / stride / GROUP * GROUP).min(BLOCK_ELEMENTS)
}

/// Bytes that `count` elements need at the least: every plane has its 2 bits a group in version 0, every block its control
/// bytes in version 1.
fn least(version: u8, count: usize, stride: usize) -> usize {
    let block = block_elements(stride);
    let bytes = |elements: usize| match version {
        0 => stride * elements.div_ceil(GROUP).div_ceil(4),
        _ => stride / 4,
    };
    let rest = match count % block {
        0 => 0,
        rest => bytes(rest),
    };
    (count / block)
        .saturating_mul(bytes(block))
        .saturating_add(rest)
}

/// Decodes `count` elements of `stride` bytes, a multiple of 4 from 4 to 256.
pub(super) fn decode(count: usize, stride: usize, stream: &[u8]) -> Result<Vec<u8>, String> {
    let mode_bytes = |version: u8| usize::from(version) * (stride / 4);
    let parts = super::parts(
        stream,
        [0xa0, 0xa1],
        |version| (stride + mode_bytes(version)).max(if version == 0 { 32 } else { 24 }),
        |version| least(version, count, stride),
        count,
    )?;
    let modes_at = stream.len() - mode_bytes(parts.version);
    let mut channels = [Channel::Bytes; LARGEST / 4];
    for (at, &byte) in (modes_at..).zip(&stream[modes_at..]) {
        channels[at - modes_at] = Channel::from_byte(byte, at)?;
    }
    let mut previous = [[0; 4]; LARGEST / 4];
    let (baseline, _) = stream[modes_at - stride..modes_at].as_chunks::<4>();
    previous[..stride / 4].copy_from_slice(baseline);

    let mut elements = super::room(count, stride)?;
    let mut cursor = ByteCursor::new(&stream[..parts.payload_end], 1);
    let mut planes = [0; BLOCK_BYTES];
    while elements.len() < count * stride {
        let begun = elements.len();
        let length = block_elements(stride).min(count - begun / stride);
        let rows = length.next_multiple_of(GROUP);
        read_block(
            &mut cursor,
            parts.version,
            length,
            &mut planes[..rows * stride],
        )
        .map_err(|(at, expected)| {
            format!(
                "byte {at}: the stream ends before its tail, in the block of elements {} to {} of {count}; expected {expected}",
                begun / stride,
                begun / stride + length - 1,
            )
        })?;
        elements.resize(begun + length * stride, 0);
        let block = &mut elements[begun..];
        for (c, planes) in planes[..rows * stride].chunks_exact(4 * rows).enumerate() {
            for (i, element) in block.chunks_exact_mut(stride).enumerate() {
                let code = std::array::from_fn(|byte| planes[byte * rows + i]);
                previous[c] = channels[c].next(previous[c], code);
                element[4 * c..4 * c + 4].copy_from_slice(&previous[c]);
            }
        }
    }
    super::all_taken(cursor.offset(), parts.payload_end)?;
    Ok(elements)
}

/// Where a stream ended too early, and what should be there.
type Short = (usize, &'static str);

fn take<'a>(
    cursor: &mut ByteCursor<'a>,
    count: usize,
    expected: &'static str,
) -> Result<&'a [u8], Short> {
    cursor.take(count).ok_or((cursor.offset(), expected))
}

/// Reads the codes of a block of `length` elements, one plane of whole groups after the other.
fn read_block(
    cursor: &mut ByteCursor<'_>,
    version: u8,
    length: usize,
    planes: &mut [u8],
) -> Result<(), Short> {
    let rows = length.next_multiple_of(GROUP);
    let stride = planes.len() / rows;
    let controls = match version {
        0 => &[][..],
        _ => take(cursor, stride / 4, "control bytes")?,
    };
    for (byte, plane) in planes.chunks_exact_mut(rows).enumerate() {
        let control = controls.get(byte / 4).map(|c| c >> (2 * (byte % 4)) & 3);
        match control {
            None => read_plane(cursor, &VERSION_0, plane)?,
            Some(0) => read_plane(cursor, &NARROW, plane)?,
            Some(1) => read_plane(cursor, &WIDE, plane)?,
            Some(2) => plane.fill(0),
            Some(_) => plane[..length].copy_from_slice(take(cursor, length, "plain bytes")?),
        }
    }
    Ok(())
}

/// Reads the groups of a plane.
fn read_plane(
    cursor: &mut ByteCursor<'_>,
    widths: &[usize; 4],
    plane: &mut [u8],
) -> Result<(), Short> {
    let (groups, _) = plane.as_chunks_mut::<GROUP>();
    let choices = take(cursor, groups.len().div_ceil(4), "widths of groups")?;
    for (g, group) in groups.iter_mut().enumerate() {
        read_group(
            cursor,
            widths[usize::from(choices[g / 4] >> (2 * (g % 4)) & 3)],
            group,
        )?;
    }
    Ok(())
}

/// Reads 16 codes of `width` bits. The greatest code of 1, 2 or 4 bits stands for a byte that follows them all. The first
/// code lies in the highest bits of its byte, except where codes are single bits.
fn read_group(
    cursor: &mut ByteCursor<'_>,
    width: usize,
    group: &mut [u8; GROUP],
) -> Result<(), Short> {
    if width == 0 {
        group.fill(0);
        return Ok(());
    }
    let packed = take(cursor, 2 * width, "codes of a group")?;
    if width == 8 {
        group.copy_from_slice(packed);
        return Ok(());
    }
    let escape = (1_u8 << width) - 1;
    for (i, code) in group.iter_mut().enumerate() {
        let bit = i * width % 8;
        let shift = if width == 1 { bit } else { 8 - width - bit };
        *code = packed[i * width / 8] >> shift & escape;
        if *code == escape {
            *code = take(cursor, 1, "a byte after the codes of a group")?[0];
        }
    }
    Ok(())
}
