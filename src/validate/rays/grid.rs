//! The test whether a view of a mesh is *grid-exact*: the transform needs no rounding, so that rays and rasterizer see the very
//! same triangles, and nothing may differ.
//!
//! Every corner of a triangle lies on the sub-pixel grid and its depth on a multiple of 2^-32, below 1, inside the
//! guard band and in front of the near plane.

use super::{exact::Exact, intersect::Rays};
use crate::num::{Each, fixed::SubpixelBits};

/// One past the largest depth.
const DEPTHS: f64 = 4_294_967_296.0;

/// True where nothing is rounded in the view; quick to say no.
pub(super) fn is_exact(rays: &Rays<'_>, corners: &[u32], bits: SubpixelBits) -> bool {
    let zero = |x: &Exact| x.sign().is_eq();
    let band = bits.guard_band();
    corners.iter().all(|&v| {
        let [x, y, z, w] = rays.points[v as usize].each(|n| n.value);
        let [width, height] = rays.size.each(|side| side as f64);
        let column = (x / w * 0.5 + 0.5) * width;
        let row = (0.5 - y / w * 0.5) * height;
        let scale = f64::from(bits.scale());
        let (steps, depth) = ([column * scale, row * scale], z / w * DEPTHS);
        let whole = |x: f64| x.fract().abs() <= 0.0;
        let inside = w > 0.0 && column.abs() <= band && row.abs() <= band;
        let in_range = (0.0..DEPTHS).contains(&depth);
        if !inside || !in_range || ![steps[0], steps[1], depth].into_iter().all(whole) {
            return false;
        }
        let [x, y, z, w] = rays.exactly(rays.position(v));
        let step = |clip: &Exact, side: i64, steps: f64| {
            let twice = &(&(&w + clip) * &side.into()) * &Exact::from(scale);
            zero(&(&twice - &(&(&w * &Exact::from(2_i64)) * &Exact::from(steps))))
        };
        step(&x, rays.size[0], steps[0])
            && step(&-&y, rays.size[1], steps[1])
            && zero(&(&(&z * &Exact::from(DEPTHS)) - &(&w * &Exact::from(depth))))
    })
}
