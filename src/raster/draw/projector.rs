//! From positions to sub-pixel integers.
//!
//! The transform is `f64` in one written order; the snap rounds ties to even. From here on pictures are integers.

use glam::DVec3;

use super::PixelRect;
use crate::{
    num::fixed::{SubpixelBits, depth},
    view::{Eye, View, ViewSet},
};

/// A point in clip space, before the division by `w`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipVertex {
    /// x, y, z, w.
    pub c: [f64; 4],
}

/// A vertex on the screen, or the mark that triangles with it need clipping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenVertex {
    /// Column, in sub-pixels from the left edge of the image.
    pub x: i32,
    /// Row, in sub-pixels from the top edge of the image, downwards.
    pub y: i32,
    /// Depth, in units of 2^-32; 0 at the near plane.
    pub depth: u32,
    /// 1/w, or 1 for an orthographic view.
    pub w_inverse: f64,
}

impl ScreenVertex {
    /// Behind the near plane, outside the guard band, or not finite: triangles with this vertex need clipping.
    pub const OUTSIDE: Self = Self {
        x: i32::MIN,
        y: i32::MIN,
        depth: 0,
        w_inverse: 0.0,
    };

    /// True for [`ScreenVertex::OUTSIDE`].
    #[inline]
    pub fn is_outside(&self) -> bool {
        self.x == i32::MIN
    }
}

/// The part of a [`ScreenVertex`] that coverage and depth need, in half the bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::rooms::raster) struct ScreenPoint {
    /// Column, in sub-pixels.
    pub(in crate::rooms::raster) x: i32,
    /// Row, in sub-pixels, downwards.
    pub(in crate::rooms::raster) y: i32,
    /// Depth, in units of 2^-32.
    pub(in crate::rooms::raster) depth: u32,
}

impl From<ScreenVertex> for ScreenPoint {
    #[inline]
    fn from(v: ScreenVertex) -> Self {
        Self {
            x: v.x,
            y: v.y,
            depth: v.depth,
        }
    }
}

impl ScreenPoint {
    /// See [`ScreenVertex::OUTSIDE`].
    pub(super) const OUTSIDE: Self = Self {
        x: i32::MIN,
        y: i32::MIN,
        depth: 0,
    };
}

/// The transform of one view for one image size.
#[derive(Clone, Debug)]
pub struct Projector {
    matrix: [[f64; 4]; 4],
    width: f64,
    height: f64,
    bits: SubpixelBits,
    perspective: bool,
    image: PixelRect,
}

impl Projector {
    /// The projector of a view of a set. The image counts samples: `width * samples` by `height * samples`.
    pub fn new(view: &View, set: &ViewSet) -> Self {
        let (width, height) = (set.width * set.samples, set.height * set.samples);
        Self {
            matrix: view.matrix,
            width: f64::from(width),
            height: f64::from(height),
            bits: set.subpixel,
            perspective: matches!(view.eye, Eye::Point(_)),
            image: PixelRect::image(width, height),
        }
    }

    /// The sub-pixel resolution.
    pub fn bits(&self) -> SubpixelBits {
        self.bits
    }

    /// All samples of the image.
    pub fn image(&self) -> PixelRect {
        self.image
    }

    /// Clip space from world space: `((m0 x + m1 y) + m2 z) + m3` for every row.
    #[inline]
    pub fn clip(&self, p: DVec3) -> ClipVertex {
        let row = |m: &[f64; 4]| ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3];
        ClipVertex {
            c: [
                row(&self.matrix[0]),
                row(&self.matrix[1]),
                row(&self.matrix[2]),
                row(&self.matrix[3]),
            ],
        }
    }

    /// Position on the screen in pixels, not yet snapped: `(X/W * 0.5 + 0.5) * width`, and y downwards.
    #[inline]
    fn viewport(&self, v: ClipVertex) -> (f64, f64) {
        let [x, y, _, w] = v.c;
        (
            (x / w * 0.5 + 0.5) * self.width,
            (0.5 - y / w * 0.5) * self.height,
        )
    }

    /// The position on the screen, or [`ScreenVertex::OUTSIDE`].
    #[inline]
    pub fn screen(&self, p: DVec3) -> ScreenVertex {
        match self.unclipped(p) {
            Some((v, x, y)) => self.snap(v, x, y),
            None => ScreenVertex::OUTSIDE,
        }
    }

    /// As [`Projector::screen`], without the attribute weight.
    #[inline]
    pub(super) fn point(&self, p: DVec3) -> ScreenPoint {
        match self.unclipped(p) {
            Some((v, x, y)) => ScreenPoint {
                x: self.bits.snap(x),
                y: self.bits.snap(y),
                depth: depth(v.c[2] / v.c[3]),
            },
            None => ScreenPoint::OUTSIDE,
        }
    }

    /// Clip space and pixels of a point that needs no clipping.
    #[inline]
    fn unclipped(&self, p: DVec3) -> Option<(ClipVertex, f64, f64)> {
        let v = self.clip(p);
        let [_, _, z, w] = v.c;
        let (x, y) = self.viewport(v);
        let band = self.bits.guard_band();
        // Written so that a NaN anywhere answers "outside".
        if z >= 0.0
            && w > 0.0
            && w < f64::INFINITY
            && x >= -band
            && x <= band
            && y >= -band
            && y <= band
        {
            Some((v, x, y))
        } else {
            None
        }
    }

    /// The snapped vertex for a point that clipping has made: it may leave the guard band by rounding.
    pub(super) fn screen_clipped(&self, v: ClipVertex) -> Option<ScreenVertex> {
        let (x, y) = self.viewport(v);
        let band = self.bits.guard_band() + 1.0;
        if v.c[3] > 0.0 && x >= -band && x <= band && y >= -band && y <= band {
            Some(self.snap(v, x, y))
        } else {
            None
        }
    }

    #[inline]
    fn snap(&self, v: ClipVertex, x: f64, y: f64) -> ScreenVertex {
        let [_, _, z, w] = v.c;
        ScreenVertex {
            x: self.bits.snap(x),
            y: self.bits.snap(y),
            depth: depth(z / w),
            w_inverse: if self.perspective { 1.0 / w } else { 1.0 },
        }
    }

    /// Signed distances to the planes that bound what can be snapped: near, then left, right, top, bottom of the
    /// guard band. Linear in clip space; inside is `>= 0`.
    pub(super) fn distances(&self, v: ClipVertex) -> [f64; 5] {
        let [x, y, z, w] = v.c;
        let band = self.bits.guard_band() * w;
        let column = (0.5 * x + 0.5 * w) * self.width;
        let row = (0.5 * w - 0.5 * y) * self.height;
        [z, band + column, band - column, band + row, band - row]
    }
}
