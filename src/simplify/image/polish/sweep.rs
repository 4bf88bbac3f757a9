//! Sweeps over vertices and edges, in independent sets that are searched in parallel.

use std::{collections::VecDeque, sync::Mutex};

use super::{
    super::Pictures,
    Limits, PolishCounters,
    search::{Found, Probe, Search},
};
use crate::{
    Progress, Result,
    collapse::{Changes, LiveMesh, Observer, Patch, check_folds, flip},
    parallel,
    raster::ViewSubset,
};

/// First distance of the search, as a share of the mean edge length at the vertex.
const FIRST_STEP: f64 = 0.15;

/// Below this distance a vertex is left alone until its surroundings change.
const LAST_STEP: f64 = FIRST_STEP / 16.0;

/// Vertices searched against the same pictures.
const BATCH: usize = 16;

/// Golden angle, by which the tangents turn from sweep to sweep.
const TURN: f64 = 2.399_963_229_728_653;

/// State of the search at a vertex.
#[derive(Clone, Copy, Debug)]
struct Stand {
    step: f64,
    /// Nothing was better at the last step.
    settled: bool,
    /// The batch that must not touch it.
    batch: u32,
    /// When its surroundings last changed.
    changed: u32,
}

/// The squared error that every triangle holds, and the least that makes a change of some of them worth trying; all are
/// where nothing is known.
#[derive(Debug, Default)]
struct Errors {
    of_triangles: Vec<u64>,
    least: u64,
}

impl Errors {
    fn are_worth(&self, triangles: impl Iterator<Item = u32>) -> bool {
        let error = |t: u32| self.of_triangles.get(t as usize).copied().unwrap_or(0);
        self.of_triangles.is_empty() || triangles.map(error).sum::<u64>() >= self.least.max(1)
    }
}

/// A mesh that is polished, with its pictures.
pub(super) struct Polisher<'a> {
    pub(super) live: &'a mut LiveMesh,
    pub(super) pictures: Pictures,
    limits: Limits<'a>,
    progress: &'a dyn Progress,
    /// By vertex id.
    stands: Vec<Stand>,
    /// By edge id: when its flip was last found to be no good.
    tried: Vec<u32>,
    own: Search,
    /// Buffers of the threads; which thread gets which changes nothing.
    pool: Mutex<Vec<Search>>,
    changes: Changes,
    clock: u32,
    batch: u32,
    pub(super) counters: PolishCounters,
}

impl<'a> Polisher<'a> {
    pub(super) fn new(
        live: &'a mut LiveMesh,
        pictures: Pictures,
        limits: Limits<'a>,
        progress: &'a dyn Progress,
    ) -> Self {
        let stand = Stand {
            step: FIRST_STEP,
            settled: false,
            batch: 0,
            changed: 1,
        };
        Self {
            stands: vec![stand; live.vertex_ids() as usize],
            tried: Vec::new(),
            own: Search::new(&pictures),
            pool: Mutex::new(Vec::new()),
            live,
            pictures,
            limits,
            progress,
            changes: Changes::default(),
            clock: 1,
            batch: 0,
            counters: PolishCounters::default(),
        }
    }

    /// Goes on with other pictures of the same mesh.
    pub(super) fn look_through(&mut self, pictures: Pictures) {
        self.pictures = pictures;
        self.own = Search::new(&self.pictures);
        self.pool = Mutex::new(Vec::new());
        self.clock += 1;
        for stand in &mut self.stands {
            stand.settled = false;
            stand.changed = self.clock;
        }
    }

    /// One sweep, the `sweep`th of `sweeps`, over the vertices that hold at least a share of the error.
    pub(super) fn moves(
        &mut self,
        (sweep, sweeps): (u32, u32),
        least_share: f64,
        observer: &mut dyn Observer,
    ) -> Result<()> {
        let errors = self.errors(least_share);
        let mut waiting: VecDeque<u32> = (0..self.live.vertex_ids())
            .filter(|&v| self.live.valence(v) > 0 && !self.stands[v as usize].settled)
            .filter(|&v| errors.are_worth(self.live.triangles_at(v)))
            .collect();
        let total = waiting.len();
        let turn = TURN * f64::from(sweep);
        let mut batch = Vec::with_capacity(BATCH);
        while !waiting.is_empty() {
            let done = u64::from(sweep) * total as u64 + (total - waiting.len()) as u64;
            self.progress
                .step("polish", done, u64::from(sweeps) * total as u64)?;
            self.take_independent(&mut waiting, &mut batch, Self::around_vertex);
            let found = self.in_parallel(&batch, |polisher, search, &v| {
                let step = polisher.stands[v as usize].step;
                search.run(
                    polisher.live,
                    &polisher.pictures,
                    polisher.limits,
                    v,
                    Probe { step, turn },
                )
            });
            let mut committed = false;
            for (&v, found) in batch.iter().zip(found) {
                self.counters.evaluations += found.evaluations;
                let moved = self.make_move(v, found, committed, observer);
                committed |= moved;
                let stand = &mut self.stands[v as usize];
                if !moved {
                    stand.step *= 0.5;
                    if stand.step < LAST_STEP {
                        stand.step = LAST_STEP;
                        stand.settled = true;
                    }
                }
            }
        }
        Ok(())
    }

    /// Results in the order of `items`; each with buffers of its own.
    fn in_parallel<T: Sync, R: Send>(
        &self,
        items: &[T],
        work: impl Fn(&Self, &mut Search, &T) -> R + Sync,
    ) -> Vec<R> {
        parallel::map_slice(items, |item| {
            let taken = self.pool.lock().ok().and_then(|mut pool| pool.pop());
            let mut search = taken.unwrap_or_else(|| Search::new(&self.pictures));
            let result = work(self, &mut search, item);
            if let Ok(mut pool) = self.pool.lock() {
                pool.push(search);
            }
            result
        })
    }

    /// Makes the move that a search found, unless it is no longer one for the better; `stale` where the pictures have
    /// changed since.
    fn make_move(
        &mut self,
        vertex: u32,
        found: Found,
        stale: bool,
        observer: &mut dyn Observer,
    ) -> bool {
        let Some((to, cost)) = found.better else {
            return false;
        };
        self.own.star.gather(self.live, vertex);
        if self.own.prepare(self.live, to, self.limits.rules).is_none() {
            return false;
        }
        let kept = self.keep((cost, stale), observer);
        self.counters.moves += u64::from(kept);
        kept
    }

    /// Commits the patch of `own`, which was found to add `expected` to the error, perhaps to older pictures (`stale`);
    /// false where that turns out to be neither for the better nor for as little, and nothing has changed.
    fn keep(&mut self, (expected, stale): (i64, bool), observer: &mut dyn Observer) -> bool {
        let Search {
            patch, pictures, ..
        } = &mut self.own;
        let cost = self.pictures.commit(self.live, patch, pictures);
        debug_assert!(stale || cost == expected, "a fresh cost is exact");
        if cost >= 0 && cost > expected {
            self.pictures.commit(self.live, &patch.reversed(), pictures);
            self.counters.reverted += 1;
            return false;
        }
        self.live.apply(patch, &mut self.changes);
        observer.committed(self.live, patch);
        for &edge in &self.changes.created {
            if let Some(tried) = self.tried.get_mut(edge as usize) {
                *tried = 0;
            }
        }
        self.clock += 1;
        for v in patch.removed.iter().flat_map(|f| f.corners) {
            let stand = &mut self.stands[v as usize];
            stand.settled = false;
            stand.changed = self.clock;
        }
        true
    }

    /// Tries to flip every edge whose surroundings changed since it was last tried and that holds at least a share of the
    /// error.
    pub(super) fn flips(&mut self, least_share: f64, observer: &mut dyn Observer) -> Result<()> {
        let errors = self.errors(least_share);
        self.tried.resize(self.live.edge_ids() as usize, 0);
        let mut waiting: VecDeque<u32> = (0..self.live.edge_ids())
            .filter(|&e| self.live.faces_at_edge(e) == 2 && self.may_flip(e))
            .filter(|&e| errors.are_worth(self.faces_at(e)))
            .collect();
        let mut batch = Vec::with_capacity(BATCH);
        while !waiting.is_empty() {
            self.progress.step("flip", 0, 0)?;
            self.take_independent(&mut waiting, &mut batch, Self::around_edge);
            let now = self.clock;
            let outcomes = self.in_parallel(&batch, |polisher, search, &e| {
                let patch = polisher.flip(e, &mut search.patch)?;
                let (live, pictures) = (&*polisher.live, &polisher.pictures);
                let cost = pictures.cost(live, patch, ViewSubset::All, &mut search.pictures);
                let sum = pictures.sum() as f64;
                let limits = polisher.limits;
                let pays = cost < 0
                    && limits.balance(live, patch, (cost, sum), &mut None) <= 0.0
                    && limits.keeps_sides(live, patch);
                Some((cost, pays))
            });
            let mut committed = false;
            for (&e, good) in batch.iter().zip(outcomes) {
                self.tried[e as usize] = now;
                self.counters.evaluations += u64::from(good.is_some());
                let Some((cost, true)) = good else {
                    continue;
                };
                let mut patch = std::mem::take(&mut self.own.patch);
                let legal = self.flip(e, &mut patch).is_some();
                self.own.patch = patch;
                if legal && self.keep((cost, committed), observer) {
                    committed = true;
                    self.counters.flips += 1;
                }
            }
        }
        Ok(())
    }

    /// The flip of an edge, where it is allowed.
    fn flip<'p>(&self, edge: u32, patch: &'p mut Patch) -> Option<&'p Patch> {
        let ends = self.live.edge(edge)?;
        flip(self.live, ends, self.limits.rules, patch).ok()?;
        check_folds(self.live, patch, self.limits.rules).ok()?;
        Some(patch)
    }

    fn may_flip(&self, edge: u32) -> bool {
        let Some(ends) = self.live.edge(edge) else {
            return false;
        };
        let changed = |v: &u32| self.stands[*v as usize].changed > self.tried[edge as usize];
        ends.iter().any(changed)
    }

    /// The vertices that a search at a vertex depends on: it and its neighbours.
    fn around_vertex(&self, vertex: u32, into: &mut Vec<u32>) {
        let faces = self.live.triangles_at(vertex);
        into.extend(faces.filter_map(|f| self.live.triangle(f)).flatten());
    }

    /// The vertices of the faces at an edge.
    fn around_edge(&self, edge: u32, into: &mut Vec<u32>) {
        let corners = self.faces_at(edge).filter_map(|f| self.live.triangle(f));
        into.extend(corners.flatten());
    }

    /// The faces at an edge.
    fn faces_at(&self, edge: u32) -> impl Iterator<Item = u32> {
        let live = &*self.live;
        let ends = live.edge(edge).into_iter();
        ends.flat_map(move |[a, b]| {
            let holds = move |f: &u32| live.triangle(*f).is_some_and(|c| c.contains(&b));
            live.triangles_at(a).filter(holds)
        })
    }

    /// The error of every triangle, and how much of it makes a change worth trying.
    fn errors(&self, least_share: f64) -> Errors {
        if least_share <= 0.0 {
            return Errors::default();
        }
        let of_triangles = self.pictures.errors(self.live);
        let sum: u64 = of_triangles.iter().sum();
        Errors {
            least: (least_share * sum as f64) as u64,
            of_triangles,
        }
    }

    /// Takes an independent set of the next items in their order: no two share one of the vertices `around` them.
    fn take_independent(
        &mut self,
        waiting: &mut VecDeque<u32>,
        batch: &mut Vec<u32>,
        around: impl Fn(&Self, u32, &mut Vec<u32>),
    ) {
        self.batch += 1;
        batch.clear();
        let (mut skipped, mut vertices) = (Vec::new(), Vec::new());
        while batch.len() < BATCH
            && skipped.len() < 2 * BATCH
            && let Some(item) = waiting.pop_front()
        {
            vertices.clear();
            around(self, item, &mut vertices);
            let known = |v: &u32| self.stands[*v as usize].batch == self.batch;
            if vertices.iter().any(known) {
                skipped.push(item);
                continue;
            }
            for &v in &vertices {
                self.stands[v as usize].batch = self.batch;
            }
            batch.push(item);
        }
        for item in skipped.into_iter().rev() {
            waiting.push_front(item);
        }
    }
}
