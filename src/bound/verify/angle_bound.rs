//! The largest angle under which any viewer of a cell sees a point of a piece and what stands for it: from below and from
//! above, by branch and bound.
//!
//! For points `P` of a piece, displacements `D` and viewpoints `V`, with `R = P - V`, the tangent is `|D x R|` over
//! `R . (R + D)`. Over the piece both are of second degree in the weights of its corners, so a mean of their Bernstein
//! coefficients, one for each pair of corners: numerators are no longer than the longest of these, denominators no less
//! than the least. A coefficient of the numerator is linear in `V` and longest at a corner of the part of the cell; one
//! of the denominator is `|V|^2` plus something linear, and `|V|^2` is at least its tangent plane at the middle `C`. So
//! the quotients at pairs and corners, with `|V - C|^2` left out, bound all others, and their error is of second order in
//! the size of part and piece. Where that is not near enough to what is attained somewhere, the larger of part and piece
//! is halved; the part with the largest bound comes first. No halving comes down to a viewer who stands on a piece, or on
//! what stands for it, and sees any angle: such places are looked for first.

use std::{cmp::Ordering, collections::BinaryHeap};

use glam::DVec3;

use super::{angle_tally::FrameSighting, cell_contact::sights_at_contact};
use crate::num::Each;

/// Largest excess of an upper bound over the angle attained, as a share of the tangent.
const NEAR: f64 = 0.002;
/// The same for squares.
const NEAR2: f64 = (1.0 + NEAR) * (1.0 + NEAR);
/// Largest ratio of the squares of upper and lower bound where the claim lies between them.
const DECIDED2: f64 = 1.0 + 2e-6;
/// Halvings for one piece; what is not settled then touches the cell or comes very near.
const HALVINGS: usize = 1 << 12;
/// A part of every bound that is given away for rounding.
const MARGIN: f64 = 1e-11;

/// Twice: corners of a piece, and corners of what stands for it.
type Corners = Vec<[DVec3; 2]>;

/// A piece, or a part of one, and a simplex of viewpoints.
struct Part {
    corners: Corners,
    viewers: Vec<DVec3>,
    /// Square of the tangent.
    upper2: f64,
    /// Order of making, for ties.
    number: usize,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_bound = self.upper2.total_cmp(&other.upper2);
        by_bound.then(other.number.cmp(&self.number))
    }
}

/// The closeness that is wanted of the bounds of a piece.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    /// Square of the tangent that is claimed.
    pub(super) claim2: f64,
    /// Of the largest one known: what stays below that by bound is not looked at any closer.
    pub(super) known2: f64,
}

impl Wanted {
    /// True where closer bounds than `lower2` and `upper2` change nothing: they are near each other or what is known, and
    /// the claim lies not between them or both are next to it.
    pub(super) fn is_met(&self, lower2: f64, upper2: f64) -> bool {
        let decided = upper2 <= self.claim2 || lower2 > self.claim2 || upper2 <= lower2 * DECIDED2;
        decided && upper2 <= lower2.max(self.known2) * NEAR2
    }
}

/// A first bound of a piece for all simplices of viewpoints, and the largest angle between corners in `seen`.
pub(super) fn first(corners: &[[DVec3; 2]], cell: &[Vec<DVec3>], seen: &mut FrameSighting) -> f64 {
    if corners.iter().all(|[p, s]| p == s) {
        return 0.0;
    }
    let of = |viewers: &Vec<DVec3>| {
        look(corners, viewers, seen);
        bound2(corners, viewers)
    };
    cell.iter().map(of).fold(0.0, f64::max)
}

/// A closer bound, until it is as wanted or that would take too long.
pub(super) fn refine(
    corners: &[[DVec3; 2]],
    cell: &[Vec<DVec3>],
    wanted: Wanted,
    seen: &mut FrameSighting,
) -> f64 {
    let mut open = BinaryHeap::new();
    let mut number = 0;
    let mut add = |open: &mut BinaryHeap<Part>, corners: Corners, viewers: Vec<DVec3>| {
        number += 1;
        open.push(Part {
            upper2: bound2(&corners, &viewers),
            corners,
            viewers,
            number,
        });
    };
    for viewers in cell {
        look(corners, viewers, seen);
        if bound2(corners, viewers) == f64::INFINITY {
            look_at_contact(corners, viewers, seen);
        }
        add(&mut open, corners.to_vec(), viewers.clone());
    }
    for _ in 0..HALVINGS {
        let Some(top) = open.peek() else { return 0.0 };
        if wanted.is_met(seen.tangent2, top.upper2) {
            break;
        }
        let Some(Part {
            corners, viewers, ..
        }) = open.pop()
        else {
            break;
        };
        let (viewer, apart) = (longest(&viewers, |v| *v), longest(&corners, |c| c[0]));
        if corners.len() > 3 {
            // From here on as it is mapped: in triangles from the first corner.
            for i in 2..corners.len() {
                let three = vec![corners[0], corners[i - 1], corners[i]];
                look(&three, &viewers, seen);
                add(&mut open, three, viewers.clone());
            }
        } else if viewer.length2 > apart.length2 {
            for half in halves(&viewers, viewer, |a, b| (a + b) * 0.5) {
                look(&corners, &half, seen);
                add(&mut open, corners.clone(), half);
            }
        } else if apart.length2 > 0.0 {
            let middle = |a: [DVec3; 2], b: [DVec3; 2]| [0, 1].each(|k| (a[k] + b[k]) * 0.5);
            for half in halves(&corners, apart, middle) {
                look(&half, &viewers, seen);
                add(&mut open, half, viewers.clone());
            }
        } else {
            // A single point and a single viewpoint: what was seen is all there is.
            open.push(Part {
                upper2: seen.tangent2,
                corners,
                viewers,
                number: 0,
            });
            break;
        }
    }
    open.peek().map_or(0.0, |top| top.upper2)
}

/// Measures the corners and their mean from the corners of a simplex of viewpoints and its middle.
fn look(corners: &[[DVec3; 2]], viewers: &[DVec3], seen: &mut FrameSighting) {
    let middle = mean(viewers, |v| *v);
    for &viewpoint in viewers.iter().chain([&middle]) {
        for &[p, s] in corners {
            seen.look(p, s, viewpoint);
        }
    }
    if corners.len() <= 3 {
        seen.look(mean(corners, |c| c[0]), mean(corners, |c| c[1]), middle);
    }
}

/// Measures where viewpoints are on the triangles of a piece, or on those that stand for them.
fn look_at_contact(corners: &[[DVec3; 2]], viewers: &[DVec3], seen: &mut FrameSighting) {
    for i in 2..corners.len() {
        let three = [corners[0], corners[i - 1], corners[i]];
        let turned = three.each(|[p, s]| [s, p]);
        let turned = sights_at_contact(turned, viewers).map(|([s, p], v)| ([p, s], v));
        for ([point, replacement], viewpoint) in sights_at_contact(three, viewers).chain(turned) {
            seen.look(point, replacement, viewpoint);
        }
    }
}

fn mean<T>(of: &[T], at: impl Fn(&T) -> DVec3) -> DVec3 {
    of.iter().map(at).fold(DVec3::ZERO, |sum, p| sum + p) / of.len() as f64
}

/// No square of a tangent is larger: for all means of corners, and all viewpoints in the hull of `viewers`.
fn bound2(corners: &[[DVec3; 2]], viewers: &[DVec3]) -> f64 {
    let middle = mean(viewers, |v| *v);
    let mut upper2 = 0.0_f64;
    for (i, [p, s]) in corners.iter().enumerate() {
        let (p, d) = (*p - middle, *s - *p);
        for [q, t] in &corners[i..] {
            let (q, e) = (*q - middle, *t - *q);
            let across = (d.cross(q) + e.cross(p)) * 0.5;
            let steps = (d + e) * 0.5;
            let along = p.dot(q) + 0.5 * (p.dot(e) + q.dot(d));
            let slope = p + q + steps;
            for v in viewers {
                let v = *v - middle;
                let numerator = across - steps.cross(v);
                let denominator = along - slope.dot(v);
                let square = numerator.dot(numerator) / (denominator * denominator);
                // What is no number is no bound either.
                if denominator > 0.0 && !square.is_nan() {
                    upper2 = upper2.max(square);
                } else {
                    return f64::INFINITY;
                }
            }
        }
    }
    upper2 * (1.0 + MARGIN)
}

/// The longest side of a simplex or polygon: two corners and the square of their distance.
#[derive(Clone, Copy, Default)]
struct Side {
    from: usize,
    to: usize,
    length2: f64,
}

/// The side between the corners that are farthest apart.
fn longest<T>(of: &[T], at: impl Fn(&T) -> DVec3) -> Side {
    let mut found = Side::default();
    for i in 0..of.len() {
        for j in i + 1..of.len() {
            let d = at(&of[j]) - at(&of[i]);
            if d.dot(d) > found.length2 {
                found = Side {
                    from: i,
                    to: j,
                    length2: d.dot(d),
                };
            }
        }
    }
    found
}

/// Halves a simplex across a side.
fn halves<T: Copy>(of: &[T], side: Side, middle: impl Fn(T, T) -> T) -> [Vec<T>; 2] {
    let middle = middle(of[side.from], of[side.to]);
    let mut halves = [of.to_vec(), of.to_vec()];
    halves[0][side.to] = middle;
    halves[1][side.from] = middle;
    halves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{bound::verify::viewpoints::tangent2, mesh::generate::Pcg32};

    fn mixed(points: &[DVec3], random: &mut Pcg32) -> (DVec3, Vec<f64>) {
        let weights: Vec<f64> = points.iter().map(|_| random.unit() + 1e-9).collect();
        let sum: f64 = weights.iter().sum();
        let weights: Vec<f64> = weights.iter().map(|w| w / sum).collect();
        let all = points.iter().zip(&weights);
        (all.fold(DVec3::ZERO, |all, (&p, &w)| all + p * w), weights)
    }

    #[test]
    fn no_viewer_of_a_simplex_sees_a_mean_of_corners_beyond_the_bound() {
        let mut random = Pcg32::new(2007, 501);
        let mut bounded = 0;
        for case in 0..3_000 {
            let mut vector = |size: f64| {
                let mut axis = || (2.0 * random.unit() - 1.0) * size;
                DVec3::new(axis(), axis(), axis())
            };
            let size = [0.05, 0.4, 1.0][case % 3];
            // A polygon that turns around its middle, so that its triangles are not turned over.
            let tilt = vector(0.3);
            let n = 3 + case % 3;
            let corners: Corners = (0..n)
                .map(|i| {
                    let turn = std::f64::consts::TAU * i as f64 / n as f64;
                    let p = DVec3::new(libm::cos(turn), libm::sin(turn), 0.0) * size;
                    let p = p + DVec3::Z * p.dot(tilt);
                    [p, p + vector(size)]
                })
                .collect();
            let eye = DVec3::Z * 2.5;
            let cell: Vec<Vec<DVec3>> = (0..2)
                .map(|_| (0..1 + case % 4).map(|_| eye + vector(1.0)).collect())
                .collect();
            let mut seen = FrameSighting {
                tangent2: 0.0,
                triangle: 0,
                point: DVec3::ZERO,
                replacement: DVec3::ZERO,
                viewpoint: DVec3::ZERO,
            };
            let first = first(&corners, &cell, &mut seen);
            let wanted = Wanted {
                claim2: 0.0,
                known2: 0.0,
            };
            let refined = refine(&corners, &cell, wanted, &mut seen);
            bounded += u32::from(refined < f64::INFINITY);
            for _ in 0..20 {
                for viewers in &cell {
                    let eye = mixed(viewers, &mut random).0;
                    for i in 2..n {
                        let three = [corners[0], corners[i - 1], corners[i]];
                        let (p, weights) = mixed(&three.map(|c| c[0]), &mut random);
                        let s = (0..3).fold(DVec3::ZERO, |all, k| all + three[k][1] * weights[k]);
                        let found = tangent2(p, s, eye);
                        assert!(found <= first && found <= refined, "case {case}");
                        assert!(
                            found <= seen.tangent2 * NEAR2 || refined == f64::INFINITY,
                            "case {case}"
                        );
                    }
                }
            }
        }
        assert!(bounded > 1_000, "{bounded}");
    }
}
