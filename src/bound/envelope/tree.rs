//! A tree of boxes over the original's triangles.
//!
//! Halved at the median of the longest side. The answer is a triangle within a given distance and, among those that
//! were looked at, the nearest: whatever the tree looks like, a distance that is returned is one to a triangle of the
//! set. Where rounding lets a box be skipped wrongly, a triangle is missed and the caller refuses: never the other way.

use glam::DVec3;

use super::Facet;
use crate::parallel;

/// Triangles in a leaf.
const LEAF: usize = 4;
/// Below this many triangles a subtree is built on one thread.
const PARALLEL: usize = 8_192;
/// Deepest tree: halving 2^31 triangles.
const DEPTH: usize = 40;

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// Leaf: index of its first triangle. Inner node: index of its second child; the first one follows the node.
    index: u32,
    /// Triangles in a leaf; 0 for an inner node.
    count: u32,
}

impl Node {
    #[inline]
    fn distance2(&self, p: DVec3) -> f64 {
        let d = (self.low - p).max(p - self.high).max(DVec3::ZERO);
        d.dot(d)
    }
}

/// Triangles in a tree of boxes.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    nodes: Vec<Node>,
    facets: Vec<Facet>,
}

impl Tree {
    /// Builds the tree; O(n log n).
    #[must_use]
    pub fn new(mut facets: Vec<Facet>) -> Self {
        let mut nodes = Vec::new();
        if !facets.is_empty() {
            let blank = Node {
                low: DVec3::ZERO,
                high: DVec3::ZERO,
                index: 0,
                count: 0,
            };
            nodes = vec![blank; node_count(facets.len())];
            build(&mut nodes, &mut facets, 0, 0);
        }
        Self { nodes, facets }
    }

    /// A triangle of the tree.
    #[inline]
    #[must_use]
    pub fn facet(&self, index: u32) -> &Facet {
        &self.facets[index as usize]
    }

    /// A triangle whose squared distance from `p` is below `limit2`, the nearest but for rounding; `None` where there
    /// is none. `near` is a guess that saves time.
    #[must_use]
    pub fn nearest(&self, p: DVec3, near: Option<u32>, limit2: f64) -> Option<u32> {
        let mut best = limit2;
        let mut found = None;
        if let Some(near) = near {
            let d = self.facets[near as usize].distance2(p);
            if d < best {
                best = d;
                found = Some(near);
            }
        }
        let first = self.nodes.first()?;
        let mut stack = [(0_u32, 0.0_f64); DEPTH];
        stack[0] = (0, first.distance2(p));
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (index, bound) = stack[height];
            if bound >= best {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                for i in node.index..node.index + node.count {
                    let d = self.facets[i as usize].distance2(p);
                    if d < best {
                        best = d;
                        found = Some(i);
                    }
                }
                continue;
            }
            let [mut far, mut close] =
                [index + 1, node.index].map(|i| (i, self.nodes[i as usize].distance2(p)));
            if far.1 < close.1 {
                (far, close) = (close, far);
            }
            // Each level leaves at most one node behind, so the stack never exceeds the depth.
            for child in [far, close] {
                if child.1 < best {
                    stack[height] = child;
                    height += 1;
                }
            }
        }
        found
    }
}

/// A binary tree with full leaves except the last: one inner node less than leaves.
fn node_count(facets: usize) -> usize {
    2 * facets.div_ceil(LEAF) - 1
}

/// Fills `nodes` with the tree of `facets`; they lie at `node` and `first` of the whole arrays.
fn build(nodes: &mut [Node], facets: &mut [Facet], node: usize, first: usize) {
    let (mut low, mut high) = (facets[0].low(), facets[0].high());
    for f in &facets[1..] {
        low = low.min(f.low());
        high = high.max(f.high());
    }
    let count = facets.len();
    if count <= LEAF {
        nodes[0] = Node {
            low,
            high,
            index: first as u32,
            count: count as u32,
        };
        return;
    }
    let side = high - low;
    let axis = if side.x >= side.y && side.x >= side.z {
        0
    } else if side.y >= side.z {
        1
    } else {
        2
    };
    let half = (count.div_ceil(LEAF) / 2) * LEAF;
    let centre = |f: &Facet| 0.5 * f.low()[axis] + 0.5 * f.high()[axis];
    facets.select_nth_unstable_by(half, |f, g| {
        centre(f).total_cmp(&centre(g)).then_with(|| f.order(g))
    });
    let (inner, below) = nodes.split_at_mut(1);
    let (left_nodes, right_nodes) = below.split_at_mut(node_count(half));
    let (left, right) = facets.split_at_mut(half);
    let second = node + 1 + left_nodes.len();
    inner[0] = Node {
        low,
        high,
        index: second as u32,
        count: 0,
    };
    let build_left = &mut || build(left_nodes, left, node + 1, first);
    let build_right = &mut || build(right_nodes, right, second, first + half);
    if count > PARALLEL {
        parallel::both(build_left, build_right);
    } else {
        build_left();
        build_right();
    }
}
