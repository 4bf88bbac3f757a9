//! The part of a quadric that values of a channel add to a position's: Garland & Heckbert 1998, in closed form.
//!
//! A face lifted to R^(3+w) by its corners' values, times a scale, spans a plane there. The squared distance to it, in
//! the paper `A = I - e1 e1^T - e2 e2^T` with orthonormal `e1` and `e2`, is the squared distance to the plane of the face
//! in space, which [`Quadric`] has, plus `r^T M r`: `r` is the value less that of the face's linear extension, times the
//! scale, and `M = (I + H H^T)^-1` with the slopes `H` of the values along the face. So constant values add exactly
//! nothing, and all entries are sums of products of slopes and their 2x2 minors over `det(I + H H^T)`, without the
//! cancellation of `I - e1 e1^T - e2 e2^T` where slopes are steep. Values in their own units: scales may differ by face.

use glam::DVec3;

use super::Quadric;
use crate::{collapse::wedge::WIDEST, geometry::Sym3, num::math};

/// Least share of a diagonal entry that elimination may leave of it for values to count as determined.
const DETERMINED: f64 = 1e-12;

/// Values of a channel; those beyond its width are 0.
pub type Values = [f64; WIDEST];

/// A quadratic function of a position `p` and values `s`, with the square of the distance to planes in space left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AttributeQuadric {
    /// The coefficients of `p p^T`, `s p^T` and `s s^T`.
    pp: Sym3,
    sp: [DVec3; WIDEST],
    ss: [Values; WIDEST],
    /// Half the coefficients of `p` and `s`, and the constant.
    p: DVec3,
    s: Values,
    c: f64,
}

#[expect(
    clippy::needless_range_loop,
    reason = "entries of small matrices, by their indices"
)]
impl AttributeQuadric {
    /// `weight` times the squared distance to the plane of a face in space and values, less that to its plane in space;
    /// `scale` is the length of a unit of the values. `None` where the face or its slopes have no direction.
    pub fn face(points: [DVec3; 3], values: [Values; 3], scale: f64, weight: f64) -> Option<Self> {
        let (e, f) = (points[1] - points[0], points[2] - points[0]);
        let along = math::unit(e)?;
        let across = math::unit(e.cross(f).cross(e))?;
        let (length, forward, height) = (e.dot(along), f.dot(along), f.dot(across));
        // Slopes along and across the first edge, in scaled units.
        let (mut a, mut b) = ([0.0; WIDEST], [0.0; WIDEST]);
        for i in 0..WIDEST {
            let [first, second, third] = [0, 1, 2].map(|k: usize| values[k][i]);
            a[i] = scale * (second - first) / length;
            b[i] = (scale * (third - first) - a[i] * forward) / height;
        }
        let minor = |i: usize, j: usize| a[i] * b[j] - b[i] * a[j];
        let (mut aa, mut ab, mut bb, mut minors) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..WIDEST {
            aa += a[i] * a[i];
            ab += a[i] * b[i];
            bb += b[i] * b[i];
            for j in i + 1..WIDEST {
                minors += minor(i, j) * minor(i, j);
            }
        }
        let weight = weight / (1.0 + aa + bb + minors);
        let mut face = Self::default();
        face.pp
            .add_weighted(weight * (aa + minors), &Sym3::outer(along));
        face.pp
            .add_weighted(weight * (bb + minors), &Sym3::outer(across));
        let (sum, difference) = (Sym3::outer(along + across), Sym3::outer(along - across));
        face.pp.add_weighted(weight * ab * 0.5, &sum);
        face.pp.add_weighted(weight * ab * -0.5, &difference);
        for i in 0..WIDEST {
            // (1 + bb) a_i - ab b_i and (1 + aa) b_i - ab a_i.
            let (mut x, mut y) = (a[i], b[i]);
            for j in 0..WIDEST {
                x += b[j] * minor(i, j);
                y -= a[j] * minor(i, j);
            }
            face.sp[i] = (along * x + across * y) * (-weight * scale);
            for j in 0..WIDEST {
                face.ss[i][j] = weight * (scale * scale) * inverse([a, b], i, j);
            }
        }
        face.based_at(points[0], values[0])
    }

    /// Makes this homogeneous function of differences from a point and its values one of positions and values; `None`
    /// where it is not finite.
    fn based_at(mut self, point: DVec3, values: Values) -> Option<Self> {
        self.p = -self.pp.times(point);
        for i in 0..WIDEST {
            self.p -= self.sp[i] * values[i];
            let mut own = self.sp[i].dot(point);
            for j in 0..WIDEST {
                own += self.ss[i][j] * values[j];
            }
            self.s[i] = -own;
        }
        self.c = -self.p.dot(point);
        for i in 0..WIDEST {
            self.c -= self.s[i] * values[i];
        }
        self.c.is_finite().then_some(self)
    }

    /// Adds another.
    pub fn add(&mut self, other: &Self) {
        self.pp.add(&other.pp);
        for i in 0..WIDEST {
            self.sp[i] += other.sp[i];
            for j in 0..WIDEST {
                self.ss[i][j] += other.ss[i][j];
            }
            self.s[i] += other.s[i];
        }
        self.p += other.p;
        self.c += other.c;
    }

    /// Its value at a position and values; rounding below 0 is 0.
    pub fn error(&self, position: DVec3, values: Values) -> f64 {
        let mut sum = position.dot(self.pp.times(position)) + 2.0 * self.p.dot(position) + self.c;
        for i in 0..WIDEST {
            let mut slope = 2.0 * (self.sp[i].dot(position) + self.s[i]);
            for j in 0..WIDEST {
                slope += self.ss[i][j] * values[j];
            }
            sum += slope * values[i];
        }
        sum.max(0.0)
    }

    /// The first `width` values for which it is smallest at a position; `None` where they are not determined.
    pub fn values_at(&self, position: DVec3, width: usize) -> Option<Values> {
        let factors = self.factors(width)?;
        let mut values = [0.0; WIDEST];
        for i in 0..width {
            values[i] = -(self.sp[i].dot(position) + self.s[i]);
            for j in 0..i {
                values[i] -= factors[i][j] * values[j];
            }
        }
        for i in (0..width).rev() {
            values[i] /= factors[i][i];
            for j in i + 1..width {
                values[i] -= factors[j][i] * values[j];
            }
        }
        values.iter().all(|x| x.is_finite()).then_some(values)
    }

    /// The function of the position alone that is left with the best values at each; `None` where those are not
    /// determined.
    pub fn without_values(&self, width: usize) -> Option<Quadric> {
        let factors = self.factors(width)?;
        let mut left = Quadric::new(self.pp, self.p, self.c);
        let (mut rows, mut constants) = ([DVec3::ZERO; WIDEST], [0.0; WIDEST]);
        for i in 0..width {
            (rows[i], constants[i]) = (self.sp[i], self.s[i]);
            for j in 0..i {
                rows[i] -= rows[j] * factors[i][j];
                constants[i] -= constants[j] * factors[i][j];
            }
            let (row, constant, pivot) = (rows[i], constants[i], factors[i][i]);
            let outer = Sym3::outer(row);
            left = left.plus(
                &Quadric::new(outer, row * constant, constant * constant).scaled(-1.0 / pivot),
            );
        }
        Some(left)
    }

    /// The factors `L D L^T` of the coefficients of values: `D` on the diagonal, `L` below it.
    fn factors(&self, width: usize) -> Option<[Values; WIDEST]> {
        let mut factors = [[0.0; WIDEST]; WIDEST];
        for i in 0..width {
            for j in 0..=i {
                let mut entry = self.ss[i][j];
                for k in 0..j {
                    entry -= factors[i][k] * factors[k][k] * factors[j][k];
                }
                if j < i {
                    factors[i][j] = entry / factors[j][j];
                } else if entry > DETERMINED * self.ss[i][i] {
                    factors[i][i] = entry;
                } else {
                    return None;
                }
            }
        }
        Some(factors)
    }
}

/// An entry of `(I + H H^T)^-1`, times the determinant, for slopes `H` along two directions.
fn inverse([a, b]: [Values; 2], i: usize, j: usize) -> f64 {
    let minor = |i: usize, j: usize| a[i] * b[j] - b[i] * a[j];
    let mut sum = 0.0;
    if i == j {
        for k in (0..WIDEST).filter(|&k| k != i) {
            sum += a[k] * a[k] + b[k] * b[k];
            for l in (k + 1..WIDEST).filter(|&l| l != i) {
                sum += minor(k, l) * minor(k, l);
            }
        }
        1.0 + sum
    } else {
        for k in 0..WIDEST {
            sum += minor(i, k) * minor(j, k);
        }
        -(a[i] * a[j] + b[i] * b[j] + sum)
    }
}
