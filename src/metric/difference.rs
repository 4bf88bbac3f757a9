//! The difference of two images: equal, or the places and sizes of differences.
//!
//! There is no tolerance: a pixel differs where any of its values does. Counts are pixels, magnitudes are levels
//! (for luma and colour) or the absolute difference of the numbers (for sums, ids and depth).

use std::fmt;

use serde::Serialize;

use crate::{Error, Result, num::Each, raster::Grid};

/// A pixel that can be compared value by value.
pub trait Pixel: Copy + PartialEq {
    /// Values in a pixel.
    const CHANNELS: usize;

    /// Value `channel` (below [`Pixel::CHANNELS`]) of the pixel.
    fn channel(self, channel: usize) -> u32;
}

macro_rules! number {
    ($($number:ty),*) => {$(
        impl Pixel for $number {
            const CHANNELS: usize = 1;

            fn channel(self, _: usize) -> u32 {
                self.into()
            }
        }
    )*};
}

number!(u8, u16, u32);

impl Pixel for [u8; 3] {
    const CHANNELS: usize = 3;

    fn channel(self, channel: usize) -> u32 {
        u32::from(self[channel])
    }
}

/// A pixel of 8-bit levels, of which a difference picture can be made.
pub trait Levels: Pixel {
    /// The pixel of `f` of every pair of levels.
    fn zip(self, other: Self, f: impl Fn(u8, u8) -> u8) -> Self;
}

impl Levels for u8 {
    fn zip(self, other: Self, f: impl Fn(u8, u8) -> u8) -> Self {
        f(self, other)
    }
}

impl Levels for [u8; 3] {
    fn zip(self, other: Self, f: impl Fn(u8, u8) -> u8) -> Self {
        [0, 1, 2].each(|c| f(self[c], other[c]))
    }
}

/// The result of comparing two images.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ImageComparison {
    /// Same size, same pixels.
    Equal,
    /// Different sizes: width and height of each.
    Sizes {
        /// Width and height of the expected image.
        expected: (u32, u32),
        /// Width and height of the actual image.
        actual: (u32, u32),
    },
    /// Same size, different pixels.
    Pixels(PixelDifference),
}

/// The places and sizes of the differences of two images of the same size.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PixelDifference {
    /// Pixels that differ, at least 1.
    pub count: u64,
    /// Pixels compared.
    pub pixels: u64,
    /// Largest absolute difference of every channel.
    pub largest: Vec<u32>,
    /// Column and row of the first pixel that differs, row by row from the top left.
    pub first: (u32, u32),
    /// The values expected there.
    pub expected: Vec<u32>,
    /// The values found there.
    pub actual: Vec<u32>,
    /// Smallest column and row of the pixels that differ.
    pub low: (u32, u32),
    /// Largest column and row of the pixels that differ; they belong to the box.
    pub high: (u32, u32),
}

impl ImageComparison {
    /// True where nothing differs.
    pub fn is_equal(&self) -> bool {
        *self == Self::Equal
    }
}

impl fmt::Display for ImageComparison {
    /// One sentence, such as `2 of 64 pixels differ, first at (3, 4): expected 128, found 130; ...`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Equal => write!(f, "equal"),
            Self::Sizes { expected, actual } => write!(
                f,
                "sizes differ: expected {} x {} pixels, found {} x {}",
                expected.0, expected.1, actual.0, actual.1
            ),
            Self::Pixels(d) => write!(
                f,
                "{} of {} pixels differ, first at ({}, {}): expected {}, found {}; all in columns {} to {} and rows \
                 {} to {}, by at most {}",
                d.count,
                d.pixels,
                d.first.0,
                d.first.1,
                List(&d.expected),
                List(&d.actual),
                d.low.0,
                d.high.0,
                d.low.1,
                d.high.1,
                List(&d.largest),
            ),
        }
    }
}

/// `7` for one value, `(1, 2, 3)` for several.
struct List<'a>(&'a [u32]);

impl fmt::Display for List<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [value] = self.0 {
            return write!(f, "{value}");
        }
        for (i, value) in self.0.iter().enumerate() {
            write!(f, "{}{value}", if i == 0 { "(" } else { ", " })?;
        }
        write!(f, ")")
    }
}

/// Compares two images; O(pixels).
pub fn compare<P: Pixel>(expected: &Grid<P>, actual: &Grid<P>) -> ImageComparison {
    let size = |p: &Grid<P>| (p.width(), p.height());
    if size(expected) != size(actual) {
        return ImageComparison::Sizes {
            expected: size(expected),
            actual: size(actual),
        };
    }
    let values = |pixel: P| (0..P::CHANNELS).map(|c| pixel.channel(c)).collect();
    let mut found: Option<PixelDifference> = None;
    let pairs = expected.values().iter().zip(actual.values());
    for (i, (&e, &a)) in pairs.enumerate().filter(|(_, (e, a))| e != a) {
        let width = expected.width() as usize;
        let at = ((i % width) as u32, (i / width) as u32);
        let d = found.get_or_insert_with(|| PixelDifference {
            count: 0,
            pixels: expected.values().len() as u64,
            largest: vec![0; P::CHANNELS],
            first: at,
            expected: values(e),
            actual: values(a),
            low: at,
            high: at,
        });
        d.count += 1;
        for (c, largest) in d.largest.iter_mut().enumerate() {
            *largest = (*largest).max(e.channel(c).abs_diff(a.channel(c)));
        }
        d.low = (d.low.0.min(at.0), d.low.1.min(at.1));
        d.high = (d.high.0.max(at.0), d.high.1.max(at.1));
    }
    found.map_or(ImageComparison::Equal, ImageComparison::Pixels)
}

/// The signed difference picture: `128 + scale * (actual - expected)` in every channel, clamped to 0..=255.
///
/// Grey 128 means equal and nothing else does; brighter means that `actual` is brighter. `scale` 1 loses nothing up
/// to 127 levels; larger ones show smaller differences and saturate sooner.
///
/// # Errors
/// [`Error::Usage`] where the sizes differ or `scale` is 0.
pub fn signed_picture<P: Levels>(
    expected: &Grid<P>,
    actual: &Grid<P>,
    scale: u8,
) -> Result<Grid<P>> {
    let (width, height) = (expected.width(), expected.height());
    require_same_size(expected, actual, scale)?;
    let level = |e: u8, a: u8| {
        let shown = 128 + i32::from(scale) * (i32::from(a) - i32::from(e));
        shown.clamp(0, 255) as u8
    };
    let pixels = expected
        .values()
        .iter()
        .zip(actual.values())
        .map(|(&e, &a)| e.zip(a, level))
        .collect();
    Grid::new(width, height, pixels)
        .ok_or_else(|| Error::Internal("a difference picture changed its size".into()))
}

/// `expected` in grey, blended towards pure red by `scale * |actual - expected|` of 255 (clamped): differences in the
/// red channel as in Figure 8 of Zhang & Turk 2002, here on top of the picture they belong to. Where nothing differs it
/// is grey, and the reddest pixels differ most.
///
/// # Errors
/// [`Error::Usage`] where the sizes differ or `scale` is 0.
pub fn red_picture(expected: &Grid<u8>, actual: &Grid<u8>, scale: u8) -> Result<Grid<[u8; 3]>> {
    require_same_size(expected, actual, scale)?;
    let pixel = |(&e, &a): (&u8, &u8)| {
        let red = (u32::from(scale) * u32::from(e.abs_diff(a))).min(255);
        let rest = (u32::from(e) * (255 - red) + 127) / 255;
        // Both at most 255: a mean of the level and 255, and a share of the level.
        [(rest + red) as u8, rest as u8, rest as u8]
    };
    let pixels = expected.values().iter().zip(actual.values()).map(pixel);
    Grid::new(expected.width(), expected.height(), pixels.collect())
        .ok_or_else(|| Error::Internal("a difference picture changed its size".into()))
}

fn require_same_size<P: Copy>(expected: &Grid<P>, actual: &Grid<P>, scale: u8) -> Result<()> {
    let (width, height) = (expected.width(), expected.height());
    if (width, height) != (actual.width(), actual.height()) {
        return Err(Error::Usage(format!(
            "no difference picture of images of {width} x {height} and {} x {} pixels; expected the same size",
            actual.width(),
            actual.height()
        )));
    }
    if scale == 0 {
        return Err(Error::Usage(
            "a difference picture with scale 0 shows nothing; expected 1 to 255".into(),
        ));
    }
    Ok(())
}
