//! A rectangle of pixels.

use crate::num::fixed::SubpixelBits;

/// Pixels with `x0 <= x < x1` and `y0 <= y < y1`; empty where a lower bound is not below its upper bound.
///
/// A region limits loops over pixels. It never clips geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PixelRect {
    /// First column.
    pub x0: i32,
    /// First row.
    pub y0: i32,
    /// One past the last column.
    pub x1: i32,
    /// One past the last row.
    pub y1: i32,
}

impl PixelRect {
    /// No pixel at all; the neutral element of [`PixelRect::union`].
    pub const EMPTY: Self = Self::new([i32::MAX, i32::MIN], [i32::MAX, i32::MIN]);

    /// The pixels of some columns and rows, each from the first to one past the last.
    const fn new([x0, x1]: [i32; 2], [y0, y1]: [i32; 2]) -> Self {
        Self { x0, y0, x1, y1 }
    }

    /// All pixels of an image.
    pub const fn image(width: u32, height: u32) -> Self {
        Self::new([0, width as i32], [0, height as i32])
    }

    /// Pixels whose centres lie in a box of sub-pixels, borders included; the snapped corners of a triangle span it.
    #[inline]
    pub fn with_centers_in(
        [x_min, x_max]: [i32; 2],
        [y_min, y_max]: [i32; 2],
        bits: SubpixelBits,
    ) -> Self {
        let half = bits.scale() / 2;
        let first = |v: i32| (v - half + bits.scale() - 1) >> bits.bits();
        let last = |v: i32| (v - half) >> bits.bits();
        let columns = [first(x_min), last(x_max) + 1];
        Self::new(columns, [first(y_min), last(y_max) + 1])
    }

    /// One pixel.
    #[inline]
    pub const fn pixel(x: i32, y: i32) -> Self {
        Self::new([x, x + 1], [y, y + 1])
    }

    /// True where it has no pixel.
    #[inline]
    pub const fn is_empty(self) -> bool {
        self.x0 >= self.x1 || self.y0 >= self.y1
    }

    /// The pixels in both.
    #[inline]
    pub fn intersection(self, other: Self) -> Self {
        Self {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        }
    }

    /// The smallest region that contains both; an empty one adds nothing.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        if other.is_empty() {
            return self;
        }
        if self.is_empty() {
            return other;
        }
        Self {
            x0: self.x0.min(other.x0),
            y0: self.y0.min(other.y0),
            x1: self.x1.max(other.x1),
            y1: self.y1.max(other.y1),
        }
    }

    /// Columns.
    #[inline]
    pub fn width(self) -> usize {
        if self.is_empty() {
            0
        } else {
            (self.x1 - self.x0) as usize
        }
    }

    /// Rows.
    #[inline]
    pub fn height(self) -> usize {
        if self.is_empty() {
            0
        } else {
            (self.y1 - self.y0) as usize
        }
    }
}
