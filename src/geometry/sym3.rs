//! A symmetric 3x3 matrix.

use glam::DVec3;

/// A symmetric 3x3 matrix as `[xx, xy, xz, yy, yz, zz]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sym3(pub [f64; 6]);

impl Sym3 {
    /// The outer product `n n^T`.
    #[inline]
    pub fn outer(n: DVec3) -> Self {
        let DVec3 { x, y, z } = n;
        Self([x * x, x * y, x * z, y * y, y * z, z * z])
    }

    /// The product with a vector.
    #[inline]
    pub fn times(&self, v: DVec3) -> DVec3 {
        let [xx, xy, xz, yy, yz, zz] = self.0;
        DVec3::new(
            xx * v.x + xy * v.y + xz * v.z,
            xy * v.x + yy * v.y + yz * v.z,
            xz * v.x + yz * v.y + zz * v.z,
        )
    }

    /// The sum of the diagonal.
    #[inline]
    pub fn trace(&self) -> f64 {
        let [xx, _, _, yy, _, zz] = self.0;
        xx + yy + zz
    }

    /// Adds another matrix.
    #[inline]
    pub fn add(&mut self, other: &Self) {
        for (entry, more) in self.0.iter_mut().zip(other.0) {
            *entry += more;
        }
    }

    /// Adds `weight` times another matrix.
    #[inline]
    pub fn add_weighted(&mut self, weight: f64, other: &Self) {
        for (entry, more) in self.0.iter_mut().zip(other.0) {
            *entry += weight * more;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outer_product_maps_a_vector_to_its_share_along_the_normal() {
        let (n, v) = (DVec3::new(1.0, -2.0, 3.0), DVec3::new(4.0, 5.0, -6.0));
        let mut m = Sym3::outer(n);
        assert_eq!(m.times(v), n * n.dot(v));
        m.add_weighted(2.0, &Sym3::outer(n));
        m.add(&Sym3::outer(n));
        assert_eq!((m.times(v), m.trace()), (n * (4.0 * n.dot(v)), 56.0));
    }
}
