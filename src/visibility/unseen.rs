//! Triangles that no pixel shows: hidden, or too small to hit a pixel centre?
//!
//! Zhang & Turk 2002, section 4, end: "the depth at any of its vertices is within a tolerance to the depth of a
//! neighbor pixel". Neither the tolerance nor the neighbourhood is given: here a vertex may be no more than one pixel's
//! size deeper than one of the 3 x 3 pixels around it.
//!
//! The default extends the plane of the triangle that the vertex's pixel shows to the vertex itself, so that a slope is
//! not mistaken for an obstacle, and asks the centroid too. A triangle that covers a sample is large enough to be shown:
//! where it is not, it is hidden, although a vertex of it may be seen.
//! Units: pixels, in all three directions; depth grows away from the camera.

use glam::DVec3;

use super::{UnseenRule, sight::EMPTY};
use crate::{
    raster::{Plane, Scene},
    view::View,
};

/// How far behind a plane a point may lie and still count as on it, in pixels.
const PLANE_TOLERANCE: f64 = 0.02;

/// How much deeper than a neighbouring pixel a vertex may be, in pixels.
const NEIGHBOR_TOLERANCE: f64 = 1.0;

/// Which vertices a view sees, by the depths around them.
#[derive(Clone, Debug, Default)]
pub(super) struct DepthTest {
    rule: UnseenRule,
    /// Pixels in a row and column.
    size: usize,
    /// Column, row and depth of every vertex.
    points: Vec<DVec3>,
    visible: Vec<bool>,
    /// Depth `x p.x + y p.y + p.z` of the plane that every pixel shows.
    planes: Vec<DVec3>,
    /// The greatest depth around every pixel.
    depths: Vec<f64>,
}

impl DepthTest {
    /// Tests the vertices of a scene in a view whose picture has these keys.
    pub(super) fn prepare(
        &mut self,
        rule: UnseenRule,
        scene: &Scene,
        view: &View,
        keys: &Plane<u64>,
    ) {
        self.rule = rule;
        self.size = keys.width() as usize;
        if rule == UnseenRule::Pixels {
            return;
        }
        let side = f64::from(keys.width());
        let [column, line, depth, _] = &view.matrix;
        let row = |m: &[f64; 4], p: DVec3| ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3];
        self.points.clear();
        // An orthographic view has w = 1.
        self.points.extend(scene.positions().iter().map(|&p| {
            DVec3::new(
                (row(column, p) * 0.5 + 0.5) * side,
                (0.5 - row(line, p) * 0.5) * side,
                row(depth, p) * side,
            )
        }));
        let unit = side / 4_294_967_296.0;
        if rule == UnseenRule::Plane {
            self.extend_planes(scene, keys, unit);
        } else {
            self.deepest_neighbors(keys, unit);
        }
        let mut visible = std::mem::take(&mut self.visible);
        visible.clear();
        visible.extend(self.points.iter().map(|&p| self.is_visible(p)));
        self.visible = visible;
    }

    /// True where a triangle that no pixel shows is visible.
    #[inline]
    pub(super) fn sees(&self, corners: [u32; 3]) -> bool {
        match self.rule {
            UnseenRule::Pixels => false,
            UnseenRule::Neighbors => corners.iter().any(|&v| self.visible[v as usize]),
            UnseenRule::Plane => {
                corners.iter().any(|&v| self.visible[v as usize]) || {
                    let [a, b, c] = corners.map(|v| self.points[v as usize]);
                    self.is_visible(((a + b) + c) / 3.0)
                }
            }
        }
    }

    /// True where the rule holds only for a triangle that covers no sample, and this one might cover some.
    #[inline]
    pub(super) fn needs_gap(&self, corners: [u32; 3]) -> bool {
        if self.rule != UnseenRule::Plane {
            return false;
        }
        let [a, b, c] = corners.map(|v| self.points[v as usize]);
        // Snapping moves a corner by less than this.
        let margin = 1.0 / 256.0;
        let holds_center = |a: f64, b: f64, c: f64| {
            let (low, high) = (a.min(b).min(c) - margin, a.max(b).max(c) + margin);
            // Centres lie at 0.5, 1.5, ...; coordinates are positive up to rounding.
            ((low + 0.5).max(0.0) as u32) < ((high + 0.5).max(0.0) as u32)
        };
        holds_center(a.x, b.x, c.x) && holds_center(a.y, b.y, c.y)
    }

    fn extend_planes(&mut self, scene: &Scene, keys: &Plane<u64>, unit: f64) {
        self.planes.clear();
        for &key in keys.values() {
            if key == EMPTY {
                self.planes.push(DVec3::new(0.0, 0.0, f64::INFINITY));
                continue;
            }
            let corners = scene.triangles()[key as u32 as usize];
            let [a, b, c] = corners.map(|v| self.points[v as usize]);
            let normal = (b - a).cross(c - a);
            let (x, y) = (-normal.x / normal.z, -normal.y / normal.z);
            let offset = a.z - (x * a.x + y * a.y);
            self.planes.push(if offset.is_finite() {
                DVec3::new(x, y, offset)
            } else {
                // Seen exactly from its edge.
                DVec3::new(0.0, 0.0, (key >> 32) as f64 * unit)
            });
        }
    }

    fn deepest_neighbors(&mut self, keys: &Plane<u64>, unit: f64) {
        let (size, last) = (self.size, self.size - 1);
        let depth = |x: usize, y: usize| match keys.values()[y * size + x] {
            EMPTY => f64::INFINITY,
            key => (key >> 32) as f64 * unit,
        };
        self.depths.clear();
        for y in 0..size {
            for x in 0..size {
                let mut deepest = 0.0;
                for y in y.saturating_sub(1)..=(y + 1).min(last) {
                    for x in x.saturating_sub(1)..=(x + 1).min(last) {
                        let found = depth(x, y);
                        if found > deepest {
                            deepest = found;
                        }
                    }
                }
                self.depths.push(deepest);
            }
        }
    }

    #[inline]
    fn is_visible(&self, point: DVec3) -> bool {
        // `as` saturates, and rounding may put a point on the border of the image outside.
        let last = self.size - 1;
        let (column, row) = ((point.x as usize).min(last), (point.y as usize).min(last));
        let pixel = row * self.size + column;
        if self.rule == UnseenRule::Plane {
            let plane = self.planes[pixel];
            point.z <= (plane.x * point.x + plane.y * point.y) + plane.z + PLANE_TOLERANCE
        } else {
            point.z <= self.depths[pixel] + NEIGHBOR_TOLERANCE
        }
    }
}
