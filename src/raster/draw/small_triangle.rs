//! SmallTriangle triangles: the same fragments as [`Setup::fragments`](super::Setup::fragments) finds, in 32-bit integers and
//! without a branch per pixel.
//!
//! Edge functions of a triangle whose bounding box is at most 2^15 sub-pixels wide and high (128 pixels with 8
//! sub-pixel bits) stay below 2^30 inside the box. Pixels of the box are tested by sign and written to a list whose
//! length grows by the outcome; depths are divided by multiplication with the reciprocal and corrected exactly.

use super::{PixelRect, projector::ScreenPoint, setup::is_top_left};
use crate::{num::fixed::SubpixelBits, view::Cull};

/// Longest side of the bounding box, in sub-pixels.
const LIMIT: i32 = 1 << 15;

/// Up to this width, in pixels, testing every pixel of a row is cheaper than three divisions.
const TESTED_WIDTH: usize = 10;

/// 2^52: added to a double in [0, 2^51), it leaves the nearest integer in the low bits.
const ROUND: f64 = 4_503_599_627_370_496.0;

/// A small triangle ready to be drawn.
#[derive(Clone, Copy, Debug)]
pub(in crate::rooms::raster) struct SmallTriangle {
    /// Pixels whose centres the bounding box contains, inside the image.
    pub(in crate::rooms::raster) bounds: PixelRect,
    /// Edge functions at the first pixel of the bounds, with the bias: inside where none is negative.
    edges: [i32; 3],
    step_x: [i32; 3],
    step_y: [i32; 3],
    /// `sum(e_i * depth_above_i)` at the first pixel of the bounds, and its steps; modulo 2^64 outside the triangle.
    above: i64,
    above_x: i64,
    above_y: i64,
    /// Twice the area, in sub-pixels squared; positive.
    area: i64,
    reciprocal: f64,
    depth_min: u32,
}

/// Outcome of [`SmallTriangle::fit`].
#[derive(Clone, Copy, Debug)]
pub(in crate::rooms::raster) enum Fit {
    /// It fits.
    Small(SmallTriangle),
    /// It draws nothing: no area after snapping, culled, or no pixel centre in its bounding box.
    Nothing,
    /// It is too large.
    Large,
}

/// Covered pixels: an index and `sum(e_i * depth_above_i)` for each.
#[derive(Clone, Debug, Default)]
pub(in crate::rooms::raster) struct Covered {
    pub(in crate::rooms::raster) at: Vec<u32>,
    pub(in crate::rooms::raster) above: Vec<i64>,
}

impl SmallTriangle {
    #[inline]
    /// Sets up a triangle from its corners on the screen, culled and cut to the image as [`Setup::new`] does it.
    ///
    /// [`Setup::new`]: super::Setup::new
    pub(in crate::rooms::raster) fn fit(
        [a, mut b, mut c]: [ScreenPoint; 3],
        bits: SubpixelBits,
        cull: Cull,
        image: PixelRect,
    ) -> Fit {
        let (x_min, x_max) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let (y_min, y_max) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        let bounds =
            PixelRect::with_centers_in([x_min, x_max], [y_min, y_max], bits).intersection(image);
        if bounds.is_empty() {
            return Fit::Nothing;
        }
        // Snapped coordinates are at most 2^29 in magnitude. With 16 sub-pixel bits the limit is half a pixel: too rare.
        if bits != SubpixelBits::Eight || x_max - x_min > LIMIT || y_max - y_min > LIMIT {
            return Fit::Large;
        }
        let mut area = ((b.x - a.x) * (c.y - a.y)).wrapping_sub((b.y - a.y) * (c.x - a.x));
        match area.signum() {
            0 => return Fit::Nothing,
            1 if cull == Cull::Back => return Fit::Nothing,
            -1 if cull == Cull::Front => return Fit::Nothing,
            -1 => {
                (b, c) = (c, b);
                area = -area;
            }
            _ => {}
        }
        let depth_min = a.depth.min(b.depth).min(c.depth);
        let half = bits.scale() / 2;
        let px = (bounds.x0 << bits.bits()) + half;
        let py = (bounds.y0 << bits.bits()) + half;
        let mut small = Self {
            bounds,
            edges: [0; 3],
            step_x: [0; 3],
            step_y: [0; 3],
            above: 0,
            above_x: 0,
            above_y: 0,
            area: i64::from(area),
            reciprocal: 1.0 / f64::from(area),
            depth_min,
        };
        let weighed = [(b, c, a.depth), (c, a, b.depth), (a, b, c.depth)];
        for (i, (from, to, depth)) in weighed.into_iter().enumerate() {
            let (dx, dy) = (to.x - from.x, to.y - from.y);
            let z = i64::from(depth - depth_min);
            let (step_x, step_y) = (-(dy << bits.bits()), dx << bits.bits());
            let e = (dx * (py - from.y)).wrapping_sub(dy * (px - from.x));
            small.edges[i] = e - i32::from(!is_top_left(dx, dy));
            small.step_x[i] = step_x;
            small.step_y[i] = step_y;
            small.above = small.above.wrapping_add(i64::from(e).wrapping_mul(z));
            small.above_x += i64::from(step_x) * z;
            small.above_y += i64::from(step_y) * z;
        }
        Fit::Small(small)
    }

    /// The least depth of its corners.
    #[inline]
    pub(in crate::rooms::raster) fn nearest(&self) -> u32 {
        self.depth_min
    }

    /// Lists the covered pixels; `index` of pixel (x, y) is `(y - origin.1 << shift) + x - origin.0`.
    #[inline]
    pub(in crate::rooms::raster) fn list(
        &self,
        origin: (i32, i32),
        shift: u32,
        covered: &mut Covered,
    ) -> usize {
        let bounds = self.bounds;
        let (width, height) = (bounds.width(), bounds.height());
        let most = width * height;
        if covered.at.len() < most {
            covered.at.resize(most, 0);
            covered.above.resize(most, 0);
        }
        let (at, above) = (&mut covered.at[..most], &mut covered.above[..most]);
        let mut start = ((bounds.y0 - origin.1) as u32) << shift;
        start += (bounds.x0 - origin.0) as u32;
        let mut edges = self.edges;
        let mut sum = self.above;
        let mut count = 0;
        if width > TESTED_WIDTH {
            for _ in 0..height {
                let (first, end) = self.span(&edges, width as i32);
                if first < end {
                    let length = (end - first) as usize;
                    let at = &mut at[count..count + length];
                    let above = &mut above[count..count + length];
                    let mut n = sum.wrapping_add(self.above_x.wrapping_mul(i64::from(first)));
                    let columns = start + first as u32..;
                    for (i, (at, above)) in columns.zip(at.iter_mut().zip(above)) {
                        (*at, *above) = (i, n);
                        n = n.wrapping_add(self.above_x);
                    }
                    count += length;
                }
                start += 1 << shift;
                for (e, step) in edges.iter_mut().zip(self.step_y) {
                    *e = e.wrapping_add(step);
                }
                sum = sum.wrapping_add(self.above_y);
            }
            return count;
        }
        for _ in 0..height {
            let [mut e0, mut e1, mut e2] = edges;
            let mut n = sum;
            for i in start..start + width as u32 {
                at[count] = i;
                above[count] = n;
                count += usize::from((e0 | e1 | e2) >= 0);
                e0 += self.step_x[0];
                e1 += self.step_x[1];
                e2 += self.step_x[2];
                n = n.wrapping_add(self.above_x);
            }
            start += 1 << shift;
            for (e, step) in edges.iter_mut().zip(self.step_y) {
                // One row past the last may leave the box by 2^23.
                *e = e.wrapping_add(step);
            }
            sum = sum.wrapping_add(self.above_y);
        }
        count
    }

    /// First covered column of a row and one past the last, from the first column of the bounds; `edges` are those of
    /// the row.
    #[inline]
    fn span(&self, edges: &[i32; 3], width: i32) -> (i32, i32) {
        let (mut first, mut end) = (0, width);
        for (&e, &step) in edges.iter().zip(&self.step_x) {
            if step > 0 {
                if e < 0 {
                    first = first.max((step - 1 - e) / step);
                }
            } else if e < 0 {
                return (0, 0);
            } else if step < 0 {
                end = end.min(e / -step + 1);
            }
        }
        (first, end)
    }

    /// The depth of a covered pixel: `floor(above / area)` more than the least depth.
    ///
    /// The product with the reciprocal is off by less than 2^-18, so its nearest integer is the quotient or one more.
    #[inline]
    pub(in crate::rooms::raster) fn depth(&self, above: i64) -> u32 {
        let nearest = (above as f64 * self.reciprocal + ROUND).to_bits() as u32;
        let rest = above - i64::from(nearest) * self.area;
        self.depth_min
            .wrapping_add(nearest)
            .wrapping_add((rest >> 63) as u32)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::raster::{ScreenVertex, Setup};

    fn corner() -> impl Strategy<Value = ScreenPoint> {
        let coordinate = || {
            prop_oneof![
                -4_000..20_000_i32,
                3_000..5_000_i32,
                (-4..80_i32).prop_map(|v| v * 128)
            ]
        };
        let depth = prop_oneof![any::<u32>(), 0..9_u32, (u32::MAX - 9)..=u32::MAX];
        (coordinate(), coordinate(), depth).prop_map(|(x, y, depth)| ScreenPoint { x, y, depth })
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3000) })]

        #[test]
        fn a_small_triangle_has_the_pixels_and_depths_of_any_other(
            corners in [corner(), corner(), corner()],
            cull in prop_oneof![4 => Just(Cull::None), 1 => Just(Cull::Back), 1 => Just(Cull::Front)],
            sixteen in any::<bool>(),
        ) {
            let bits = if sixteen { SubpixelBits::Sixteen } else { SubpixelBits::Eight };
            let image = PixelRect::image(40, 36);
            let setup = Setup::new(
                corners.map(|c| ScreenVertex { x: c.x, y: c.y, depth: c.depth, w_inverse: 1.0 }),
                bits,
                cull,
                image,
            );
            let mut expected = Vec::new();
            if let Some(setup) = setup {
                setup.fragments(image, |x, y, depth| expected.push(((y + 1) as u32 * 64 + (x + 2) as u32, depth)));
            }
            match SmallTriangle::fit(corners, bits, cull, image) {
                Fit::Large => {
                    let extent = |of: fn(&ScreenPoint) -> i32| {
                        let all = corners.iter().map(of);
                        all.clone().max().expect("three") - all.min().expect("three")
                    };
                    prop_assert!(sixteen || extent(|c| c.x).max(extent(|c| c.y)) > LIMIT);
                }
                Fit::Nothing => prop_assert_eq!(expected, vec![]),
                Fit::Small(small) => {
                    let mut covered = Covered::default();
                    let count = small.list((-2, -1), 6, &mut covered);
                    let found: Vec<_> = covered.at[..count]
                        .iter()
                        .zip(&covered.above)
                        .map(|(&at, &above)| (at, small.depth(above)))
                        .collect();
                    prop_assert_eq!(found, expected);
                }
            }
        }
    }
}
