//! Polishing: after the last collapse the vertices that are left move, and edges flip, wherever that makes the pictures
//! better.
//!
//! Not in the papers. Sweeps visit the vertices by ascending id; a vertex tries positions along its normal and two
//! tangents at a distance that halves whenever none of them is better. Every few sweeps all edges are tried for a flip,
//! and the cameras are turned as a whole and the original drawn again, so that the mesh fits the model and not the
//! noise of one set of pictures. Every change that is kept lowers the error of the pictures of that moment, exactly, or
//! where the surface counts too, brings a vertex so much nearer to the original that it is worth an error.
//!
//! Vertices are searched in batches of neighbours' strangers, each against the same pictures; then the batch is
//! committed one by one, and what an earlier one has made worse is taken back. Batches do not depend on the number of
//! threads, so neither does the result.

use std::{collections::VecDeque, sync::Mutex};

use serde::{Deserialize, Serialize};

use super::{
    Deviation, Pictures,
    moves::{Found, Search},
};
use crate::{
    Progress, Result,
    collapse::{Changes, LiveMesh, Observer, Patch, PatchFace, Rules, check_folds, flip},
    metric::Orientation,
    parallel,
    raster::ViewSubset,
};

/// How much polishing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Polish {
    /// Sweeps over all vertices; 0 is no polishing.
    pub sweeps: u32,
    /// Edges are tried for flips after every so many sweeps; 0 is never.
    pub flips_every: u32,
    /// Cameras are turned after every so many sweeps; 0 is never.
    pub cameras_every: u32,
    /// How much the share of the distance from the original weighs against the share of the image error in a change;
    /// 0 is nothing. See [`Deviation`].
    pub deviation_weight: f64,
}

/// What polishing may not do.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limits<'a> {
    /// As for collapses.
    pub rules: Rules,
    /// How near the original a change should stay, and what being nearer is worth.
    pub deviation: Option<&'a Deviation<'a>>,
    /// The error of the pictures may not rise for the surface either: it is limited.
    pub falling: bool,
    /// The sides of the original, which no face may turn its back on.
    pub sides: Option<&'a Orientation>,
}

impl Limits<'_> {
    /// What a change that adds `cost` to the error `sum` is worth where the surface counts too: negative where it is for
    /// the better. The deviation of what the patch removes is kept in `before` for other changes of the same faces.
    pub(super) fn balance(
        &self,
        live: &LiveMesh,
        patch: &Patch,
        (cost, sum): (i64, f64),
        before: &mut Option<f64>,
    ) -> f64 {
        let Some(deviation) = self.deviation else {
            return cost as f64;
        };
        let before = *before.get_or_insert_with(|| deviation.before(live, patch));
        deviation.balance(cost, sum, deviation.after(live, patch) - before)
    }

    /// Whether a change turns no face over that was not turned over before.
    pub(super) fn keeps_sides(&self, live: &LiveMesh, patch: &Patch) -> bool {
        self.sides.is_none_or(|sides| {
            let faces = patch.added.iter();
            let flipped = faces
                .filter(|f| sides.is_flipped(patch.after(live, f)))
                .count();
            // What was flipped before is no fault of the change.
            let before = |f: &&PatchFace| sides.is_flipped(patch.before(live, f));
            flipped == 0 || flipped <= patch.removed.iter().filter(before).count()
        })
    }
}

/// What the polishing did. The same for every number of threads.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PolishCounters {
    /// Positions and flips whose pictures were drawn.
    pub evaluations: u64,
    /// Vertices moved.
    pub moves: u64,
    /// Edges flipped.
    pub flips: u64,
    /// Changes taken back because one just before had made them worse.
    pub reverted: u64,
    /// For every set of cameras, the root mean square of the luma differences when they came and when they went.
    pub cameras: Vec<[f64; 2]>,
}

/// First distance of the search, as a share of the mean edge length at the vertex.
const FIRST_STEP: f64 = 0.15;

/// Below this distance a vertex is left alone until its surroundings change.
const LAST_STEP: f64 = FIRST_STEP / 16.0;

/// Vertices searched against the same pictures.
const BATCH: usize = 16;

/// Golden angle, by which the tangents turn from sweep to sweep.
const TURN: f64 = 2.399_963_229_728_653;

/// How the search stands at a vertex.
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

/// Makes pictures of a mesh with cameras turned for a round (1, 2, ...); none where the cameras are to stay.
pub type Turn<'a> = dyn FnMut(&LiveMesh, u32) -> Result<Option<Pictures>> + 'a;

/// Polishes `live`, which `pictures` show, with cameras that `fresh` turns.
///
/// # Errors
/// [`crate::Error::Interrupted`], and what `fresh` fails with; the mesh is then somewhere in between.
pub fn polish(
    live: &mut LiveMesh,
    pictures: Pictures,
    options: Polish,
    limits: Limits<'_>,
    fresh: &mut Turn<'_>,
    observer: &mut dyn Observer,
    progress: &dyn Progress,
) -> Result<(Pictures, PolishCounters)> {
    let stand = Stand {
        step: FIRST_STEP,
        settled: false,
        batch: 0,
        changed: 1,
    };
    let mut polisher = Polisher {
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
    };
    let mut rms = polisher.pictures.error().rms();
    let every = |n: u32, sweep: u32| n > 0 && sweep.is_multiple_of(n);
    for sweep in 0..options.sweeps {
        if sweep > 0
            && every(options.cameras_every, sweep)
            && let Some(pictures) = fresh(polisher.live, sweep / options.cameras_every)?
        {
            let now = polisher.pictures.error().rms();
            polisher.counters.cameras.push([rms, now]);
            polisher.look_through(pictures);
            rms = polisher.pictures.error().rms();
        }
        polisher.moves(sweep, options.sweeps, observer)?;
        if every(options.flips_every, sweep + 1) {
            polisher.flips(observer)?;
        }
    }
    let Polisher {
        pictures,
        mut counters,
        ..
    } = polisher;
    if options.sweeps > 0 {
        counters.cameras.push([rms, pictures.error().rms()]);
    }
    Ok((pictures, counters))
}

struct Polisher<'a> {
    live: &'a mut LiveMesh,
    pictures: Pictures,
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
    counters: PolishCounters,
}

impl Polisher<'_> {
    /// Other pictures of the same mesh.
    fn look_through(&mut self, pictures: Pictures) {
        self.pictures = pictures;
        self.own = Search::new(&self.pictures);
        self.pool = Mutex::new(Vec::new());
        self.clock += 1;
        for stand in &mut self.stands {
            stand.settled = false;
            stand.changed = self.clock;
        }
    }

    /// One sweep over the vertices.
    fn moves(&mut self, sweep: u32, sweeps: u32, observer: &mut dyn Observer) -> Result<()> {
        let mut waiting: VecDeque<u32> = (0..self.live.vertex_ids())
            .filter(|&v| self.live.valence(v) > 0 && !self.stands[v as usize].settled)
            .collect();
        let total = waiting.len();
        let turn = TURN * f64::from(sweep);
        let mut batch = Vec::with_capacity(BATCH);
        while !waiting.is_empty() {
            let done = u64::from(sweep) * total as u64 + (total - waiting.len()) as u64;
            self.progress
                .step("polish", done, u64::from(sweeps) * total as u64)?;
            self.take_strangers(&mut waiting, &mut batch, Self::around_vertex);
            let found = self.in_parallel(&batch, |polisher, search, &v| {
                let step = polisher.stands[v as usize].step;
                search.run(
                    polisher.live,
                    &polisher.pictures,
                    polisher.limits,
                    v,
                    [step, turn],
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

    /// Tries to flip every edge whose surroundings changed since it was last tried.
    fn flips(&mut self, observer: &mut dyn Observer) -> Result<()> {
        self.tried.resize(self.live.edge_ids() as usize, 0);
        let mut waiting: VecDeque<u32> = (0..self.live.edge_ids())
            .filter(|&e| self.live.faces_at_edge(e) == 2 && self.may_flip(e))
            .collect();
        let mut batch = Vec::with_capacity(BATCH);
        while !waiting.is_empty() {
            self.progress.step("flip", 0, 0)?;
            self.take_strangers(&mut waiting, &mut batch, Self::around_edge);
            let now = self.clock;
            let outcomes = self.in_parallel(&batch, |polisher, search, &e| {
                let patch = polisher.flip(e, &mut search.patch)?;
                let (live, pictures) = (&*polisher.live, &polisher.pictures);
                let cost = pictures.cost(live, patch, ViewSubset::All, &mut search.pictures);
                let sum = pictures.error().sum() as f64;
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

    /// The vertices that a search at a vertex looks at: it and its neighbours.
    fn around_vertex(&self, vertex: u32, into: &mut Vec<u32>) {
        let faces = self.live.triangles_at(vertex);
        into.extend(faces.filter_map(|f| self.live.triangle(f)).flatten());
    }

    /// The vertices of the faces at an edge.
    fn around_edge(&self, edge: u32, into: &mut Vec<u32>) {
        let Some([a, b]) = self.live.edge(edge) else {
            return;
        };
        let faces = self.live.triangles_at(a);
        let corners = faces.filter_map(|f| self.live.triangle(f));
        into.extend(corners.filter(|c| c.contains(&b)).flatten());
    }

    /// Takes the next items in their order, leaving out those that share one of the vertices `around` them with an
    /// item taken already.
    fn take_strangers(
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
