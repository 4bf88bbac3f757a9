//! What two meshes cover: squares and spikes by hand, and every other mask by brute force.

use lodmark::{metric::outline::OutlineDifference, num::Grid};

use crate::support::Random;

/// A mask from rows of `#` and `.`.
fn mask(rows: &[&str]) -> Grid<bool> {
    let values = rows.iter().flat_map(|row| row.bytes()).map(|b| b == b'#');
    let (width, height) = (rows[0].len() as u32, rows.len() as u32);
    Grid::new(width, height, values.collect()).expect("rows of one length")
}

#[track_caller]
fn displaced(a: &[&str], b: &[&str], squared: u64, differing: u64) {
    let (a, b) = (mask(a), mask(b));
    for (reference, candidate) in [(&a, &b), (&b, &a)] {
        let found = OutlineDifference::between(reference, candidate).expect("one size");
        let covered = reference.values().iter().filter(|&&c| c).count() as u64;
        let expected = OutlineDifference {
            covered,
            differing,
            squared_displacement: squared,
        };
        assert_eq!(found, expected);
    }
}

#[test]
fn a_square_that_moved_counts_with_its_way() {
    displaced(&["##...", "##..."], &["##...", "##..."], 0, 0);
    displaced(&["##...", "##..."], &[".##..", ".##.."], 1, 4);
    displaced(&["##...", "##..."], &["...##", "...##"], 9, 8);
    displaced(&["##..", "##..", "...."], &["....", ".##.", ".##."], 2, 6);
}

#[test]
fn a_spike_that_is_gone_counts_with_its_length_and_a_hole_with_its_radius() {
    displaced(&["##....", "######"], &["##....", "##...."], 16, 4);
    let hole = ["#####", "#...#", "#...#", "#...#", "#####"];
    displaced(&hole, &["#####"; 5], 4, 9);
}

#[test]
fn what_appears_alone_counts_with_its_size() {
    displaced(&["....", "...."], &["....", "...."], 0, 0);
    displaced(&["....", "...."], &["....", ".#.."], 1, 1);
    displaced(&["....", "...."], &["###.", ".#.."], 9, 4);
}

#[test]
fn masks_of_different_sizes_are_refused_and_empty_ones_are_equal() {
    let found = OutlineDifference::between(&mask(&["#."]), &mask(&["#", "."]));
    assert!(found.is_err());
    let empty = Grid::filled(0, 0, false);
    let found = OutlineDifference::between(&empty, &empty).expect("one size");
    assert_eq!(found, OutlineDifference::default());
}

/// The largest squared distance of a sample of `a` from the nearest one of `b`, by trying all pairs.
fn farthest_by_force(a: &Grid<bool>, b: &Grid<bool>) -> u64 {
    let places = |mask: &Grid<bool>| {
        let width = mask.width() as usize;
        let covered = mask.values().iter().enumerate().filter(|(_, c)| **c);
        covered
            .map(|(i, _)| ((i % width) as i64, (i / width) as i64))
            .collect::<Vec<_>>()
    };
    let (a, b) = (places(a), places(b));
    let squared = |p: &(i64, i64), q: &(i64, i64)| (p.0 - q.0).pow(2) + (p.1 - q.1).pow(2);
    let nearest = |p| b.iter().map(|q| squared(p, q)).min().expect("covers some");
    a.iter().map(nearest).max().expect("covers some") as u64
}

#[test]
fn the_displacement_is_the_hausdorff_distance_of_what_is_covered() {
    let mut random = Random::new(7, 0);
    for case in 0..400 {
        let (width, height) = (1 + random.below(13) as u32, 1 + random.below(11) as u32);
        let sparse = 1 + case % 9;
        let mut draw = || {
            let count = (width * height) as usize;
            let mut values: Vec<bool> = (0..count).map(|_| random.below(sparse + 1) == 0).collect();
            let one = random.below(count);
            values[one] = true;
            Grid::new(width, height, values).expect("of this size")
        };
        let (a, b) = (draw(), draw());
        let found = OutlineDifference::between(&a, &b).expect("one size");
        let expected = farthest_by_force(&a, &b).max(farthest_by_force(&b, &a));
        assert_eq!(found.squared_displacement, expected, "{a:?} {b:?}");
        let differing = a.values().iter().zip(b.values()).filter(|(a, b)| a != b);
        assert_eq!(found.differing, differing.count() as u64);
    }
}
