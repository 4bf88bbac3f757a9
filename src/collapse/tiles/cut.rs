//! Cuts of a mesh into boxes with few vertices.

use crate::{
    collapse::{LiveMesh, NONE},
    geometry::Box3,
    num::Each,
    parallel,
};

/// A tile before its collapses, in ids of the whole.
pub(super) struct Cut {
    /// Its vertices, ascending.
    pub(super) vertices: Vec<u32>,
    /// The faces that have all their vertices in it.
    pub(super) faces: Vec<u32>,
    /// True for those of its vertices that have faces elsewhere.
    pub(super) frozen: Vec<bool>,
}

/// Cuts a mesh into boxes of at most `most` vertices; every other round cuts elsewhere.
pub(super) fn cut(live: &LiveMesh, most: usize, round: u32) -> Vec<Cut> {
    let mut used: Vec<u32> = (0..live.vertex_ids())
        .filter(|&v| live.valence(v) > 0)
        .collect();
    let first = if round.is_multiple_of(2) {
        0.5
    } else {
        1.0 / 3.0
    };
    let mut boxes = Vec::new();
    split(live, &mut used, most, first, &mut boxes);
    let mut tile_of = vec![NONE; live.vertex_ids() as usize];
    let mut slot_of = vec![NONE; live.vertex_ids() as usize];
    let mut cuts: Vec<Cut> = Vec::with_capacity(boxes.len());
    for (tile, mut vertices) in boxes.into_iter().enumerate() {
        vertices.sort_unstable();
        for (slot, &v) in vertices.iter().enumerate() {
            tile_of[v as usize] = tile as u32;
            slot_of[v as usize] = slot as u32;
        }
        cuts.push(Cut {
            frozen: vec![false; vertices.len()],
            vertices,
            faces: Vec::new(),
        });
    }
    for (t, corners) in live.faces.iter().enumerate() {
        if corners[0] == NONE {
            continue;
        }
        let tiles = corners.each(|v| tile_of[v as usize]);
        if tiles[0] == tiles[1] && tiles[1] == tiles[2] {
            cuts[tiles[0] as usize].faces.push(t as u32);
        } else {
            for k in 0..3 {
                cuts[tiles[k] as usize].frozen[slot_of[corners[k] as usize] as usize] = true;
            }
        }
    }
    cuts
}

/// Halves a box across its longest side until it holds few vertices; the first cut is at the share `first`.
fn split(live: &LiveMesh, ids: &mut [u32], most: usize, first: f64, boxes: &mut Vec<Vec<u32>>) {
    if ids.len() <= most.max(1) {
        boxes.push(ids.to_vec());
        return;
    }
    let place = |v: u32| live.position(v);
    let axis = Box3::of(ids.iter().map(|&v| place(v))).map_or(0, |all| all.longest_axis());
    let at = ((ids.len() as f64 * first) as usize).clamp(1, ids.len() - 1);
    ids.select_nth_unstable_by(at, |&a, &b| {
        place(a)[axis].total_cmp(&place(b)[axis]).then(a.cmp(&b))
    });
    let (left, right) = ids.split_at_mut(at);
    let (mut more, mut rest) = (Vec::new(), Vec::new());
    parallel::both(&mut || split(live, left, most, 0.5, &mut more), &mut || {
        split(live, right, most, 0.5, &mut rest)
    });
    boxes.append(&mut more);
    boxes.append(&mut rest);
}

impl LiveMesh {
    /// True where nothing but positions and triangles matters: no attributes, no borders of materials, no locks, no
    /// weights.
    pub(super) fn is_plain(&self) -> bool {
        let held = self.locked.contains(&true) || !self.weights.is_empty();
        !self.may_have_features() && self.wedges.is_empty() && !held
    }
}
