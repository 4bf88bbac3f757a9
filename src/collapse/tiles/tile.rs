//! The collapses inside one tile.

use glam::DVec3;

use super::{TileCollapse, TileOptions, Tileable, cut::Cut};
use crate::{
    Progress, Result,
    collapse::{Counters, Engine, LiveMesh, NONE, Observer, Patch, Proposal},
    num::Each,
};

/// A tile after its collapses, in ids of the whole. Its adjacency is gone: all tiles of a round wait
/// for each other, and those of a million triangles would take more memory than the mesh.
pub(super) struct Tile {
    pub(super) vertices: Vec<u32>,
    pub(super) positions: Vec<DVec3>,
    pub(super) faces: Vec<u32>,
    /// The corners of `faces`, [`NONE`] where they are gone.
    pub(super) corners: Vec<[u32; 3]>,
    /// Number of faces that are gone.
    pub(super) removed: usize,
    pub(super) method: Box<dyn Tileable>,
    pub(super) collapses: Vec<TileCollapse>,
    pub(super) counters: Counters,
}

/// Collapses the edges of a tile in the order of its own queue up to the cost `limit`.
pub(super) fn collapse_tile(
    whole: &LiveMesh,
    method: &dyn Tileable,
    cut: Cut,
    options: TileOptions,
    limit: f64,
    progress: &dyn Progress,
) -> Result<Tile> {
    let Cut {
        vertices,
        faces,
        frozen,
    } = cut;
    let positions = vertices.iter().map(|&v| whole.position(v)).collect();
    let local = |v: u32| vertices.binary_search(&v).map_or(NONE, |slot| slot as u32);
    let corners = faces
        .iter()
        .map(|&t| whole.faces[t as usize].each(local))
        .collect();
    let live = LiveMesh::part(whole, positions, corners, frozen);
    let mut method = method.part(&live, &vertices);
    let mut collapses = Collapses {
        all: Vec::new(),
        cost: f64::NEG_INFINITY,
    };
    let engine = Engine::new(live, options.rules, options.schedule);
    let mut engine = engine.with_cost_limit(limit);
    engine.run(&mut *method, 0, &mut collapses, &Interruption(progress))?;
    let (live, counters) = engine.into_parts();
    let collapses = collapses.all.into_iter().map(|c| TileCollapse {
        keep: vertices[c.keep as usize],
        gone: vertices[c.gone as usize],
        ..c
    });
    let collapses = collapses.collect();
    let corners = live.faces.iter().map(|corners| {
        corners.each(|v| match v {
            NONE => NONE,
            v => vertices[v as usize],
        })
    });
    Ok(Tile {
        collapses,
        removed: faces.len() - live.triangle_count(),
        corners: corners.collect(),
        positions: live.positions,
        vertices,
        faces,
        method,
        counters,
    })
}

/// Hears of an interruption and says nothing.
struct Interruption<'a>(&'a dyn Progress);

impl Progress for Interruption<'_> {
    fn report(&self, _: &str, _: u64, _: u64) {}

    fn interrupted(&self) -> bool {
        self.0.interrupted()
    }
}

/// The collapses of a tile, in its own ids.
struct Collapses {
    all: Vec<TileCollapse>,
    /// The largest cost so far.
    cost: f64,
}

impl Observer for Collapses {
    fn chosen(&mut self, proposal: &Proposal) {
        if proposal.secondary > self.cost {
            self.cost = proposal.secondary;
        }
    }

    fn committed(&mut self, _: &LiveMesh, patch: &Patch) {
        if let (Some(moved), Some(gone)) = (patch.moved, patch.gone) {
            self.all.push(TileCollapse {
                keep: moved.vertex,
                gone,
                to: moved.to,
                cost: self.cost,
            });
        }
    }
}
