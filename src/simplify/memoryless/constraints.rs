//! Linear constraints on the place of a new vertex, and the quadratic functions that add to them.

use glam::DVec3;

use crate::{geometry::Sym3, num::math};

/// cos^2 and sin^2 of one degree, the least angle between constraints.
const COS2: f64 = 0.999_695_413_509_547_9;
const SIN2: f64 = 3.045_864_904_520_854_5e-4;

/// A symmetric 3x3 matrix and a vector: the gradient `H v + c` of a quadratic function.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gradient {
    pub(super) h: Sym3,
    pub(super) c: DVec3,
}

impl Gradient {
    /// Adds `weight * n n^T` and `weight * c`.
    pub(super) fn add_outer(&mut self, weight: f64, n: DVec3, c: DVec3) {
        self.h.add_weighted(weight, &Sym3::outer(n));
        self.c += c * weight;
    }

    /// Adds `weight * ([e]x)^T [e]x` and `weight * c`.
    pub(super) fn add_cross(&mut self, weight: f64, e: DVec3, c: DVec3) {
        let ee = e.dot(e);
        let products = [
            ee - e.x * e.x,
            -e.x * e.y,
            -e.x * e.z,
            ee - e.y * e.y,
            -e.y * e.z,
            ee - e.z * e.z,
        ];
        self.h.add_weighted(weight, &Sym3(products));
        self.c += c * weight;
    }
}

/// Up to three accepted rows `a . v = b`; of unit length where `UNIT`, which only guards against overflow.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Constraints<const UNIT: bool> {
    rows: [DVec3; 3],
    values: [f64; 3],
    pub(super) count: usize,
}

impl<const UNIT: bool> Constraints<UNIT> {
    /// Accepts the row where it is compatible with those before it.
    pub(super) fn offer(&mut self, a: DVec3, b: f64) {
        let a2 = a.dot(a);
        if !(a2 > 0.0 && a2 < f64::INFINITY && b.is_finite()) {
            return;
        }
        let compatible = match self.count {
            0 => true,
            1 => {
                let d = self.rows[0].dot(a);
                d * d <= self.rows[0].dot(self.rows[0]) * a2 * COS2
            }
            2 => {
                let n = self.rows[0].cross(self.rows[1]);
                let d = n.dot(a);
                d * d > n.dot(n) * a2 * SIN2
            }
            _ => false,
        };
        if compatible {
            (self.rows[self.count], self.values[self.count]) = if UNIT {
                let l = math::sqrt(a2);
                (a / l, b / l)
            } else {
                (a, b)
            };
            self.count += 1;
        }
    }

    /// Adds the conditions for the minimum of a quadratic function in the directions that are still free.
    pub(super) fn minimise(&mut self, gradient: &Gradient) {
        match self.count {
            0 => {
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    self.descend(gradient, axis);
                }
            }
            1 => {
                let a = self.rows[0];
                let (x, y, z) = (a.x.abs(), a.y.abs(), a.z.abs());
                let q = if x >= y && x >= z {
                    DVec3::new(-a.z / a.x, 0.0, 1.0)
                } else if y >= z {
                    DVec3::new(0.0, -a.z / a.y, 1.0)
                } else {
                    DVec3::new(1.0, 0.0, -a.x / a.z)
                };
                self.descend(gradient, q);
                self.descend(gradient, a.cross(q));
            }
            2 => self.descend(gradient, self.rows[0].cross(self.rows[1])),
            _ => {}
        }
    }

    /// Offers that the derivative along `direction` vanishes.
    fn descend(&mut self, gradient: &Gradient, direction: DVec3) {
        self.offer(gradient.h.times(direction), -direction.dot(gradient.c));
    }

    pub(super) fn solve(&self) -> Option<DVec3> {
        if self.count < 3 {
            return None;
        }
        let [a, b, c] = self.rows;
        let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
        let v = (bc * self.values[0] + ca * self.values[1] + ab * self.values[2]) / a.dot(bc);
        v.is_finite().then_some(v)
    }
}
