//! A camera as the rasterizer sees it: a matrix, an eye, and how surfaces look from it.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::num::fixed::SubpixelBits;

/// Rows of the clip-from-world matrix: `clip_i = ((m_i0 x + m_i1 y) + m_i2 z) + m_i3`, in that order.
///
/// Visible points have `-w <= x <= w`, `-w <= y <= w` (y up) and `0 <= z <= w`, with z/w = 0 at the near plane.
pub type Matrix = [[f64; 4]; 4];

/// Where the viewer is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye {
    /// Perspective: the centre of projection.
    Point(DVec3),
    /// Orthographic: the unit direction from the scene towards the viewer.
    Axis(DVec3),
}

/// Which triangles are not drawn, by the side they show. A front is counter-clockwise on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

/// Where intensities are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Interpolation {
    /// Once per triangle, at its centroid, with its own normal.
    #[default]
    Flat,
    /// At every vertex, with area-weighted normals; interpolated perspective-correctly.
    Gouraud,
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

/// How surfaces are shaded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shading {
    /// Flat or Gouraud.
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

/// Where the light is.
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
    /// Where the viewer is.
    pub eye: Eye,
    /// Distance from the eye (orthographic: from the plane z = 0 of the camera) to the near plane.
    pub near: f64,
    /// Distance to the far plane.
    pub far: f64,
    /// Which triangles are left out.
    pub cull: Cull,
    /// How surfaces are shaded.
    pub shading: Shading,
    /// Where the light is.
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
