//! A tree of boxes over triangles, which finds the triangle nearest to a point.
//!
//! **The answer does not depend on the tree.** It is the minimum, over *all* triangles, of the squared distance as
//! [`TreeItem::squared_distance`] computes it: rounded, but a function of point and triangle alone. A box is skipped
//! only where its squared distance is not below the best so far, and a box distance never exceeds the computed distance
//! of a
//! [`Triangle`] inside: the closest point is clamped to the triangle's box, rounded subtraction, squaring and addition
//! are monotonic, and both distances are summed in the same order. So neither the split rule nor the starting bound
//! nor the order of the search can change a bit.
//! Items whose distance is not clamped like that may be missed where rounding lets a box be skipped wrongly: what is
//! found is still an item at the distance that is returned.
//! Boxes are `f64` minima and maxima of coordinates: nothing is rounded. Limits: fewer than 2^31 triangles.

use std::cmp::Ordering;

use glam::DVec3;

use super::{Box3, Triangle};
use crate::parallel;

/// Triangles in a leaf.
const LEAF: usize = 4;
/// Below this many triangles a subtree is built on one thread.
const PARALLEL: usize = 4_096;
/// Deepest tree: halving 2^31 triangles down to a leaf.
const DEPTH: usize = 32;

/// A triangle, prepared for distances in some way, that a [`TriangleTree`] can hold.
pub trait TreeItem: Send {
    /// The smallest box around it.
    fn bounds(&self) -> Box3;

    /// Squared distance from a point.
    fn squared_distance(&self, p: DVec3) -> f64;

    /// An order of items whose middles are equal along an axis.
    fn order(&self, _other: &Self) -> Ordering {
        Ordering::Equal
    }
}

impl TreeItem for Triangle {
    #[inline]
    fn bounds(&self) -> Box3 {
        Triangle::bounds(self)
    }

    #[inline]
    fn squared_distance(&self, p: DVec3) -> f64 {
        self.closest(p).1
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Node {
    bounds: Box3,
    /// Leaf: index of the first triangle. Inner node: index of the second child; the first one follows the node.
    index: u32,
    /// Triangles in a leaf; 0 for an inner node.
    count: u32,
}

/// Triangles in a tree of boxes.
#[derive(Clone, Debug)]
pub struct TriangleTree<T = Triangle> {
    nodes: Vec<Node>,
    items: Vec<T>,
}

impl<T: TreeItem> TriangleTree<T> {
    /// Builds the tree by halving at the median of the longest side; O(n log n). `None` without triangles.
    pub fn of(mut items: Vec<T>) -> Option<Self> {
        if items.is_empty() {
            return None;
        }
        let mut nodes = vec![Node::default(); node_count(items.len())];
        build(&mut nodes, &mut items, 0, 0);
        Some(Self { nodes, items })
    }

    /// A triangle of the tree.
    #[inline]
    pub fn item(&self, index: u32) -> &T {
        &self.items[index as usize]
    }

    /// Squared distance from `p` to the triangles and the index of a triangle of the tree that has it. `near` is a
    /// guess of that triangle: a good one saves time and changes no distance.
    pub fn squared_distance(&self, p: DVec3, near: u32) -> (f64, u32) {
        self.search(p, (self.item(near).squared_distance(p), near), |_| true)
    }

    /// A triangle whose squared distance from `p` is below `limit`, the nearest one; `None` where there is none. `near`
    /// is a guess that saves time.
    pub fn nearest_within(&self, p: DVec3, near: Option<u32>, limit: f64) -> Option<u32> {
        const NONE: u32 = u32::MAX;
        let mut best = (limit, NONE);
        if let Some(near) = near {
            let squared = self.item(near).squared_distance(p);
            if squared < limit {
                best = (squared, near);
            }
        }
        let (_, found) = self.search(p, best, |_| true);
        (found != NONE).then_some(found)
    }

    /// The nearest one of the triangles that `counts` admits whose squared distance from `p` is below `limit`; `None`
    /// where there is none.
    pub fn nearest_of(&self, p: DVec3, limit: f64, counts: impl Fn(&T) -> bool) -> Option<u32> {
        const NONE: u32 = u32::MAX;
        let (_, found) = self.search(p, (limit, NONE), counts);
        (found != NONE).then_some(found)
    }

    /// The least squared distance below that of `best` of a triangle that `counts` admits, and that triangle; `best` where
    /// there is none.
    #[inline]
    fn search(&self, p: DVec3, mut best: (f64, u32), counts: impl Fn(&T) -> bool) -> (f64, u32) {
        let mut stack = [(0_u32, 0.0_f64); DEPTH + 1];
        stack[0] = (0, self.nodes[0].bounds.squared_distance(p));
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (index, bound) = stack[height];
            if bound >= best.0 {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                for i in node.index..node.index + node.count {
                    let item = &self.items[i as usize];
                    let squared = item.squared_distance(p);
                    if squared < best.0 && counts(item) {
                        best = (squared, i);
                    }
                }
                continue;
            }
            let [mut far, mut close] = [index + 1, node.index]
                .map(|i| (i, self.nodes[i as usize].bounds.squared_distance(p)));
            if far.1 < close.1 {
                (far, close) = (close, far);
            }
            // Each level leaves at most one node behind, so the stack never exceeds the depth.
            for child in [far, close] {
                if child.1 < best.0 {
                    stack[height] = child;
                    height += 1;
                }
            }
        }
        best
    }
}

impl TriangleTree {
    /// The tree of triangles by their corners; `None` without any. O(n log n).
    pub fn new(corners: Vec<[DVec3; 3]>) -> Option<Self> {
        Self::of(corners.into_iter().map(Triangle::new).collect())
    }

    /// The corners of a triangle of the tree, in ascending order of their coordinates.
    pub fn corners(&self, index: u32) -> [DVec3; 3] {
        self.item(index).corners()
    }

    /// The point of the triangles nearest to `p`, and the index of a triangle that has it. `near` as for
    /// [`TriangleTree::squared_distance`], but it may decide between points at the same distance.
    pub fn nearest(&self, p: DVec3, near: u32) -> (DVec3, u32) {
        let (_, index) = self.squared_distance(p, near);
        (self.item(index).closest(p).0, index)
    }

    /// True where a triangle within the root of `squared` of `p` has a normal along `direction`: their product is
    /// positive.
    pub fn looks_along(&self, p: DVec3, direction: DVec3, squared: f64) -> bool {
        let mut stack = [0_u32; DEPTH + 1];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let index = stack[height];
            let node = &self.nodes[index as usize];
            if node.bounds.squared_distance(p) > squared {
                continue;
            }
            if node.count == 0 {
                // As above.
                stack[height] = index + 1;
                stack[height + 1] = node.index;
                height += 2;
                continue;
            }
            let leaf = node.index as usize..(node.index + node.count) as usize;
            let looks =
                |t: &Triangle| t.area_normal().dot(direction) > 0.0 && t.closest(p).1 <= squared;
            if self.items[leaf].iter().any(looks) {
                return true;
            }
        }
        false
    }
}

/// A binary tree with full leaves except the last: one inner node less than leaves.
fn node_count(triangles: usize) -> usize {
    2 * triangles.div_ceil(LEAF) - 1
}

/// Fills `nodes` with the tree of `items`; they lie at `node` and `first` of the whole arrays.
fn build<T: TreeItem>(nodes: &mut [Node], items: &mut [T], node: usize, first: usize) {
    let bounds = items[1..]
        .iter()
        .fold(items[0].bounds(), |all, t| all.union(t.bounds()));
    let count = items.len();
    if count <= LEAF {
        nodes[0] = Node {
            bounds,
            index: first as u32,
            count: count as u32,
        };
        return;
    }
    let axis = bounds.longest_axis();
    let half = (count.div_ceil(LEAF) / 2) * LEAF;
    // Halves of the sum: the sum itself could be infinite.
    let centre = |t: &T| {
        let Box3 { low, high } = t.bounds();
        0.5 * low[axis] + 0.5 * high[axis]
    };
    items.select_nth_unstable_by(half, |s, t| {
        centre(s).total_cmp(&centre(t)).then_with(|| s.order(t))
    });
    let (inner, below) = nodes.split_at_mut(1);
    let (left_nodes, right_nodes) = below.split_at_mut(node_count(half));
    let (left, right) = items.split_at_mut(half);
    let second = node + 1 + left_nodes.len();
    inner[0] = Node {
        bounds,
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Small integer coordinates make ties and degenerate triangles frequent; the scale brings slivers in.
    fn soup() -> impl Strategy<Value = Vec<[DVec3; 3]>> {
        let coordinate = (-6_i32..=6, 0_u32..3)
            .prop_map(|(x, shift)| f64::from(x) / f64::from(1 << (8 * shift)));
        let point = prop::array::uniform3(coordinate).prop_map(DVec3::from_array);
        prop::collection::vec(prop::array::uniform3(point), 1..120)
    }

    /// Coordinates a few units in the last place apart: closest points are rounded across the sides of the box.
    fn crowded() -> impl Strategy<Value = DVec3> {
        let coordinate = (-2_i32..=2, -8_i32..=8)
            .prop_map(|(x, ulps)| f64::from(x) * 0.1 + f64::from(ulps) * f64::EPSILON / 16.0);
        prop::array::uniform3(coordinate).prop_map(DVec3::from_array)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn the_tree_finds_the_very_minimum_over_all_triangles(
            corners in soup(),
            p in prop::array::uniform3(-8.0..8.0_f64).prop_map(DVec3::from_array),
            guess in 0_usize..1000,
        ) {
            let triangles: Vec<Triangle> = corners.iter().map(|&c| Triangle::new(c)).collect();
            let all = triangles.iter().map(|t| t.closest(p).1).fold(f64::INFINITY, f64::min);
            let tree = TriangleTree::of(triangles).expect("not empty");
            let (found, _) = tree.squared_distance(p, (guess % corners.len()) as u32);
            prop_assert_eq!(found.to_bits(), all.to_bits());
        }

        #[test]
        fn no_box_is_farther_than_what_lies_inside(
            corners in soup(),
            p in prop::array::uniform3(-8.0..8.0_f64).prop_map(DVec3::from_array),
        ) {
            for c in corners {
                prop_assert!(box_and_triangle(c, p), "{p} and {c:?}");
            }
        }

        #[test]
        fn no_box_is_farther_than_what_was_rounded_out_of_it(
            pairs in prop::collection::vec((prop::array::uniform3(crowded()), crowded()), 200),
        ) {
            for (c, p) in pairs {
                prop_assert!(box_and_triangle(c, p), "{p} and {c:?}");
            }
        }
    }

    /// True where the box is not farther from `p` than the triangle.
    fn box_and_triangle(corners: [DVec3; 3], p: DVec3) -> bool {
        let t = Triangle::new(corners);
        t.bounds().squared_distance(p) <= t.closest(p).1
    }
}
