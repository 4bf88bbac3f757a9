//! Quadratic functions of a position, and where they are smallest.

use glam::DVec3;

use crate::geometry::Sym3;

/// A quadratic function of a position: `v^T A v + 2 b . v + c`, with a symmetric `A`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quadric {
    a: Sym3,
    b: DVec3,
    c: f64,
}

/// Smallest share of the largest eigenvalue that the smallest may have for a minimum to be trusted.
const WELL_CONDITIONED: f64 = 1e-5;

impl Quadric {
    /// The function with the given coefficients.
    pub(super) fn new(a: Sym3, b: DVec3, c: f64) -> Self {
        Self { a, b, c }
    }

    /// `weight` times the squared distance to the plane through `point` with unit normal `normal`.
    pub fn plane(point: DVec3, normal: DVec3, weight: f64) -> Self {
        Self::uncertain_plane(point, normal, weight, 0.0, 0.0)
    }

    /// The expected squared distance to a plane whose normal and point have the given standard deviations.
    pub fn uncertain_plane(
        point: DVec3,
        n: DVec3,
        weight: f64,
        normal: f64,
        position: f64,
    ) -> Self {
        let (n2, p2) = (normal * normal, position * position);
        let d = n.dot(point);
        let c = d * d + n2 * point.dot(point) + p2 * n.dot(n) + 3.0 * p2 * n2;
        Self {
            a: Sym3([
                n.x * n.x + n2,
                n.x * n.y,
                n.x * n.z,
                n.y * n.y + n2,
                n.y * n.z,
                n.z * n.z + n2,
            ]),
            b: -(n * d + point * n2),
            c,
        }
        .scaled(weight)
    }

    /// This function times a number.
    pub fn scaled(mut self, weight: f64) -> Self {
        for a in &mut self.a.0 {
            *a *= weight;
        }
        self.b *= weight;
        self.c *= weight;
        self
    }

    /// The sum of two.
    pub fn plus(mut self, other: &Self) -> Self {
        self.a.add(&other.a);
        self.b += other.b;
        self.c += other.c;
        self
    }

    /// Its value at `v`; rounding below 0 is 0.
    pub fn error(&self, v: DVec3) -> f64 {
        (v.dot(self.a.times(v)) + 2.0 * self.b.dot(v) + self.c).max(0.0)
    }

    /// Where it is smallest; `None` where that is ill-conditioned (planes nearly parallel to one line).
    pub fn minimum(&self) -> Option<DVec3> {
        let [xx, xy, xz, yy, yz, zz] = self.a.0;
        let (c0, c1, c2) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
        let (c4, c5, c8) = (xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy);
        let determinant = xx * c0 + xy * c1 + xz * c2;
        // Eigenvalues l1 >= l2 >= l3: the minors are about l1 l2, the determinant over them lies in [l3 / 3, l3].
        let (trace, minors) = (xx + yy + zz, c0 + c4 + c8);
        let well = minors > WELL_CONDITIONED * (trace * trace)
            && determinant > WELL_CONDITIONED * (trace * minors);
        let b = self.b;
        let v = -DVec3::new(
            c0 * b.x + c1 * b.y + c2 * b.z,
            c1 * b.x + c4 * b.y + c5 * b.z,
            c2 * b.x + c5 * b.y + c8 * b.z,
        ) / determinant;
        (well && v.is_finite()).then_some(v)
    }

    /// The best point of the segment from `u` to `w`; `None` where it is constant along it.
    pub fn minimum_on(&self, [u, w]: [DVec3; 2]) -> Option<DVec3> {
        let d = w - u;
        let curvature = d.dot(self.a.times(d));
        let least = f64::EPSILON * self.a.trace() * d.dot(d);
        let t = -(d.dot(self.a.times(u)) + self.b.dot(d)) / curvature;
        (curvature > least && t.is_finite()).then(|| u + d * t.clamp(0.0, 1.0))
    }

    /// Where the new vertex of an edge between `u` and `w` belongs: the minimum, else the best point of the edge,
    /// else the best of midpoint and ends (the first on a tie).
    pub fn place(&self, ends: [DVec3; 2]) -> DVec3 {
        let middle = (ends[0] + ends[1]) * 0.5;
        self.minimum()
            .or_else(|| self.minimum_on(ends))
            .unwrap_or_else(|| {
                let mut best = middle;
                for end in ends {
                    if self.error(end) < self.error(best) {
                        best = end;
                    }
                }
                best
            })
    }
}
