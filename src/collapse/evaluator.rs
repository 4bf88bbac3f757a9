//! What edges cost, or why they may not collapse: one after the other, or many in parallel.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::{LiveMesh, Method, Proposal, Refusal, Ring, Rules, Site, queue::Evaluation};

/// Evaluates edges of a mesh that stays as it is meanwhile. Outcomes are in the order of the edges that were asked for,
/// and depend on no other one.
#[derive(Debug)]
pub(super) struct Evaluator<'a, M> {
    live: &'a LiveMesh,
    method: &'a M,
    rules: Rules,
    how: Evaluation,
}

/// What an edge costs, or why it may not collapse.
type Outcome = Result<Proposal, Refusal>;

impl<'a, M: Method> Evaluator<'a, M> {
    pub(super) fn new(live: &'a LiveMesh, method: &'a M, rules: Rules, how: Evaluation) -> Self {
        Self {
            live,
            method,
            rules,
            how,
        }
    }

    /// Evaluates an edge on this thread; the ring is its ring afterwards, where it was looked at.
    pub(super) fn one(&self, id: u32, ring: &mut Ring, scratch: &mut M::Scratch) -> Outcome {
        let Self {
            live, method, how, ..
        } = self;
        if self.is_crowded(id) {
            return Err(Refusal::Valence);
        }
        if !ring.gather(live, id) {
            return Err(Refusal::Unplaced);
        }
        let site = Site::new(live, ring, self.rules)?;
        match how {
            Evaluation::Whole => method.propose(&site, scratch),
            Evaluation::Glance => method.glance(&site, scratch),
        }
    }

    /// Evaluates a small batch on all threads: each takes the next edge when it is done with one.
    pub(super) fn shared(&self, ids: &[u32], pool: &mut Vec<(Ring, M::Scratch)>) -> Vec<Outcome> {
        let threads = rayon::current_num_threads().min(ids.len());
        while pool.len() < threads {
            pool.push((Ring::default(), self.method.scratch()));
        }
        let next = AtomicUsize::new(0);
        let outcomes = pool[..threads].par_iter_mut().map(|(ring, scratch)| {
            let mut outcomes = Vec::new();
            loop {
                let i = next.fetch_add(1, Ordering::Relaxed);
                let Some(&id) = ids.get(i) else {
                    return outcomes;
                };
                outcomes.push((i, self.one(id, ring, scratch)));
            }
        });
        let outcomes: Vec<Vec<_>> = outcomes.collect();
        let mut outcomes: Vec<(usize, Outcome)> = outcomes.into_iter().flatten().collect();
        outcomes.sort_unstable_by_key(|(i, _)| *i);
        outcomes.into_iter().map(|(_, outcome)| outcome).collect()
    }

    /// Evaluates many edges in parallel, so many in a task.
    pub(super) fn all(&self, ids: &[u32], per_task: usize) -> Vec<Outcome>
    where
        M: Sync,
    {
        let chunks: Vec<Vec<_>> = ids
            .par_chunks(per_task.max(1))
            .map_init(
                || (Ring::default(), self.method.scratch()),
                |(ring, scratch), chunk| {
                    let each = chunk.iter().map(|&id| self.one(id, ring, scratch));
                    each.collect()
                },
            )
            .collect();
        chunks.into_iter().flatten().collect()
    }

    /// True where more faces touch an edge than the method looks at; those at both ends count twice.
    fn is_crowded(&self, id: u32) -> bool {
        let valence = |[u, w]: [u32; 2]| self.live.valence(u) + self.live.valence(w);
        let limit = self.method.ring_limit();
        self.live.edge(id).map(valence).is_some_and(|n| n > limit)
    }
}
