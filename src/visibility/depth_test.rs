//! The depth test for triangles that no pixel shows: hidden, or too small to hit a pixel centre?
//!
//! Zhang & Turk 2002, section 4, end: "the depth at any of its vertices is within a tolerance to the depth of a
//! neighbor pixel". Neither the tolerance nor the neighbourhood is given: here a vertex may be no more than one pixel's
//! size deeper than one of the 3 x 3 pixels around it.
//!
//! The default extends the plane of the triangle that the vertex's pixel shows to the vertex itself, so that a slope is
//! not mistaken for an obstacle, and asks the centroid too. A triangle that covers a sample is large enough to be shown:
//! where it is not, it is hidden, although a vertex of it may be seen.
//! Units: columns and rows in 1/65,536 pixel, depth in 2^-32 of the diameter of the bounding sphere, away from the
//! camera.

use glam::DVec3;

use super::UnseenRule;
use crate::{
    num::{
        Each,
        fixed::{SubpixelBits, depth},
    },
    raster::{Grid, SampleKey, Scene},
    view::View,
};

/// Depth behind a plane at which a point still counts as on it, in pixels.
const PLANE_TOLERANCE: f64 = 0.02;

/// Depth behind a neighbouring pixel at which a vertex is still visible, in pixels.
const NEIGHBOR_TOLERANCE: f64 = 1.0;

/// Units in a pixel, and half of them: pixel centres.
const PIXEL: i32 = 1 << 16;
const HALF: i32 = PIXEL / 2;

/// The range of depth in its units.
const DEPTH_RANGE: f64 = 4_294_967_296.0;

/// A vertex on the screen.
#[derive(Clone, Copy, Debug, Default)]
struct Point {
    x: i32,
    y: i32,
    depth: u32,
    visible: bool,
}

/// The plane that a pixel shows: depth at its centre, and its change for a unit to the right and down.
#[derive(Clone, Copy, Debug)]
struct Slope {
    center: f64,
    x: f64,
    y: f64,
}

/// The vertices that a view sees, by the depths around them.
#[derive(Clone, Debug, Default)]
pub(super) struct DepthTest {
    rule: UnseenRule,
    /// Pixels in a row and column.
    size: i32,
    tolerance: f64,
    points: Vec<Point>,
    /// The plane that every pixel shows; for the rule of neighbours the greatest depth around it, flat.
    slopes: Vec<Slope>,
}

impl DepthTest {
    /// Tests the vertices of a scene in a view whose picture has these keys.
    pub(super) fn prepare(
        &mut self,
        rule: UnseenRule,
        scene: &Scene,
        view: &View,
        keys: &Grid<SampleKey>,
    ) {
        self.rule = rule;
        self.size = keys.width() as i32;
        if rule == UnseenRule::Pixels {
            return;
        }
        let side = f64::from(keys.width());
        let [column, line, inwards, _] = &view.matrix;
        let row = |m: &[f64; 4], p: DVec3| ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3];
        let snap = |x: f64| SubpixelBits::Sixteen.snap(x);
        self.points.clear();
        // An orthographic view has w = 1.
        self.points.extend(scene.positions().iter().map(|&p| Point {
            x: snap((row(column, p) * 0.5 + 0.5) * side),
            y: snap((0.5 - row(line, p) * 0.5) * side),
            depth: depth(row(inwards, p)),
            visible: false,
        }));
        let pixels = if rule == UnseenRule::Plane {
            self.extend_planes(scene, keys);
            PLANE_TOLERANCE
        } else {
            self.deepest_neighbors(keys);
            NEIGHBOR_TOLERANCE
        };
        self.tolerance = pixels * (DEPTH_RANGE / side);
        let mut points = std::mem::take(&mut self.points);
        for point in &mut points {
            let (x, y) = (f64::from(point.x), f64::from(point.y));
            point.visible = self.is_visible(x, y, f64::from(point.depth));
        }
        self.points = points;
    }

    /// True where a triangle that no pixel shows is visible.
    #[inline]
    pub(super) fn sees(&self, corners: [u32; 3]) -> bool {
        if self.rule == UnseenRule::Pixels {
            return false;
        }
        let [a, b, c] = corners.each(|v| self.points[v as usize]);
        if a.visible || b.visible || c.visible {
            return true;
        }
        if self.rule != UnseenRule::Plane {
            return false;
        }
        let third = |a: i32, b: i32, c: i32| f64::from(a + b + c) * (1.0 / 3.0);
        let depth = f64::from(a.depth) + f64::from(b.depth) + f64::from(c.depth);
        let (x, y) = (third(a.x, b.x, c.x), third(a.y, b.y, c.y));
        self.is_visible(x, y, depth * (1.0 / 3.0))
    }

    /// True where the rule holds only for a triangle that covers no sample, and this one may cover some: fast, and
    /// never wrongly false.
    #[inline]
    pub(super) fn may_cover(&self, corners: [u32; 3]) -> bool {
        if self.rule != UnseenRule::Plane {
            return false;
        }
        // The picture's vertices may be snapped to 1/256 pixel, which moves them by half of that.
        const MOVED: i32 = PIXEL / 512 + 1;
        let [a, b, c] = corners.each(|v| self.points[v as usize]);
        let first = |a: i32, b: i32, c: i32| (a.min(b).min(c) - MOVED + HALF - 1) >> 16;
        let last = |a: i32, b: i32, c: i32| (a.max(b).max(c) + MOVED - HALF) >> 16;
        let (left, right) = (first(a.x, b.x, c.x), last(a.x, b.x, c.x));
        let (top, bottom) = (first(a.y, b.y, c.y), last(a.y, b.y, c.y));
        if left > right || top > bottom {
            return false;
        }
        if left < right || top < bottom {
            return true;
        }
        // One pixel centre: is it beyond an edge, wherever the corners were moved to?
        let [x, y] = [left, top].each(|at| i64::from(at * PIXEL + HALF));
        let side = |p: Point, q: Point| {
            let (dx, dy) = (i64::from(q.x - p.x), i64::from(q.y - p.y));
            let value = dx * (y - i64::from(p.y)) - dy * (x - i64::from(p.x));
            // Both ends of the edge, and both factors of the product.
            let margin = 4 * i64::from(MOVED) * (dx.abs() + dy.abs() + i64::from(PIXEL));
            i64::from(value > margin) - i64::from(value < -margin)
        };
        let sides = [side(a, b), side(b, c), side(c, a)];
        !(sides.contains(&1) && sides.contains(&-1))
    }

    fn extend_planes(&mut self, scene: &Scene, keys: &Grid<SampleKey>) {
        self.slopes.clear();
        let mut center_y = HALF;
        for row in keys.values().chunks(keys.width() as usize) {
            let mut center_x = HALF;
            for &key in row {
                self.slopes.push(match key {
                    SampleKey::BACKGROUND => Slope::flat(f64::INFINITY),
                    key => {
                        let corners = scene.triangles()[key.id() as usize];
                        let corners = corners.each(|v| self.points[v as usize]);
                        Slope::of(corners, center_x, center_y)
                            .unwrap_or_else(|| Slope::flat(f64::from(key.depth())))
                    }
                });
                center_x += PIXEL;
            }
            center_y += PIXEL;
        }
    }

    fn deepest_neighbors(&mut self, keys: &Grid<SampleKey>) {
        let size = self.size as usize;
        let depth = |x: usize, y: usize| match keys.values()[y * size + x] {
            SampleKey::BACKGROUND => f64::INFINITY,
            key => f64::from(key.depth()),
        };
        let around = |i: usize| i.saturating_sub(1)..(i + 2).min(size);
        self.slopes.clear();
        for y in 0..size {
            for x in 0..size {
                let mut deepest = 0.0;
                for y in around(y) {
                    for x in around(x) {
                        deepest = f64::max(deepest, depth(x, y));
                    }
                }
                self.slopes.push(Slope::flat(deepest));
            }
        }
    }

    #[inline]
    fn is_visible(&self, x: f64, y: f64, depth: f64) -> bool {
        // Rounding may put a point on the border of the image outside.
        let last = self.size - 1;
        let [column, row] = [x, y].each(|at| (at as i32 >> 16).clamp(0, last));
        let slope = self.slopes[(row * self.size + column) as usize];
        let [left, top] = [column, row].each(|at| f64::from(at * PIXEL + HALF));
        let (x, y) = (x - left, y - top);
        depth <= slope.center + (slope.x * x + slope.y * y) + self.tolerance
    }
}

impl Slope {
    fn flat(center: f64) -> Self {
        Self {
            center,
            x: 0.0,
            y: 0.0,
        }
    }

    /// The plane of a triangle around a pixel's centre; `None` where it is seen exactly from its edge.
    fn of([a, b, c]: [Point; 3], center_x: i32, center_y: i32) -> Option<Self> {
        let edge = |p: Point| {
            let depth = f64::from(p.depth) - f64::from(a.depth);
            DVec3::new(f64::from(p.x - a.x), f64::from(p.y - a.y), depth)
        };
        let normal = edge(b).cross(edge(c));
        if normal.z == 0.0 {
            return None;
        }
        let (x, y) = (-normal.x / normal.z, -normal.y / normal.z);
        let (from_x, from_y) = (f64::from(center_x - a.x), f64::from(center_y - a.y));
        Some(Self {
            center: f64::from(a.depth) + (x * from_x + y * from_y),
            x,
            y,
        })
    }
}
