//! A triangle around a pixel: how far the centre is from its outline, how deep it is there and how steep.
//!
//! The triangle as no snap has moved it, cut at the near plane. In `f64`: distances are compared with a tolerance that
//! is a hundred million times their error. Pixels, and depths in units of 2^-32.

use super::intersect::{Four, Ray, Rays};
use crate::num::{Each, math::sqrt};

/// One past the largest depth.
const DEPTHS: f64 = 4_294_967_296.0;

/// A triangle seen from the centre of a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    /// Distance of the centre from the outline, positive inside; negative infinity where nothing is in front of the
    /// near plane.
    pub(super) distance: f64,
    /// Twice the area.
    pub(super) area: f64,
    /// Smallest height of the whole triangle on the screen.
    pub(super) height: f64,
    /// Depth of its plane at the centre.
    depth: f64,
    /// Change of the depth per pixel along the steepest direction.
    slope: f64,
    /// Least and greatest depth of its corners.
    range: [f64; 2],
}

impl Outline {
    pub(super) fn new(rays: &Rays<'_>, ray: Ray, triangle: [u32; 3]) -> Self {
        let [width, height] = rays.size.each(|side| side as f64);
        let corners = triangle.each(|v| {
            let [x, y, z, w] = rays.points[v as usize].each(|n| n.value);
            let (a, b) = (
                width * x - ray.column as f64 * w,
                height * y - ray.row as f64 * w,
            );
            [a, b, z, w]
        });
        let visible = in_front(&corners);
        let place = |[a, b, _, w]: &Four<f64>| [a / (2.0 * w), b / (2.0 * w)];
        let places: Vec<[f64; 2]> = visible.iter().map(place).collect();
        let depths = visible.iter().map(|[_, _, z, w]| z / w * DEPTHS);
        let range = depths.fold([f64::INFINITY, 0.0], |[low, high], z| {
            [
                if z < low { z } else { low },
                if z > high { z } else { high },
            ]
        });
        // z = alpha a + beta b + gamma w holds at every corner, and a = b = 0 at the centre.
        let [p, q, r] = &corners;
        let determinant = |k: [usize; 3]| {
            let [p, q, r] = [p, q, r].each(|c| k.each(|i| c[i]));
            p[0] * (q[1] * r[2] - q[2] * r[1]) - p[1] * (q[0] * r[2] - q[2] * r[0])
                + p[2] * (q[0] * r[1] - q[1] * r[0])
        };
        let whole = determinant([0, 1, 3]);
        let [alpha, beta] = [[2, 1, 3], [0, 2, 3]].each(|k| determinant(k) / whole);
        let (distance, area, longest) = polygon(&places);
        Self {
            distance,
            area,
            height: area / longest,
            depth: determinant([0, 1, 2]) / whole * DEPTHS,
            slope: 2.0 * DEPTHS * sqrt(alpha * alpha + beta * beta),
            range,
        }
    }

    /// The depths that a triangle may have at the centre when it is moved by up to `tolerance` pixels; never beyond
    /// those of its corners.
    pub(super) fn depths(&self, tolerance: f64) -> [f64; 2] {
        let [low, high] = self.range;
        let reach = self.slope * tolerance;
        // Where the plane stands on edge the numbers are not finite, and the corners say all.
        let held = |z: f64, corner: f64| {
            if z.is_nan() {
                corner
            } else if z < low {
                low
            } else if z > high {
                high
            } else {
                z
            }
        };
        let (nearest, farthest) = (self.depth - reach, self.depth + reach);
        [held(nearest, low), held(farthest, high)]
    }
}

/// The part of a triangle in front of the near plane.
fn in_front(corners: &[Four<f64>; 3]) -> Vec<Four<f64>> {
    let visible = |c: &Four<f64>| c[2] >= 0.0 && c[3] > 0.0;
    let mut polygon = Vec::with_capacity(4);
    for (i, from) in corners.iter().enumerate() {
        let to = &corners[(i + 1) % 3];
        if visible(from) {
            polygon.push(*from);
        }
        if visible(from) != visible(to) {
            let t = from[2] / (from[2] - to[2]);
            let crossing = [0, 1, 2, 3].each(|k| from[k] + (to[k] - from[k]) * t);
            if crossing[3] > 0.0 {
                polygon.push(crossing);
            }
        }
    }
    polygon
}

/// Signed distance of the origin from the boundary of a convex polygon, positive inside; twice the area; longest side.
fn polygon(corners: &[[f64; 2]]) -> (f64, f64, f64) {
    let (mut nearest, mut area, mut longest) = (f64::INFINITY, 0.0, 0.0);
    let (mut left, mut right) = (false, false);
    for (i, p) in corners.iter().enumerate() {
        let q = corners[(i + 1) % corners.len()];
        let edge = [q[0] - p[0], q[1] - p[1]];
        let turn = p[0] * q[1] - p[1] * q[0];
        let square = edge[0] * edge[0] + edge[1] * edge[1];
        area += turn;
        left |= turn > 0.0;
        right |= turn < 0.0;
        let t = -(p[0] * edge[0] + p[1] * edge[1]) / square;
        let distance = if t > 0.0 && t < 1.0 {
            turn.abs() / sqrt(square)
        } else {
            let end = if t >= 1.0 { q } else { *p };
            sqrt(end[0] * end[0] + end[1] * end[1])
        };
        if distance < nearest {
            nearest = distance;
        }
        if square > longest {
            longest = square;
        }
    }
    let distance = if left != right { nearest } else { -nearest };
    (distance, f64::abs(area), sqrt(longest))
}
