//! A short list per vertex, in one pool.
//!
//! Contiguous rather than linked: whoever walks a list on a large mesh waits for one cache miss, not for one per
//! element. A list that outgrows its block moves to the end of the pool with twice the room; the old block is lost,
//! which costs at most a small multiple of the initial size over a whole run.

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
pub(super) struct Lists<T> {
    spans: Vec<Span>,
    pool: Vec<T>,
}

impl<T: Copy + Default + PartialEq> Lists<T> {
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
        }
    }

    /// The list of a vertex.
    #[inline]
    pub(super) fn of(&self, vertex: u32) -> &[T] {
        let span = self.spans[vertex as usize];
        &self.pool[span.start as usize..][..span.count as usize]
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
        span.count += 1;
    }

    /// Removes one element that equals `element`, if there is one.
    pub(super) fn remove(&mut self, vertex: u32, element: T) {
        let span = &mut self.spans[vertex as usize];
        let list = &mut self.pool[span.start as usize..][..span.count as usize];
        if let Some(at) = list.iter().position(|&e| e == element) {
            list.swap(at, list.len() - 1);
            span.count -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_that_outgrows_its_room_loses_nothing() {
        let mut lists: Lists<u32> = Lists::with_room(&[0, 1, 0]);
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
