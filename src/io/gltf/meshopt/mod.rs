//! Decodes the streams of the glTF extensions `EXT_meshopt_compression` and `KHR_meshopt_compression`.
//!
//! Written from Appendices A and B of the two specifications (Khronos, 2020 and 2026). Attributes exist in two versions
//! ([`attributes`]), triangle lists and index sequences in one ([`indices`]); [`filters`] turn decoded attributes into
//! what accessors read. The colour filter and version 1 belong to the later extension, and are decoded for both.
//!
//! Every stream is checked as the later specification demands: nothing may be missing, nothing left over, and no entry of
//! a queue is read before it was written. Reserved and padding bytes may hold anything. Memory is allocated only after
//! the stream was found long enough for the declared count: at most 1,024 times its length, which is what 256 equal
//! elements need at the least.

mod attributes;
mod filters;
#[cfg(test)]
mod hostile;
mod indices;
#[cfg(test)]
mod reference;

use crate::{Error, Result};

/// The layout of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// Elements of any meaning, 4 to 256 bytes each.
    Attributes,
    /// Indices of a triangle list.
    Triangles,
    /// Indices in any order.
    Indices,
}

/// The transformation of decoded attributes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Filter {
    /// Attributes are what was decoded.
    None,
    /// Unit vectors.
    Octahedral,
    /// Unit quaternions.
    Quaternion,
    /// 32-bit floats.
    Exponential,
    /// Red, green, blue and alpha.
    Color,
}

/// Decodes `count` elements of `stride` bytes: the contents of the buffer view, little-endian.
///
/// # Errors
/// [`Error::Input`] for a stride, a count or a filter that does not fit the mode, and for a stream that is not exactly
/// `count` elements; offsets count from the start of `stream`.
pub(super) fn decode(
    mode: Mode,
    filter: Filter,
    count: usize,
    stride: usize,
    stream: &[u8],
) -> Result<Vec<u8>> {
    fits(mode, filter, count, stride)
        .and_then(|()| match mode {
            Mode::Attributes => attributes::decode(count, stride, stream),
            Mode::Triangles => indices::triangles(count, stride, stream),
            Mode::Indices => indices::sequence(count, stride, stream),
        })
        .and_then(|mut elements| {
            filters::apply(filter, stride, &mut elements)?;
            Ok(elements)
        })
        .map_err(|message| Error::content(format!("meshopt stream: {message}")))
}

/// Refuses what the extension declares around a stream and no stream can hold.
fn fits(mode: Mode, filter: Filter, count: usize, stride: usize) -> Result<(), String> {
    let (stride_fits, strides) = match (mode, filter) {
        (Mode::Attributes, Filter::None | Filter::Exponential) => (
            stride.is_multiple_of(4) && (4..=256).contains(&stride),
            "a multiple of 4 up to 256",
        ),
        (Mode::Attributes, Filter::Octahedral | Filter::Color) => {
            (stride == 4 || stride == 8, "4 or 8")
        }
        (Mode::Attributes, Filter::Quaternion) => (stride == 8, "8"),
        (Mode::Triangles | Mode::Indices, Filter::None) => (stride == 2 || stride == 4, "2 or 4"),
        (Mode::Triangles | Mode::Indices, _) => {
            return Err(format!(
                "filter {filter:?} is declared for mode {mode:?}; expected it for attributes only"
            ));
        }
    };
    if !stride_fits {
        return Err(format!(
            "mode {mode:?} and filter {filter:?} are declared with {stride} bytes an element; expected {strides}"
        ));
    }
    if mode == Mode::Triangles && !count.is_multiple_of(3) {
        return Err(format!(
            "{count} indices of triangles are declared; expected a multiple of 3"
        ));
    }
    Ok(())
}

/// The parts of a stream: its version, where its payload ends, and its tail.
struct Parts<'a> {
    version: u8,
    payload_end: usize,
    tail: &'a [u8],
}

/// Checks the first byte against those of `headers`, whose place is the version, and that the payload between header and
/// tail has room for `least(version)` bytes.
fn parts<'a, const N: usize>(
    stream: &'a [u8],
    headers: [u8; N],
    tail: impl FnOnce(u8) -> usize,
    least: impl FnOnce(u8) -> usize,
    count: usize,
) -> Result<Parts<'a>, String> {
    let expected = || headers.map(|header| format!("{header:#04x}")).join(" or ");
    let Some((&header, rest)) = stream.split_first() else {
        return Err(format!(
            "byte 0: the stream is empty; expected {}",
            expected()
        ));
    };
    let Some((version, _)) = (0..).zip(headers).find(|&(_, known)| known == header) else {
        return Err(format!(
            "byte 0: found {header:#04x}; expected {}",
            expected()
        ));
    };
    let (tail, least) = (tail(version), least(version));
    let needed = tail.saturating_add(least);
    if rest.len() < needed {
        return Err(format!(
            "byte 1: {count} elements and the tail need at least {needed} bytes, but {} follow; the stream is cut off or \
             its count is wrong",
            rest.len()
        ));
    }
    let payload_end = stream.len() - tail;
    Ok(Parts {
        version,
        payload_end,
        tail: &stream[payload_end..],
    })
}

/// Memory for `count` elements of `stride` bytes, whose number was checked against the length of the stream.
fn room(count: usize, stride: usize) -> Result<Vec<u8>, String> {
    let mut room = Vec::new();
    count
        .checked_mul(stride)
        .and_then(|bytes| room.try_reserve_exact(bytes).ok())
        .ok_or_else(|| format!("there is no memory for {count} elements of {stride} bytes"))?;
    Ok(room)
}

/// Refuses bytes that no element took.
fn all_taken(at: usize, payload_end: usize) -> Result<(), String> {
    if at == payload_end {
        Ok(())
    } else {
        Err(format!(
            "byte {at}: {} bytes are left after the last element; expected the tail at once",
            payload_end - at
        ))
    }
}
