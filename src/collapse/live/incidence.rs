//! Incidence lists: the faces or the edges at every vertex, in one pool.
//!
//! Contiguous rather than linked: whoever walks a list on a large mesh waits for one cache miss, not for one per
//! element. A list that outgrows its block moves to the end of the pool with twice the room; the old block is lost,
//! which costs at most a small multiple of the initial size over a whole run.

use std::collections::BTreeMap;

/// Elements of a list up to which it is searched one by one to remove one: a hub may have a million.
const LONG: u32 = 1024;

/// Room that every list starts with beyond its first elements.
const SLACK: u32 = 2;

#[derive(Clone, Copy, Debug)]
struct Span {
    start: u32,
    count: u32,
    room: u32,
}

/// Lists of `T` by vertex, in no useful order.
#[derive(Clone, Debug, Default)]
pub(super) struct IncidenceLists<T> {
    spans: Vec<Span>,
    pool: Vec<T>,
    /// Index of every element of the long lists from which one was removed.
    places: BTreeMap<u32, BTreeMap<T, u32>>,
}

impl<T: Copy + Default + Ord> IncidenceLists<T> {
    /// Empty lists with room for the given numbers of elements.
    pub(super) fn with_room(counts: &[u32]) -> Self {
        let mut spans = Vec::with_capacity(counts.len());
        let mut start = 0;
        for &count in counts {
            let room = count + SLACK;
            spans.push(Span {
                start,
                count: 0,
                room,
            });
            start += room;
        }
        Self {
            spans,
            pool: vec![T::default(); start as usize],
            places: BTreeMap::new(),
        }
    }

    /// The list of a vertex.
    #[inline]
    pub(super) fn of(&self, vertex: u32) -> &[T] {
        let span = self.spans[vertex as usize];
        &self.pool[span.start as usize..][..span.count as usize]
    }

    /// The list of a vertex; `None` where there is no such vertex.
    #[inline]
    pub(super) fn get(&self, vertex: u32) -> Option<&[T]> {
        let span = self.spans.get(vertex as usize)?;
        Some(&self.pool[span.start as usize..][..span.count as usize])
    }

    /// Adds an element.
    pub(super) fn push(&mut self, vertex: u32, element: T) {
        let span = &mut self.spans[vertex as usize];
        if span.count == span.room {
            let (old, start) = (span.start as usize, self.pool.len());
            span.room = 2 * span.room + SLACK;
            self.pool.resize(start + span.room as usize, T::default());
            self.pool.copy_within(old..old + span.count as usize, start);
            span.start = start as u32;
        }
        self.pool[(span.start + span.count) as usize] = element;
        if span.count >= LONG
            && let Some(places) = self.places.get_mut(&vertex)
        {
            places.insert(element, span.count);
        }
        span.count += 1;
    }

    /// Removes one element that equals `element`, if there is one.
    pub(super) fn remove(&mut self, vertex: u32, element: T) {
        let span = &mut self.spans[vertex as usize];
        let list = &mut self.pool[span.start as usize..][..span.count as usize];
        let looked_through = |list: &[T]| list.iter().position(|&e| e == element);
        if span.count <= LONG {
            if let Some(at) = looked_through(list) {
                list.swap(at, list.len() - 1);
                span.count -= 1;
            }
            return;
        }
        let places = self.places.entry(vertex).or_insert_with(|| {
            let places = list.iter().zip(0..);
            places.map(|(&e, at)| (e, at)).collect()
        });
        // An element that is there twice has one place.
        let known = places.remove(&element).map(|at| at as usize);
        let known = known.filter(|&at| list.get(at) == Some(&element));
        if let Some(at) = known.or_else(|| looked_through(list)) {
            let last = list.len() - 1;
            if at < last {
                places.insert(list[last], at as u32);
            }
            list.swap(at, last);
            span.count -= 1;
        }
        if span.count <= LONG {
            self.places.remove(&vertex);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_long_list_loses_an_element_or_keeps_one_that_is_gone() {
        let mut lists: IncidenceLists<u32> = IncidenceLists::with_room(&[0, 5000]);
        let mut known: Vec<Vec<u32>> = vec![Vec::new(); 2];
        let (mut x, mut remembered) = (1_u32, 0);
        let mut next = |below: u32| {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (x >> 8) % below
        };
        // Up and down across the length from which places are remembered, some elements twice.
        for step in 0..24_000 {
            let v = step % 2;
            let growing = step / 4_000 % 2 == 0;
            let list = &mut known[v as usize];
            if next(10) < if growing { 8 } else { 2 } {
                let element = next(6_000);
                list.push(element);
                lists.push(v, element);
            } else {
                let some = list.get(next(list.len() as u32 + 9) as usize).copied();
                let element = some.unwrap_or(next(6_000));
                if let Some(at) = list.iter().position(|&e| e == element) {
                    list.swap_remove(at);
                }
                lists.remove(v, element);
                remembered += lists.places.len();
            }
            if step % 500 < 2 {
                let mut found = lists.of(v).to_vec();
                found.sort_unstable();
                let mut expected = list.clone();
                expected.sort_unstable();
                assert_eq!(found, expected, "step {step}");
            }
        }
        assert!(remembered > 400 && lists.places.is_empty(), "{remembered}");
    }

    #[test]
    fn a_list_that_outgrows_its_room_loses_nothing() {
        let mut lists: IncidenceLists<u32> = IncidenceLists::with_room(&[0, 1, 0]);
        for i in 0..50 {
            for v in 0..3 {
                lists.push(v, 10 * i + v);
            }
        }
        lists.remove(1, 11);
        lists.remove(1, 7);
        for v in 0..3 {
            let mut found = lists.of(v).to_vec();
            found.sort_unstable();
            let all = (0..50).map(|i| 10 * i + v).filter(|&x| x != 11);
            assert_eq!(found, all.collect::<Vec<_>>());
        }
    }
}
