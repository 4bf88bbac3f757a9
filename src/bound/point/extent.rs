//! The extent of the validity region of a point in a direction, over a view cell (section 4 of the paper).

use glam::DVec3;

use super::{
    Aperture,
    candidates::{Question, ask},
    edge::Edge,
    plane,
    viewpoint::extent_from,
};
use crate::{bound::view_cell::ViewCell, num::math::unit};

/// The distance that a point may move in a direction, and the viewpoint that limits it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// In the units of the positions; infinite where no viewpoint limits it.
    pub length: f64,
    /// The viewpoint that limits it most (the point itself where that lies in the cell); `None` where none does, or
    /// where no single one does: Theta = 0 and a cell without corners.
    pub viewpoint: Option<DVec3>,
}

/// Distance that `point` may move along `direction` (any length but 0) before a viewer in the cell sees it move by more
/// than the aperture. 0 where the point lies in the cell; infinite where nobody sees such a move, or for no direction.
///
/// It is the extent of a viewpoint of the cell, and no other viewpoint has a smaller one but for rounding: up to some
/// 1e-9 of it. Positions should have magnitudes near 1. Cost: less than a microsecond for each face and edge.
pub fn extent(cell: &ViewCell, point: DVec3, direction: DVec3, aperture: Aperture) -> Extent {
    let extent = |length, viewpoint| Extent { length, viewpoint };
    let found = extent(f64::INFINITY, None);
    let Some(direction) = unit(direction) else {
        return found;
    };
    if cell.contains(point) {
        return extent(0.0, Some(point));
    }
    let mut least = Least {
        point,
        direction,
        aperture,
        found,
    };
    if aperture.sin() > 0.0 {
        ask(cell, &mut least);
        return least.found;
    }
    // Theta = 0: whoever does not look along the direction sees every move.
    let Some(corners) = cell.corners() else {
        return extent(0.0, None);
    };
    for &corner in corners {
        least.take(corner);
    }
    least.found
}

struct Least {
    point: DVec3,
    direction: DVec3,
    aperture: Aperture,
    found: Extent,
}

impl Question for Least {
    fn on_edge(&self, edge: &Edge) -> Option<DVec3> {
        edge.max_viewpoint(self.point, self.direction, self.aperture)
    }

    fn on_plane(&self, origin: DVec3, normal: DVec3) -> [Option<DVec3>; 2] {
        plane::max_viewpoints([origin, normal], self.point, self.direction, self.aperture)
    }

    fn take(&mut self, viewpoint: DVec3) {
        let length = extent_from(viewpoint, self.point, self.direction, self.aperture);
        if length < self.found.length {
            let viewpoint = Some(viewpoint);
            self.found = Extent { length, viewpoint };
        }
    }
}
