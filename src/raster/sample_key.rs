//! [`SampleKey`]: the nearest triangle of a sample as one number.

/// Depth and id of a fragment, ordered by depth and then by id: the nearest of several is the least.
///
/// One `u64`: the depth in the upper 32 bits, in units of 2^-32 from the near plane, and the id in the lower ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(transparent)]
pub struct SampleKey(u64);

impl SampleKey {
    /// The key of a sample that nothing covers: behind every fragment.
    pub const BACKGROUND: Self = Self(u64::MAX);

    /// The key of a fragment of the triangle `id`.
    #[inline]
    pub const fn new(depth: u32, id: u32) -> Self {
        Self((depth as u64) << 32 | id as u64)
    }

    /// The key with these bits.
    #[inline]
    pub const fn from_bits(bits: u64) -> Self {
        Self(bits)
    }

    /// `depth << 32 | id`.
    #[inline]
    pub const fn bits(self) -> u64 {
        self.0
    }

    /// The depth, in units of 2^-32; `u32::MAX` for the background.
    #[inline]
    pub const fn depth(self) -> u32 {
        (self.0 >> 32) as u32
    }

    /// The id of the triangle; `u32::MAX` for the background.
    #[inline]
    pub const fn id(self) -> u32 {
        self.0 as u32
    }

    /// True where nothing covers the sample.
    #[inline]
    pub const fn is_background(self) -> bool {
        self.0 == u64::MAX
    }
}
