//! The random numbers of the tests.

use glam::DVec3;

/// A small deterministic generator (SplitMix64): equal seeds give equal numbers everywhere.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Another sequence for every stream.
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        Self(seed ^ stream << 32)
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In [low, high).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// 1 or -1.
    pub(crate) fn sign(&mut self) -> f64 {
        [1.0, -1.0][self.below(2)]
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// In a cube around the origin with sides of `2 * size`.
    pub(crate) fn vector(&mut self, size: f64) -> DVec3 {
        let mut axis = || (self.unit() * 2.0 - 1.0) * size;
        DVec3::new(axis(), axis(), axis())
    }

    /// Of length 1.
    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.vector(1.0);
            if (0.1..=1.0).contains(&v.length()) {
                return v / v.length();
            }
        }
    }
}
