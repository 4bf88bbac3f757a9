//! Half of space, on one side of a plane.

use glam::DVec3;

use crate::num::math;

/// The points `p` with `normal . p <= offset`; the normal has unit length and points out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Unit normal, out of the half-space.
    pub normal: DVec3,
    /// Offset of the plane along the normal.
    pub offset: f64,
}

impl HalfSpace {
    /// The half-space behind a plane through `point`; `None` where the normal has no direction.
    pub fn behind(point: DVec3, normal: DVec3) -> Option<Self> {
        let normal = math::unit(normal)?;
        let offset = normal.dot(point);
        Some(Self { normal, offset })
    }

    /// Distance of `p` from the half-space; negative inside.
    #[inline]
    pub fn excess(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }

    /// The other side of the plane.
    pub fn complement(&self) -> Self {
        Self {
            normal: -self.normal,
            offset: -self.offset,
        }
    }
}
