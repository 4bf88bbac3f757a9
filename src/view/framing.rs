//! Placing cameras: matrices from an eye, a target, an up-vector and a field of view of 60 degrees.
//!
//! Lindstrom & Turk 2000, section 3.2: viewpoints lie on a sphere of twice the radius R of the minimum bounding sphere
//! and look at its centre with 60 degrees, so that the sphere is exactly contained in the shorter side of the image
//! (asin(R / 2R) = 30 degrees); near = R and far = 3R enclose it. Orthographic views (Zhang & Turk 2002) stand at the
//! same distance and frame the same sphere.
//!
//! **Up-vectors** ("are varied uniformly" in the paper, which does not say how). View i of n is rolled about its view
//! axis by 2 pi i / n from its canonical up-vector: the part of +y perpendicular to the axis or, where the axis is
//! within 25.8 degrees of +-y (|y| > 0.9), the part of +z. Counter-clockwise seen by the viewer. No view is
//! degenerate, and the rolls of a set cover the circle evenly.
//!
//! The unit of clip space is the power of two above `near`: in the working frame of the mesh `w` is then the depth in
//! frame units, and a view has the same clip coordinates in every frame.

use glam::DVec3;

use super::{
    Cull, Eye, Light, Matrix, Shading, View,
    sphere::{Sphere, usable_radius},
};
use crate::num::{
    Each, Frame,
    math::{self, scale_by_power_of_two},
};

/// Projection of a scene onto an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// From a point, with a field of view of 60 degrees along the shorter side of the image.
    #[default]
    Perspective,
    /// Along an axis.
    Orthographic,
}

impl Projection {
    /// Orthographic where that is asked for, else perspective.
    pub(crate) fn of(orthographic: bool) -> Self {
        if orthographic {
            Self::Orthographic
        } else {
            Self::Perspective
        }
    }
}

/// 1 / tan 30 degrees, the square root of 3 rounded to nearest: half the field of view is 30 degrees.
const COTANGENT_OF_30_DEGREES: f64 = 1.732_050_807_568_877_2;

/// Beyond this |y| of the view axis the canonical up-vector comes from +z.
const STEEP: f64 = 0.9;

/// Right, up and backward (towards the viewer): a right-handed orthonormal basis.
#[derive(Clone, Copy, Debug)]
struct Basis {
    right: DVec3,
    up: DVec3,
    back: DVec3,
}

impl Basis {
    fn new(back: DVec3, up: DVec3) -> Option<Self> {
        let back = math::unit(back)?;
        let right = math::unit(up.cross(back))?;
        Some(Self {
            right,
            up: back.cross(right),
            back,
        })
    }
}

impl View {
    /// A perspective view from `eye` to `target` with 60 degrees along the shorter side and square pixels.
    ///
    /// `None` where `eye` is `target`, `up` is zero or parallel to the view axis, a number is not finite, or not
    /// `0 < near < far`. Sizes are in pixels, at least 1.
    #[must_use]
    pub fn perspective(
        [eye, target, up]: [DVec3; 3],
        [near, far]: [f64; 2],
        [width, height]: [u32; 2],
    ) -> Option<Self> {
        let factors = full_view([width, height]);
        Self::perspective_along(eye, eye - target, up, [near, far], factors)
    }

    /// An orthographic view along `-axis` onto `sphere`, which touches the shorter side of the image; `near` and `far`
    /// touch it too, at one and three radii from the camera.
    ///
    /// `None` where `axis` or `up` is zero or one is parallel to the other, or a number is not finite.
    #[must_use]
    pub fn orthographic(
        sphere: &Sphere,
        axis: DVec3,
        up: DVec3,
        [width, height]: [u32; 2],
    ) -> Option<Self> {
        let basis = Basis::new(axis, up)?;
        let radius = usable_radius(sphere);
        let shorter = f64::from(width.min(height));
        let row = |direction: DVec3, factor: f64, offset: f64| {
            let r = direction * factor;
            [r.x, r.y, r.z, offset - r.dot(sphere.center)]
        };
        let matrix = [
            row(basis.right, shorter / f64::from(width) / radius, 0.0),
            row(basis.up, shorter / f64::from(height) / radius, 0.0),
            row(-basis.back, 0.5 / radius, 0.5),
            [0.0, 0.0, 0.0, 1.0],
        ];
        Self::finite(matrix, Eye::Axis(basis.back), radius, 3.0 * radius)
    }

    /// View `index` of `count` onto `sphere` from `direction` (towards the viewer), rolled by the rule above.
    ///
    /// `None` where `direction` is zero or a number is not finite; `count` is at least 1.
    #[must_use]
    pub fn around(
        sphere: &Sphere,
        direction: DVec3,
        [index, count]: [usize; 2],
        size: [u32; 2],
        projection: Projection,
    ) -> Option<Self> {
        let back = math::unit(direction)?;
        let up = rolled_up(back, index, count)?;
        match projection {
            Projection::Perspective => {
                let radius = usable_radius(sphere);
                let eye = sphere.center + back * (2.0 * radius);
                // The axis is `back` itself: taking it from rounded positions would lose bits far from the origin.
                Self::perspective_along(eye, back, up, [radius, 3.0 * radius], full_view(size))
            }
            Projection::Orthographic => Self::orthographic(sphere, back, up, size),
        }
    }

    /// [`View::perspective`] with the view axis instead of a target, and the cotangents of half the fields of view along
    /// the rows and the columns of the image.
    pub(super) fn perspective_along(
        eye: DVec3,
        back: DVec3,
        up: DVec3,
        [near, far]: [f64; 2],
        [x, y]: [f64; 2],
    ) -> Option<Self> {
        if !(near > 0.0 && near < far && far.is_finite()) {
            return None;
        }
        let basis = Basis::new(back, up)?;
        let unit = Frame::for_size(near).exponent;
        let row = |direction: DVec3, factor: f64, offset: f64| {
            let r = direction * factor;
            [r.x, r.y, r.z, offset - r.dot(eye)].each(|m| scale_by_power_of_two(m, -unit))
        };
        let slope = far / (far - near);
        let forward = -basis.back;
        let matrix = [
            row(basis.right, x, 0.0),
            row(basis.up, y, 0.0),
            row(forward, slope, -(near * slope)),
            row(forward, 1.0, 0.0),
        ];
        Self::finite(matrix, Eye::Point(eye), near, far)
    }

    /// With the default shading, light and culling; `None` where a number is not finite.
    fn finite(matrix: Matrix, eye: Eye, near: f64, far: f64) -> Option<Self> {
        let numbers = matrix.iter().flatten();
        let finite = numbers.chain([&near, &far]).all(|x| x.is_finite());
        finite.then_some(Self {
            matrix,
            eye,
            near,
            far,
            cull: Cull::None,
            shading: Shading::default(),
            light: Light::Headlight,
        })
    }

    /// The same view of the same scene in units of `frame`.
    ///
    /// All four clip coordinates of a point are the same bits in both units (columns 0 to 2 of the matrix scale
    /// inversely to the positions), hence so is every image. Exact unless a number over- or underflows.
    #[must_use]
    pub fn enter_frame(&self, frame: Frame) -> Self {
        self.scaled(-frame.exponent)
    }

    /// Undoes [`View::enter_frame`].
    #[must_use]
    pub fn leave_frame(&self, frame: Frame) -> Self {
        self.scaled(frame.exponent)
    }

    /// Lengths times `2^exponent`.
    fn scaled(&self, exponent: i32) -> Self {
        let length = |x: f64| scale_by_power_of_two(x, exponent);
        let point = |p: DVec3| DVec3::new(length(p.x), length(p.y), length(p.z));
        Self {
            matrix: self.matrix.each(|[x, y, z, offset]| {
                let [x, y, z] = [x, y, z].each(|m| scale_by_power_of_two(m, -exponent));
                [x, y, z, offset]
            }),
            eye: match self.eye {
                Eye::Point(p) => Eye::Point(point(p)),
                axis @ Eye::Axis(_) => axis,
            },
            near: length(self.near),
            far: length(self.far),
            light: match self.light {
                Light::Point(p) => Light::Point(point(p)),
                light => light,
            },
            ..*self
        }
    }
}

/// The cotangents of half the fields of view along the rows and the columns of an image: 60 degrees along its shorter side.
fn full_view([width, height]: [u32; 2]) -> [f64; 2] {
    let shorter = f64::from(width.min(height));
    [width, height].each(|side| COTANGENT_OF_30_DEGREES * (shorter / f64::from(side)))
}

/// The up-vector of view `index` of `count` along the unit vector `back`, by the rule in the file's first lines.
pub(super) fn rolled_up(back: DVec3, index: usize, count: usize) -> Option<DVec3> {
    let steep = back.y.abs() > STEEP;
    let reference = if steep { DVec3::Z } else { DVec3::Y };
    let Basis { right, up, .. } = Basis::new(back, reference)?;
    let angle = std::f64::consts::TAU * (index as f64 / count as f64);
    // Counter-clockwise for the viewer: from up towards the left.
    Some(up * math::cos(angle) - right * math::sin(angle))
}
