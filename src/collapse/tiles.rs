//! Thinning of a large mesh tile by tile, until it is small enough for one queue.
//!
//! Collapses far from each other do not see each other, so the greedy order between them means nothing but where the
//! run stops. A round cuts the mesh into tiles of a size that a processor's cache holds; every tile is collapsed in
//! the order of its own queue up to a cost that is the same for all, in parallel; vertices with faces in two tiles wait
//! for the next round, which cuts elsewhere. The collapses of a round are put in one order by the largest cost so far
//! in their tile. Cuts, costs and order follow from the mesh alone: not from the number of threads, nor from how far
//! the run will go.

use glam::DVec3;

use super::{
    Changes, Counters, Engine, LiveMesh, Method, NONE, Observer, Patch, Proposal, Refusal, Ring,
    Rules, Schedule, Site, Target,
};
use crate::{Error, Progress, Result, geometry::Box3, parallel};

/// A method that can work on parts of a mesh at the same time.
pub trait Divisible: Method + Send + Sized {
    /// The method for a part whose vertex `i` is the vertex `vertices[i]` of the whole.
    #[must_use]
    fn part(&self, part: &LiveMesh, vertices: &[u32]) -> Self;

    /// Takes back what a part knows about its vertices.
    fn unite(&mut self, part: Self, vertices: &[u32]);

    /// The whole has new adjacency and positions.
    fn relinked(&mut self, live: &LiveMesh);
}

/// How a mesh is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tiling {
    /// Vertices of a tile, at most.
    pub vertices: usize,
    /// Triangles that one queue takes: a mesh with no more of them is left alone.
    pub triangles: usize,
}

impl Tiling {
    /// For meshes that something else goes on with: twice as fast on 70,000 triangles, and up to 2 % more error while
    /// half of them are left.
    pub const COARSE: Self = Self {
        vertices: 4096,
        triangles: 24_576,
    };
}

impl Default for Tiling {
    /// On the bunny, flat RMS at 23 levels from 10 % to 0.2 % is that of one queue: 0.999 of it on average.
    fn default() -> Self {
        Self {
            vertices: 4096,
            triangles: 49_152,
        }
    }
}

/// The share of edges that a round may collapse at their present costs.
const SHARE: f64 = 0.5;

/// Every so-manieth edge is asked for its cost to find that of the share.
const SAMPLED: usize = 16;

/// A collapse in a tile, in ids of the whole.
#[derive(Clone, Copy, Debug)]
struct Thinned {
    keep: u32,
    gone: u32,
    to: DVec3,
    /// The largest cost in its tile so far.
    cost: f64,
}

/// What is left of a tile after its collapses, in ids of the whole. Its adjacency is gone: all tiles of a round wait
/// for each other, and those of a million triangles would take more memory than the mesh.
struct Tile<M> {
    vertices: Vec<u32>,
    positions: Vec<DVec3>,
    faces: Vec<u32>,
    /// The corners of `faces`, [`NONE`] where they are gone.
    corners: Vec<[u32; 3]>,
    removed: usize,
    method: M,
    collapses: Vec<Thinned>,
    counters: Counters,
}

/// Thins `live` in rounds down to what one queue takes, or to `target` where that is reached before.
///
/// Meshes with attributes, materials or locks are left alone. `counters` goes on counting.
///
/// # Errors
/// [`crate::Error::Interrupted`].
#[expect(
    clippy::too_many_arguments,
    reason = "what an engine has, and where the results go"
)]
pub fn thin<M: Divisible>(
    live: &mut LiveMesh,
    method: &mut M,
    (rules, schedule): (Rules, Schedule),
    tiling: Tiling,
    target: Target,
    counters: &mut Counters,
    observer: &mut dyn Observer,
    progress: &dyn Progress,
) -> Result<()> {
    let start = live.triangle_count();
    let total = start.saturating_sub(target.triangles) as u64;
    for round in 0_u32.. {
        let before = live.triangle_count();
        if before <= tiling.triangles.max(target.triangles) || !live.is_plain() {
            break;
        }
        progress.step("collapse in tiles", (start - before) as u64, total)?;
        let Some(limit) = common_limit(live, method) else {
            break;
        };
        let cuts = cut(live, tiling, round);
        let whole = &*live;
        let by = &*method;
        let tiles = parallel::map_vec(cuts, |cut| {
            collapse_tile(whole, by, cut, (rules, schedule), limit, progress)
        });
        let tiles: Vec<Tile<M>> = tiles.into_iter().collect::<Result<_>>()?;
        for tile in &tiles {
            counters.add(&tile.counters);
        }
        let removed: usize = tiles.iter().map(|t| t.removed).sum();
        let mut order: Vec<Thinned> = Vec::new();
        for tile in &tiles {
            order.extend_from_slice(&tile.collapses);
        }
        // Stable: tiles in their order, and every tile in its own.
        sort_by_cost(&mut order);
        if before - removed < target.triangles {
            let applied = apply(live, method, &order, target, observer)?;
            counters.collapses -= order.len() as u64 - applied;
            return Ok(());
        }
        let mut faces = std::mem::take(&mut live.faces);
        for tile in tiles {
            for (&id, &corners) in tile.faces.iter().zip(&tile.corners) {
                faces[id as usize] = corners;
            }
            for (&v, &p) in tile.vertices.iter().zip(&tile.positions) {
                live.positions[v as usize] = p;
            }
            method.unite(tile.method, &tile.vertices);
        }
        live.link(faces);
        method.relinked(live);
        for c in &order {
            observer.thinned(live, c.keep, c.gone, c.to);
        }
        if removed < before / 16 {
            break;
        }
    }
    Ok(())
}

/// Commits collapses one by one until the target is reached; how many that were.
fn apply<M: Method>(
    live: &mut LiveMesh,
    method: &mut M,
    order: &[Thinned],
    target: Target,
    observer: &mut dyn Observer,
) -> Result<u64> {
    let mut applied = 0;
    let (mut ring, mut patch, mut changes) =
        (Ring::default(), Patch::default(), Changes::default());
    for c in order {
        if live.triangle_count() <= target.triangles {
            break;
        }
        let edge = live
            .find_edge(c.keep, c.gone)
            .ok_or_else(|| Error::Internal("a collapse of a tile does not fit the mesh".into()))?;
        ring.gather(live, edge);
        ring.patch(live, c.to, &mut patch);
        live.apply(&patch, &mut changes);
        method.committed(live, &patch);
        observer.committed(live, &patch);
        applied += 1;
    }
    Ok(applied)
}

fn sort_by_cost(order: &mut [Thinned]) {
    parallel::sort_stable_by(order, |a, b| a.cost.total_cmp(&b.cost));
}

/// The cost below which the wanted share of edges lies; `None` where the method cannot estimate.
fn common_limit<M: Method>(live: &LiveMesh, method: &M) -> Option<f64> {
    let ids: Vec<u32> = (0..live.edge_ids())
        .step_by(SAMPLED)
        .filter(|&e| live.edge(e).is_some())
        .collect();
    let mut costs = parallel::filter_map(ids.len(), |i| method.estimate(live, ids[i]));
    if costs.is_empty() {
        return None;
    }
    let at = ((costs.len() as f64 * SHARE) as usize).min(costs.len() - 1);
    Some(*costs.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// A tile before its collapses.
struct Cut {
    vertices: Vec<u32>,
    faces: Vec<u32>,
    frozen: Vec<bool>,
}

/// Cuts a mesh into boxes with few vertices; every other round cuts elsewhere.
fn cut(live: &LiveMesh, tiling: Tiling, round: u32) -> Vec<Cut> {
    let mut used: Vec<u32> = (0..live.vertex_ids())
        .filter(|&v| live.valence(v) > 0)
        .collect();
    let first = if round.is_multiple_of(2) {
        0.5
    } else {
        1.0 / 3.0
    };
    let mut boxes = Vec::new();
    split(live, &mut used, tiling.vertices, first, &mut boxes);
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
        let tiles = corners.map(|v| tile_of[v as usize]);
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

fn collapse_tile<M: Divisible>(
    whole: &LiveMesh,
    method: &M,
    cut: Cut,
    (rules, schedule): (Rules, Schedule),
    limit: f64,
    progress: &dyn Progress,
) -> Result<Tile<M>> {
    let Cut {
        vertices,
        faces,
        frozen,
    } = cut;
    let positions = vertices.iter().map(|&v| whole.position(v)).collect();
    let local = |v: u32| vertices.binary_search(&v).map_or(NONE, |slot| slot as u32);
    let corners = faces
        .iter()
        .map(|&t| whole.faces[t as usize].map(local))
        .collect();
    let live = LiveMesh::part(whole, positions, corners, frozen);
    let method = Limited {
        own: method.part(&live, &vertices),
        limit,
        costs: Vec::new(),
    };
    let mut collapses = Collapses(Vec::new());
    let mut engine = Engine::new(live, method, rules, schedule);
    engine.run(
        Target { triangles: 0 },
        &mut collapses,
        &Interruption(progress),
    )?;
    let (live, method, counters) = engine.into_parts();
    let mut largest = f64::NEG_INFINITY;
    let collapses = collapses.0.into_iter().zip(method.costs);
    let collapses = collapses
        .map(|((keep, gone, to), cost)| {
            largest = if cost > largest { cost } else { largest };
            Thinned {
                keep: vertices[keep as usize],
                gone: vertices[gone as usize],
                to,
                cost: largest,
            }
        })
        .collect();
    let corners = live.faces.iter().map(|corners| {
        corners.map(|v| match v {
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
struct Limited<M> {
    own: M,
    limit: f64,
    costs: Vec<f64>,
}

impl<M: Method> Method for Limited<M> {
    type Scratch = M::Scratch;

    fn scratch(&self) -> M::Scratch {
        self.own.scratch()
    }

    fn propose(&self, site: &Site<'_>, scratch: &mut M::Scratch) -> Result<Proposal, Refusal> {
        self.own.propose(site, scratch)
    }

    fn estimate(&self, live: &LiveMesh, edge: u32) -> Option<f64> {
        self.own.estimate(live, edge)
    }

    fn may_fall(&self, live: &LiveMesh, edge: u32) -> bool {
        self.own.may_fall(live, edge)
    }

    fn within_limit(&mut self, live: &LiveMesh, patch: &Patch, proposal: &Proposal) -> bool {
        let within = proposal.geometric <= self.limit;
        if within {
            self.costs.push(proposal.geometric);
        }
        within && self.own.within_limit(live, patch, proposal)
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        self.own.committed(live, patch);
    }

    fn evaluations_per_task(&self) -> usize {
        usize::MAX
    }
}
