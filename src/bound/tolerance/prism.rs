//! A triangle thickened along its normal (section 2).
//!
//! The walls stand on the edges, along the normal; the caps are the triangle moved up and down by the bound. The column
//! is the prism without its caps.

use glam::DVec3;

use super::HalfSpace;
use crate::{
    geometry::area_normal,
    num::{Each, math},
};

/// `sin` of the least corner below which a triangle has no normal to speak of.
const NEEDLE: f64 = 1e-6;

/// A triangle with its normal and the walls of its column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prism {
    /// The triangle's corners.
    pub points: [DVec3; 3],
    /// Its unit normal.
    pub normal: DVec3,
    /// The wall on the edge from every corner to the next one; the column is behind all three.
    pub walls: [HalfSpace; 3],
}

impl Prism {
    /// The column over a triangle; `None` for a needle.
    pub fn new(points: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = points;
        let cross = area_normal(points);
        let longest2 = [b - a, c - b, a - c]
            .each(|s| s.dot(s))
            .into_iter()
            .fold(0.0, f64::max);
        if cross.dot(cross) <= (NEEDLE * NEEDLE) * (longest2 * longest2) {
            return None;
        }
        let normal = math::unit(cross)?;
        let wall = |k: usize| {
            let (from, to) = (points[k], points[(k + 1) % 3]);
            HalfSpace::behind(from, (to - from).cross(normal))
        };
        Some(Self {
            points,
            normal,
            walls: [wall(0)?, wall(1)?, wall(2)?],
        })
    }

    /// Height of a point over the triangle's plane.
    #[inline]
    pub fn height(&self, p: DVec3) -> f64 {
        (p - self.points[0]).dot(self.normal)
    }

    /// The triangle moved along its normal.
    pub fn cap(&self, height: f64) -> [DVec3; 3] {
        self.points.each(|p| p + self.normal * height)
    }

    /// The prism of half-height `bound`: walls, then the upper and the lower cap.
    pub fn sides(&self, bound: f64) -> [HalfSpace; 5] {
        let plane = self.normal.dot(self.points[0]);
        let cap = |normal: DVec3, offset: f64| HalfSpace {
            normal,
            offset: offset + bound,
        };
        let [x, y, z] = self.walls;
        [x, y, z, cap(self.normal, plane), cap(-self.normal, -plane)]
    }
}
