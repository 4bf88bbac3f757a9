//! A triangle on the screen: its edge functions, area and depth plane, all exact integers.
//!
//! With y downwards and a positive area, `e = dx (py - uy) - dy (px - ux)` is positive inside. Of the points with
//! `e = 0` those on top and left edges belong to the triangle, so a shared edge is covered exactly once.

use super::{PixelRect, projector::ScreenVertex};
use crate::{num::fixed::SubpixelBits, view::Cull};

/// `e(x, y) = dx * x + dy * y + c` at the centre of pixel (x, y), in sub-pixels squared; inside where `e >= bias`.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeFunction {
    pub(super) dx: i64,
    pub(super) dy: i64,
    pub(super) c: i64,
    /// 0 for top and left edges, 1 for the others.
    pub(super) bias: i64,
}

impl EdgeFunction {
    fn new(from: ScreenVertex, to: ScreenVertex, bits: SubpixelBits) -> Self {
        let dx = i64::from(to.x) - i64::from(from.x);
        let dy = i64::from(to.y) - i64::from(from.y);
        let half = i64::from(bits.scale()) / 2;
        Self {
            dx: -dy << bits.bits(),
            dy: dx << bits.bits(),
            c: dx * (half - i64::from(from.y)) - dy * (half - i64::from(from.x)),
            bias: i64::from(!is_top_left(dx, dy)),
        }
    }

    /// The value at the centre of a pixel, without the bias.
    #[inline]
    pub(super) fn at(&self, x: i32, y: i32) -> i64 {
        self.dx * i64::from(x) + self.dy * i64::from(y) + self.c
    }
}

/// True for top and left edges, whose points belong to the triangle: `dx` and `dy` lead along it with the inside on the
/// positive side, y downwards.
#[inline]
pub(super) fn is_top_left<T: Ord + Default>(dx: T, dy: T) -> bool {
    let zero = T::default();
    dy < zero || (dy == zero && dx > zero)
}

/// A triangle ready to be drawn: positive area, starting at its lexicographically smallest corner.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Edge functions; number i is opposite to corner i and weighs it.
    pub(super) edges: [EdgeFunction; 3],
    /// Twice the area, in sub-pixels squared; positive.
    pub(super) area: i64,
    /// Smallest depth of the three corners.
    pub(super) depth_min: u32,
    /// Depths of the corners above `depth_min`.
    pub(super) depth_above: [u32; 3],
    /// 1/w of the corners.
    pub(super) w_inverse: [f64; 3],
    /// Pixels whose centres the bounding box contains, inside the image.
    pub(super) bounds: PixelRect,
    /// Index among the given corners of each of the three.
    pub(super) order: [u8; 3],
    /// True where `i64` holds every sum of `e_i * depth_above_i` inside the triangle.
    pub(super) narrow: bool,
}

impl Setup {
    /// Prepares a triangle, or `None` where it draws nothing: no area after snapping, culled, or no pixel centre in
    /// its bounding box.
    #[inline]
    pub fn new(
        corners: [ScreenVertex; 3],
        bits: SubpixelBits,
        cull: Cull,
        image: PixelRect,
    ) -> Option<Self> {
        let [a, b, c] = corners;
        let columns = [a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x)];
        let rows = [a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y)];
        let bounds = PixelRect::with_centers_in(columns, rows, bits).intersection(image);
        if bounds.is_empty() {
            return None;
        }
        let mut order = [0_u8, 1, 2];
        let area = (i64::from(b.x) - i64::from(a.x)) * (i64::from(c.y) - i64::from(a.y))
            - (i64::from(b.y) - i64::from(a.y)) * (i64::from(c.x) - i64::from(a.x));
        // y points down: a triangle that is counter-clockwise on the screen has a negative area here.
        match area.signum() {
            0 => return None,
            1 if cull == Cull::Back => return None,
            -1 if cull == Cull::Front => return None,
            -1 => order = [0, 2, 1],
            _ => {}
        }
        let mut first = 0;
        for i in 1..3 {
            let (p, q) = (&corners[order[i] as usize], &corners[order[first] as usize]);
            if (p.x, p.y) < (q.x, q.y) {
                first = i;
            }
        }
        order.rotate_left(first);
        let [a, b, c] = order.map(|i| corners[i as usize]);
        let area = area.abs();
        let depth_min = a.depth.min(b.depth).min(c.depth);
        let depth_above = [
            a.depth - depth_min,
            b.depth - depth_min,
            c.depth - depth_min,
        ];
        let edges = [
            EdgeFunction::new(b, c, bits),
            EdgeFunction::new(c, a, bits),
            EdgeFunction::new(a, b, bits),
        ];
        let depth_range = depth_above.iter().fold(0, |m, &z| m.max(z));
        // Inside, the weights are in [0, area] and sum to area.
        let narrow = bit_length(area) + bit_length(i64::from(depth_range)) <= 62;
        Some(Self {
            edges,
            area,
            depth_min,
            depth_above,
            w_inverse: [a.w_inverse, b.w_inverse, c.w_inverse],
            bounds,
            order,
            narrow,
        })
    }

    /// The pixels the triangle can touch, inside the image.
    pub fn bounds(&self) -> PixelRect {
        self.bounds
    }

    /// For each corner of the set-up triangle, in its written order, which of the given corners it is.
    pub fn order(&self) -> [u8; 3] {
        self.order
    }

    /// The values `attributes` (by the given corners) at the centre of a pixel, perspective-correctly:
    /// `sum(e_i a_i / w_i) / sum(e_i / w_i)`, in the set-up order.
    #[inline]
    pub fn interpolate<const N: usize>(
        &self,
        attributes: &[[f64; N]; 3],
        x: i32,
        y: i32,
    ) -> [f64; N] {
        let weight = |i: usize| self.edges[i].at(x, y) as f64 * self.w_inverse[i];
        let (w0, w1, w2) = (weight(0), weight(1), weight(2));
        let sum = (w0 + w1) + w2;
        let [a, b, c] = self.order.map(|i| &attributes[i as usize]);
        std::array::from_fn(|k| ((w0 * a[k] + w1 * b[k]) + w2 * c[k]) / sum)
    }
}

/// Bits needed for a non-negative number.
#[inline]
fn bit_length(x: i64) -> u32 {
    64 - x.leading_zeros()
}
