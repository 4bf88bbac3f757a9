//! Layers of one picture: every fragment at every sample, sorted by key (Atherton 1981's object buffer, which Lindstrom &
//! Turk 2000 call attractive and too expensive for its time).
//!
//! The nearest key of every sample lies in a plane of its own, since that is what most looks are about; those behind it
//! lie in blocks of an arena whose capacities are powers of two. A block that became too small is reused for other
//! samples; blocks never shrink, so memory is at most twice the fragments of the deepest moments: 16 bytes for every
//! sample and 8 to 16 for every fragment that is not the nearest.

/// Where the fragments behind the nearest lie.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    start: u32,
    /// Length << 5 | capacity class; class c > 0 holds 2^(c - 1) keys.
    length_and_class: u32,
}

impl Block {
    #[inline]
    fn len(self) -> usize {
        (self.length_and_class >> 5) as usize
    }

    #[inline]
    fn class(self) -> usize {
        (self.length_and_class & 31) as usize
    }

    #[inline]
    fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.start as usize + self.len()
    }
}

/// Keys that a class has room for.
fn capacity(class: usize) -> usize {
    if class == 0 { 0 } else { 1 << (class - 1) }
}

/// The fragments of a picture.
#[derive(Clone, Debug)]
pub(super) struct Stacks {
    nothing: u64,
    nearest: Vec<u64>,
    behind: Vec<Block>,
    arena: Vec<u64>,
    /// Blocks that are not in use, by class.
    free: [Vec<u32>; 32],
}

impl Stacks {
    /// Stacks without a fragment; `nothing` is what an empty sample shows and is above every key.
    pub(super) fn new(samples: usize, nothing: u64) -> Self {
        Self {
            nothing,
            nearest: vec![nothing; samples],
            behind: vec![Block::default(); samples],
            arena: Vec::new(),
            free: std::array::from_fn(|_| Vec::new()),
        }
    }

    /// What an empty sample shows.
    pub(super) fn nothing(&self) -> u64 {
        self.nothing
    }

    /// The nearest key of every sample.
    #[inline]
    pub(super) fn nearest(&self) -> &[u64] {
        &self.nearest
    }

    /// The nearest key behind the first at a sample whose triangle is not `gone`.
    #[inline]
    pub(super) fn below(&self, at: usize, gone: impl Fn(u32) -> bool) -> u64 {
        let keys = &self.arena[self.behind[at].range()];
        let kept = keys.iter().find(|&&key| !gone(key as u32));
        kept.copied().unwrap_or(self.nothing)
    }

    /// Adds a fragment.
    #[inline]
    pub(super) fn insert(&mut self, at: usize, key: u64) {
        let nearest = self.nearest[at];
        if key < nearest {
            self.nearest[at] = key;
            if nearest != self.nothing {
                self.insert_behind(at, nearest);
            }
        } else {
            self.insert_behind(at, key);
        }
    }

    fn insert_behind(&mut self, at: usize, key: u64) {
        let mut block = self.behind[at];
        if block.len() == capacity(block.class()) {
            block = self.grown(block);
        }
        let start = block.start as usize;
        let mut place = start + block.len();
        while place > start && self.arena[place - 1] > key {
            self.arena[place] = self.arena[place - 1];
            place -= 1;
        }
        self.arena[place] = key;
        block.length_and_class += 1 << 5;
        self.behind[at] = block;
    }

    /// A block of the next class with the same keys; the old one is free.
    #[cold]
    fn grown(&mut self, block: Block) -> Block {
        let class = block.class() + 1;
        let start = self.free[class].pop().unwrap_or_else(|| {
            let start = self.arena.len() as u32;
            self.arena.resize(self.arena.len() + capacity(class), 0);
            start
        });
        self.arena.copy_within(block.range(), start as usize);
        if block.class() > 0 {
            self.free[block.class()].push(block.start);
        }
        Block {
            start,
            length_and_class: (block.len() as u32) << 5 | class as u32,
        }
    }

    /// Takes out every fragment of a triangle at a sample. A triangle that clipping cut to pieces may have several there
    /// after snapping, or none any more.
    #[inline]
    pub(super) fn remove(&mut self, at: usize, id: u32) {
        let block = self.behind[at];
        let keys = &mut self.arena[block.range()];
        let mut kept = 0;
        for i in 0..keys.len() {
            let key = keys[i];
            keys[kept] = key;
            kept += usize::from(key as u32 != id);
        }
        let mut first = 0;
        if self.nearest[at] as u32 == id {
            self.nearest[at] = if kept > 0 { keys[0] } else { self.nothing };
            first = kept.min(1);
            keys.copy_within(first..kept, 0);
        }
        self.behind[at].length_and_class = ((kept - first) as u32) << 5 | block.class() as u32;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

        #[test]
        fn stacks_hold_what_was_put_in_and_not_taken_out(
            steps in proptest::collection::vec((0..3_usize, 0..6_u32, 0..4_u32, any::<bool>()), 0..200),
            gone in proptest::collection::vec(0..6_u32, 0..4),
        ) {
            let mut stacks = Stacks::new(3, 99 << 32);
            let mut expected = vec![Vec::<u64>::new(); 3];
            for (at, id, depth, insert) in steps {
                let key = u64::from(depth) << 32 | u64::from(id);
                if insert {
                    stacks.insert(at, key);
                    expected[at].push(key);
                } else {
                    stacks.remove(at, id);
                    expected[at].retain(|&k| k as u32 != id);
                }
                for (at, keys) in expected.iter_mut().enumerate() {
                    keys.sort_unstable();
                    prop_assert_eq!(stacks.nearest()[at], keys.first().copied().unwrap_or(99 << 32));
                    let below = keys.iter().skip(1).find(|&&k| !gone.contains(&(k as u32)));
                    prop_assert_eq!(stacks.below(at, |id| gone.contains(&id)), below.copied().unwrap_or(99 << 32));
                }
            }
        }
    }
}
