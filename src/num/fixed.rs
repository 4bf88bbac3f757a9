//! Fixed point: screen coordinates, depth, levels and weights, and how floats become them.

/// Bits of the fraction of a snapped screen coordinate: positions are multiples of `1 / 2^bits` pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "u32", into = "u32")]
pub enum SubpixelBits {
    /// 8 bits, as GPUs have; guard band +-2^14 pixels.
    Eight,
    /// 16 bits, for cross-checks against ray casting; guard band +-2^13 pixels.
    Sixteen,
}

impl SubpixelBits {
    /// 8 or 16.
    #[inline]
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            Self::Eight => 8,
            Self::Sixteen => 16,
        }
    }

    /// Sub-pixel steps in a pixel: 256 or 65,536.
    #[inline]
    #[must_use]
    pub const fn scale(self) -> i32 {
        1 << self.bits()
    }

    /// Half the side, in pixels, of the square around the origin inside which no triangle is clipped at the sides.
    ///
    /// With it every snapped coordinate is at most 2^29 in magnitude, every difference 2^30 and every edge function
    /// 2^61: `i64` never overflows.
    #[inline]
    #[must_use]
    pub const fn guard_band(self) -> f64 {
        match self {
            Self::Eight => 16_384.0,
            Self::Sixteen => 8_192.0,
        }
    }

    /// The nearest multiple of the sub-pixel step to `x` pixels, ties to even; `x` lies inside the guard band.
    #[inline]
    #[must_use]
    pub fn snap(self, x: f64) -> i32 {
        // Added to 1.5 * 2^52, a number loses its fraction, ties to even, and stands in the low bits as an integer.
        // `round_ties_even` is a call to the C library where the processor has no instruction for it.
        (x * f64::from(self.scale()) + 6_755_399_441_055_744.0).to_bits() as i32
    }
}

impl From<SubpixelBits> for u32 {
    fn from(bits: SubpixelBits) -> Self {
        bits.bits()
    }
}

impl TryFrom<u32> for SubpixelBits {
    type Error = String;

    fn try_from(bits: u32) -> Result<Self, String> {
        match bits {
            8 => Ok(Self::Eight),
            16 => Ok(Self::Sixteen),
            other => Err(format!("sub-pixel bits are 8 or 16, not {other}")),
        }
    }
}

/// Depth in [0, 1] as a multiple of 2^-32, rounded down and clamped; 0 is the near plane.
#[inline]
pub fn depth(z01: f64) -> u32 {
    // `as` saturates: below 0 gives 0, above the range u32::MAX.
    (z01 * 4_294_967_296.0) as u32
}

/// An intensity in [0, 1] as an 8-bit level, rounded to nearest (halves up) and clamped.
#[inline]
pub fn level(intensity: f64) -> u8 {
    (intensity * 255.0 + 0.5) as u8
}

/// Luma of 8-bit red, green and blue: the NTSC weights in 16 bits.
#[inline]
pub const fn luma(rgb: [u8; 3]) -> u8 {
    ((19_595 * rgb[0] as u32 + 38_470 * rgb[1] as u32 + 7_471 * rgb[2] as u32 + 32_768) >> 16) as u8
}

/// The weights of the second and third corner at a point of a triangle, in units of 2^-31: exact at the corners and at
/// midpoints of sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Weights31([u32; 2]);

impl Weights31 {
    /// The weight 1.
    pub const ONE: u32 = 1 << 31;

    /// The nearest weights that are not negative and have a sum of at most 1; NaN counts as 0.
    pub fn new([u, v]: [f64; 2]) -> Self {
        let fixed = |x: f64| (x.clamp(0.0, 1.0) * f64::from(Self::ONE)).round() as u32;
        let u = fixed(u);
        Self([u, fixed(v).min(Self::ONE - u)])
    }

    /// As numbers from 0 to 1.
    pub fn get(self) -> [f64; 2] {
        self.0.map(|x| f64::from(x) / f64::from(Self::ONE))
    }

    /// In units of 2^-31.
    pub const fn bits(self) -> [u32; 2] {
        self.0
    }

    /// From units of 2^-31; `None` where the weights have a sum above 1.
    pub fn from_bits(bits: [u32; 2]) -> Option<Self> {
        let sum = u64::from(bits[0]) + u64::from(bits[1]);
        (sum <= u64::from(Self::ONE)).then_some(Self(bits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ties_snap_to_even_and_never_away_from_zero() {
        let bits = SubpixelBits::Eight;
        let ties = [(0.5, 0), (1.5, 2), (2.5, 2), (-0.5, 0), (-1.5, -2)];
        for (x, snapped) in ties.into_iter().chain([(0.500_001, 1)]) {
            assert_eq!(bits.snap(x / 256.0), snapped, "{x} sub-pixels");
        }
    }

    #[test]
    fn a_snap_is_the_rounding_of_the_standard_library_anywhere_in_the_guard_band() {
        for bits in [SubpixelBits::Eight, SubpixelBits::Sixteen] {
            let mut state = 1_u64;
            for _ in 0..200_000 {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                let share = (state >> 11) as f64 / (1_u64 << 53) as f64;
                let x = (share * 2.0 - 1.0) * (bits.guard_band() + 1.0);
                // Also on and next to a tie.
                let tie = ((x * f64::from(bits.scale())).floor() + 0.5) / f64::from(bits.scale());
                for x in [x, tie, tie.next_up(), tie.next_down()] {
                    let expected = (x * f64::from(bits.scale())).round_ties_even() as i32;
                    assert_eq!(bits.snap(x), expected, "{x}");
                }
            }
        }
    }

    #[test]
    fn depth_clamps_outside_the_near_and_far_planes() {
        assert_eq!(depth(-1.0), 0);
        assert_eq!(depth(0.5), 1 << 31);
        assert_eq!(depth(1.0), u32::MAX);
        assert_eq!(depth(7.0), u32::MAX);
    }

    #[test]
    fn luma_of_grey_is_that_grey() {
        for v in 0..=255 {
            assert_eq!(luma([v; 3]), v);
        }
    }
}
