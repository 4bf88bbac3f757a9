//! Groups equal items and numbers the groups in the order of their first members, without a hash map.

use crate::parallel;
use std::cmp::Ordering;

/// Items with equal keys share a group.
pub(crate) struct EqualGroups {
    /// The group of every item; groups are numbered in the order of their first members.
    pub groups: Vec<u32>,
    /// The first member of every group, ascending.
    pub firsts: Vec<usize>,
}

/// Groups the items `0..count` that `compare` calls equal (a total order). O(n log n), the same for every number of
/// threads; fewer than 2^32 groups.
pub(crate) fn group_equal(
    count: usize,
    compare: &(dyn Fn(usize, usize) -> Ordering + Sync),
) -> EqualGroups {
    let mut order: Vec<usize> = (0..count).collect();
    parallel::sort_numbers(&mut order, &|a, b| compare(a, b).then(a.cmp(&b)));
    let mut leaders = vec![0_usize; count];
    for run in order.chunk_by(|&a, &b| compare(a, b) == Ordering::Equal) {
        for &item in run {
            leaders[item] = run[0];
        }
    }
    let mut groups = vec![0_u32; count];
    let mut firsts = Vec::new();
    for (item, leader) in leaders.into_iter().enumerate() {
        if leader == item {
            groups[item] = firsts.len() as u32;
            firsts.push(item);
        } else {
            groups[item] = groups[leader];
        }
    }
    EqualGroups { groups, firsts }
}

/// Compares rows of numbers bit for bit, in the order of the numbers: equal only where all bits are.
pub(crate) fn compare_rows(a: &[f64], b: &[f64]) -> Ordering {
    a.iter()
        .zip(b)
        .map(|(x, y)| x.total_cmp(y))
        .find(|o| o.is_ne())
        .unwrap_or(Ordering::Equal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_numbered_by_their_first_members() {
        let items = [7, 3, 7, 1, 3];
        let found = group_equal(items.len(), &|a, b| items[a].cmp(&items[b]));
        assert_eq!(found.groups, [0, 1, 0, 2, 1]);
        assert_eq!(found.firsts, [0, 1, 3]);
    }
}
