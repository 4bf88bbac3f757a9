//! What a viewer sees, by nothing but the angle between two sights: the code that the bounds are held against.

use glam::DVec2;

use crate::support::{Random, bound_count, bound_seed};

/// How many cases of a kind, and the numbers they are drawn from: 10^3 and seed 2007 unless LODMARK_BOUND_CASES and
/// LODMARK_SEED say otherwise.
pub(super) fn cases(stream: u64) -> (u32, Random) {
    let count = bound_count(1_000);
    (count, Random::new(bound_seed(), stream))
}

/// The angle between `a` and `b` seen from `v`.
pub(super) fn angle(v: DVec2, a: DVec2, b: DVec2) -> f64 {
    let (a, b) = (a - v, b - v);
    (a.x * b.y - a.y * b.x).abs().atan2(a.x * b.x + a.y * b.y)
}

/// The largest value of `f` on [0, 1] that sampling finds, refined around the best sample, and where it is.
pub(super) fn largest(f: impl Fn(f64) -> f64, samples: u32) -> (f64, f64) {
    let mut best = (f64::NEG_INFINITY, 0.0);
    let (mut low, mut high, mut count) = (0.0, 1.0, samples);
    for _ in 0..14 {
        for i in 0..=count {
            let t = low + (high - low) * f64::from(i) / f64::from(count);
            let value = f(t);
            if value > best.0 {
                best = (value, t);
            }
        }
        let half = (high - low) / f64::from(count) * 1.5;
        (low, high) = ((best.1 - half).max(0.0), (best.1 + half).min(1.0));
        count = 12;
    }
    best
}

/// The largest value of `f` on the unit square that sampling finds, refined around the `starts` best local maxima of a
/// grid of so many steps each way (0: that parameter changes nothing), and where it is.
pub(super) fn largest_of_two(
    f: impl Fn(f64, f64) -> f64,
    steps: [u32; 2],
    starts: usize,
) -> (f64, [f64; 2]) {
    let (rows, columns) = (steps[0] as usize + 1, steps[1] as usize + 1);
    let at = |i: usize, n: usize| i as f64 / (n - 1).max(1) as f64;
    let places = (0..rows * columns).map(|k| (at(k / columns, rows), at(k % columns, columns)));
    let grid: Vec<f64> = places.map(|(s, t)| f(s, t)).collect();
    let mut peaks = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            let value = grid[i * columns + j];
            let (top, left) = (i.saturating_sub(1), j.saturating_sub(1));
            let around = (top..(i + 2).min(rows))
                .flat_map(|k| (left..(j + 2).min(columns)).map(move |l| k * columns + l));
            if around.map(|k| grid[k]).all(|other| other <= value) {
                peaks.push((value, [at(i, rows), at(j, columns)]));
            }
        }
    }
    peaks.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut best = peaks[0];
    for &peak in peaks.iter().take(starts) {
        let mut here = peak;
        let mut half = [1.0 / steps[0].max(1) as f64, 1.0 / steps[1].max(1) as f64];
        for _ in 0..40 {
            let (before, centre) = here;
            let across = if steps[0] == 0 { 0 } else { 2 };
            for i in -across..=across {
                for j in -2..=2 {
                    let s = (centre[0] + half[0] * f64::from(i) / 2.0).clamp(0.0, 1.0);
                    let t = (centre[1] + half[1] * f64::from(j) / 2.0).clamp(0.0, 1.0);
                    let value = f(s, t);
                    if value > here.0 {
                        here = (value, [s, t]);
                    }
                }
            }
            // A ridge is followed as long as it rises.
            let shrink = if here.0 > before { 0.85 } else { 0.4 };
            half = half.map(|h| h * shrink);
            if half[0].max(half[1]) < 1e-8 {
                break;
            }
        }
        if here.0 > best.0 {
            best = here;
        }
    }
    best
}
