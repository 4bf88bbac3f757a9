//! An indexed heap: the smallest key first, and any edge can be re-keyed or taken out by its id.

use std::cmp::Ordering;

use crate::collapse::NONE;

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

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// True where there is no entry.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
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

    /// Every id in the heap, in no useful order.
    pub fn ids(&self) -> impl Iterator<Item = u32> {
        self.nodes.iter().map(|&(_, id)| id)
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
