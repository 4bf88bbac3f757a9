//! NumPy arrays (.npy): buffers that no picture can hold, such as ids and depth.
//!
//! Little-endian, C order, at most four dimensions; written as version 1.0 of the format, read as versions 1 to 3. Grids
//! have the shape (height, width), rows of three (n, 3). Own code: the format is a line of text before the bytes, and the
//! crate for it brings 18 others, a C compiler, and a panic on a shape whose product overflows.
//!
//! Limits on reading: the array must be as large as the file says, so a small file cannot ask for much memory.

use std::{fmt::Write as _, path::Path};

use super::{atomic, byte_cursor::ByteCursor, bytes, hash::Raw};
use crate::{Error, Result, num::Grid};

/// A number that arrays are made of.
pub trait Element: Raw {
    /// NumPy's name of the type, with its byte order.
    const TYPE: &'static str;

    /// The number of its little-endian bytes; 0 where there are too few.
    fn from_bytes(bytes: &[u8]) -> Self;
}

macro_rules! element {
    ($($number:ty: $name:literal),*) => {$(
        impl Element for $number {
            const TYPE: &'static str = $name;

            fn from_bytes(bytes: &[u8]) -> Self {
                let number = bytes.first_chunk().copied();
                number.map_or_else(Self::default, Self::from_le_bytes)
            }
        }
    )*};
}

element!(u8: "|u1", u16: "<u2", u32: "<u4", u64: "<u8", i64: "<i8", f32: "<f4", f64: "<f8");

/// Most dimensions of an array.
const MOST_DIMENSIONS: usize = 4;
/// The first bytes of every file.
const MAGIC: &[u8] = b"\x93NUMPY";
/// The values begin at a multiple of this.
const ALIGNMENT: usize = 64;

/// Writes a plane as an array of shape (height, width); an existing file is replaced as a whole.
///
/// # Errors
/// As [`atomic::write`].
pub fn write_plane<T: Element>(path: &Path, plane: &Grid<T>) -> Result<()> {
    let shape = [u64::from(plane.height()), u64::from(plane.width())];
    write_array(path, plane.values(), &shape)
}

/// Writes rows of three numbers (points, triangles) as an array of shape (rows, 3); an existing file is replaced as a
/// whole.
///
/// # Errors
/// As [`atomic::write`].
pub fn write_rows<T: Element>(path: &Path, rows: &[[T; 3]]) -> Result<()> {
    write_array(path, rows.as_flattened(), &[rows.len() as u64, 3])
}

/// Writes an array of one to four dimensions in C order; an existing file is replaced as a whole.
///
/// # Errors
/// [`Error::Internal`] where `shape` is not that of `values`; as [`atomic::write`].
pub fn write_array<T: Element>(path: &Path, values: &[T], shape: &[u64]) -> Result<()> {
    if count(shape) != Some(values.len() as u64) {
        return Err(Error::Internal(format!(
            "an array of shape {shape:?} with {} values",
            values.len()
        )));
    }
    let head = header(T::TYPE, shape);
    atomic::write(path, |file| {
        file.write_all(&head)?;
        let mut part = Vec::new();
        for values in values.chunks(4_096) {
            part.clear();
            values.iter().for_each(|&value| value.append(&mut part));
            file.write_all(&part)?;
        }
        Ok(())
    })
}

/// The bytes before the values: magic, version, length of a Python dictionary, and the dictionary, padded with spaces.
fn header(name: &str, shape: &[u64]) -> Vec<u8> {
    let mut text = format!("{{'descr': '{name}', 'fortran_order': False, 'shape': (");
    for side in shape {
        // Writing to a String cannot fail.
        let _ = write!(text, "{side}, ");
    }
    text.push_str("), }");
    let begin = MAGIC.len() + 4;
    let total = (begin + text.len() + 1).next_multiple_of(ALIGNMENT);
    let length = (total - begin) as u16;
    let mut bytes = MAGIC.to_vec();
    bytes.extend([1, 0]);
    bytes.extend(length.to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.resize(total - 1, b' ');
    bytes.push(b'\n');
    bytes
}

/// Number of values of an array with one to four sides; `None` where it has others, or too many to count.
fn count(shape: &[u64]) -> Option<u64> {
    if !(1..=MOST_DIMENSIONS).contains(&shape.len()) {
        return None;
    }
    shape.iter().try_fold(1_u64, |n, &side| n.checked_mul(side))
}

/// Reads an array of shape (height, width) and exactly this type.
///
/// # Errors
/// As [`read_array`], and where the array has another shape.
pub fn read_plane<T: Element>(path: &Path) -> Result<Grid<T>> {
    let (values, [rows, columns]) = read_table(path)?;
    match (u32::try_from(columns), u32::try_from(rows)) {
        (Ok(width), Ok(height)) => Grid::new(width, height, values)
            .ok_or_else(|| Error::Internal("an array changed its size".into())),
        _ => {
            let told = format!("holds {rows} x {columns} values; expected sides below 2^32");
            Err(Error::input(path, told))
        }
    }
}

/// Reads an array of shape (rows, 3) and exactly this type.
///
/// # Errors
/// As [`read_array`], and where the array has another shape.
pub fn read_rows<T: Element>(path: &Path) -> Result<Vec<[T; 3]>> {
    let (values, [_, columns]) = read_table(path)?;
    if columns != 3 {
        let told = format!("holds rows of {columns} values; expected 3");
        return Err(Error::input(path, told));
    }
    let (rows, _) = values.as_chunks::<3>();
    Ok(rows.to_vec())
}

/// Reads the values, rows and columns of a two-dimensional array.
fn read_table<T: Element>(path: &Path) -> Result<(Vec<T>, [u64; 2])> {
    let (values, shape) = read_array(path)?;
    match shape[..] {
        [rows, columns] => Ok((values, [rows, columns])),
        _ => {
            let count = shape.len();
            let told = format!("holds an array of {count} dimensions; expected 2");
            Err(Error::input(path, told))
        }
    }
}

/// Reads the values and the shape of an array of exactly this type, of one to four dimensions, in C order.
///
/// # Errors
/// [`Error::Io`]; [`Error::Input`] where the file is damaged or holds another array.
pub fn read_array<T: Element>(path: &Path) -> Result<(Vec<T>, Vec<u64>)> {
    let bytes = bytes::read(path)?;
    let bad = |message: String| Error::input(path, message);
    let Some(header) = Header::of(&bytes) else {
        let told = "does not begin like a .npy file of version 1 to 3; expected a NumPy array";
        return Err(bad(told.into()));
    };
    if header.descr != T::TYPE || header.fortran_order {
        let order = if header.fortran_order { "Fortran" } else { "C" };
        let (found, expected) = (header.descr, T::TYPE);
        return Err(bad(format!(
            "holds numbers of type {found} in {order} order; expected {expected} in C order"
        )));
    }
    let shape = header.shape;
    let dimensions = shape.len();
    if !(1..=MOST_DIMENSIONS).contains(&dimensions) {
        return Err(bad(format!(
            "holds an array of {dimensions} dimensions; expected 1 to {MOST_DIMENSIONS}"
        )));
    }
    let size = count(&shape).and_then(|n| n.checked_mul(u64::from(T::BYTES)));
    if size != Some(header.body.len() as u64) {
        let sides: Vec<String> = shape.iter().map(u64::to_string).collect();
        let expected = size.map_or("more than any file has".into(), |size| size.to_string());
        return Err(bad(format!(
            "claims {} values but has {} bytes of them; expected {expected}",
            sides.join(" x "),
            header.body.len(),
        )));
    }
    let values = header.body.chunks_exact(T::BYTES as usize);
    Ok((values.map(T::from_bytes).collect(), shape))
}

/// The parts of a file: the entries of its dictionary, and the bytes of the values.
struct Header<'a> {
    descr: &'a str,
    fortran_order: bool,
    shape: Vec<u64>,
    body: &'a [u8],
}

impl<'a> Header<'a> {
    /// Reads the header that NumPy writes: a Python dictionary with exactly these keys, without escapes.
    fn of(bytes: &'a [u8]) -> Option<Self> {
        let mut cursor = ByteCursor::new(bytes, 0);
        if cursor.take(MAGIC.len())? != MAGIC {
            return None;
        }
        let length = match cursor.array::<2>()? {
            [1, 0] => u32::from(u16::from_le_bytes(cursor.array()?)),
            [2 | 3, 0] => u32::from_le_bytes(cursor.array()?),
            _ => return None,
        };
        let text = std::str::from_utf8(cursor.take(length as usize)?).ok()?;
        let after = |key: &str| Some(text.split_once(key)?.1.trim_start());
        let (descr, _) = after("'descr':")?.strip_prefix('\'')?.split_once('\'')?;
        let (shape, _) = after("'shape':")?.strip_prefix('(')?.split_once(')')?;
        let order = after("'fortran_order':")?;
        let fortran_order = order.starts_with("True");
        if !fortran_order && !order.starts_with("False") {
            return None;
        }
        let sides = shape.split(',').map(str::trim).filter(|s| !s.is_empty());
        Some(Self {
            descr,
            fortran_order,
            shape: sides.map(|side| side.parse().ok()).collect::<Option<_>>()?,
            body: cursor.rest(),
        })
    }
}
