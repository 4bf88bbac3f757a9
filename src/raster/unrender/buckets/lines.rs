//! Triangle buckets for every pixel row and column (Lindstrom & Turk 2000, section 4.2.3, Figure 4).
//!
//! `T_i` holds the triangles that cross column i, the difference set `D_i = T_i \ T_{i-1}` those that begin there, so
//! the union over a range of columns is `T_first, D_{first+1}, ..., D_last` without repetition; rows likewise. Time
//! stamps intersect the two unions in linear time. The paper's hash tables are vectors here: what is in a bucket never
//! depends on their order, and the picture never depends on the order of triangles.

use crate::raster::PixelRect;

/// The buckets of one direction.
#[derive(Clone, Debug)]
struct Lines {
    crossing: Vec<Vec<u32>>,
    beginning: Vec<Vec<u32>>,
}

impl Lines {
    fn new(count: usize) -> Self {
        Self {
            crossing: vec![Vec::new(); count],
            beginning: vec![Vec::new(); count],
        }
    }

    fn insert(&mut self, id: u32, first: i32, end: i32) {
        self.beginning[first as usize].push(id);
        for line in &mut self.crossing[first as usize..end as usize] {
            line.push(id);
        }
    }

    fn remove(&mut self, id: u32, first: i32, end: i32) {
        let take = |bucket: &mut Vec<u32>| {
            let at = bucket.iter().position(|&other| other == id);
            bucket.swap_remove(at.expect("a triangle is in the buckets of its extent"));
        };
        take(&mut self.beginning[first as usize]);
        self.crossing[first as usize..end as usize]
            .iter_mut()
            .for_each(take);
    }

    /// Every triangle that crosses a line in `first..end`, once.
    #[inline]
    fn union(&self, first: i32, end: i32) -> impl Iterator<Item = u32> {
        let rest = &self.beginning[first as usize + 1..end as usize];
        self.crossing[first as usize]
            .iter()
            .chain(rest.iter().flatten())
            .copied()
    }
}

/// Time stamps: which triangles the current query has met. One per thread.
#[derive(Clone, Debug, Default)]
pub(super) struct Stamps {
    of: Vec<u32>,
    now: u32,
}

impl Stamps {
    pub(super) fn new(triangles: usize) -> Self {
        Self {
            of: vec![0; triangles],
            now: 0,
        }
    }

    /// Begins a query that leaves out the given triangles.
    pub(super) fn leave_out(&mut self, without: impl Iterator<Item = u32>) {
        if self.now > u32::MAX - 2 {
            self.of.fill(0);
            self.now = 0;
        }
        self.now += 2;
        for id in without {
            self.of[id as usize] = self.now - 1;
        }
    }

    /// True for the triangles that the current query leaves out.
    #[inline]
    pub(super) fn is_left_out(&self, id: u32) -> bool {
        self.of[id as usize] == self.now - 1
    }
}

/// Row and column buckets of one picture.
#[derive(Clone, Debug)]
pub(super) struct Buckets {
    columns: Lines,
    rows: Lines,
}

impl Buckets {
    pub(super) fn new(width: u32, height: u32) -> Self {
        Self {
            columns: Lines::new(width as usize),
            rows: Lines::new(height as usize),
        }
    }

    /// Enters a triangle with its extent, a region inside the picture; an empty one is not entered.
    pub(super) fn insert(&mut self, id: u32, extent: PixelRect) {
        if !extent.is_empty() {
            self.columns.insert(id, extent.x0, extent.x1);
            self.rows.insert(id, extent.y0, extent.y1);
        }
    }

    /// Takes a triangle out again; `extent` as it was entered.
    pub(super) fn remove(&mut self, id: u32, extent: PixelRect) {
        if !extent.is_empty() {
            self.columns.remove(id, extent.x0, extent.x1);
            self.rows.remove(id, extent.y0, extent.y1);
        }
    }

    /// Puts into `found` every triangle whose extent meets `region` (not empty, inside the picture), but for those that
    /// `stamps` leaves out; in no particular order. One query for every [`Stamps::leave_out`].
    pub(super) fn query(&self, region: PixelRect, stamps: &mut Stamps, found: &mut Vec<u32>) {
        found.clear();
        let (left_out, met) = (stamps.now - 1, stamps.now);
        for id in self.columns.union(region.x0, region.x1) {
            let stamp = &mut stamps.of[id as usize];
            if *stamp != left_out {
                *stamp = met;
            }
        }
        let rows = self.rows.union(region.y0, region.y1);
        found.extend(rows.filter(|&id| stamps.of[id as usize] == met));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn extent() -> impl Strategy<Value = PixelRect> {
        (0..30_i32, 0..20_i32, 0..12_i32, 0..12_i32).prop_map(|(x0, y0, w, h)| PixelRect {
            x0,
            y0,
            x1: (x0 + w).min(30),
            y1: (y0 + h).min(20),
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

        #[test]
        fn a_query_finds_every_triangle_whose_extent_meets_the_region_once(
            extents in proptest::collection::vec(extent(), 1..40),
            changes in proptest::collection::vec((any::<prop::sample::Index>(), extent()), 0..30),
            region in extent().prop_filter("not empty", |r| !r.is_empty()),
            without in proptest::collection::vec(any::<prop::sample::Index>(), 0..4),
        ) {
            let mut buckets = Buckets::new(30, 20);
            let mut extents = extents;
            for (id, &e) in extents.iter().enumerate() {
                buckets.insert(id as u32, e);
            }
            for (which, e) in changes {
                let id = which.index(extents.len());
                buckets.remove(id as u32, extents[id]);
                extents[id] = e;
                buckets.insert(id as u32, e);
            }
            let without: Vec<u32> = without.iter().map(|w| w.index(extents.len()) as u32).collect();
            let mut stamps = Stamps::new(extents.len());
            let mut found = Vec::new();
            stamps.now = u32::MAX - 3; // so that the second query starts the count again
            for _ in 0..2 {
                stamps.leave_out(without.iter().copied());
                buckets.query(region, &mut stamps, &mut found);
                found.sort_unstable();
                let expected: Vec<u32> = (0..extents.len() as u32)
                    .filter(|id| !without.contains(id) && !extents[*id as usize].intersection(region).is_empty())
                    .collect();
                prop_assert_eq!(&found, &expected);
            }
        }
    }
}
