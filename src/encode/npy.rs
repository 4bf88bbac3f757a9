//! NumPy arrays (.npy): buffers that no picture can hold, such as ids and depth.
//!
//! Little-endian, C order, version 1.0 of the format: planes as (height, width), rows of three as (n, 3).
//! Reading is own code, because `npyz` 0.9 panics on a shape whose product overflows.
//! Limits on reading: the array must be as large as the file says, so a small file cannot ask for much memory.

use std::path::Path;

use npyz::{DType, TypeStr, WriterBuilder};

use super::{atomic, bytes};
use crate::{Error, Result, num::Grid};

/// A number that arrays are made of.
pub trait Element: Copy + npyz::Serialize {
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
                bytes
                    .first_chunk()
                    .map_or_else(Self::default, |b| Self::from_le_bytes(*b))
            }
        }
    )*};
}

element!(u8: "|u1", u16: "<u2", u32: "<u4", f32: "<f4", f64: "<f8");

/// Writes a plane as an array of shape (height, width); an existing file is replaced as a whole.
///
/// # Errors
/// As [`atomic::write`].
pub fn write_plane<T: Element>(path: &Path, plane: &Grid<T>) -> Result<()> {
    let shape = [u64::from(plane.height()), u64::from(plane.width())];
    write(path, plane.values(), shape)
}

/// Writes rows of three numbers (points, triangles) as an array of shape (rows, 3); an existing file is replaced as a
/// whole.
///
/// # Errors
/// As [`atomic::write`].
pub fn write_rows<T: Element>(path: &Path, rows: &[[T; 3]]) -> Result<()> {
    write(path, rows.as_flattened(), [rows.len() as u64, 3])
}

fn write<T: Element>(path: &Path, values: &[T], shape: [u64; 2]) -> Result<()> {
    let dtype = dtype::<T>()?;
    atomic::write(path, |file| {
        let mut writer = npyz::WriteOptions::new()
            .dtype(dtype)
            .shape(&shape)
            .writer(file)
            .begin_nd()?;
        writer.extend(values.iter())?;
        writer.finish()
    })
}

fn dtype<T: Element>() -> Result<DType> {
    let name: TypeStr = T::TYPE
        .parse()
        .map_err(|_| Error::Internal(format!("{} is no array type", T::TYPE)))?;
    Ok(DType::new_scalar(name))
}

/// Reads an array of shape (height, width) and exactly this type.
///
/// # Errors
/// [`Error::Io`]; [`Error::Input`] where the file is damaged or holds another array.
pub fn read_plane<T: Element>(path: &Path) -> Result<Grid<T>> {
    let (values, rows, columns) = read(path)?;
    match (u32::try_from(columns), u32::try_from(rows)) {
        (Ok(width), Ok(height)) => Grid::new(width, height, values)
            .ok_or_else(|| Error::Internal("an array changed its size".into())),
        _ => Err(Error::input(
            path,
            format!("holds {rows} x {columns} values; expected sides below 2^32"),
        )),
    }
}

/// Reads an array of shape (rows, 3) and exactly this type.
///
/// # Errors
/// As [`read_plane`].
pub fn read_rows<T: Element>(path: &Path) -> Result<Vec<[T; 3]>> {
    let (values, _, columns) = read(path)?;
    if columns != 3 {
        return Err(Error::input(
            path,
            format!("holds rows of {columns} values; expected 3"),
        ));
    }
    let (rows, _) = values.as_chunks::<3>();
    Ok(rows.to_vec())
}

/// The values, rows and columns of a two-dimensional array.
fn read<T: Element>(path: &Path) -> Result<(Vec<T>, u64, u64)> {
    let bytes = bytes::read(path)?;
    let header = Header::of(&bytes).ok_or_else(|| {
        Error::input(
            path,
            "does not begin like a .npy file of version 1 to 3; expected a NumPy array",
        )
    })?;
    if header.descr != T::TYPE || header.fortran_order {
        return Err(Error::input(
            path,
            format!(
                "holds numbers of type {} in {} order; expected {} in C order",
                header.descr,
                if header.fortran_order { "Fortran" } else { "C" },
                T::TYPE
            ),
        ));
    }
    let &[rows, columns] = &header.shape[..] else {
        return Err(Error::input(
            path,
            format!(
                "holds an array of {} dimensions; expected 2",
                header.shape.len()
            ),
        ));
    };
    let size = u128::from(rows) * u128::from(columns) * size_of::<T>() as u128;
    if size != header.body.len() as u128 {
        return Err(Error::input(
            path,
            format!(
                "claims {rows} x {columns} values but has {} bytes of them; expected {size}",
                header.body.len()
            ),
        ));
    }
    let values = header.body.chunks_exact(size_of::<T>());
    Ok((values.map(T::from_bytes).collect(), rows, columns))
}

/// What stands before the values, and the values.
struct Header<'a> {
    descr: &'a str,
    fortran_order: bool,
    shape: Vec<u64>,
    body: &'a [u8],
}

impl<'a> Header<'a> {
    /// Reads what NumPy and npyz write: a Python dictionary with exactly these keys, without escapes.
    fn of(bytes: &'a [u8]) -> Option<Self> {
        let rest = bytes.strip_prefix(b"\x93NUMPY")?;
        let (version, rest) = rest.split_first_chunk::<2>()?;
        let (length, rest) = match version {
            [1, 0] => {
                let (length, rest) = rest.split_first_chunk::<2>()?;
                (u32::from(u16::from_le_bytes(*length)), rest)
            }
            [2 | 3, 0] => {
                let (length, rest) = rest.split_first_chunk::<4>()?;
                (u32::from_le_bytes(*length), rest)
            }
            _ => return None,
        };
        let (text, body) = rest.split_at_checked(length as usize)?;
        let text = std::str::from_utf8(text).ok()?;
        let after = |key: &str| Some(text.split_once(key)?.1.trim_start());
        let (descr, _) = after("'descr':")?.strip_prefix('\'')?.split_once('\'')?;
        let (shape, _) = after("'shape':")?.strip_prefix('(')?.split_once(')')?;
        let fortran_order = after("'fortran_order':")?;
        Some(Self {
            descr,
            fortran_order: if fortran_order.starts_with("True") {
                true
            } else if fortran_order.starts_with("False") {
                false
            } else {
                return None;
            },
            shape: shape
                .split(',')
                .map(str::trim)
                .filter(|side| !side.is_empty())
                .map(|side| side.parse().ok())
                .collect::<Option<_>>()?,
            body,
        })
    }
}
