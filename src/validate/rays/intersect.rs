//! The intersection of a ray and a triangle, and its depth: our own intersector, in exact arithmetic.
//!
//! The ray through the centre of pixel (x, y) is where two planes meet, that of its column, `A = W X - (2x + 1 - W) w`,
//! and that of its row, `B = H Y - (H - 2y - 1) w`, with X, Y, w the clip coordinates: linear in world space, without a
//! division, an eye or a direction that would have to be rounded. The line passes the edge from p to q on the side of
//! the sign of `A_p B_q - A_q B_p` (a Pluecker product), and meets the triangle where the three signs agree, wherever
//! its corners lie; these products, opposite to the corners, weigh them at the hit.
//!
//! **Ties.** Moving the centre right by e and down by e^2 for an infinitely small e is the top-left rule. It turns A
//! into `A - 2e w` and B into `B + 2e^2 w`; a product of 0 then has the sign of its next term in e.
//!
//! **Depth** is part of the picture: `floor(Z/w 2^32)` at the centre, clamped; in front of the near plane is `Z >= 0`
//! and `w > 0`.
//!
//! Every sign is computed in `f64` with a bound of its error first, and in [`Exact`] arithmetic where that cannot
//! tell; both through the same lines ([`Arithmetic`]), so that there is one formula to trust.

use std::cmp::Ordering;

use glam::DVec3;

use super::{exact::Exact, hierarchy::Hierarchy};
use crate::{
    num::Each,
    view::{Cull, Matrix, View, ViewSet},
};

/// One past the largest depth.
const DEPTHS: f64 = 4_294_967_296.0;

/// Numbers that know their sign, or that they do not.
pub(super) trait Arithmetic: Sized {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn negated(&self) -> Self;
    /// Against 0; `None` where the error is too large to tell.
    fn sign(&self) -> Option<Ordering>;
}

impl Arithmetic for Exact {
    fn plus(&self, other: &Self) -> Self {
        self + other
    }

    fn minus(&self, other: &Self) -> Self {
        self - other
    }

    fn times(&self, other: &Self) -> Self {
        self * other
    }

    fn negated(&self) -> Self {
        -self
    }

    fn sign(&self) -> Option<Ordering> {
        Some(Self::sign(self))
    }
}

/// A double and a bound of its distance from the number it stands for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounded {
    pub(super) value: f64,
    error: f64,
}

impl Rounded {
    /// Four times the relative error of one operation: the bounds are rounded themselves.
    const UNIT: f64 = 2.0 * f64::EPSILON;
    /// More than what a product loses that is too small for a double.
    const TINY: f64 = f64::MIN_POSITIVE;

    /// A double that is exactly meant.
    pub(super) const fn exactly(value: f64) -> Self {
        Self { value, error: 0.0 }
    }

    /// The result of an operation on numbers with errors that make `error`.
    fn after(value: f64, error: f64) -> Self {
        Self {
            value,
            error: error * (1.0 + Self::UNIT) + (value.abs() * Self::UNIT + Self::TINY),
        }
    }
}

impl Arithmetic for Rounded {
    fn plus(&self, other: &Self) -> Self {
        Self::after(self.value + other.value, self.error + other.error)
    }

    fn minus(&self, other: &Self) -> Self {
        Self::after(self.value - other.value, self.error + other.error)
    }

    fn times(&self, other: &Self) -> Self {
        let (a, b) = (self.value.abs(), other.value.abs());
        let error = a * other.error + self.error * (b + other.error);
        Self::after(self.value * other.value, error)
    }

    fn negated(&self) -> Self {
        Self {
            value: -self.value,
            ..*self
        }
    }

    fn sign(&self) -> Option<Ordering> {
        // False for NaN and where everything has overflowed.
        if self.value > self.error {
            Some(Ordering::Greater)
        } else if -self.value > self.error {
            Some(Ordering::Less)
        } else {
            None
        }
    }
}

/// Four numbers of a point: X, Y, Z and w, or with the first two replaced by A and B of a ray.
pub(super) type Four<N> = [N; 4];

/// Clip coordinates of a point, with the rounding errors of every operation.
fn clip<N: Arithmetic>(matrix: &Matrix, p: DVec3, number: impl Fn(f64) -> N) -> Four<N> {
    matrix.each(|m| {
        let term = |i: usize, x: f64| number(m[i]).times(&number(x));
        let sum = term(0, p.x).plus(&term(1, p.y)).plus(&term(2, p.z));
        sum.plus(&number(m[3]))
    })
}

/// The rule by which a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Hit {
    /// `floor(Z/w 2^32)`, at most `u32::MAX`.
    pub(super) depth: u32,
    /// Counter-clockwise as the viewer sees it.
    pub(super) front: bool,
}

/// All rays of a view.
#[derive(Debug)]
pub(super) struct Rays<'a> {
    matrix: Matrix,
    cull: Cull,
    /// Samples in a row and in a column.
    pub(super) size: [i64; 2],
    positions: &'a [DVec3],
    /// Clip coordinates of every position.
    pub(super) points: Vec<Four<Rounded>>,
}

/// The ray through the centre of a sample: the factors of its two planes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    /// `2x + 1 - W`.
    pub(super) column: i64,
    /// `H - 2y - 1`.
    pub(super) row: i64,
}

impl<'a> Rays<'a> {
    pub(super) fn new(view: &View, set: &ViewSet, positions: &'a [DVec3]) -> Self {
        let point = |&p: &DVec3| clip(&view.matrix, p, Rounded::exactly);
        Self {
            matrix: view.matrix,
            cull: view.cull,
            size: [set.width, set.height].each(|side| i64::from(side * set.samples)),
            positions,
            points: positions.iter().map(point).collect(),
        }
    }

    /// The clip coordinates of a point, exactly.
    pub(super) fn exactly(&self, p: DVec3) -> Four<Exact> {
        clip(&self.matrix, p, Exact::from)
    }

    pub(super) fn ray(&self, x: i64, y: i64) -> Ray {
        let [width, height] = self.size;
        Ray {
            column: 2 * x + 1 - width,
            row: height - 2 * y - 1,
        }
    }

    /// A position of the mesh.
    pub(super) fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// The planes of every column (or, upwards, row) in the frame of a hierarchy.
    pub(super) fn planes(&self, axis: usize, hierarchy: &Hierarchy) -> Vec<Option<(DVec3, f64)>> {
        let center = self.exactly(hierarchy.center());
        let plane = |i| self.plane_around(&center, axis, i, hierarchy);
        (0..self.size[axis]).map(plane).collect()
    }

    /// One of [`Rays::planes`].
    pub(super) fn plane(&self, axis: usize, i: i64, hierarchy: &Hierarchy) -> Option<(DVec3, f64)> {
        self.plane_around(&self.exactly(hierarchy.center()), axis, i, hierarchy)
    }

    /// Normal and offset; the offset correctly rounded, because it decides where the plane is when the mesh is far from
    /// the origin.
    fn plane_around(
        &self,
        center: &Four<Exact>,
        axis: usize,
        i: i64,
        hierarchy: &Hierarchy,
    ) -> Option<(DVec3, f64)> {
        let normal = |m: &[f64; 4]| hierarchy.frame().leave(DVec3::new(m[0], m[1], m[2]));
        let size = self.size[axis];
        let factor = 2 * i + 1 - size;
        let a = normal(&self.matrix[axis]) * size as f64;
        let b = normal(&self.matrix[3]) * factor as f64;
        let plane = a - b;
        // Cancellation leaves too few digits.
        let sound = plane.dot(plane) > 1e-8 * (a.dot(a) + b.dot(b));
        let offset = &(&center[axis] * &size.into()) - &(&center[3] * &factor.into());
        sound.then(|| (plane, offset.approximate()))
    }

    /// True where a triangle is counter-clockwise as the viewer sees it, up to rounding.
    pub(super) fn is_front(&self, triangle: [u32; 3]) -> bool {
        let [a, b, c] = triangle.each(|v| {
            let [x, y, _, w] = &self.points[v as usize];
            DVec3::new(x.value, y.value, w.value)
        });
        a.dot(b.cross(c)) > 0.0
    }

    /// The exact place where a triangle is hit, if it is.
    #[inline]
    pub(super) fn hit(&self, ray: Ray, triangle: [u32; 3]) -> Option<Hit> {
        let [column, row] = [ray.column, ray.row].each(|n| Rounded::exactly(n as f64));
        let [width, height] = self.size.each(|n| Rounded::exactly(n as f64));
        let [a, b, c] = triangle.each(|v| {
            let [x, y, z, w] = &self.points[v as usize];
            let a = width.times(x).minus(&column.times(w));
            let b = height.times(y).minus(&row.times(w));
            [a, b, *z, *w]
        });
        // A triangle on one side of a plane of the ray is the usual case.
        for k in 0..2 {
            let side = a[k].sign();
            if side.is_some() && side == b[k].sign() && side == c[k].sign() {
                return None;
            }
        }
        let answer = meet(&[a, b, c]).and_then(|meeting| match meeting {
            Meeting::Miss => Some(None),
            Meeting::At { z, w, front } => {
                let quotient = z.value / w.value;
                let error = (z.error + quotient.abs() * w.error) / (w.value - w.error);
                let quanta = quotient * DEPTHS;
                let error = 2.0 * (error * DEPTHS + quanta.abs() * Rounded::UNIT);
                let (low, high) = ((quanta - error).floor(), (quanta + error).floor());
                if high < 0.0 {
                    return Some(None);
                }
                (low >= 0.0 && low >= high).then_some(Some(Hit {
                    depth: low as u32,
                    front,
                }))
            }
        });
        let hit = answer.unwrap_or_else(|| self.exact_hit(ray, triangle))?;
        let culled = match self.cull {
            Cull::None => false,
            Cull::Back => !hit.front,
            Cull::Front => hit.front,
        };
        (!culled).then_some(hit)
    }

    /// [`Rays::hit`] without doubles and without culling.
    #[cold]
    pub(super) fn exact_hit(&self, ray: Ray, triangle: [u32; 3]) -> Option<Hit> {
        let [column, row] = [ray.column, ray.row].each(Exact::from);
        let [width, height] = self.size.each(Exact::from);
        let corners = triangle.each(|v| {
            let [x, y, z, w] = self.exactly(self.positions[v as usize]);
            let (a, b) = (
                &(&width * &x) - &(&column * &w),
                &(&height * &y) - &(&row * &w),
            );
            [a, b, z, w]
        });
        match meet(&corners)? {
            Meeting::Miss => None,
            Meeting::At { z, w, front } => exact_depth(&z, &w).map(|depth| Hit { depth, front }),
        }
    }
}

/// `floor(z / w 2^32)` by bisection, at most `u32::MAX`; `None` where it is negative. `w` is positive.
fn exact_depth(z: &Exact, w: &Exact) -> Option<u32> {
    if z.sign() == Ordering::Less {
        return None;
    }
    let scaled = z * &Exact::from(DEPTHS);
    let (mut low, mut high) = (0_i64, 1 << 32);
    while high - low > 1 {
        let middle = i64::midpoint(low, high);
        if (&scaled - &(w * &middle.into())).sign() == Ordering::Less {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(low as u32)
}

/// The way a line and a triangle meet.
enum Meeting<N> {
    Miss,
    /// At the point with the depth `z / w`; `w` is positive.
    At {
        z: N,
        w: N,
        front: bool,
    },
}

/// `None` where the numbers do not know.
fn meet<N: Arithmetic>(corners: &[Four<N>; 3]) -> Option<Meeting<N>> {
    let [a, b, c] = corners;
    let (along_a, side) = passes(b, c)?;
    if side == Ordering::Equal {
        return Some(Meeting::Miss);
    }
    let (along_b, other) = passes(c, a)?;
    if other != side {
        return Some(Meeting::Miss);
    }
    let (along_c, other) = passes(a, b)?;
    if other != side {
        return Some(Meeting::Miss);
    }
    let sum = |k: usize| {
        let first = along_a.times(&a[k]).plus(&along_b.times(&b[k]));
        first.plus(&along_c.times(&c[k]))
    };
    let (z, w) = (sum(2), sum(3));
    // The weights have the sign of the side; at the hit, w is their mean.
    if w.sign()? != side {
        return Some(Meeting::Miss);
    }
    let front = side == Ordering::Greater;
    Some(if front {
        Meeting::At { z, w, front }
    } else {
        Meeting::At {
            z: z.negated(),
            w: w.negated(),
            front,
        }
    })
}

/// On which side the line passes the edge from `p` to `q`, ties broken as the first lines of the file say; `Equal` only
/// where the edge and the line lie in one plane with every neighbour of the line. And the product itself.
fn passes<N: Arithmetic>(p: &Four<N>, q: &Four<N>) -> Option<(N, Ordering)> {
    let product = |i: usize, j: usize| p[i].times(&q[j]).minus(&q[i].times(&p[j]));
    let side = product(0, 1);
    let mut order = side.sign()?;
    if order == Ordering::Equal {
        // (A_p - 2e w_p)(B_q + 2e^2 w_q) - (A_q - 2e w_q)(B_p + 2e^2 w_p)
        order = product(1, 3).sign()?;
    }
    if order == Ordering::Equal {
        order = product(0, 3).sign()?;
    }
    Some((side, order))
}
