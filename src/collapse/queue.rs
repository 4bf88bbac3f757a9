//! The state of every edge between evaluations, and when edges are evaluated again.

use serde::{Deserialize, Serialize};

use super::{Heap, Key, LiveMesh, Proposal};

/// When an edge whose ring changed is evaluated again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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

#[derive(Clone, Copy, Debug, Default)]
struct State {
    /// The last legal proposal; stale while `dirty`.
    proposal: Option<Proposal>,
    dirty: bool,
    /// The round in which the edge was last marked.
    round: u32,
}

/// Edges in the order of their keys. An illegal edge is in nobody's way: it comes back when its ring changes.
#[derive(Clone, Debug, Default)]
pub(super) struct Queue {
    heap: Heap,
    states: Vec<State>,
    round: u32,
}

/// What comes to the front.
pub(super) enum Front {
    /// Its ring changed since it was evaluated.
    Stale(u32),
    /// The next collapse.
    Ready(u32, Proposal),
}

impl Queue {
    pub(super) fn new(live: &LiveMesh, evaluated: Vec<(u32, Proposal)>) -> Self {
        let mut states = vec![State::default(); live.edge_ids() as usize];
        let mut entries = Vec::with_capacity(evaluated.len());
        for (id, proposal) in evaluated {
            states[id as usize].proposal = Some(proposal);
            entries.extend(key(live, id, &proposal).map(|key| (key, id)));
        }
        Self {
            heap: Heap::of(entries),
            states,
            round: 0,
        }
    }

    /// The edge with the smallest key; it stays in the queue.
    pub(super) fn front(&mut self) -> Option<Front> {
        let (_, id) = self.heap.peek()?;
        let state = self.states[id as usize];
        Some(match state.proposal {
            Some(proposal) if !state.dirty => Front::Ready(id, proposal),
            _ => Front::Stale(id),
        })
    }

    /// Records the outcome of an evaluation.
    pub(super) fn evaluated(&mut self, live: &LiveMesh, id: u32, proposal: Option<Proposal>) {
        self.states[id as usize].dirty = false;
        match proposal.and_then(|p| Some((p, key(live, id, &p)?))) {
            Some((proposal, key)) => {
                self.states[id as usize].proposal = Some(proposal);
                self.heap.set(id, key);
            }
            None => {
                self.heap.remove(id);
            }
        }
    }

    /// The next commit begins.
    pub(super) fn next_round(&mut self) {
        self.round = self.round.wrapping_add(1);
    }

    /// The edge's ring changed. It waits under its old cost, or at the front where it never had one. False where it
    /// was already marked in this round.
    pub(super) fn stale(&mut self, live: &LiveMesh, id: u32) -> bool {
        self.grow(id);
        if self.states[id as usize].round == self.round {
            return false;
        }
        self.states[id as usize].round = self.round;
        self.states[id as usize].dirty = true;
        if self.heap.key(id).is_none() {
            let Some(ends) = live.edge(id) else {
                return false;
            };
            let old = self.states[id as usize].proposal;
            let key = old.and_then(|p| key(live, id, &p));
            self.heap.set(id, key.unwrap_or(Key::first(ends)));
        }
        true
    }

    /// Forgets an edge whose id is no longer in use.
    pub(super) fn forget(&mut self, id: u32) {
        self.heap.remove(id);
        if let Some(state) = self.states.get_mut(id as usize) {
            *state = State::default();
        }
    }

    /// The last legal proposal of an edge.
    pub(super) fn known(&self, id: u32) -> Option<Proposal> {
        self.states.get(id as usize)?.proposal
    }

    /// Gives a new edge the cost of the one it replaces, until it is evaluated.
    pub(super) fn inherit(&mut self, id: u32, proposal: Option<Proposal>) {
        self.grow(id);
        self.states[id as usize] = State {
            proposal,
            dirty: true,
            // Not yet marked in this round.
            round: self.round.wrapping_sub(1),
        };
    }

    fn grow(&mut self, id: u32) {
        if self.states.len() <= id as usize {
            self.states.resize(id as usize + 1, State::default());
        }
    }
}

/// The key of a proposal for an edge; `None` where the id is not in use.
pub(super) fn key(live: &LiveMesh, id: u32, proposal: &Proposal) -> Option<Key> {
    let edge = live.edge(id)?;
    let d = live.position(edge[1]) - live.position(edge[0]);
    Some(Key {
        image: proposal.image,
        geometric: proposal.geometric,
        length2: d.dot(d),
        edge,
    })
}
