//! Layers of one picture: every fragment at every sample, sorted by key (Atherton 1981's object buffer, which Lindstrom &
//! Turk 2000 call attractive and too expensive for its time).
//!
//! One word per sample holds what decides most of them: the nearest triangle, its luma, the luma of the reference, and
//! the upper half of the depth. The rest of the depth lies in a plane of its own, and the fragments behind
//! in blocks of an arena whose capacities are powers of two. A block that became too small is reused for other samples;
//! blocks never shrink. Memory: 20 bytes for every sample and 8 to 16 for every fragment that is not the nearest, at the
//! deepest moment of its sample. Hierarchical z, the greatest visible depth of small squares, follows from them: a triangle
//! behind all of a square is not seen there.

use crate::raster::{PixelRect, SampleKey};

/// Samples in a row and column of a tile, as a power of two.
pub(super) const TILE: u32 = 3;

/// The visible state of a sample: id, luma, luma of the reference (where pixels have one sample), upper half of the depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Shown(u64);

impl Shown {
    #[inline]
    pub(super) fn id(self) -> u32 {
        self.0 as u32
    }

    #[inline]
    pub(super) fn luma(self) -> u8 {
        (self.0 >> 32) as u8
    }

    #[inline]
    pub(super) fn reference(self) -> u8 {
        (self.0 >> 40) as u8
    }

    /// The least key that the sample may have: the upper half of the depth, and zeros.
    #[inline]
    pub(super) fn least_key(self) -> SampleKey {
        SampleKey::from_bits(self.0 & 0xffff_0000_0000_0000)
    }

    /// The upper half of the depth.
    #[inline]
    pub(super) fn upper_depth(self) -> u16 {
        (self.0 >> 48) as u16
    }

    fn set_key(&mut self, key: SampleKey) {
        let key = key.bits();
        self.0 = self.0 & 0x0000_ffff_0000_0000
            | key & 0xffff_0000_0000_0000
            | key & 0x0000_0000_ffff_ffff;
    }
}

/// Place in the arena of the fragments behind the nearest.
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
pub(super) struct FragmentLists {
    nothing: SampleKey,
    shown: Vec<Shown>,
    /// Depth of what is shown.
    depths: Vec<u32>,
    behind: Vec<Block>,
    arena: Vec<SampleKey>,
    /// Blocks that are not in use, by class.
    free: [Vec<u32>; 32],
    /// A lower bound of the keys that are not the nearest, by tile.
    bounds: Vec<SampleKey>,
}

impl FragmentLists {
    /// Lists without a fragment, in this number of tiles. `nothing` is the key of an empty sample, above every other;
    /// `reference` may be empty.
    pub(super) fn new(
        samples: usize,
        luma: u8,
        reference: &[u8],
        tiles: usize,
        nothing: SampleKey,
    ) -> Self {
        let shown = (0..samples).map(|at| {
            let reference = reference.get(at).copied().unwrap_or(0);
            let mut shown = Shown(u64::from(luma) << 32 | u64::from(reference) << 40);
            shown.set_key(nothing);
            shown
        });
        Self {
            nothing,
            shown: shown.collect(),
            depths: vec![nothing.depth(); samples],
            behind: vec![Block::default(); samples],
            arena: Vec::new(),
            free: std::array::from_fn(|_| Vec::new()),
            bounds: vec![nothing; tiles],
        }
    }

    /// The key of an empty sample.
    pub(super) fn nothing(&self) -> SampleKey {
        self.nothing
    }

    /// The visible state of every sample.
    #[inline]
    pub(super) fn shown(&self) -> &[Shown] {
        &self.shown
    }

    /// The nearest key at a sample.
    #[inline]
    pub(super) fn nearest(&self, at: usize) -> SampleKey {
        SampleKey::new(self.depths[at], self.shown[at].id())
    }

    fn set_nearest(&mut self, at: usize, key: SampleKey) {
        self.shown[at].set_key(key);
        self.depths[at] = key.depth();
    }

    /// Changes the luma of a sample.
    #[inline]
    pub(super) fn set_luma(&mut self, at: usize, luma: u8) {
        let shown = &mut self.shown[at];
        shown.0 = shown.0 & !(0xff << 32) | u64::from(luma) << 32;
    }

    /// A bound that no key in the tile is below, but for those that are the nearest of their samples.
    #[inline]
    pub(super) fn bound(&self, tile: usize) -> SampleKey {
        self.bounds[tile]
    }

    /// The nearest key behind the first at a sample whose triangle is not `gone`.
    #[inline]
    pub(super) fn below(&self, at: usize, gone: impl Fn(u32) -> bool) -> SampleKey {
        let keys = &self.arena[self.behind[at].range()];
        let kept = keys.iter().find(|&&key| !gone(key.id()));
        kept.copied().unwrap_or(self.nothing)
    }

    /// Adds a fragment to a sample of a tile.
    #[inline]
    pub(super) fn insert(&mut self, at: usize, tile: usize, key: SampleKey) {
        let nearest = self.nearest(at);
        let behind = if key < nearest {
            self.set_nearest(at, key);
            if nearest == self.nothing {
                return;
            }
            nearest
        } else {
            key
        };
        let bound = &mut self.bounds[tile];
        *bound = (*bound).min(behind);
        self.insert_behind(at, behind);
    }

    fn insert_behind(&mut self, at: usize, key: SampleKey) {
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
            self.arena
                .resize(self.arena.len() + capacity(class), self.nothing);
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
            kept += usize::from(key.id() != id);
        }
        let mut first = 0;
        if self.shown[at].id() == id {
            let next = if kept > 0 { keys[0] } else { self.nothing };
            first = kept.min(1);
            keys.copy_within(first..kept, 0);
            self.set_nearest(at, next);
        }
        self.behind[at].length_and_class = ((kept - first) as u32) << 5 | block.class() as u32;
    }
}

/// Samples in a row and column of a square, as a power of two. Squares of 8 hide a third of the triangles that nobody
/// sees, those of 4 half of them.
const SQUARE: u32 = 2;

/// The greatest visible depth of every square, its upper half.
#[derive(Clone, Debug)]
pub(super) struct HiZ {
    columns: usize,
    depths: Vec<u16>,
}

impl HiZ {
    /// Of a picture of which nothing is known.
    pub(super) fn new(image: PixelRect) -> Self {
        let squares = |length: usize| length.div_ceil(1 << SQUARE);
        let columns = squares(image.width());
        Self {
            columns,
            depths: vec![u16::MAX; columns * squares(image.height())],
        }
    }

    /// True where everything that is seen in the squares of a region is nearer than a depth; the region must be in the
    /// picture.
    #[inline]
    pub(super) fn hides(&self, region: PixelRect, depth: u32) -> bool {
        if region.is_empty() {
            return true;
        }
        let depth = (depth >> 16) as u16;
        let square = |v: i32| (v >> SQUARE) as usize;
        let columns = square(region.x0)..square(region.x1 - 1) + 1;
        (square(region.y0)..=square(region.y1 - 1)).all(|row| {
            let row = &self.depths[row * self.columns..][columns.clone()];
            row.iter().all(|&deepest| depth > deepest)
        })
    }

    /// Measures the squares that meet a region of the picture, which shows what `shown` says.
    pub(super) fn measure(&mut self, region: PixelRect, image: PixelRect, shown: &[Shown]) {
        let square = |v: i32| (v >> SQUARE) as usize;
        let samples = |at: usize, end: usize| at << SQUARE..((at + 1) << SQUARE).min(end);
        for row in square(region.y0)..=square(region.y1 - 1) {
            for column in square(region.x0)..=square(region.x1 - 1) {
                let columns = samples(column, image.width());
                let rows = samples(row, image.height());
                let depths = rows.flat_map(|y| {
                    let row = &shown[y * image.width()..][columns.clone()];
                    row.iter().map(|s| s.upper_depth())
                });
                self.depths[row * self.columns + column] = depths.fold(0, u16::max);
            }
        }
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
            steps in proptest::collection::vec((0..3_usize, 0..6_u32, 0..9_u32, any::<bool>()), 0..200),
            gone in proptest::collection::vec(0..6_u32, 0..4),
        ) {
            let nothing = SampleKey::new(u32::MAX, 99);
            let mut lists = FragmentLists::new(3, 9, &[1, 2, 3], 1, nothing);
            lists.set_luma(0, 7);
            let mut expected = vec![Vec::<SampleKey>::new(); 3];
            for (at, id, depth, insert) in steps {
                let key = SampleKey::new(depth << 15, id);
                if insert {
                    lists.insert(at, 0, key);
                    expected[at].push(key);
                } else {
                    lists.remove(at, id);
                    expected[at].retain(|&k| k.id() != id);
                }
                for (at, keys) in expected.iter_mut().enumerate() {
                    keys.sort_unstable();
                    let nearest = keys.first().copied().unwrap_or(nothing);
                    prop_assert_eq!(lists.nearest(at), nearest);
                    let shown = lists.shown()[at];
                    prop_assert_eq!(shown.least_key(), SampleKey::from_bits(nearest.bits() >> 48 << 48));
                    prop_assert_eq!([shown.luma(), shown.reference()], [[7, 9, 9][at], 1 + at as u8]);
                    let below = keys.iter().skip(1).find(|&&k| !gone.contains(&k.id()));
                    prop_assert_eq!(lists.below(at, |id| gone.contains(&id)), below.copied().unwrap_or(nothing));
                    prop_assert!(keys.iter().skip(1).all(|&k| k >= lists.bound(0)));
                }
            }
        }
    }

    #[test]
    fn only_what_is_behind_every_sample_of_its_squares_is_hidden() {
        let image = PixelRect::image(10, 7); // squares at the right and below are cut off
        let nothing = SampleKey::new(u32::MAX, 0);
        let mut lists = FragmentLists::new(70, 0, &[], 4, nothing);
        let mut hi_z = HiZ::new(image);
        let depth = |at: usize| (at as u32 * 7 % 70 + 1) << 16 | 5;
        for at in 0..70 {
            assert!(!hi_z.hides(image, u32::MAX), "the background is deepest");
            lists.insert(at, 0, SampleKey::new(depth(at), 0));
            hi_z.measure(image, image, lists.shown());
        }
        for (x0, y0) in (0..70).map(|at| (at % 10, at / 10)) {
            for (x1, y1) in [(x0 + 1, y0 + 1), (10, y0 + 1), (x0 + 1, 7), (10, 7)] {
                let region = PixelRect { x0, y0, x1, y1 };
                let near =
                    |v: i32, from: i32, to: i32| v >> 2 >= from >> 2 && v >> 2 <= (to - 1) >> 2;
                let squares = (0..70).filter(|at| near(at % 10, x0, x1) && near(at / 10, y0, y1));
                let most = squares
                    .map(|at| depth(at as usize) >> 16)
                    .max()
                    .expect("one");
                assert!(
                    !hi_z.hides(region, most << 16 | 0xffff),
                    "as deep, to 16 bits"
                );
                assert!(hi_z.hides(region, (most + 1) << 16));
            }
        }
        assert!(hi_z.hides(PixelRect::EMPTY, 0));
    }
}
