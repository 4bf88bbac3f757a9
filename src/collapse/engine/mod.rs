//! The one engine behind every method: it takes the cheapest legal collapse until it should stop.
//!
//! Evaluations run in parallel in fixed batches whose results are put together by edge id; queue and commits are
//! serial. The result does not depend on the number of threads.

mod queue;
mod survey;

use self::queue::Queue;
pub use self::queue::{Heap, Key, Schedule};
use super::{
    Changes, Concession, Counters, EdgeStar, Evaluation, LiveMesh, Method, MethodScratch, Observer,
    Patch, Plan, Proposal, Refusal, Review, Rules, Site, Stop, legality,
};
use crate::{Error, Progress, Result, parallel};

/// Collapses between two reports of progress.
const REPORT_EVERY: u64 = 256;

/// A mesh and the queue of its collapses.
#[derive(Debug, Default)]
pub struct Engine {
    live: LiveMesh,
    rules: Rules,
    schedule: Schedule,
    plan: Plan,
    /// The largest second key that a collapse may have, where there is one.
    cost_limit: Option<f64>,
    rank_every: u64,
    queue: Option<Queue>,
    counters: Counters,
    star: EdgeStar,
    scratch: MethodScratch,
    /// Buffers of the threads that share a batch.
    pool: Vec<(EdgeStar, MethodScratch)>,
    patch: Patch,
    /// The edge of `star`, where nothing was committed since it was collected.
    gathered: Option<u32>,
    changes: Changes,
    inherited: Vec<(u32, Option<Proposal>)>,
    touched: Vec<u32>,
}

impl Engine {
    /// An engine that has not evaluated anything yet.
    pub fn new(live: LiveMesh, rules: Rules, schedule: Schedule) -> Self {
        Self {
            live,
            rules,
            schedule,
            scratch: MethodScratch::alone(),
            ..Self::default()
        }
    }

    /// Ends before a collapse whose second key is above `limit`, and stays on one thread: for a part of a mesh.
    pub(super) fn with_cost_limit(mut self, limit: f64) -> Self {
        self.cost_limit = Some(limit);
        self
    }

    /// Measures the true rank of every `every`-th collapse by evaluating all edges; 0 is off. Changes no result.
    pub fn with_rank_measured(mut self, every: u64) -> Self {
        self.rank_every = every;
        self
    }

    /// Goes on counting from what was done before.
    pub fn with_counters(mut self, counters: Counters) -> Self {
        self.counters = counters;
        self
    }

    /// The mesh as it is now.
    pub fn live(&self) -> &LiveMesh {
        &self.live
    }

    /// Counts of the work done so far.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// The mesh, and the counts of the work.
    pub fn into_parts(self) -> (LiveMesh, Counters) {
        (self.live, self.counters)
    }

    /// Collapses until there are no more than `triangles`, the method's limit would be exceeded, or nothing is legal.
    /// May be called again with the same method and fewer triangles: the queue continues where it was.
    ///
    /// Time: one evaluation, rough or from sums where the method has such, per edge at first, then per collapse a
    /// handful (lazy) to some forty (eager).
    ///
    /// # Errors
    /// [`crate::Error::Interrupted`].
    pub fn run(
        &mut self,
        method: &mut dyn Method,
        triangles: usize,
        observer: &mut dyn Observer,
        progress: &dyn Progress,
    ) -> Result<Stop> {
        let start = self.live.triangle_count();
        if self.live.is_small_enough(triangles) {
            return Ok(Stop::TargetReached);
        }
        self.plan = method.plan();
        if self.cost_limit.is_some() {
            self.plan.evaluations_per_task = usize::MAX;
        }
        let total = start.saturating_sub(triangles) as u64;
        let mut queue = match self.queue.take() {
            Some(queue) => queue,
            None => self.first_queue(method, progress)?,
        };
        let stop = loop {
            if self.live.is_small_enough(triangles) {
                break Stop::TargetReached;
            }
            if progress.interrupted() {
                return Err(Error::Interrupted);
            }
            match queue.front() {
                None => {
                    let refusals = self.blocked(method);
                    break Stop::NoLegalCollapse { refusals };
                }
                Some((id, None)) => self.requeue(method, &mut queue, id),
                Some((id, Some(proposal))) => {
                    if self.counters.collapses.is_multiple_of(REPORT_EVERY) {
                        let done = (start - self.live.triangle_count()) as u64;
                        progress.step("collapse", done, total)?;
                    }
                    if self.gathered != Some(id) {
                        self.star.gather(&self.live, id);
                    }
                    // What was legal may not be any more for what happened elsewhere.
                    if let Err(refusal) = legality::counts(&self.live, &self.star, self.rules) {
                        self.note(&mut queue, id, Err(refusal), Evaluation::Exact);
                        continue;
                    }
                    let position = proposal.position.position();
                    let values = method.wedge_values();
                    self.star
                        .patch_by(&self.live, position, values, &mut self.patch);
                    let cost = proposal.secondary;
                    let affordable = self.cost_limit.is_none_or(|limit| cost <= limit);
                    match method.review(&self.live, &self.patch) {
                        Review::Commit if affordable => {
                            self.measure_rank(method, id);
                            observer.chosen(&proposal);
                            self.commit(method, &mut queue, observer);
                        }
                        Review::Outdated => {
                            self.refresh(method, &mut queue, &[id], Evaluation::Exact);
                            if queue.known(id) == Some(proposal) {
                                let refused = Err(Refusal::Unconfirmed);
                                self.note(&mut queue, id, refused, Evaluation::Exact);
                            }
                        }
                        Review::Commit | Review::LimitReached => break Stop::ErrorLimit,
                    }
                }
            }
        };
        self.queue = Some(queue);
        Ok(stop)
    }

    /// Gives an edge at the front, whose star changed or whose keys are not exact, keys that are better.
    fn requeue(&mut self, method: &dyn Method, queue: &mut Queue, id: u32) {
        if queue.is_estimated(id) {
            return self.evaluate_front(method, queue, id);
        }
        let estimates = method.estimates();
        match estimates.and_then(|sums| sums.estimate(&self.live, id)) {
            Some(cost) => {
                self.counters.estimates += 1;
                queue.estimate(&self.live, id, cost, true);
            }
            None if self.plan.rough_first => {
                self.refresh(method, queue, &[id], Evaluation::Rough);
            }
            None => self.evaluate_front(method, queue, id),
        }
    }

    /// Applies `self.patch`, the collapse of `self.star`, and brings the queue up to date.
    fn commit(&mut self, method: &mut dyn Method, queue: &mut Queue, observer: &mut dyn Observer) {
        let [vertex, gone] = self.star.ends;
        self.inherited.clear();
        for e in self.live.edges_at(gone) {
            if let Some([a, b]) = self.live.edge(e) {
                let other = if a == gone { b } else { a };
                self.inherited.push((other, queue.known(e)));
            }
        }
        self.inherited.sort_unstable_by_key(|(other, _)| *other);
        if self.rules.concession >= Concession::Seams {
            let site = Site::new(&self.live, &self.star, self.rules);
            self.counters.seams_broken += u64::from(site.is_ok_and(|s| s.breaks_seam));
        }
        self.live.apply(&self.patch, &mut self.changes);
        self.gathered = None;
        self.counters.collapses += 1;
        method.committed(&self.live, &self.patch);
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
        self.refresh_around(method, queue, vertex);
    }

    /// Marks the edges around the new vertex as stale, and gives those new keys that the schedule wants at once.
    fn refresh_around(&mut self, method: &dyn Method, queue: &mut Queue, vertex: u32) {
        let estimates = method.estimates();
        // Every edge whose star has a face of the patch ends at the new vertex or at a vertex of the link.
        let mut touched = std::mem::take(&mut self.touched);
        touched.clear();
        queue.next_round();
        let spokes = self.star.spokes.iter().map(|s| s.vertex);
        for v in std::iter::once(vertex).chain(spokes) {
            // No collapse makes such a vertex: its edges were never evaluated as legal, and are evaluated again with
            // the collapse that brings the vertex below the limit.
            if self.live.valence(v) > self.plan.star_limit {
                continue;
            }
            for e in self.live.edges_at(v) {
                if self.live.is_frozen(e) || !queue.stale(&self.live, e) {
                    continue;
                }
                self.counters.evaluations_if_eager += 1;
                let may_fall = || estimates.is_none_or(|sums| sums.may_fall(&self.live, e));
                let at_once = match self.schedule {
                    Schedule::Lazy => false,
                    Schedule::Semi => v == vertex,
                    Schedule::Eager => v == vertex || may_fall(),
                };
                if at_once {
                    touched.push(e);
                }
            }
        }
        if let Some(sums) = estimates {
            let live = &self.live;
            touched.retain(|&e| match sums.estimate(live, e) {
                Some(cost) => {
                    self.counters.estimates += 1;
                    queue.estimate(live, e, cost, false);
                    false
                }
                None => true,
            });
        }
        if !touched.is_empty() {
            touched.sort_unstable();
            self.refresh(method, queue, &touched, self.first_evaluation());
        }
        self.touched = touched;
    }

    /// Evaluates the edge at the front, and with it those behind it that wait under an estimate as well.
    fn evaluate_front(&mut self, method: &dyn Method, queue: &mut Queue, id: u32) {
        if self.plan.look_ahead <= 1 {
            self.refresh(method, queue, &[id], Evaluation::Exact);
        } else {
            let ids = queue.estimated_in_front(self.plan.look_ahead);
            self.refresh(method, queue, &ids, Evaluation::Exact);
        }
    }

    /// Evaluates edges again and re-keys them.
    fn refresh(&mut self, method: &dyn Method, queue: &mut Queue, ids: &[u32], how: Evaluation) {
        self.count(ids.len(), how);
        let per_task = self.plan.evaluations_per_task;
        let shared = ids.len() >= self.plan.shared_batch && parallel::threads() > 1;
        if !shared && ids.len() <= per_task {
            for &id in ids {
                let evaluator = Evaluator {
                    live: &self.live,
                    method,
                    star_limit: self.plan.star_limit,
                    rules: self.rules,
                    how,
                };
                let outcome = evaluator.one(id, &mut self.star, &mut self.scratch);
                self.gathered = Some(id);
                self.note(queue, id, outcome, how);
            }
            return;
        }
        let mut pool = std::mem::take(&mut self.pool);
        let evaluator = self.evaluator(method, how);
        let outcomes = if shared {
            evaluator.shared(ids, &mut pool)
        } else {
            evaluator.all(ids, per_task)
        };
        self.pool = pool;
        for (&id, outcome) in ids.iter().zip(outcomes) {
            self.note(queue, id, outcome, how);
        }
    }

    fn count(&mut self, edges: usize, how: Evaluation) {
        match how {
            Evaluation::Exact => self.counters.evaluations += edges as u64,
            Evaluation::Rough => self.counters.estimates += edges as u64,
        }
    }

    fn note(&mut self, queue: &mut Queue, id: u32, outcome: Outcome, how: Evaluation) {
        if let Err(refusal) = outcome {
            self.counters.refusals.add(refusal);
        }
        queue.evaluated(&self.live, id, outcome.ok(), how);
    }
}

/// Evaluates edges of a mesh that stays as it is meanwhile. Outcomes are in the order of the edges that were asked for,
/// and depend on no other one.
struct Evaluator<'a> {
    live: &'a LiveMesh,
    method: &'a dyn Method,
    star_limit: usize,
    rules: Rules,
    how: Evaluation,
}

/// Price of an edge, or the reason why it may not collapse.
type Outcome = Result<Proposal, Refusal>;

impl Evaluator<'_> {
    /// Evaluates an edge on this thread; the star is its star afterwards, where it was gathered.
    fn one(&self, id: u32, star: &mut EdgeStar, scratch: &mut MethodScratch) -> Outcome {
        if self.is_crowded(id) {
            return Err(Refusal::Valence);
        }
        if !star.gather(self.live, id) {
            return Err(Refusal::Unplaced);
        }
        let site = Site {
            accuracy: self.how,
            values: self.method.wedge_values(),
            ..Site::new(self.live, star, self.rules)?
        };
        self.method.propose(&site, scratch)
    }

    /// True where more faces touch an edge than may; those at both ends count twice.
    fn is_crowded(&self, id: u32) -> bool {
        let valence = |[u, w]: [u32; 2]| self.live.valence(u) + self.live.valence(w);
        let limit = self.star_limit;
        self.live.edge(id).map(valence).is_some_and(|n| n > limit)
    }
}
