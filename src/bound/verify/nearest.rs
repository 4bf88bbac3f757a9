//! The distance from a point to a set of triangles, for the verifier alone.
//!
//! A tree of boxes over facets, halved at the median. A facet's distance is that to its plane where the foot lies inside
//! all three sides, else the least of the distances to its sides. A facet so thin that its normal is mostly rounding
//! (sine of the angle at its first corner below 1e-10) counts as its sides: the distance is then too large by at most
//! 1e-10 of its size, never too small. Units: frame units, sizes near 1.

use glam::DVec3;

use super::viewpoints::{angle, tangent2};
use crate::num::{
    Each,
    math::{atan2, length, sqrt},
};

/// Facets in a leaf.
const LEAF: usize = 4;
/// Halving 2^31 facets leaves fewer levels.
const DEPTH: usize = 40;
/// Squared sine below which a facet has no normal.
const NEEDLE: f64 = 1e-20;

/// A triangle, prepared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    corners: [DVec3; 3],
    normal: DVec3,
    /// Squared length of the normal; 0 where the facet counts as its sides.
    norm: f64,
}

impl Facet {
    pub(super) fn new([a, b, c]: [DVec3; 3]) -> Self {
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let norm = normal.dot(normal);
        let flat = norm <= NEEDLE * (ab.dot(ab) * ac.dot(ac));
        Self {
            corners: [a, b, c],
            normal,
            norm: if flat { 0.0 } else { norm },
        }
    }

    /// The point nearest to `p`.
    pub(super) fn nearest_point(&self, p: DVec3) -> DVec3 {
        let [a, b, c] = self.corners;
        if self.norm > 0.0 && self.contains(p) {
            let n = self.normal;
            return p - n * ((p - a).dot(n) / self.norm);
        }
        let mut best = a;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let side = to - from;
            let along = (p - from).dot(side) / side.dot(side);
            let foot = from.lerp(to, if along > 0.0 { along.min(1.0) } else { 0.0 });
            if (foot - p).length_squared() < (best - p).length_squared() {
                best = foot;
            }
        }
        best
    }

    /// True where the foot of `p` in the plane lies inside all sides.
    fn contains(&self, p: DVec3) -> bool {
        let [a, b, c] = self.corners;
        let left = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(self.normal) >= 0.0;
        left(a, b) && left(b, c) && left(c, a)
    }

    /// The point that a viewer at `v` sees under the smallest angle from `p`.
    fn nearest_in_angle(&self, v: DVec3, p: DVec3) -> DVec3 {
        let [a, b, c] = self.corners;
        let sight = p - v;
        let slope = sight.dot(self.normal);
        let hit = v + sight * ((a - v).dot(self.normal) / slope);
        if self.norm > 0.0 && hit.is_finite() && (hit - v).dot(sight) > 0.0 && self.contains(hit) {
            return hit;
        }
        let mut best = a;
        for (from, to) in [(a, b), (b, c), (c, a)] {
            // Where the cosine along the side is stationary.
            let (from_v, side) = (from - v, to - from);
            let (da, de) = (sight.dot(from_v), sight.dot(side));
            let (aa, ae, ee) = (from_v.dot(from_v), from_v.dot(side), side.dot(side));
            let t = (da * ae - de * aa) / (de * ae - da * ee);
            let inside = if t > 0.0 && t < 1.0 {
                from.lerp(to, t)
            } else {
                to
            };
            for q in [inside, to] {
                if tangent2(p, q, v) < tangent2(p, best, v) {
                    best = q;
                }
            }
        }
        best
    }

    /// Squared distance from `p`.
    #[inline]
    pub(super) fn squared(&self, p: DVec3) -> f64 {
        let [a, b, c] = self.corners;
        if self.norm > 0.0 && self.contains(p) {
            let height = (p - a).dot(self.normal);
            return height * height / self.norm;
        }
        to_side(p, a, b).min(to_side(p, b, c)).min(to_side(p, c, a))
    }
}

/// Twice the area of a triangle.
pub(super) fn double_area([a, b, c]: [DVec3; 3]) -> f64 {
    length((b - a).cross(c - a))
}

/// Squared distance from `p` to a segment.
#[inline]
fn to_side(p: DVec3, from: DVec3, to: DVec3) -> f64 {
    let (side, offset) = (to - from, p - from);
    let (along, all) = (offset.dot(side), side.dot(side));
    let foot = if along <= 0.0 || all <= 0.0 {
        offset
    } else if along >= all {
        p - to
    } else {
        offset - side * (along / all)
    };
    foot.dot(foot)
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// First facet of a leaf, or the second child; the first child is the next node.
    link: u32,
    /// Facets of a leaf; 0 for an inner node.
    facets: u32,
}

impl Node {
    /// A lower bound of the angle between `p` and anything in the box for a viewer at `v`.
    fn least_angle(&self, v: DVec3, p: DVec3) -> f64 {
        let (centre, half) = ((self.low + self.high) * 0.5, (self.high - self.low) * 0.5);
        let (away, radius2) = (centre - v, half.dot(half));
        let beyond = away.dot(away) - radius2;
        if beyond <= 0.0 {
            return 0.0;
        }
        angle(p, centre, v) - atan2(sqrt(radius2), sqrt(beyond)) - 1e-12
    }

    #[inline]
    fn squared(&self, p: DVec3) -> f64 {
        let out = (self.low - p).max(p - self.high).max(DVec3::ZERO);
        out.dot(out)
    }
}

/// The facets of a surface, by place.
#[derive(Clone, Debug)]
pub(super) struct Facets {
    nodes: Vec<Node>,
    facets: Vec<Facet>,
}

impl Facets {
    /// Sorts triangles into a tree; O(n log n). There must be at least one.
    pub(super) fn new(corners: &[[DVec3; 3]]) -> Self {
        let mut order: Vec<u32> = (0..corners.len() as u32).collect();
        let mut nodes = Vec::with_capacity(corners.len());
        grow(corners, &mut order, 0, &mut nodes);
        let facets = order
            .iter()
            .map(|&t| Facet::new(corners[t as usize]))
            .collect();
        Self { nodes, facets }
    }

    /// A facet of the tree.
    #[inline]
    pub(super) fn facet(&self, index: u32) -> &Facet {
        &self.facets[index as usize]
    }

    /// Squared distance from `p` and the facet that has it. `guess` is a facet to begin with; where any facet is no
    /// farther than `enough` (squared), the search may end with it.
    pub(super) fn nearest(&self, p: DVec3, guess: u32, enough: f64) -> (f64, u32) {
        let mut best = (self.facet(guess).squared(p), guess);
        if best.0 <= enough {
            return best;
        }
        let mut stack = [(0.0_f64, 0_u32); DEPTH];
        let mut height = 1;
        stack[0] = (self.nodes[0].squared(p), 0);
        while height > 0 {
            height -= 1;
            let (bound, at) = stack[height];
            if bound >= best.0 {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.facets > 0 {
                for i in node.link..node.link + node.facets {
                    let squared = self.facet(i).squared(p);
                    if squared < best.0 {
                        best = (squared, i);
                        if squared <= enough {
                            return best;
                        }
                    }
                }
                continue;
            }
            let first = (self.nodes[at as usize + 1].squared(p), at + 1);
            let second = (self.nodes[node.link as usize].squared(p), node.link);
            let (near, far) = if second.0 < first.0 {
                (second, first)
            } else {
                (first, second)
            };
            stack[height] = far;
            stack[height + 1] = near;
            height += 2;
        }
        best
    }

    /// The point that a viewer at `v` sees under the smallest angle from `p`, or `known` where none is nearer.
    pub(super) fn nearest_in_angle(&self, v: DVec3, p: DVec3, known: DVec3) -> DVec3 {
        let mut best = (angle(p, known, v), known);
        let mut open = vec![0_u32];
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            if node.least_angle(v, p) >= best.0 {
                continue;
            }
            if node.facets > 0 {
                for i in node.link..node.link + node.facets {
                    let q = self.facet(i).nearest_in_angle(v, p);
                    let seen = angle(p, q, v);
                    if seen < best.0 {
                        best = (seen, q);
                    }
                }
                continue;
            }
            let children = [at + 1, node.link];
            let [first, second] = children.each(|c| self.nodes[c as usize].least_angle(v, p));
            // The nearer one is looked at first.
            open.extend(if first < second {
                [children[1], children[0]]
            } else {
                children
            });
        }
        best.1
    }
}

fn grow(corners: &[[DVec3; 3]], order: &mut [u32], first: usize, nodes: &mut Vec<Node>) {
    let (mut low, mut high) = (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
    for &t in order.iter() {
        for &p in &corners[t as usize] {
            low = low.min(p);
            high = high.max(p);
        }
    }
    let at = nodes.len();
    nodes.push(Node {
        low,
        high,
        link: first as u32,
        facets: order.len() as u32,
    });
    if order.len() <= LEAF {
        return;
    }
    let size = high - low;
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let place = |t: u32| {
        let [a, b, c] = corners[t as usize];
        a[axis] + b[axis] + c[axis]
    };
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&s, &t| place(s).total_cmp(&place(t)).then(s.cmp(&t)));
    let (left, right) = order.split_at_mut(half);
    grow(corners, left, first, nodes);
    nodes[at].link = nodes.len() as u32;
    nodes[at].facets = 0;
    grow(corners, right, first + half, nodes);
}
