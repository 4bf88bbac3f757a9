//! Work on all threads whose results do not depend on them: the only place that names rayon.
//!
//! Every function maps over an indexed list and gives results in its order, or merges integers, whose sums have no
//! order. What rayon instantiates for a closure is large, so all of them end in [`divide`] and [`both`], which take
//! closures by reference; the functions around them are thin.
//!
//! Ranges are halved as rayon does it: at first once for every thread, and again where another thread takes a half.

use std::{
    cmp::Ordering,
    ops::Range,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering::Relaxed},
    },
};

use rayon::slice::ParallelSliceMut;

use crate::{Error, Result};

/// Returns the number of threads that share work.
pub(crate) fn threads() -> usize {
    rayon::current_num_threads()
}

/// Sets the number of threads for the whole process, before any work is shared.
///
/// # Errors
/// [`Error::Internal`] where work has been shared already.
#[cfg(feature = "cli")]
pub(crate) fn set_threads(count: usize) -> Result<()> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .build_global()
        .map_err(|e| Error::Internal(e.to_string()))
}

/// Runs `work` on a thread of the pool: from there, handing work to another thread costs a microsecond, from outside many.
pub(crate) fn in_pool<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    let (mut work, mut result) = (Some(work), None);
    enter(&mut || result = work.take().map(|work| work()));
    result.expect("the work was done")
}

fn enter(work: &mut (dyn FnMut() + Send)) {
    rayon::scope(|_| work());
}

/// Runs both closures, on two threads where one is idle.
pub(crate) fn join<A: Send, B: Send>(
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    let (mut a, mut b) = (Some(a), Some(b));
    let (mut left, mut right) = (None, None);
    both(&mut || left = a.take().map(|a| a()), &mut || {
        right = b.take().map(|b| b())
    });
    let done = "both closures were run";
    (left.expect(done), right.expect(done))
}

/// [`join`] without results and without a closure type of its own.
pub(crate) fn both(a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
    rayon::join(a, b);
}

/// Calls `work` for ranges that cover `0..len`, none of them shorter than `least` where there is more than one.
pub(crate) fn for_ranges(len: usize, least: usize, work: &(dyn Fn(Range<usize>) + Sync)) {
    if len > 0 {
        divide(0..len, least.max(1), threads(), false, work);
    }
}

fn divide(
    range: Range<usize>,
    least: usize,
    splits: usize,
    moved: bool,
    work: &(dyn Fn(Range<usize>) + Sync),
) {
    let half = range.len() / 2;
    if half < least || splits == 0 && !moved {
        return work(range);
    }
    let splits = if moved {
        threads().max(splits / 2)
    } else {
        splits / 2
    };
    let middle = range.start + half;
    rayon::join_context(
        |on| divide(range.start..middle, least, splits, on.migrated(), work),
        |on| divide(middle..range.end, least, splits, on.migrated(), work),
    );
}

/// Collects what `fill` pushes for ranges that cover `0..len`, in the order of the ranges: see [`for_ranges`].
pub(crate) fn collect<T: Send>(
    len: usize,
    least: usize,
    fill: impl Fn(Range<usize>, &mut Vec<T>) + Sync,
) -> Vec<T> {
    let parts = Parts::default();
    for_ranges(len, least, &|range| {
        let (start, mut part) = (range.start, Vec::new());
        fill(range, &mut part);
        parts.add(start, part);
    });
    parts.in_order()
}

/// Results of ranges with the starts of the ranges, as they come.
struct Parts<T>(Mutex<(Vec<usize>, Vec<Vec<T>>)>);

impl<T> Default for Parts<T> {
    fn default() -> Self {
        Self(Mutex::new((Vec::new(), Vec::new())))
    }
}

impl<T> Parts<T> {
    fn add(&self, start: usize, part: Vec<T>) {
        let mut parts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        parts.0.push(start);
        parts.1.push(part);
    }

    /// Joins the parts in the order of their starts.
    fn in_order(self) -> Vec<T> {
        let (starts, mut parts) = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        let mut len = 0;
        for part in &parts {
            len += part.len();
        }
        let mut all = Vec::new();
        for i in ascending(starts) {
            if all.is_empty() {
                std::mem::swap(&mut all, &mut parts[i]);
                all.reserve_exact(len - all.len());
            } else {
                all.append(&mut parts[i]);
            }
        }
        all
    }
}

/// The places of `starts` in ascending order.
fn ascending(starts: Vec<usize>) -> Vec<usize> {
    let mut order: Vec<(usize, usize)> = (0..).zip(starts).map(|(i, start)| (start, i)).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, i)| i).collect()
}

/// Returns `f(i)` for every `i` below `len`, in order.
pub(crate) fn map<T: Send>(len: usize, f: impl Fn(usize) -> T + Sync) -> Vec<T> {
    collect(len, 1, |range, part| {
        part.reserve_exact(range.len());
        for i in range {
            part.push(f(i));
        }
    })
}

/// Returns `f(item)` for every item, in order.
pub(crate) fn map_slice<'a, I: Sync, T: Send>(
    items: &'a [I],
    f: impl Fn(&'a I) -> T + Sync,
) -> Vec<T> {
    map(items.len(), |i| f(&items[i]))
}

/// Returns `f(item)` for every item, in order, where there is one.
pub(crate) fn filter_map<T: Send>(len: usize, f: impl Fn(usize) -> Option<T> + Sync) -> Vec<T> {
    collect(len, 1, |range, part| {
        for i in range {
            if let Some(found) = f(i) {
                part.push(found);
            }
        }
    })
}

/// Returns `f(i)` for every `i` below `len`, in order; ends soon after the first error.
///
/// # Errors
/// One of those of `f`.
pub(crate) fn try_map<T: Send>(
    len: usize,
    f: impl Fn(usize) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    let fault = Fault::default();
    let found = filter_map(len, |i| fault.watch(|| f(i)));
    fault.into_result().map(|()| found)
}

/// True where `holds` is for any number below `len`.
pub(crate) fn any(len: usize, holds: &(dyn Fn(usize) -> bool + Sync)) -> bool {
    let found = AtomicBool::new(false);
    for_ranges(len, 1, &|mut range| {
        if range.any(|i| found.load(Relaxed) || holds(i)) {
            found.store(true, Relaxed);
        }
    });
    found.into_inner()
}

/// Counts the numbers below `len` for which `holds` is true.
pub(crate) fn count(len: usize, holds: &(dyn Fn(usize) -> bool + Sync)) -> u64 {
    let total = AtomicU64::new(0);
    for_ranges(len, 1, &|range| {
        let count = range.filter(|&i| holds(i)).count();
        total.fetch_add(count as u64, Relaxed);
    });
    total.into_inner()
}

/// Calls `work` for every chunk of `size` items (the last may be shorter) with its number.
pub(crate) fn for_chunks<T: Send>(
    items: &mut [T],
    size: usize,
    work: impl Fn(usize, &mut [T]) + Sync,
) {
    halve(items, 0, size.max(1), 1, &work);
}

/// [`for_chunks`], at least `least` chunks one after the other; ends soon after the first error.
///
/// # Errors
/// One of those of `work`.
pub(crate) fn try_for_chunks<T: Send>(
    items: &mut [T],
    size: usize,
    least: usize,
    work: impl Fn(usize, &mut [T]) -> Result<()> + Sync,
) -> Result<()> {
    let fault = Fault::default();
    halve(items, 0, size.max(1), least.max(1), &|i, chunk| {
        fault.watch(|| work(i, chunk));
    });
    fault.into_result()
}

fn halve<T: Send>(
    items: &mut [T],
    first: usize,
    size: usize,
    least: usize,
    work: &(dyn Fn(usize, &mut [T]) + Sync),
) {
    let half = items.len().div_ceil(size) / 2;
    if half < least {
        for (i, chunk) in (first..).zip(items.chunks_mut(size)) {
            work(i, chunk);
        }
        return;
    }
    let (left, right) = items.split_at_mut(half * size);
    both(&mut || halve(left, first, size, least, work), &mut || {
        halve(right, first + half, size, least, work)
    });
}

/// Returns `f(i, item)` for every item, in order.
pub(crate) fn map_mut<T: Send, R: Send>(
    items: &mut [T],
    f: impl Fn(usize, &mut T) -> R + Sync,
) -> Vec<R> {
    let mut pairs: Vec<(&mut T, Option<R>)> = Vec::with_capacity(items.len());
    for item in items {
        pairs.push((item, None));
    }
    halve(&mut pairs, 0, 1, 1, &|i, chunk| {
        for (item, result) in chunk {
            *result = Some(f(i, item));
        }
    });
    let results = pairs.into_iter().map(|(_, result)| result);
    results.map(|r| r.expect("every item was asked")).collect()
}

/// Returns `f(item)` for every item, in order.
pub(crate) fn map_vec<T: Send, R: Send>(items: Vec<T>, f: impl Fn(T) -> R + Sync) -> Vec<R> {
    let mut items: Vec<Option<T>> = items.into_iter().map(Some).collect();
    map_mut(&mut items, |_, item| {
        f(item.take().expect("an item is taken once"))
    })
}

/// The sum of `f(i, item)` over all items.
pub(crate) fn sum_mut<T: Send>(items: &mut [T], f: &(dyn Fn(usize, &mut T) -> i64 + Sync)) -> i64 {
    match items {
        [] => 0,
        [item] => f(0, item),
        _ => {
            let half = items.len() / 2;
            let (left, right) = items.split_at_mut(half);
            let (mut a, mut b) = (0, 0);
            both(&mut || a = sum_mut(left, f), &mut || {
                b = sum_mut(right, &|i, item| f(half + i, item))
            });
            a + b
        }
    }
}

/// Sorts by a total order.
pub(crate) fn sort_by<T: Send>(items: &mut [T], compare: impl Fn(&T, &T) -> Ordering + Sync) {
    items.par_sort_unstable_by(compare);
}

/// Sorts by an order in which equal items stay in the order they are in.
pub(crate) fn sort_stable_by<T: Send>(
    items: &mut [T],
    compare: impl Fn(&T, &T) -> Ordering + Sync,
) {
    items.par_sort_by(compare);
}

/// [`sort_by`] for numbers of items, with one compiled sort for all orders.
pub(crate) fn sort_numbers(
    numbers: &mut [usize],
    compare: &(dyn Fn(usize, usize) -> Ordering + Sync),
) {
    sort_by(numbers, |&a, &b| compare(a, b));
}

/// Remembers that work which goes on elsewhere has failed.
#[derive(Default)]
struct Fault {
    is_set: AtomicBool,
    error: Mutex<Option<Error>>,
}

impl Fault {
    /// Does `work` unless some has failed; `None` where it fails or is not done.
    fn watch<T>(&self, work: impl FnOnce() -> Result<T>) -> Option<T> {
        if self.is_set.load(Relaxed) {
            return None;
        }
        work().map_err(|error| self.note(error)).ok()
    }

    fn note(&self, error: Error) {
        self.is_set.store(true, Relaxed);
        let mut first = self.error.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert(error);
    }

    fn into_result(self) -> Result<()> {
        let error = self.error.into_inner();
        error
            .unwrap_or_else(PoisonError::into_inner)
            .map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_list() {
        for len in [0, 1, 2, 3, 100, 10_000] {
            assert!(map(len, |i| i).into_iter().eq(0..len));
            let odd = filter_map(len, |i| (i % 2 == 1).then_some(i));
            assert!(odd.into_iter().eq((0..len).filter(|i| i % 2 == 1)));
            assert_eq!(count(len, &|i| i % 3 == 0), len.div_ceil(3) as u64);
            assert_eq!(any(len, &|i| i == 99), len > 99);
            let mut items: Vec<usize> = (0..len).collect();
            let doubled = map_mut(&mut items, |i, item| {
                *item += i;
                *item
            });
            assert!(doubled.into_iter().eq((0..len).map(|i| 2 * i)));
            let sum = sum_mut(&mut items, &|i, item| *item as i64 - i as i64);
            assert_eq!(sum, (0..len as i64).sum::<i64>());
        }
    }

    #[test]
    fn chunks_are_those_of_the_slice() {
        let mut items: Vec<usize> = (0..1_000).collect();
        for_chunks(&mut items, 7, |i, chunk| {
            for item in chunk {
                assert_eq!(*item / 7, i);
                *item = i;
            }
        });
        assert!(items.into_iter().eq((0..1_000).map(|i| i / 7)));
    }

    #[test]
    fn ranges_are_not_shorter_than_asked() {
        for_ranges(1_000, 300, &|range| assert!(range.len() >= 300));
    }

    #[test]
    fn an_error_ends_the_work() {
        let usage = |i: usize| Error::Usage(i.to_string());
        let found = try_map(1_000, |i| if i == 700 { Err(usage(i)) } else { Ok(i) });
        assert!(matches!(found, Err(Error::Usage(i)) if i == "700"));
        let mut items = [0; 100];
        let third = |i, _: &mut [i32]| if i == 3 { Err(usage(i)) } else { Ok(()) };
        let chunks = try_for_chunks(&mut items, 10, 2, third);
        assert!(matches!(chunks, Err(Error::Usage(i)) if i == "3"));
        assert!(try_map(3, Ok).is_ok_and(|all| all == [0, 1, 2]));
    }
}
