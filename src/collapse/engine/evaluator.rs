//! Evaluation of edges: one after the other, or many in parallel.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::{
    collapse::{
        EdgeStar, Evaluation, LiveMesh, Method, MethodScratch, Proposal, Refusal, Rules, Site,
    },
    parallel,
};

/// Evaluates edges of a mesh that stays as it is meanwhile. Outcomes are in the order of the edges that were asked for,
/// and depend on no other one.
pub(super) struct Evaluator<'a> {
    pub(super) live: &'a LiveMesh,
    pub(super) method: &'a dyn Method,
    pub(super) star_limit: usize,
    pub(super) rules: Rules,
    pub(super) how: Evaluation,
}

/// Price of an edge, or the reason why it may not collapse.
pub(super) type Outcome = Result<Proposal, Refusal>;

impl Evaluator<'_> {
    /// Evaluates an edge on this thread; the star is its star afterwards, where it was gathered.
    pub(super) fn one(&self, id: u32, star: &mut EdgeStar, scratch: &mut MethodScratch) -> Outcome {
        if self.is_crowded(id) {
            return Err(Refusal::Valence);
        }
        if !star.gather(self.live, id) {
            return Err(Refusal::Unplaced);
        }
        let site = Site {
            accuracy: self.how,
            ..Site::new(self.live, star, self.rules)?
        };
        self.method.propose(&site, scratch)
    }

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

    /// True where more faces touch an edge than may; those at both ends count twice.
    fn is_crowded(&self, id: u32) -> bool {
        let valence = |[u, w]: [u32; 2]| self.live.valence(u) + self.live.valence(w);
        let limit = self.star_limit;
        self.live.edge(id).map(valence).is_some_and(|n| n > limit)
    }
}
