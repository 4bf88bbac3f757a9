//! Groups of corners that share a normal.

use glam::DVec3;

use super::face::{Face, Faces};
use crate::{
    collapse::Forest,
    mesh::{Edges, Mesh},
    num::{Each, math::unit},
};

/// Most faces at an edge of which every two are compared; of more, each with the next. Sheets that show both sides have four.
const FEW: usize = 8;

/// The slots of the corners of every group, ascending, in the order of their first ones.
#[derive(Clone, Debug)]
pub(super) struct Groups {
    starts: Vec<usize>,
    slots: Vec<u32>,
}

impl Groups {
    /// Corners at a vertex belong together where a chain of edges at the vertex joins their faces, at all of which the two
    /// corners, given by their slots, share a normal. Corners of faces without an area, or of parts without normals, are
    /// alone. O(n log n).
    pub(super) fn of(mesh: &Mesh, faces: &Faces, share: &dyn Fn(usize, usize) -> bool) -> Self {
        let slots = 3 * faces.0.len();
        let mut forest = Forest::of(slots);
        for (edge, around) in Edges::of(mesh).iter() {
            let farthest = if around.len() > FEW { 1 } else { FEW };
            for (i, &f) in around.iter().enumerate() {
                for &g in around[i + 1..].iter().take(farthest) {
                    for v in edge {
                        let [a, b] = [f, g].each(|f| faces.slot(f as usize, v));
                        if faces.are_shown(a, b) && share(a, b) {
                            forest.unite(a, b);
                        }
                    }
                }
            }
        }
        Self::from_forest(forest, slots)
    }

    fn from_forest(mut forest: Forest, slots: usize) -> Self {
        let mut group_of = vec![0_u32; slots];
        let mut sizes = Vec::new();
        for slot in 0..slots {
            let root = forest.root(slot);
            if root == slot {
                group_of[slot] = sizes.len() as u32;
                sizes.push(0_usize);
            } else {
                group_of[slot] = group_of[root];
            }
            sizes[group_of[slot] as usize] += 1;
        }
        let mut starts = Vec::with_capacity(sizes.len() + 1);
        let mut total = 0;
        for size in &sizes {
            starts.push(total);
            total += size;
        }
        starts.push(total);
        let mut next = starts.clone();
        let mut sorted = vec![0_u32; slots];
        for (slot, &group) in group_of.iter().enumerate() {
            sorted[next[group as usize]] = slot as u32;
            next[group as usize] += 1;
        }
        Self {
            starts,
            slots: sorted,
        }
    }

    /// Number of groups.
    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The slots of a group, ascending.
    pub(super) fn slots(&self, group: usize) -> &[u32] {
        &self.slots[self.starts[group]..self.starts[group + 1]]
    }

    /// By slot: the direction of the sum of the group's faces, each as long as its area is large; `None` where there is
    /// none, and in parts without normals.
    pub(super) fn area_weighted(&self, faces: &Faces) -> Vec<Option<DVec3>> {
        let mut found = vec![None; self.slots.len()];
        for group in 0..self.len() {
            let slots = self.slots(group);
            let sum = |sum: DVec3, &slot: &u32| sum + faces.0[slot as usize / 3].normal;
            let normal = unit(slots.iter().fold(DVec3::ZERO, sum));
            for &slot in slots {
                let slot = slot as usize;
                let face = &faces.0[slot / 3];
                if face.has_normals {
                    found[slot] = normal.or_else(|| fallback(face, slot % 3));
                }
            }
        }
        found
    }
}

/// A normal for a corner that nothing else gives one.
pub(super) fn fallback(face: &Face, corner: usize) -> Option<DVec3> {
    let carried = unit(face.carried[corner]);
    Some(carried.or_else(|| unit(face.normal)).unwrap_or(DVec3::Z))
}
