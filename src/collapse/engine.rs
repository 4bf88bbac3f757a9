//! The one engine behind every method: it takes the cheapest legal collapse until it should stop.
//!
//! Evaluations run in parallel in fixed batches whose results are put together by edge id; queue and commits are
//! serial. The result does not depend on the number of threads.

use glam::DVec3;

use super::{
    Changes, Counters, LiveMesh, Method, Patch, Proposal, Refusal, Refusals, Ring, Rules, Schedule,
    evaluator::Evaluator,
    queue::{self, Evaluation, Front, Queue},
};
use crate::{Error, Progress, Result, parallel};

/// When a run has done enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// Stop at this number of triangles or fewer.
    pub triangles: usize,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// There are no more triangles than wanted.
    TargetReached,
    /// The next collapse would exceed the method's error limit.
    ErrorLimit,
    /// No edge may be collapsed; how many of them each rule blocks.
    NoLegalCollapse {
        /// One count per edge that is left.
        blocked: Refusals,
    },
}

/// Watches a run: history, charts, tests.
pub trait Observer {
    /// A patch was committed; `live` already has it.
    fn committed(&mut self, live: &LiveMesh, patch: &Patch);

    /// The edge between `keep` and `gone` was collapsed to `to` (frame units) while the mesh was in tiles: its patch
    /// is not known. Only for meshes without attributes.
    fn thinned(&mut self, live: &LiveMesh, keep: u32, gone: u32, to: DVec3) {
        let _ = (live, keep, gone, to);
    }
}

/// Watches nothing.
impl Observer for () {
    fn committed(&mut self, _: &LiveMesh, _: &Patch) {}
}

/// Edges in a task of the first, complete evaluation.
const CHUNK: usize = 1024;

/// Tasks between two looks at the progress of the first evaluation.
const TASKS: usize = 64;

/// Collapses between two looks at the progress.
const REPORT_EVERY: u64 = 256;

/// A mesh, a method and the queue of collapses between them.
#[derive(Debug)]
pub struct Engine<M: Method> {
    live: LiveMesh,
    method: M,
    rules: Rules,
    schedule: Schedule,
    rank_every: u64,
    queue: Option<Queue>,
    counters: Counters,
    ring: Ring,
    scratch: M::Scratch,
    /// Buffers of the threads that share a batch.
    pool: Vec<(Ring, M::Scratch)>,
    patch: Patch,
    /// The edge of `ring`, where nothing was committed since it was collected.
    gathered: Option<u32>,
    changes: Changes,
    inherited: Vec<(u32, Option<Proposal>)>,
    touched: Vec<u32>,
}

impl<M: Method> Engine<M> {
    /// An engine that has not evaluated anything yet.
    #[must_use]
    pub fn new(live: LiveMesh, method: M, rules: Rules, schedule: Schedule) -> Self {
        let scratch = method.lone_scratch();
        Self {
            live,
            method,
            rules,
            schedule,
            rank_every: 0,
            queue: None,
            counters: Counters::default(),
            ring: Ring::default(),
            scratch,
            pool: Vec::new(),
            patch: Patch::default(),
            gathered: None,
            changes: Changes::default(),
            inherited: Vec::new(),
            touched: Vec::new(),
        }
    }

    /// Measures the true rank of every `every`-th collapse by evaluating all edges; 0 is off. Changes no result.
    #[must_use]
    pub fn with_rank_measured(mut self, every: u64) -> Self {
        self.rank_every = every;
        self
    }

    /// Goes on counting from what was done before.
    #[must_use]
    pub fn with_counters(mut self, counters: Counters) -> Self {
        self.counters = counters;
        self
    }

    /// The mesh as it is now.
    #[must_use]
    pub fn live(&self) -> &LiveMesh {
        &self.live
    }

    /// The method.
    #[must_use]
    pub fn method(&self) -> &M {
        &self.method
    }

    /// What was done so far.
    #[must_use]
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// The mesh, the method and what was done.
    #[must_use]
    pub fn into_parts(self) -> (LiveMesh, M, Counters) {
        (self.live, self.method, self.counters)
    }

    /// Collapses until the target is reached, the method's limit would be exceeded, or nothing is legal. May be
    /// called again with a lower target: the queue continues where it was.
    ///
    /// Time: one evaluation, or one glance, per edge at first, then per collapse a handful (lazy) to some forty (eager).
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub fn run(
        &mut self,
        target: Target,
        observer: &mut dyn Observer,
        progress: &dyn Progress,
    ) -> Result<End> {
        let start = self.live.triangle_count();
        if start <= target.triangles {
            return Ok(End::TargetReached);
        }
        let total = (start - target.triangles) as u64;
        let mut queue = match self.queue.take() {
            Some(queue) => queue,
            None => self.first_queue(progress)?,
        };
        let end = loop {
            if self.live.triangle_count() <= target.triangles {
                break End::TargetReached;
            }
            if progress.interrupted() {
                return Err(Error::Interrupted);
            }
            match queue.front() {
                None => {
                    let blocked = self.blocked();
                    break End::NoLegalCollapse { blocked };
                }
                Some(Front::Stale(id)) => {
                    let estimate = if queue.is_estimated(id) {
                        None
                    } else {
                        self.method.estimate(&self.live, id)
                    };
                    match estimate {
                        Some(geometric) => {
                            self.counters.estimates += 1;
                            queue.defer(&self.live, id, geometric);
                        }
                        None if !queue.is_estimated(id) && self.method.glances() => {
                            self.refresh(&mut queue, &[id], Evaluation::Glance);
                        }
                        None => self.look_ahead(&mut queue, id),
                    }
                }
                Some(Front::Ready(id, proposal)) => {
                    if self.counters.collapses.is_multiple_of(REPORT_EVERY) {
                        let done = (start - self.live.triangle_count()) as u64;
                        progress.step("collapse", done, total)?;
                    }
                    if self.gathered != Some(id) {
                        self.ring.gather(&self.live, id);
                    }
                    let position = proposal.position.position();
                    self.ring.patch(&self.live, position, &mut self.patch);
                    if !self.method.confirm(&self.live, &self.patch, &proposal) {
                        self.refresh(&mut queue, &[id], Evaluation::Whole);
                        if queue.known(id) == Some(proposal) {
                            self.note(&mut queue, id, Err(Refusal::Method), Evaluation::Whole);
                        }
                        continue;
                    }
                    if !self.method.within_limit(&self.live, &self.patch, &proposal) {
                        break End::ErrorLimit;
                    }
                    self.measure_rank(id);
                    self.commit(&mut queue, observer);
                }
            }
        };
        self.queue = Some(queue);
        Ok(end)
    }

    /// Applies `self.patch`, the collapse of `self.ring`, and brings the queue up to date.
    fn commit(&mut self, queue: &mut Queue, observer: &mut dyn Observer) {
        let [vertex, gone] = self.ring.ends;
        self.inherited.clear();
        for e in self.live.edges_at(gone) {
            if let Some([a, b]) = self.live.edge(e) {
                let other = if a == gone { b } else { a };
                self.inherited.push((other, queue.known(e)));
            }
        }
        self.inherited.sort_unstable_by_key(|(other, _)| *other);
        self.live.apply(&self.patch, &mut self.changes);
        self.gathered = None;
        self.counters.collapses += 1;
        self.method.committed(&self.live, &self.patch);
        observer.committed(&self.live, &self.patch);
        for &e in &self.changes.deleted {
            queue.forget(e);
        }
        for &e in &self.changes.created {
            if let Some([a, b]) = self.live.edge(e) {
                let other = if a == vertex { b } else { a };
                let old = self.inherited.binary_search_by_key(&other, |(x, _)| *x);
                queue.inherit(e, old.ok().and_then(|i| self.inherited[i].1));
            }
        }
        // Every edge whose ring has a face of the patch ends at the new vertex or at a vertex of the link.
        let mut touched = std::mem::take(&mut self.touched);
        touched.clear();
        queue.next_round();
        let spokes = self.ring.spokes.iter().map(|s| s.vertex);
        for v in std::iter::once(vertex).chain(spokes) {
            // No collapse makes such a vertex: its edges were never evaluated as legal, and are looked at again with the
            // collapse that brings the vertex below the limit.
            if self.live.valence(v) > self.method.ring_limit() {
                continue;
            }
            for e in self.live.edges_at(v) {
                if self.live.is_frozen(e) || !queue.stale(&self.live, e) {
                    continue;
                }
                self.counters.evaluations_if_eager += 1;
                let at_once = match self.schedule {
                    Schedule::Lazy => false,
                    Schedule::Semi => v == vertex,
                    Schedule::Eager => v == vertex || self.method.may_fall(&self.live, e),
                };
                if at_once {
                    touched.push(e);
                }
            }
        }
        let live = &self.live;
        touched.retain(|&e| match self.method.estimate(live, e) {
            Some(geometric) => {
                self.counters.estimates += 1;
                queue.expect(live, e, geometric);
                false
            }
            None => true,
        });
        if !touched.is_empty() {
            touched.sort_unstable();
            self.refresh(queue, &touched, self.first_evaluation());
        }
        self.touched = touched;
    }

    /// Evaluates the edge at the front, and with it those behind it that wait under an estimate as well.
    fn look_ahead(&mut self, queue: &mut Queue, id: u32) {
        match self.method.looks_ahead() {
            0 | 1 => self.refresh(queue, &[id], Evaluation::Whole),
            count => {
                let ids = queue.estimated_in_front(count);
                self.refresh(queue, &ids, Evaluation::Whole);
            }
        }
    }

    /// Evaluates edges again, or glances at them, and re-keys them.
    fn refresh(&mut self, queue: &mut Queue, ids: &[u32], how: Evaluation) {
        self.count(ids.len(), how);
        let per_task = self.method.evaluations_per_task();
        let shared = ids.len() >= self.method.shared_batch() && parallel::threads() > 1;
        if !shared && ids.len() <= per_task {
            for &id in ids {
                let evaluator = Evaluator::new(&self.live, &self.method, self.rules, how);
                let outcome = evaluator.one(id, &mut self.ring, &mut self.scratch);
                self.gathered = Some(id);
                self.note(queue, id, outcome, how);
            }
            return;
        }
        let evaluator = Evaluator::new(&self.live, &self.method, self.rules, how);
        let outcomes = if shared {
            evaluator.shared(ids, &mut self.pool)
        } else {
            evaluator.all(ids, per_task)
        };
        for (&id, outcome) in ids.iter().zip(outcomes) {
            self.note(queue, id, outcome, how);
        }
    }

    fn count(&mut self, edges: usize, how: Evaluation) {
        match how {
            Evaluation::Whole => self.counters.evaluations += edges as u64,
            Evaluation::Glance => self.counters.estimates += edges as u64,
        }
    }

    fn note(
        &mut self,
        queue: &mut Queue,
        id: u32,
        outcome: Result<Proposal, Refusal>,
        how: Evaluation,
    ) {
        if let Err(refusal) = outcome {
            self.counters.refusals.add(refusal);
        }
        queue.evaluated(&self.live, id, outcome.ok(), how);
    }

    /// Evaluates every edge, block by block, so that the user hears of it and can stop it.
    fn first_queue(&mut self, progress: &dyn Progress) -> Result<Queue> {
        let mut ids = self.live_edges();
        let per_task = CHUNK.min(self.method.evaluations_per_task());
        self.counters.evaluations_if_eager += ids.len() as u64;
        let estimated = self.estimate_all(&mut ids);
        let how = self.first_evaluation();
        self.count(ids.len(), how);
        let mut evaluated = Vec::with_capacity(ids.len());
        for (i, block) in ids.chunks(per_task * TASKS).enumerate() {
            let done = i * per_task * TASKS;
            progress.step("evaluate", done as u64, ids.len() as u64)?;
            let outcomes = self.evaluator(how).all(block, per_task);
            for (&id, outcome) in block.iter().zip(outcomes) {
                match outcome {
                    Ok(proposal) => evaluated.push((id, proposal)),
                    Err(refusal) => self.counters.refusals.add(refusal),
                }
            }
        }
        Ok(Queue::new(&self.live, evaluated, how, estimated))
    }

    /// Estimates edges in parallel; those without an estimate stay in `ids`.
    fn estimate_all(&mut self, ids: &mut Vec<u32>) -> Vec<(u32, f64)> {
        let (live, method) = (&self.live, &self.method);
        let estimates = parallel::collect(ids.len(), CHUNK, |range, estimates| {
            estimates.reserve_exact(range.len());
            for &id in &ids[range] {
                estimates.push(method.estimate(live, id));
            }
        });
        let pairs = ids.iter().zip(&estimates);
        let estimated: Vec<_> = pairs.filter_map(|(&id, &e)| Some((id, e?))).collect();
        let mut estimates = estimates.into_iter();
        ids.retain(|_| estimates.next().flatten().is_none());
        self.counters.estimates += estimated.len() as u64;
        estimated
    }

    /// How edges are evaluated before they come to the front of the queue.
    fn first_evaluation(&self) -> Evaluation {
        if self.method.glances() {
            Evaluation::Glance
        } else {
            Evaluation::Whole
        }
    }

    fn live_edges(&self) -> Vec<u32> {
        (0..self.live.edge_ids())
            .filter(|&e| self.live.edge(e).is_some() && !self.live.is_frozen(e))
            .collect()
    }

    /// What evaluates edges of the mesh as it is.
    fn evaluator(&self, how: Evaluation) -> Evaluator<'_, M> {
        Evaluator::new(&self.live, &self.method, self.rules, how)
    }

    fn blocked(&self) -> Refusals {
        let mut blocked = Refusals::default();
        let ids = self.live_edges();
        for outcome in self.evaluator(Evaluation::Whole).all(&ids, CHUNK) {
            if let Err(refusal) = outcome {
                blocked.add(refusal);
            }
        }
        blocked
    }

    fn measure_rank(&mut self, chosen: u32) {
        if self.rank_every == 0 || !self.counters.collapses.is_multiple_of(self.rank_every) {
            return;
        }
        let ids = self.live_edges();
        let per_task = CHUNK.min(self.method.evaluations_per_task());
        let outcomes = self.evaluator(Evaluation::Whole).all(&ids, per_task);
        let keys: Vec<_> = ids
            .iter()
            .zip(outcomes)
            .filter_map(|(&id, outcome)| Some((id, queue::key(&self.live, id, &outcome.ok()?)?)))
            .collect();
        if let Some((_, own)) = keys.iter().find(|(id, _)| *id == chosen) {
            let cheaper = keys.iter().filter(|(_, key)| key < own).count();
            self.counters.ranks.push(cheaper as f64 / keys.len() as f64);
        }
    }
}
