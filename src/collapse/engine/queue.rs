//! The queue: an indexed heap of the edges by their keys, and the state of every edge between evaluations.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use crate::collapse::{Evaluation, LiveMesh, NONE, Proposal};

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
        let mut entries = Vec::with_capacity(evaluated.len() + estimated.len());
        let evaluated = evaluated
            .into_iter()
            .map(|(id, p)| (id, key(live, id, &p), Some(p)));
        let estimated = estimated
            .into_iter()
            .map(|(id, cost)| (id, estimated_key(live, id, cost), None));
        for (id, key, proposal) in evaluated.chain(estimated) {
            let Some(key) = key else { continue };
            let waits = rough || proposal.is_none();
            queue.proposals[id as usize] = proposal;
            queue.marks[id as usize] = Mark {
                round: 0,
                dirty: waits,
                queued: true,
                estimated: waits,
            };
            entries.push((key, id));
        }
        queue.heap = Heap::of(entries);
        queue
    }

    /// The edge with the smallest key, which stays in the queue, and its proposal where it may be collapsed; without one
    /// its star changed since it was evaluated, or the evaluation was rough.
    pub(super) fn front(&self) -> Option<(u32, Option<Proposal>)> {
        let (_, id) = self.heap.peek()?;
        let dirty = self.marks[id as usize].dirty;
        Some((id, self.proposals[id as usize].filter(|_| !dirty)))
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
        let pops = std::iter::from_fn(|| self.heap.pop());
        let mut front: Vec<(Key, u32)> = pops.take(count).collect();
        for &(key, id) in &front {
            self.heap.set(id, key);
        }
        let waits = |id: u32| self.marks[id as usize].dirty && self.marks[id as usize].estimated;
        let first = front[0].1;
        front.retain(|&(_, id)| id == first || waits(id));
        front.into_iter().map(|(_, id)| id).collect()
    }

    /// A stale edge costs about `cost`: it waits under that. Where it waits under less it goes on waiting there, to be
    /// estimated again at the front, unless it `is_front`.
    pub(super) fn estimate(&mut self, live: &LiveMesh, id: u32, cost: f64, is_front: bool) {
        self.grow(id);
        let Some(key) = estimated_key(live, id, cost) else {
            return;
        };
        let mark = &mut self.marks[id as usize];
        if is_front || !mark.queued || self.heap.key(id).is_none_or(|old| key < old) {
            mark.queued = true;
            mark.estimated = true;
            self.heap.set(id, key);
        }
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

/// The key of a proposal for an edge, dearer by the weights of its ends; `None` where the id is not in use.
pub(super) fn key(live: &LiveMesh, id: u32, proposal: &Proposal) -> Option<Key> {
    let price = live.price(live.edge(id)?);
    Some(Key {
        primary: price.map_or(proposal.primary, |p| p.of_count(proposal.primary)),
        ..estimated_key(live, id, proposal.secondary)?
    })
}

fn estimated_key(live: &LiveMesh, id: u32, cost: f64) -> Option<Key> {
    let edge = live.edge(id)?;
    let d = live.position(edge[1]) - live.position(edge[0]);
    let (length2, price) = (d.dot(d), live.price(edge));
    Some(Key {
        primary: 0,
        secondary: price.map_or(cost, |p| p.of(cost)),
        length2: price.map_or(length2, |p| p.of(length2)),
        edge,
    })
}

/// Order of the queue: total, and independent of everything but the mesh.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// First key of the method, an exact integer.
    pub primary: i64,
    /// Second key of the method; integers tie massively.
    pub secondary: f64,
    /// Squared length of the edge; flat areas cost 0.
    pub length2: f64,
    /// The vertices of the edge, the smaller first.
    pub edge: [u32; 2],
}

impl Key {
    /// Before every key of an evaluated edge: whoever has it is evaluated next.
    pub const fn first(edge: [u32; 2]) -> Self {
        Self {
            primary: i64::MIN,
            secondary: f64::NEG_INFINITY,
            length2: 0.0,
            edge,
        }
    }
}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> Ordering {
        self.primary
            .cmp(&other.primary)
            .then_with(|| self.secondary.total_cmp(&other.secondary))
            .then_with(|| self.length2.total_cmp(&other.length2))
            .then_with(|| self.edge.cmp(&other.edge))
    }
}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Key {}

/// Children of a node: four make the heap half as deep as two, and siblings share cache lines.
const ARITY: usize = 4;

/// A 4-ary heap of `(key, id)` with the place of every id. Keys of different ids must differ.
#[derive(Clone, Debug, Default)]
pub struct Heap {
    nodes: Vec<(Key, u32)>,
    places: Vec<u32>,
}

impl Heap {
    /// A heap of the given entries; O(n). An id that repeats is an error of the caller: the last one counts.
    pub fn of(entries: Vec<(Key, u32)>) -> Self {
        let ids = entries.iter().map(|&(_, id)| id as usize + 1).max();
        let mut heap = Self {
            places: vec![NONE; ids.unwrap_or(0)],
            nodes: entries,
        };
        for (i, &(_, id)) in heap.nodes.iter().enumerate() {
            heap.places[id as usize] = i as u32;
        }
        if heap.nodes.len() > 1 {
            for i in (0..=(heap.nodes.len() - 2) / ARITY).rev() {
                heap.sink(i);
            }
        }
        heap
    }

    /// The smallest key and its id.
    pub fn peek(&self) -> Option<(Key, u32)> {
        self.nodes.first().copied()
    }

    /// The key of an id; `None` where it is not in the heap.
    pub fn key(&self, id: u32) -> Option<Key> {
        let place = self.place(id)?;
        Some(self.nodes[place].0)
    }

    /// Puts an id into the heap, or gives it a new key; O(log n).
    pub fn set(&mut self, id: u32, key: Key) {
        if let Some(place) = self.place(id) {
            self.nodes[place].0 = key;
            self.settle(place);
            return;
        }
        if self.places.len() <= id as usize {
            self.places.resize(id as usize + 1, NONE);
        }
        self.places[id as usize] = self.nodes.len() as u32;
        self.nodes.push((key, id));
        self.rise(self.nodes.len() - 1);
    }

    /// Takes an id out and returns its key; `None` where it is not in the heap. O(log n).
    pub fn remove(&mut self, id: u32) -> Option<Key> {
        let place = self.place(id)?;
        let (key, _) = self.nodes.swap_remove(place);
        self.places[id as usize] = NONE;
        if place < self.nodes.len() {
            self.places[self.nodes[place].1 as usize] = place as u32;
            self.settle(place);
        }
        Some(key)
    }

    /// Takes out the smallest; O(log n).
    pub fn pop(&mut self) -> Option<(Key, u32)> {
        let (key, id) = self.peek()?;
        self.remove(id);
        Some((key, id))
    }

    fn place(&self, id: u32) -> Option<usize> {
        let place = *self.places.get(id as usize)?;
        (place != NONE).then_some(place as usize)
    }

    fn settle(&mut self, place: usize) {
        if !self.rise(place) {
            self.sink(place);
        }
    }

    fn rise(&mut self, mut place: usize) -> bool {
        let start = place;
        let node = self.nodes[place];
        while place > 0 {
            let parent = (place - 1) / ARITY;
            if self.nodes[parent].0 <= node.0 {
                break;
            }
            self.put(place, self.nodes[parent]);
            place = parent;
        }
        self.put(place, node);
        place != start
    }

    fn sink(&mut self, mut place: usize) {
        let node = self.nodes[place];
        loop {
            let first = ARITY * place + 1;
            let last = (first + ARITY).min(self.nodes.len());
            let Some(child) = (first..last).min_by(|&a, &b| self.nodes[a].0.cmp(&self.nodes[b].0))
            else {
                break;
            };
            if node.0 <= self.nodes[child].0 {
                break;
            }
            self.put(place, self.nodes[child]);
            place = child;
        }
        self.put(place, node);
    }

    fn put(&mut self, place: usize, node: (Key, u32)) {
        self.nodes[place] = node;
        self.places[node.1 as usize] = place as u32;
    }
}
