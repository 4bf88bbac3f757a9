//! PNG pictures: 8-bit grey and RGB, without alpha, and RGB with alpha to be written only.
//!
//! Limits on reading: 16,384 pixels per side and no larger than what the bytes of the file can decompress to, so that
//! a small hostile file cannot ask for much memory.

use std::{
    fs::File,
    io::{Cursor, Read, Write},
    path::Path,
};

use image::{
    ColorType, ExtendedColorType, ImageDecoder, ImageEncoder, Limits,
    codecs::png::{CompressionType, FilterType, PngDecoder, PngEncoder},
};

use super::atomic;
use crate::{
    Error, Result,
    num::{Grid, fixed::luma},
};

/// Most pixels in a row or column.
pub const SIDE_LIMIT: u32 = 4 * 4_096;

/// Bytes that one byte of a deflate stream can become, at most.
const DEFLATE_RATIO: u64 = 1_032;
/// Bytes of pixels that one decompressed byte can become: 8 palette indices of one bit, 3 bytes each.
const EXPANSION: u64 = 24;
/// More bytes than any file within the limits needs: RGB without compression, twice.
const FILE_LIMIT: u64 = 2 * 3 * (SIDE_LIMIT as u64) * (SIDE_LIMIT as u64);
/// The first bytes of every PNG file.
const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// A picture as a PNG file holds it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Picture {
    /// 8-bit grey.
    Grey(Grid<u8>),
    /// 8-bit red, green, blue.
    Rgb(Grid<[u8; 3]>),
}

impl Picture {
    /// The picture in grey: luma for colours (equal levels give that level).
    pub fn into_luma(self) -> Grid<u8> {
        match self {
            Self::Grey(plane) => plane,
            Self::Rgb(plane) => plane.map(luma),
        }
    }

    /// The picture in colours.
    pub fn into_rgb(self) -> Grid<[u8; 3]> {
        match self {
            Self::Grey(plane) => plane.map(|v| [v; 3]),
            Self::Rgb(plane) => plane,
        }
    }
}

/// Writes an 8-bit grey picture; an existing file is replaced as a whole.
///
/// # Errors
/// [`Error::Usage`] for a picture without pixels or beyond [`SIDE_LIMIT`]; as [`atomic::write`].
pub fn write_grey(path: &Path, picture: &Grid<u8>) -> Result<()> {
    write(path, picture, picture.values(), ExtendedColorType::L8)
}

/// Writes an 8-bit RGB picture; an existing file is replaced as a whole.
///
/// # Errors
/// As [`write_grey`].
pub fn write_rgb(path: &Path, picture: &Grid<[u8; 3]>) -> Result<()> {
    let bytes = picture.values().as_flattened();
    write(path, picture, bytes, ExtendedColorType::Rgb8)
}

/// Writes an 8-bit RGB picture with opacity; an existing file is replaced as a whole. [`read`] refuses such files.
///
/// # Errors
/// As [`write_grey`].
pub fn write_rgba(path: &Path, picture: &Grid<[u8; 4]>) -> Result<()> {
    let bytes = picture.values().as_flattened();
    write(path, picture, bytes, ExtendedColorType::Rgba8)
}

fn write<T: Copy>(
    path: &Path,
    picture: &Grid<T>,
    bytes: &[u8],
    color: ExtendedColorType,
) -> Result<()> {
    let (width, height) = (picture.width(), picture.height());
    if [width, height]
        .iter()
        .any(|side| !(1..=SIDE_LIMIT).contains(side))
    {
        return Err(Error::Usage(format!(
            "a picture of {width} x {height} pixels; expected 1 to {SIDE_LIMIT} per side"
        )));
    }
    atomic::write(path, |file: &mut dyn Write| {
        PngEncoder::new_with_quality(file, CompressionType::Default, FilterType::Adaptive)
            .write_image(bytes, width, height, color)
            .map_err(std::io::Error::other)
    })
}

/// Reads an 8-bit PNG picture: grey, RGB, or with a palette (which becomes RGB).
///
/// # Errors
/// [`Error::Io`] where the file cannot be read; [`Error::Input`] where it is damaged, no PNG, or beyond the limits;
/// [`Error::Unsupported`] for 16 bits per channel and for transparency.
pub fn read(path: &Path) -> Result<Picture> {
    let io = |e| Error::io("read", path, e);
    let mut file = File::open(path).map_err(io)?;
    let mut bytes = Vec::new();
    // The signature first: an endless device is not read to the limit.
    (&mut file)
        .take(SIGNATURE.len() as u64)
        .read_to_end(&mut bytes)
        .map_err(io)?;
    if bytes != SIGNATURE {
        let told = "does not begin like a PNG file; expected a PNG picture";
        return Err(Error::input(path, told));
    }
    file.take(FILE_LIMIT).read_to_end(&mut bytes).map_err(io)?;
    decode(path, &bytes)
}

fn decode(path: &Path, bytes: &[u8]) -> Result<Picture> {
    let bad = |message: String| Error::input(path, message);
    let damaged = |e: image::ImageError| {
        bad(format!(
            "is no readable PNG picture ({e}); write it again with another program"
        ))
    };
    let file_bytes = bytes.len() as u64;
    let most_bytes = file_bytes * DEFLATE_RATIO * EXPANSION;
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(SIDE_LIMIT);
    limits.max_image_height = Some(SIDE_LIMIT);
    // The decoder's own buffers: a picture, and what its compressed chunks may hold.
    limits.max_alloc = Some((most_bytes + (1 << 20)).min(2 * FILE_LIMIT));
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits.clone());
    let mut decoder = decoder.map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    if width > SIDE_LIMIT || height > SIDE_LIMIT {
        return Err(bad(format!(
            "claims {width} x {height} pixels; expected at most {SIDE_LIMIT} per side"
        )));
    }
    if decoder.total_bytes() > most_bytes {
        return Err(bad(format!(
            "claims {width} x {height} pixels, more than its {file_bytes} bytes can hold; it is damaged or cut off"
        )));
    }
    decoder.set_limits(limits).map_err(damaged)?;
    let color = decoder.color_type();
    let channels = match color {
        ColorType::L8 => 1,
        ColorType::Rgb8 => 3,
        other => {
            return Err(Error::Unsupported(format!(
                "{}: pixels are {other:?}; expected 8-bit grey or RGB without alpha: convert it first",
                path.display()
            )));
        }
    };
    let mut pixels = vec![0; width as usize * height as usize * channels];
    decoder.read_image(&mut pixels).map_err(damaged)?;
    let picture = if channels == 1 {
        Grid::new(width, height, pixels).map(Picture::Grey)
    } else {
        let (rgb, _) = pixels.as_chunks::<3>();
        Grid::new(width, height, rgb.to_vec()).map(Picture::Rgb)
    };
    picture.ok_or_else(|| Error::Internal("a PNG picture changed its size".into()))
}
