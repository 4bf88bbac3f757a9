//! Points on a surface, for the verifier: spread evenly over its area, along its edges, and all its vertices.
//!
//! Point `k` of `n` lies where the areas of the triangles before it have summed up to `(k + 1/2) / n` of the whole;
//! inside its triangle it is term `k` of the additive sequence with steps 1/g and 1/g^2, `g` the plastic number
//! (M. Roberts 2018), in 64-bit integers: the same points for every number of threads and every range. Edge points
//! likewise by length, with the golden ratio.

use glam::DVec3;

use super::nearest::double_area;
use crate::num::math::length;

/// 2^64 / g and 2^64 / g^2, g = 1.3247179...
const STEPS: [u64; 2] = [0xC13F_A9A9_02A6_328F, 0x91E1_0DA5_C79E_7B1D];
/// 2^64 / 1.618...
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// Term `k` of an additive sequence, in [0, 1).
fn term(k: u64, step: u64) -> f64 {
    (k.wrapping_mul(step) >> 11) as f64 / (1_u64 << 53) as f64
}

/// A point of a surface: the triangle it lies in, and its weights there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    pub(super) triangle: u32,
    pub(super) weights: [f64; 3],
}

impl Sample {
    pub(super) fn point(&self, [a, b, c]: [DVec3; 3]) -> DVec3 {
        a * self.weights[0] + b * self.weights[1] + c * self.weights[2]
    }
}

/// A plan of sample points: `inside` of them by area, then `along` by length, then the corners of all triangles.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    areas: Vec<f64>,
    sides: Vec<f64>,
    inside: u64,
    along: u64,
    triangles: u64,
}

impl Samples {
    /// A plan for `samples` points: a ninth of them on edges. Surfaces without area have their corners only.
    pub(super) fn new(corners: &[[DVec3; 3]], samples: u64) -> Self {
        let (mut areas, mut sides) = (Vec::new(), Vec::new());
        let (mut area, mut side) = (0.0, 0.0);
        for &[a, b, c] in corners {
            area += double_area([a, b, c]);
            areas.push(area);
            side += length(b - a) + length(c - b) + length(a - c);
            sides.push(side);
        }
        let along = if side > 0.0 { samples / 9 } else { 0 };
        Self {
            inside: if area > 0.0 { samples - along } else { 0 },
            along,
            triangles: corners.len() as u64,
            areas,
            sides,
        }
    }

    /// Number of points.
    pub(super) fn len(&self) -> u64 {
        self.inside + self.along + 3 * self.triangles
    }

    /// Calls `visit` with every point of a range, in order.
    pub(super) fn visit(&self, range: std::ops::Range<u64>, visit: &mut dyn FnMut(Sample)) {
        let mut at = None;
        for k in range {
            if k < self.inside {
                let t = place(&self.areas, k, self.inside, &mut at);
                let (u, v) = (term(k, STEPS[0]), term(k, STEPS[1]));
                let (u, v) = if u + v > 1.0 {
                    (1.0 - u, 1.0 - v)
                } else {
                    (u, v)
                };
                visit(Sample {
                    triangle: t,
                    weights: [1.0 - u - v, u, v],
                });
            } else if k - self.inside < self.along {
                let k = k - self.inside;
                if k == 0 {
                    at = None;
                }
                let t = place(&self.sides, k, self.along, &mut at);
                let s = 3.0 * term(k, GOLDEN);
                let (first, s) = if s < 1.0 {
                    (0, s)
                } else if s < 2.0 {
                    (1, s - 1.0)
                } else {
                    (2, s - 2.0)
                };
                let mut weights = [0.0; 3];
                weights[first] = 1.0 - s;
                weights[(first + 1) % 3] = s;
                visit(Sample {
                    triangle: t,
                    weights,
                });
            } else {
                let k = k - self.inside - self.along;
                let mut weights = [0.0; 3];
                weights[(k % 3) as usize] = 1.0;
                visit(Sample {
                    triangle: (k / 3) as u32,
                    weights,
                });
            }
        }
    }
}

/// The triangle in which the sums reach `(k + 1/2) / count` of the last one; `at` is the one of the point before.
fn place(sums: &[f64], k: u64, count: u64, at: &mut Option<usize>) -> u32 {
    let last = sums.len() - 1;
    let wanted = (k as f64 + 0.5) / count as f64 * sums[last];
    let mut t = match *at {
        Some(t) => t,
        None => sums.partition_point(|&s| s < wanted),
    };
    while t < last && sums[t] < wanted {
        t += 1;
    }
    *at = Some(t);
    t.min(last) as u32
}
