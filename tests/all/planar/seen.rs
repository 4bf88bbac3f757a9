//! What a viewer sees, by nothing but the angle between two sights: the code that the bounds are held against.

use glam::DVec2;
use lodmark::mesh::generate::Pcg32;

/// How many cases of a kind, and the numbers they are drawn from: 10^3 and seed 2007 unless LODMARK_CASES and
/// LODMARK_SEED say otherwise.
pub fn cases(stream: u64) -> (u32, Pcg32) {
    let number = |name: &str, default: u64| {
        std::env::var(name).map_or(default, |v| v.parse().expect("a whole number"))
    };
    let count = u32::try_from(number("LODMARK_CASES", 1000)).expect("a number of cases");
    (count, Pcg32::new(number("LODMARK_SEED", 2007), stream))
}

pub fn between(random: &mut Pcg32, low: f64, high: f64) -> f64 {
    low + (high - low) * random.unit()
}

/// The angle between `a` and `b` seen from `v`.
pub fn angle(v: DVec2, a: DVec2, b: DVec2) -> f64 {
    let (a, b) = (a - v, b - v);
    (a.x * b.y - a.y * b.x).abs().atan2(a.x * b.x + a.y * b.y)
}

/// The largest value of `f` on [0, 1] that sampling finds, refined around the best sample, and where it is.
pub fn largest(f: impl Fn(f64) -> f64, samples: u32) -> (f64, f64) {
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

/// The largest value of `f` on the unit square that sampling finds, refined around the best sample, and where it is.
pub fn largest_of_two(f: impl Fn(f64, f64) -> f64, samples: u32) -> (f64, [f64; 2]) {
    let mut best = (f64::NEG_INFINITY, [0.0; 2]);
    let mut window = [[0.0, 1.0]; 2];
    let mut count = samples;
    for _ in 0..14 {
        let at = |k: usize, i: u32| {
            window[k][0] + (window[k][1] - window[k][0]) * f64::from(i) / f64::from(count)
        };
        let mut found = best;
        for i in 0..=count {
            for j in 0..=count {
                let (s, t) = (at(0, i), at(1, j));
                let value = f(s, t);
                if value > found.0 {
                    found = (value, [s, t]);
                }
            }
        }
        best = found;
        for k in 0..2 {
            let half = (window[k][1] - window[k][0]) / f64::from(count) * 1.5;
            window[k] = [(best.1[k] - half).max(0.0), (best.1[k] + half).min(1.0)];
        }
        count = 8;
    }
    best
}
