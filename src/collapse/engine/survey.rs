//! Evaluations of many edges in parallel: for the first queue, for the rules that block what is left, and for ranks.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::{Engine, Evaluator, Outcome, queue, queue::Queue};
use crate::{
    Progress, Result,
    collapse::{EdgeStar, Evaluation, Method, MethodScratch, Refusals},
    parallel,
};

/// Edges in a task.
const CHUNK: usize = 1024;

/// Tasks between two reports of progress.
const TASKS: usize = 64;

impl Evaluator<'_> {
    /// Evaluates a small batch on all threads: each takes the next edge when it is done with one.
    pub(super) fn shared(
        &self,
        ids: &[u32],
        pool: &mut Vec<(EdgeStar, MethodScratch)>,
    ) -> Vec<Outcome> {
        let threads = parallel::threads().min(ids.len());
        while pool.len() < threads {
            pool.push(Default::default());
        }
        let next = AtomicUsize::new(0);
        let outcomes = parallel::map_mut(&mut pool[..threads], |_, (star, scratch)| {
            let mut outcomes = Vec::new();
            loop {
                let i = next.fetch_add(1, Ordering::Relaxed);
                let Some(&id) = ids.get(i) else {
                    return outcomes;
                };
                outcomes.push((i, self.one(id, star, scratch)));
            }
        });
        let mut outcomes: Vec<(usize, Outcome)> = outcomes.into_iter().flatten().collect();
        outcomes.sort_unstable_by_key(|(i, _)| *i);
        outcomes.into_iter().map(|(_, outcome)| outcome).collect()
    }

    /// Evaluates many edges in parallel, `per_task` in a task.
    pub(super) fn all(&self, ids: &[u32], per_task: usize) -> Vec<Outcome> {
        let per_task = per_task.max(1);
        parallel::collect(ids.len().div_ceil(per_task), 1, |tasks, outcomes| {
            let (mut star, mut scratch) = (EdgeStar::default(), MethodScratch::default());
            let ids = &ids[tasks.start * per_task..ids.len().min(tasks.end * per_task)];
            outcomes.reserve_exact(ids.len());
            for &id in ids {
                outcomes.push(self.one(id, &mut star, &mut scratch));
            }
        })
    }
}

impl Engine {
    /// Evaluates every edge, block by block, so that the user hears of it and can stop it.
    pub(super) fn first_queue(
        &mut self,
        method: &dyn Method,
        progress: &dyn Progress,
    ) -> Result<Queue> {
        let mut ids = self.live_edges();
        let per_task = CHUNK.min(self.plan.evaluations_per_task);
        self.counters.evaluations_if_eager += ids.len() as u64;
        let estimated = self.estimate_all(method, &mut ids);
        let how = self.first_evaluation();
        self.count(ids.len(), how);
        let mut evaluated = Vec::with_capacity(ids.len());
        for (i, block) in ids.chunks(per_task * TASKS).enumerate() {
            let done = i * per_task * TASKS;
            progress.step("evaluate", done as u64, ids.len() as u64)?;
            let outcomes = self.evaluator(method, how).all(block, per_task);
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
    fn estimate_all(&mut self, method: &dyn Method, ids: &mut Vec<u32>) -> Vec<(u32, f64)> {
        let Some(sums) = method.estimates() else {
            return Vec::new();
        };
        let live = &self.live;
        let estimates = parallel::collect(ids.len(), CHUNK, |range, estimates| {
            estimates.reserve_exact(range.len());
            for &id in &ids[range] {
                estimates.push(sums.estimate(live, id));
            }
        });
        let pairs = ids.iter().zip(&estimates);
        let estimated: Vec<_> = pairs.filter_map(|(&id, &e)| Some((id, e?))).collect();
        let mut estimates = estimates.into_iter();
        ids.retain(|_| estimates.next().flatten().is_none());
        self.counters.estimates += estimated.len() as u64;
        estimated
    }

    /// The way in which edges are evaluated before they come to the front of the queue.
    pub(super) fn first_evaluation(&self) -> Evaluation {
        if self.plan.rough_first {
            Evaluation::Rough
        } else {
            Evaluation::Exact
        }
    }

    /// Every edge that may be evaluated, by id.
    fn live_edges(&self) -> Vec<u32> {
        (0..self.live.edge_ids())
            .filter(|&e| self.live.edge(e).is_some() && !self.live.is_frozen(e))
            .collect()
    }

    pub(super) fn evaluator<'a>(
        &'a self,
        method: &'a dyn Method,
        how: Evaluation,
    ) -> Evaluator<'a> {
        Evaluator {
            live: &self.live,
            method,
            star_limit: self.plan.star_limit,
            rules: self.rules,
            how,
        }
    }

    /// Counts by which rule every edge that is left is refused.
    pub(super) fn blocked(&self, method: &dyn Method) -> Refusals {
        let mut blocked = Refusals::default();
        let ids = self.live_edges();
        for outcome in self.evaluator(method, Evaluation::Exact).all(&ids, CHUNK) {
            if let Err(refusal) = outcome {
                blocked.add(refusal);
            }
        }
        blocked
    }

    /// Measures the share of legal edges that are cheaper than the one that is about to be collapsed, where ranks are
    /// wanted.
    pub(super) fn measure_rank(&mut self, method: &dyn Method, chosen: u32) {
        if self.rank_every == 0 || !self.counters.collapses.is_multiple_of(self.rank_every) {
            return;
        }
        let ids = self.live_edges();
        let per_task = CHUNK.min(self.plan.evaluations_per_task);
        let evaluator = self.evaluator(method, Evaluation::Exact);
        let keys: Vec<_> = ids
            .iter()
            .zip(evaluator.all(&ids, per_task))
            .filter_map(|(&id, outcome)| Some((id, queue::key(&self.live, id, &outcome.ok()?)?)))
            .collect();
        if let Some((_, own)) = keys.iter().find(|(id, _)| *id == chosen) {
            let cheaper = keys.iter().filter(|(_, key)| key < own).count();
            self.counters.ranks.push(cheaper as f64 / keys.len() as f64);
        }
    }
}
