//! Equation 1: the largest angle under which viewers in a view cell see a point and its replacement apart.

use std::f64::consts::PI;

use glam::DVec3;

use super::{
    angle_from,
    candidates::{Question, ask},
    edge::Edge,
    plane,
};
use crate::bound::view_cell::ViewCell;

/// The largest angle under which a replacement is seen, and from where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointError {
    /// In [0, pi] radians; pi where the segment between both points meets the cell.
    pub radians: f64,
    /// A viewpoint of the cell that sees it; `None` where the angle is 0, or pi because of that meeting.
    pub viewpoint: Option<DVec3>,
}

/// The largest angle under which a viewer in the cell sees `point` and its replacement `moved` apart.
///
/// It is the angle of a viewpoint of the cell, and no other viewpoint has a larger one but for rounding: up to some
/// 1e-9 of it. Positions should have magnitudes near 1. Cost: less than a microsecond for each face and edge.
pub fn error(cell: &ViewCell, point: DVec3, moved: DVec3) -> PointError {
    let mut most = Most {
        point,
        moved,
        found: PointError {
            radians: 0.0,
            viewpoint: None,
        },
    };
    if point == moved {
        return most.found;
    }
    if cell.distance_to_hull(&[point, moved]) <= 0.0 {
        most.found.radians = PI;
        return most.found;
    }
    ask(cell, &mut most);
    most.found
}

struct Most {
    point: DVec3,
    moved: DVec3,
    found: PointError,
}

impl Question for Most {
    fn on_edge(&self, edge: &Edge) -> Option<DVec3> {
        edge.worst_viewpoint(self.point, self.moved)
    }

    fn on_plane(&self, origin: DVec3, normal: DVec3) -> [Option<DVec3>; 2] {
        plane::worst_viewpoints([origin, normal], self.point, self.moved)
    }

    fn take(&mut self, viewpoint: DVec3) {
        let radians = angle_from(viewpoint, self.point, self.moved);
        if radians > self.found.radians {
            self.found = PointError {
                radians,
                viewpoint: Some(viewpoint),
            };
        }
    }
}
