//! The collapses inside one tile.

use glam::DVec3;

use super::{TileCollapse, TileOptions, Tileable, cut::Cut};
use crate::{
    Progress, Result,
    collapse::{
        Counters, Engine, Estimates, Evaluation, LiveMesh, Method, MethodScratch, NONE, Observer,
        Patch, Plan, Proposal, Refusal, Review, Site,
    },
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
    let mut method = Limited {
        own: method.part(&live, &vertices),
        limit,
        costs: Vec::new(),
    };
    let mut collapses = Collapses(Vec::new());
    let mut engine = Engine::new(live, options.rules, options.schedule);
    engine.run(&mut method, 0, &mut collapses, &Interruption(progress))?;
    let (live, counters) = engine.into_parts();
    let mut largest = f64::NEG_INFINITY;
    let collapses = collapses.0.into_iter().zip(method.costs);
    let collapses = collapses
        .map(|((keep, gone, to), cost)| {
            largest = if cost > largest { cost } else { largest };
            TileCollapse {
                keep: vertices[keep as usize],
                gone: vertices[gone as usize],
                to,
                cost: largest,
            }
        })
        .collect();
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
        method: method.own,
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

/// The ends and places of all collapses.
struct Collapses(Vec<(u32, u32, DVec3)>);

impl Observer for Collapses {
    fn committed(&mut self, _: &LiveMesh, patch: &Patch) {
        if let (Some(moved), Some(gone)) = (patch.moved, patch.gone) {
            self.0.push((moved.vertex, gone, moved.to));
        }
    }
}

/// A method that ends before a cost, and keeps all costs up to there.
struct Limited {
    own: Box<dyn Tileable>,
    limit: f64,
    costs: Vec<f64>,
}

impl Method for Limited {
    /// A tile has one task.
    fn plan(&self) -> Plan {
        Plan {
            evaluations_per_task: usize::MAX,
            ..self.own.plan()
        }
    }

    fn estimates(&self) -> Option<&dyn Estimates> {
        self.own.estimates()
    }

    fn propose(
        &self,
        site: &Site<'_>,
        how: Evaluation,
        scratch: &mut MethodScratch,
    ) -> std::result::Result<Proposal, Refusal> {
        self.own.propose(site, how, scratch)
    }

    fn review(&mut self, live: &LiveMesh, patch: &Patch, proposal: &Proposal) -> Review {
        let own = self.own.review(live, patch, proposal);
        if own != Review::Commit {
            return own;
        }
        let within = proposal.secondary <= self.limit;
        if !within {
            return Review::LimitReached;
        }
        self.costs.push(proposal.secondary);
        Review::Commit
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        self.own.committed(live, patch);
    }
}
