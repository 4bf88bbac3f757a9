//! The projection of a layout: faces around a collapsed edge in one plane, with a size near 1.

use glam::{DVec2, DVec3};

use super::layout::{Collapse, Face};
use crate::{
    geometry::{area_normal, axis_across},
    num::math::unit,
};

/// The map from space to the plane of the faces around a collapsed edge.
pub(super) struct Projection {
    origin: DVec3,
    axes: [DVec3; 2],
    scale: f64,
}

impl Projection {
    /// The projection along the mean normal of the faces before; `None` where they have none.
    pub(super) fn of(collapse: &Collapse<'_>) -> Option<Self> {
        let mut sum = DVec3::ZERO;
        for Face { points, .. } in collapse.removed {
            sum += area_normal(*points);
        }
        let normal = unit(sum)?;
        let across = unit(axis_across(normal).cross(normal))?;
        let origin = collapse.to;
        let reach = collapse.removed.iter().flat_map(|f| f.points);
        let reach = reach.fold(0.0_f64, |r, p| r.max((p - origin).abs().max_element()));
        let scale = 1.0 / reach;
        (reach > 0.0 && scale.is_finite()).then_some(Self {
            origin,
            axes: [across, normal.cross(across)],
            scale,
        })
    }

    /// A point in the plane.
    pub(super) fn of_point(&self, p: DVec3) -> DVec2 {
        let d = (p - self.origin) * self.scale;
        DVec2::new(d.dot(self.axes[0]), d.dot(self.axes[1]))
    }
}
