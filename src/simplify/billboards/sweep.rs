//! The best offset of a bearing, exactly: a sweep over where the intervals of the faces begin and end.

use super::plan::{Limits, PlanFace};
use crate::bound::planar::Interval;

/// An end of the interval of a face: twice its number, one more for the upper end.
type Event = u32;

/// The intervals of faces along one bearing, by their ends in order. Four bytes an end: there are many bearings.
#[derive(Clone, Debug, Default)]
pub(super) struct Sweep {
    events: Vec<Event>,
}

/// Offsets that the most valuable set of faces has in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stab {
    /// Value of the set.
    pub(super) gain: u64,
    /// The middle of the offsets.
    pub(super) rho: f64,
}

impl Sweep {
    /// The intervals of the faces with the given numbers. O(n log n).
    pub(super) fn new(
        faces: &[PlanFace],
        numbers: impl Iterator<Item = u32>,
        limits: &Limits,
    ) -> Self {
        let mut ends: Vec<u128> = Vec::new();
        for face in numbers {
            let Interval { min, max } = faces[face as usize].interval(limits);
            if min <= max {
                ends.extend([order(min, false, face), order(max, true, face)]);
            }
        }
        ends.sort_unstable();
        Self {
            events: ends.into_iter().map(event).collect(),
        }
    }

    /// The offsets where the values of faces add up to most, the smallest such; forgets faces of no value. `faces` and
    /// `limits` as they were. O(n).
    pub(super) fn best(
        &mut self,
        faces: &[PlanFace],
        limits: &Limits,
        value: impl Fn(u32) -> u64,
    ) -> Stab {
        self.events.retain(|event| value(event / 2) > 0);
        let (mut gain, mut ends) = (0, None);
        let (mut sum, mut low) = (0_u64, 0);
        let mut rising = false;
        for &event in &self.events {
            let face = event / 2;
            if event % 2 == 1 {
                if rising && sum > gain {
                    (gain, ends) = (sum, Some((low, face)));
                }
                rising = false;
                sum -= value(face);
            } else {
                sum += value(face);
                low = face;
                rising = true;
            }
        }
        let rho = ends.map_or(0.0, |(low, high)| {
            let interval = |face: u32| faces[face as usize].interval(limits);
            middle(interval(low).min, interval(high).max)
        });
        Stab { gain, rho }
    }

    /// Raises what is known for every face to the most faces that one offset of its interval has in common. O(n log n).
    pub(super) fn fullest(&self, most: &mut [u32]) {
        // Where each interval has begun.
        let mut begun = vec![0; most.len()];
        // Depths that no later one reaches, with their places: ascending places, descending depths.
        let mut peaks: Vec<(usize, u32)> = Vec::new();
        let mut depth = 0;
        for (place, &event) in self.events.iter().enumerate() {
            let face = (event / 2) as usize;
            if event % 2 == 1 {
                let since = peaks.partition_point(|&(peak, _)| peak < begun[face]);
                most[face] = most[face].max(peaks.get(since).map_or(0, |peak| peak.1));
                depth -= 1;
            } else {
                depth += 1;
                begun[face] = place;
                while peaks.pop_if(|peak| peak.1 <= depth).is_some() {}
                peaks.push((place, depth));
            }
        }
    }
}

/// The order of ends, as integers, which are sorted sooner: by offset; then, as intervals are closed, what begins where
/// another ends before that; then by face.
fn order(at: f64, ends: bool, face: u32) -> u128 {
    let bits = at.to_bits();
    // As `total_cmp`.
    let negative = at.is_sign_negative();
    let rising = if negative { !bits } else { bits | 1 << 63 };
    u128::from(rising) << 64 | u128::from(ends) << 32 | u128::from(face)
}

/// The end that has a place in the order.
fn event(order: u128) -> Event {
    let (ends, face) = ((order >> 32) as u32 & 1, order as u32);
    2 * face + ends
}

/// An offset between two that may be infinite.
fn middle(low: f64, high: f64) -> f64 {
    match (low.is_finite(), high.is_finite()) {
        (true, true) => (low + (high - low) / 2.0).clamp(low, high),
        (true, false) => low,
        (false, true) => high,
        (false, false) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::mesh::generate::Pcg32;

    #[test]
    fn no_face_and_no_offset_is_fuller_than_its_sweep_says() {
        let mut random = Pcg32::new(2007, 403);
        for case in 0..200 {
            let count = 1 + case % 40;
            // Coarse, so that ends meet.
            let mut at = |size: u32| f64::from(random.bits() % size);
            let mut wall = |t| PlanFace::wall(t, DVec2::X * at(30), DVec2::X * (0.5 * at(5)));
            let faces: Vec<PlanFace> = (0..count).map(&mut wall).collect();
            let limits = Limits::Distance(DVec2::X, 1.0 + at(3));
            let values: Vec<u64> = (0..count).map(|_| at(4) as u64).collect();
            let sum_at = |rho: f64, value: &dyn Fn(usize) -> u64| {
                let there = (0..faces.len()).filter(|&i| faces[i].interval(&limits).contains(rho));
                there.map(value).sum::<u64>()
            };
            let mut sweep = Sweep::new(&faces, 0..count, &limits);
            let mut most = vec![0; faces.len()];
            sweep.fullest(&mut most);
            let offsets = || (-20..200).map(|i| f64::from(i) / 4.0);
            for (face, &most) in faces.iter().zip(&most) {
                let interval = face.interval(&limits);
                let own = offsets().filter(|&rho| interval.contains(rho));
                let expected = own.map(|rho| sum_at(rho, &|_| 1)).max().unwrap_or(0);
                assert_eq!(u64::from(most), expected, "case {case}");
            }
            let found = sweep.best(&faces, &limits, |face| values[face as usize]);
            let expected = offsets().map(|rho| sum_at(rho, &|i| values[i])).max();
            assert_eq!(Some(found.gain), expected, "case {case}");
            assert_eq!(sum_at(found.rho, &|i| values[i]), found.gain, "case {case}");
        }
    }
}
