//! A box with sides along the axes.

use glam::{BVec3, DVec3};

/// A box with sides along the axes, from its smallest to its largest corner. Nothing is rounded.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Box3 {
    /// Smallest coordinates.
    pub low: DVec3,
    /// Largest coordinates.
    pub high: DVec3,
}

impl Box3 {
    /// The box of one point.
    #[inline]
    pub fn at(p: DVec3) -> Self {
        Self { low: p, high: p }
    }

    /// The box of points; `None` without any.
    #[inline]
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        Some(points.fold(Self::at(first), |all, p| all.union(Self::at(p))))
    }

    /// One of the eight corners: from low to high along x by bit 0 of its number, along y by bit 1, along z by bit 2.
    pub fn corner(&self, i: usize) -> DVec3 {
        let high = BVec3::new(i & 1 != 0, i & 2 != 0, i & 4 != 0);
        DVec3::select(high, self.high, self.low)
    }

    /// The box of the corners of a triangle.
    #[inline]
    pub fn of_triangle([a, b, c]: [DVec3; 3]) -> Self {
        Self {
            low: a.min(b).min(c),
            high: a.max(b).max(c),
        }
    }

    /// The smallest box around two.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// The difference of the corners.
    #[inline]
    pub fn diagonal(&self) -> DVec3 {
        self.high - self.low
    }

    /// The axis along which the box is longest; the first of equals.
    #[inline]
    pub fn longest_axis(&self) -> usize {
        let d = self.diagonal();
        if d.x >= d.y && d.x >= d.z {
            0
        } else if d.y >= d.z {
            1
        } else {
            2
        }
    }

    /// Squared distance from `p`; 0 inside.
    #[inline]
    pub fn squared_distance(&self, p: DVec3) -> f64 {
        let d = (self.low - p).max(p - self.high).max(DVec3::ZERO);
        d.dot(d)
    }

    /// False where a point is farther than `reach` from the box along an axis.
    #[inline]
    pub fn may_reach(&self, p: DVec3, reach: f64) -> bool {
        let reach = DVec3::splat(reach);
        (self.low - p).cmple(reach).all() && (p - self.high).cmple(reach).all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_holds_its_points_and_knows_its_longest_axis() {
        assert_eq!(Box3::of([]), None);
        let b = Box3::of([DVec3::new(1.0, 5.0, 0.0), DVec3::new(0.0, 0.0, 5.0)]);
        let b = b.expect("two points");
        assert_eq!(
            (b.diagonal(), b.longest_axis()),
            (DVec3::new(1.0, 5.0, 5.0), 1)
        );
        let squared = |p| b.squared_distance(p).to_bits();
        assert_eq!(squared(DVec3::new(4.0, 9.0, 2.0)), 25_f64.to_bits());
        assert_eq!(squared(DVec3::splat(0.5)), 0_f64.to_bits());
        assert!(b.may_reach(DVec3::new(4.0, 9.0, 2.0), 4.0));
        assert!(!b.may_reach(DVec3::new(4.0, 9.0, 2.0), 3.0));
    }
}
