//! Coverage and depth of a triangle: scanline spans by exact integer division, and the half-space test for narrow
//! triangles. Both visit the same pixels with the same depths.

use super::{PixelRect, Setup, setup::EdgeFunction};

/// Up to this width, in pixels, testing every pixel of the box is cheaper than three divisions per row.
const HALF_SPACE_WIDTH: usize = 12;

impl Setup {
    /// Calls `visit(x, y, depth)` for every covered pixel inside `region`, row by row from the left.
    ///
    /// The depth is `floor(sum(e_i z_i) / area)`, exactly: it depends neither on the region nor on which corner is
    /// first, and never leaves the range of the corners.
    #[inline]
    pub fn fragments(&self, region: PixelRect, visit: impl FnMut(i32, i32, u32)) {
        let bounds = self.bounds.intersection(region);
        if bounds.is_empty() {
        } else if bounds.width() <= HALF_SPACE_WIDTH && self.narrow {
            self.half_space(bounds, visit);
        } else {
            self.spans(bounds, visit);
        }
    }

    /// True where the triangle covers the centre of a pixel.
    #[inline]
    pub(super) fn covers(&self, x: i32, y: i32) -> bool {
        self.edges.iter().all(|e| e.at(x, y) >= e.bias)
    }

    /// Tests every pixel of the box.
    #[inline]
    pub(super) fn half_space(&self, bounds: PixelRect, mut visit: impl FnMut(i32, i32, u32)) {
        let [e0, e1, e2] = &self.edges;
        for y in bounds.y0..bounds.y1 {
            let mut w0 = e0.at(bounds.x0, y);
            let mut w1 = e1.at(bounds.x0, y);
            let mut w2 = e2.at(bounds.x0, y);
            for x in bounds.x0..bounds.x1 {
                if ((w0 - e0.bias) | (w1 - e1.bias) | (w2 - e2.bias)) >= 0 {
                    visit(x, y, self.depth_of([w0, w1, w2]));
                }
                w0 += e0.dx;
                w1 += e1.dx;
                w2 += e2.dx;
            }
        }
    }

    /// Solves every edge for x on every row, then steps the depth along the span by quotient and remainder.
    #[inline]
    pub(super) fn spans(&self, bounds: PixelRect, mut visit: impl FnMut(i32, i32, u32)) {
        let slope = self.weighted(|e| e.dx);
        let area = i128::from(self.area);
        // Where a row covers two pixels, the slope is at most the area times the depth range, so the quotient fits;
        // where it covers one, no step is ever used.
        let quotient_step = slope.div_euclid(area) as i64;
        let remainder_step = slope.rem_euclid(area) as i64;
        for y in bounds.y0..bounds.y1 {
            let Some((x0, x1)) = self.span(y, bounds) else {
                continue;
            };
            let (mut quotient, mut remainder) = if self.narrow {
                let w = [0, 1, 2].map(|i| self.edges[i].at(x0, y) * i64::from(self.depth_above[i]));
                let above = w[0] + w[1] + w[2];
                (above / self.area, above % self.area)
            } else {
                let above = self.weighted(|e| e.at(x0, y));
                (above.div_euclid(area) as i64, above.rem_euclid(area) as i64)
            };
            for x in x0..x1 {
                visit(x, y, self.depth_min + quotient as u32);
                quotient = quotient.wrapping_add(quotient_step);
                // area <= 2^61, so the sum of two remainders fits.
                remainder += remainder_step;
                if remainder >= self.area {
                    remainder -= self.area;
                    quotient = quotient.wrapping_add(1);
                }
            }
        }
    }

    /// `sum(f(e_i) * depth_above_i)`, wide enough for every value.
    fn weighted(&self, f: impl Fn(&EdgeFunction) -> i64) -> i128 {
        self.edges
            .iter()
            .zip(self.depth_above)
            .map(|(e, z)| i128::from(f(e)) * i128::from(z))
            .sum()
    }

    /// First covered column of a row and one past the last, by exact floor division; `None` where there is none.
    #[inline]
    fn span(&self, y: i32, bounds: PixelRect) -> Option<(i32, i32)> {
        let (mut low, mut high) = (i64::from(bounds.x0), i64::from(bounds.x1) - 1);
        for e in &self.edges {
            // Covered where dx * x + rest >= 0.
            let rest = e.at(0, y) - e.bias;
            match e.dx.signum() {
                1 => low = low.max(-rest.div_euclid(e.dx)),
                -1 => high = high.min(rest.div_euclid(-e.dx)),
                _ if rest < 0 => return None,
                _ => {}
            }
        }
        (low <= high).then_some((low as i32, high as i32 + 1))
    }

    /// The depth where the weights are `w`, all inside.
    #[inline]
    fn depth_of(&self, w: [i64; 3]) -> u32 {
        let z = self.depth_above.map(i64::from);
        let above = w[0] * z[0] + w[1] * z[1] + w[2] * z[2];
        self.depth_min + quotient(above, self.area)
    }
}

/// `floor(above / area)` of a covered pixel: `above` is not negative, and the quotient a difference of depths.
#[inline]
pub(super) fn quotient(above: i64, area: i64) -> u32 {
    // A quotient of two numbers below 2^32 takes the short division of the processor.
    if (above | area) >> 32 == 0 {
        above as u32 / area as u32
    } else {
        (above / area) as u32
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{num::fixed::SubpixelBits, raster::ScreenVertex, view::Cull};

    /// Vertices anywhere inside the guard band, near the image, or on a coarse grid where ties are frequent.
    fn corner(bits: SubpixelBits) -> impl Strategy<Value = ScreenVertex> {
        let scale = bits.scale();
        let band = bits.guard_band() as i32 * scale;
        let near = 40 * scale;
        let coordinate = prop_oneof![
            -band..=band,
            -near..near,
            (-8..80_i32).prop_map(move |v| v * scale / 2),
        ];
        (coordinate.clone(), coordinate, any::<u32>()).prop_map(|(x, y, depth)| ScreenVertex {
            x,
            y,
            depth,
            w_inverse: 1.0,
        })
    }

    fn corners() -> impl Strategy<Value = (SubpixelBits, [ScreenVertex; 3])> {
        prop_oneof![Just(SubpixelBits::Eight), Just(SubpixelBits::Sixteen)]
            .prop_flat_map(|bits| (Just(bits), [corner(bits), corner(bits), corner(bits)]))
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3000) })]

        #[test]
        fn spans_and_half_spaces_never_differ((bits, corners) in corners()) {
            let image = PixelRect::image(40, 36);
            if let Some(setup) = Setup::new(corners, bits, Cull::None, image) {
                let (mut a, mut b) = (Vec::new(), Vec::new());
                setup.spans(setup.bounds(), |x, y, z| a.push((x, y, z)));
                if setup.narrow {
                    setup.half_space(setup.bounds(), |x, y, z| b.push((x, y, z)));
                    prop_assert_eq!(&a, &b);
                } else {
                    let inside = |x: i32, y: i32| setup.edges.iter().all(|e| e.at(x, y) >= e.bias);
                    for y in 0..image.y1 {
                        b.extend((0..image.x1).filter(|&x| inside(x, y)).map(|x| (x, y, 0)));
                    }
                    prop_assert_eq!(a.iter().map(|f| (f.0, f.1, 0)).collect::<Vec<_>>(), b);
                }
            }
        }
    }
}
