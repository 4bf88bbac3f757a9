//! Triangles that no pixel shows: hidden, or too small to hit a pixel centre?
//!
//! Zhang & Turk 2002, section 4, end: "the depth at any of its vertices is within a tolerance to the depth of a
//! neighbor pixel". Neither the tolerance nor the neighbourhood is given: here one pixel's size and the 3 x 3 pixels
//! around the vertex. The default extends the plane of the triangle that the vertex's pixel shows to the vertex
//! itself, so that a slope is not mistaken for an obstacle, and asks the centroid too.
//! Units: pixels, in all three directions; depth grows away from the camera.

use super::{
    UnseenRule,
    picture::{EMPTY, IdPicture},
    subdivide::Pieces,
};
use crate::view::View;

/// How far behind a plane a point may lie and still count as on it, in pixels.
const PLANE_TOLERANCE: f64 = 0.02;

/// How much the depths of a vertex and a neighbouring pixel may differ, in pixels.
const NEIGHBOR_TOLERANCE: f64 = 1.0;

/// Which vertices a view sees, by the depths around them.
#[derive(Clone, Debug, Default)]
pub(super) struct DepthTest {
    size: usize,
    rule: UnseenRule,
    /// Column, row and depth of every vertex.
    points: Vec<[f64; 3]>,
    visible: Vec<bool>,
    /// Depth `p[0] x + p[1] y + p[2]` of the plane that every pixel shows.
    planes: Vec<[f64; 3]>,
    /// Depth at the centre of every pixel.
    depths: Vec<f64>,
}

impl DepthTest {
    /// Tests the vertices of `pieces` in a view that `picture` shows.
    pub(super) fn prepare(
        &mut self,
        rule: UnseenRule,
        pieces: &Pieces,
        view: &View,
        picture: &IdPicture,
        size: u32,
    ) {
        self.rule = rule;
        self.size = size as usize;
        if rule == UnseenRule::Pixels {
            return;
        }
        let side = f64::from(size);
        let row = |m: &[f64; 4], p: glam::DVec3| ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3];
        self.points.clear();
        // An orthographic view has w = 1.
        self.points.extend(pieces.positions.iter().map(|&p| {
            [
                (row(&view.matrix[0], p) * 0.5 + 0.5) * side,
                (0.5 - row(&view.matrix[1], p) * 0.5) * side,
                row(&view.matrix[2], p) * side,
            ]
        }));
        match rule {
            UnseenRule::Neighbors => {
                self.depths.clear();
                let depth = |&key: &u64| match key {
                    EMPTY => f64::INFINITY,
                    key => (key >> 32) as f64 * (side / 4_294_967_296.0),
                };
                self.depths.extend(picture.keys.iter().map(depth));
            }
            _ => self.extend_planes(pieces, picture, side),
        }
        let mut visible = std::mem::take(&mut self.visible);
        visible.clear();
        visible.extend(self.points.iter().map(|&p| self.is_visible(p)));
        self.visible = visible;
    }

    /// True where a piece that no pixel shows is visible.
    #[inline]
    pub(super) fn sees(&self, corners: [u32; 3]) -> bool {
        match self.rule {
            UnseenRule::Pixels => false,
            UnseenRule::Neighbors => corners.iter().any(|&v| self.visible[v as usize]),
            UnseenRule::Plane => {
                corners.iter().any(|&v| self.visible[v as usize]) || {
                    let [a, b, c] = corners.map(|v| self.points[v as usize]);
                    let third = |i: usize| ((a[i] + b[i]) + c[i]) / 3.0;
                    self.is_visible([third(0), third(1), third(2)])
                }
            }
        }
    }

    fn extend_planes(&mut self, pieces: &Pieces, picture: &IdPicture, side: f64) {
        self.planes.clear();
        for &key in &picture.keys {
            if key == EMPTY {
                self.planes.push([0.0, 0.0, f64::INFINITY]);
                continue;
            }
            let corners = pieces.triangles[key as u32 as usize];
            let [a, b, c] = corners.map(|v| glam::DVec3::from_array(self.points[v as usize]));
            let normal = (b - a).cross(c - a);
            let (x, y) = (-normal.x / normal.z, -normal.y / normal.z);
            let offset = a.z - (x * a.x + y * a.y);
            self.planes.push(if offset.is_finite() {
                [x, y, offset]
            } else {
                // Seen exactly from its edge.
                [0.0, 0.0, (key >> 32) as f64 * (side / 4_294_967_296.0)]
            });
        }
    }

    #[inline]
    fn is_visible(&self, [x, y, depth]: [f64; 3]) -> bool {
        // `as` saturates, and rounding may put a point on the border of the image outside.
        let (column, row) = (
            (x as usize).min(self.size - 1),
            (y as usize).min(self.size - 1),
        );
        if self.rule == UnseenRule::Plane {
            let [slope_x, slope_y, offset] = self.planes[row * self.size + column];
            return depth <= (slope_x * x + slope_y * y) + offset + PLANE_TOLERANCE;
        }
        let last = self.size - 1;
        (row.saturating_sub(1)..=(row + 1).min(last)).any(|y| {
            let start = y * self.size;
            self.depths[start + column.saturating_sub(1)..=start + (column + 1).min(last)]
                .iter()
                .any(|d| depth <= d + NEIGHBOR_TOLERANCE)
        })
    }
}
