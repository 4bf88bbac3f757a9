//! A camera as the rasterizer sees it: a matrix, an eye, and how surfaces look from it.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::{
    Error, Result,
    num::{Frame, fixed::SubpixelBits},
};

/// Largest number of samples in a row or column of an image: what the fixed-point rasterizer has bits for.
pub const SIDE_LIMIT: u32 = 4_096;

/// Rows of the clip-from-world matrix: `clip_i = ((m_i0 x + m_i1 y) + m_i2 z) + m_i3`, in that order.
///
/// Visible points have `-w <= x <= w`, `-w <= y <= w` (y up) and `0 <= z <= w`, with z/w = 0 at the near plane.
pub type Matrix = [[f64; 4]; 4];

/// Position of the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye {
    /// Perspective: the centre of projection.
    Point(DVec3),
    /// Orthographic: the unit direction from the scene towards the viewer.
    Axis(DVec3),
}

/// Side of triangles that is not drawn. A front is counter-clockwise on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Cull {
    /// All are drawn.
    #[default]
    None,
    /// Those that show their back are not.
    Back,
    /// Those that show their front are not: interiors become visible.
    Front,
}

/// Points at which intensities are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Interpolation {
    /// Once per triangle, at its centroid, with its own normal.
    #[default]
    Flat,
    /// At every vertex, with area-weighted normals; interpolated perspective-correctly.
    Gouraud,
    /// At every corner, with the normal stored there, or the triangle's own where there is none; interpolated
    /// perspective-correctly.
    Lit,
}

/// A specular term for a light at the eye: intensity `(1 - strength) d + strength d^exponent` with `d = |n . l|`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Specular {
    /// Share of the specular term, in [0, 1].
    pub strength: f64,
    /// Sharpness, at least 1.
    pub exponent: u32,
}

/// Shading of surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shading {
    /// Flat, Gouraud or lit.
    pub interpolation: Interpolation,
    /// True: `|n . l|`; false: `max(0, n . l)`.
    pub two_sided: bool,
    /// An optional specular term.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specular: Option<Specular>,
}

impl Default for Shading {
    fn default() -> Self {
        Self {
            interpolation: Interpolation::Flat,
            two_sided: true,
            specular: None,
        }
    }
}

/// Position of the light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Light {
    /// At the eye; for an orthographic view, along the view axis.
    #[default]
    Headlight,
    /// At a point.
    Point(DVec3),
    /// Far away, in this unit direction from the scene.
    Direction(DVec3),
}

/// One view of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Clip space from world space.
    pub matrix: Matrix,
    /// Position of the viewer.
    pub eye: Eye,
    /// Distance from the eye (orthographic: from the plane z = 0 of the camera) to the near plane.
    pub near: f64,
    /// Distance to the far plane.
    pub far: f64,
    /// Side of triangles that is left out.
    pub cull: Cull,
    /// Shading of surfaces.
    pub shading: Shading,
    /// Position of the light.
    pub light: Light,
}

/// Views that share an image format.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewSet {
    /// Pixels in a row, 1 to 4096 / `samples`.
    pub width: u32,
    /// Pixels in a column, 1 to 4096 / `samples`.
    pub height: u32,
    /// Samples per pixel along each axis: 1, 2 or 4. They are summed as integers.
    pub samples: u32,
    /// Sub-pixel bits of the rasterizer.
    pub subpixel: SubpixelBits,
    /// Luma of pixels that nothing covers.
    pub background: u8,
    /// The views.
    pub views: Vec<View>,
}

impl ViewSet {
    /// With `samples` x `samples` samples per pixel.
    ///
    /// # Errors
    /// As [`ViewSet::check_size`].
    pub fn with_samples(mut self, samples: u32) -> Result<Self> {
        self.samples = samples;
        self.check_size()?;
        Ok(self)
    }

    /// With another sub-pixel grid.
    #[must_use]
    pub fn with_subpixel(mut self, subpixel: SubpixelBits) -> Self {
        self.subpixel = subpixel;
        self
    }

    /// With `shading` in every view.
    #[must_use]
    pub fn with_shading(mut self, shading: Shading) -> Self {
        for view in &mut self.views {
            view.shading = shading;
        }
        self
    }

    /// With `cull` in every view.
    #[must_use]
    pub fn with_cull(mut self, cull: Cull) -> Self {
        for view in &mut self.views {
            view.cull = cull;
        }
        self
    }

    /// With fronts culled in `count` of the views, spread evenly over their order, so that these show interiors
    /// (Lindstrom & Turk 2000, section 5.2).
    ///
    /// # Errors
    /// [`Error::Usage`] where there are fewer views.
    pub fn with_interior_views(mut self, count: usize) -> Result<Self> {
        let total = self.views.len();
        if count > total {
            let told = format!("{count} interior views of {total}; expected at most {total}");
            return Err(Error::Usage(told));
        }
        for (i, view) in self.views.iter_mut().enumerate() {
            if (i + 1) * count / total > i * count / total {
                view.cull = Cull::Front;
            }
        }
        Ok(self)
    }

    /// Refuses sizes that the rasterizer has no bits for.
    ///
    /// # Errors
    /// [`Error::Usage`] unless `samples` is 1, 2 or 4 and each side has 1 to `SIDE_LIMIT` samples.
    pub fn check_size(&self) -> Result<()> {
        let (width, height, samples) = (self.width, self.height, self.samples);
        if ![1, 2, 4].contains(&samples) {
            return Err(Error::Usage(format!(
                "{samples} samples per pixel along each axis; expected 1, 2 or 4"
            )));
        }
        let limit = SIDE_LIMIT / samples;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(Error::Usage(format!(
                "images of {width} x {height} pixels; expected sides of 1 to {limit} pixels with {samples} x \
                 {samples} samples each"
            )));
        }
        Ok(())
    }

    /// The same views of the same scene in units of `frame`; the images are the same, bit for bit.
    #[must_use]
    pub fn enter_frame(&self, frame: Frame) -> Self {
        Self {
            views: self.views.iter().map(|v| v.enter_frame(frame)).collect(),
            ..self.clone()
        }
    }

    /// Undoes [`ViewSet::enter_frame`].
    #[must_use]
    pub fn leave_frame(&self, frame: Frame) -> Self {
        Self {
            views: self.views.iter().map(|v| v.leave_frame(frame)).collect(),
            ..self.clone()
        }
    }
}
