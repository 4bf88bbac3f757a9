//! The queue: the state of every edge between evaluations.

use serde::{Deserialize, Serialize};

use super::{Heap, Key};
use crate::collapse::{Evaluation, LiveMesh, Proposal};

/// Time at which an edge whose star changed is evaluated again, roughly where the method's plan says so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Schedule {
    /// When it comes to the front of the queue (Lindstrom & Turk 2000, section 4.2.2).
    #[default]
    Lazy,
    /// At once where it touches the new vertex, otherwise as lazy: notices costs that fell.
    Semi,
    /// At once.
    Eager,
}

/// State of an edge that is read for every edge around every collapse; kept apart from the proposals to be small.
#[derive(Clone, Copy, Debug, Default)]
struct Mark {
    /// The round in which the edge was last marked.
    round: u32,
    /// Its star changed since it was evaluated, or the evaluation was rough.
    dirty: bool,
    /// It is in the heap.
    queued: bool,
    /// It waits under its present estimate.
    estimated: bool,
}

/// Edges in the order of their keys. An illegal edge is in nobody's way: it comes back when its star changes.
#[derive(Clone, Debug, Default)]
pub(super) struct Queue {
    heap: Heap,
    marks: Vec<Mark>,
    /// The last legal proposal of every edge; stale, or rough, where it is marked dirty.
    proposals: Vec<Option<Proposal>>,
    round: u32,
}

/// The edge at the front.
pub(super) enum Front {
    /// Its star changed since it was evaluated, or the evaluation was rough.
    Stale(u32),
    /// The next collapse.
    Ready(u32, Proposal),
}

impl Queue {
    /// A queue of edges that were evaluated, and of edges that were only estimated.
    pub(super) fn new(
        live: &LiveMesh,
        evaluated: Vec<(u32, Proposal)>,
        how: Evaluation,
        estimated: Vec<(u32, f64)>,
    ) -> Self {
        let ids = live.edge_ids() as usize;
        let rough = how == Evaluation::Rough;
        let mut queue = Self {
            marks: vec![Mark::default(); ids],
            proposals: vec![None; ids],
            ..Self::default()
        };
        let queued = |waits: bool| Mark {
            round: 0,
            dirty: waits,
            queued: true,
            estimated: waits,
        };
        let mut entries = Vec::with_capacity(evaluated.len() + estimated.len());
        for (id, proposal) in evaluated {
            if let Some(key) = key(live, id, &proposal) {
                queue.proposals[id as usize] = Some(proposal);
                queue.marks[id as usize] = queued(rough);
                entries.push((key, id));
            }
        }
        for (id, cost) in estimated {
            if let Some(key) = estimated_key(live, id, cost) {
                queue.marks[id as usize] = queued(true);
                entries.push((key, id));
            }
        }
        queue.heap = Heap::of(entries);
        queue
    }

    /// The edge with the smallest key; it stays in the queue.
    pub(super) fn front(&mut self) -> Option<Front> {
        let (_, id) = self.heap.peek()?;
        Some(match self.proposals[id as usize] {
            Some(proposal) if !self.marks[id as usize].dirty => Front::Ready(id, proposal),
            _ => Front::Stale(id),
        })
    }

    /// Records the outcome of an evaluation; after a rough one the edge waits for an exact one.
    pub(super) fn evaluated(
        &mut self,
        live: &LiveMesh,
        id: u32,
        proposal: Option<Proposal>,
        how: Evaluation,
    ) {
        self.grow(id);
        let mark = &mut self.marks[id as usize];
        mark.dirty = how == Evaluation::Rough;
        mark.estimated = mark.dirty;
        match proposal.and_then(|p| Some((p, key(live, id, &p)?))) {
            Some((proposal, key)) => {
                mark.queued = true;
                self.proposals[id as usize] = Some(proposal);
                self.heap.set(id, key);
            }
            None => {
                mark.queued = false;
                self.heap.remove(id);
            }
        }
    }

    /// The next commit begins.
    pub(super) fn next_round(&mut self) {
        self.round = self.round.wrapping_add(1);
    }

    /// The edge's star changed. It waits under its old cost, or at the front where it never had one. False where it
    /// was already marked in this round.
    pub(super) fn stale(&mut self, live: &LiveMesh, id: u32) -> bool {
        self.grow(id);
        let mark = &mut self.marks[id as usize];
        if mark.round == self.round {
            return false;
        }
        mark.round = self.round;
        mark.dirty = true;
        mark.estimated = false;
        if !mark.queued {
            let Some(ends) = live.edge(id) else {
                return false;
            };
            mark.queued = true;
            let old = self.proposals[id as usize].and_then(|p| key(live, id, &p));
            self.heap.set(id, old.unwrap_or(Key::first(ends)));
        }
        true
    }

    /// True where a stale edge waits under its present estimate, so that it must be evaluated to know more.
    pub(super) fn is_estimated(&self, id: u32) -> bool {
        self.marks[id as usize].estimated
    }

    /// Of the `count` edges in front, those that wait under an estimate; the first of all must be one.
    pub(super) fn estimated_in_front(&mut self, count: usize) -> Vec<u32> {
        let mut front = Vec::with_capacity(count);
        while front.len() < count {
            let Some(entry) = self.heap.pop() else { break };
            front.push(entry);
        }
        for &(key, id) in &front {
            self.heap.set(id, key);
        }
        let mark = |id: u32| self.marks[id as usize];
        let ids = front.into_iter().map(|(_, id)| id);
        ids.enumerate()
            .filter(|&(i, id)| i == 0 || (mark(id).dirty && mark(id).estimated))
            .map(|(_, id)| id)
            .collect()
    }

    /// A stale edge costs about `cost`. Where that is more than it waits under, it goes on waiting there: it is
    /// estimated again at the front.
    pub(super) fn expect(&mut self, live: &LiveMesh, id: u32, cost: f64) {
        self.grow(id);
        let Some(key) = estimated_key(live, id, cost) else {
            return;
        };
        if !self.marks[id as usize].queued || self.heap.key(id).is_none_or(|old| key < old) {
            self.wait(id, key);
        }
    }

    /// A stale edge at the front costs about `cost`: it goes where that belongs.
    pub(super) fn defer(&mut self, live: &LiveMesh, id: u32, cost: f64) {
        if let Some(key) = estimated_key(live, id, cost) {
            self.wait(id, key);
        }
    }

    fn wait(&mut self, id: u32, key: Key) {
        let mark = &mut self.marks[id as usize];
        mark.queued = true;
        mark.estimated = true;
        self.heap.set(id, key);
    }

    /// Forgets an edge whose id is no longer in use.
    pub(super) fn forget(&mut self, id: u32) {
        self.heap.remove(id);
        if let Some(mark) = self.marks.get_mut(id as usize) {
            *mark = Mark::default();
            self.proposals[id as usize] = None;
        }
    }

    /// The last legal proposal of an edge.
    pub(super) fn known(&self, id: u32) -> Option<Proposal> {
        *self.proposals.get(id as usize)?
    }

    /// Gives a new edge the cost of the one it replaces, until it is evaluated.
    pub(super) fn inherit(&mut self, id: u32, proposal: Option<Proposal>) {
        self.grow(id);
        self.proposals[id as usize] = proposal;
    }

    fn grow(&mut self, id: u32) {
        if self.marks.len() <= id as usize {
            self.marks.resize(id as usize + 1, Mark::default());
            self.proposals.resize(id as usize + 1, None);
        }
    }
}

/// The key of a proposal for an edge; `None` where the id is not in use.
pub(super) fn key(live: &LiveMesh, id: u32, proposal: &Proposal) -> Option<Key> {
    Some(Key {
        primary: proposal.primary,
        ..estimated_key(live, id, proposal.secondary)?
    })
}

fn estimated_key(live: &LiveMesh, id: u32, cost: f64) -> Option<Key> {
    let edge = live.edge(id)?;
    let d = live.position(edge[1]) - live.position(edge[0]);
    Some(Key {
        primary: 0,
        secondary: cost,
        length2: d.dot(d),
        edge,
    })
}
