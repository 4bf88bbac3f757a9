//! The best offset of a direction, exactly: a sweep over where the intervals of the faces begin and end.

use super::plan::{Limits, PlanFace};
use crate::bound::planar::Interval;

/// Where the interval of a face begins or ends.
#[derive(Clone, Copy, Debug)]
struct Event {
    at: f64,
    face: u32,
    ends: bool,
}

/// The intervals of faces along one direction, by their ends in order.
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
    /// The intervals of the faces with the given numbers.
    pub(super) fn new(
        faces: &[PlanFace],
        numbers: impl Iterator<Item = u32>,
        limits: &Limits,
    ) -> Self {
        let mut events = Vec::new();
        for face in numbers {
            let Interval { min, max } = faces[face as usize].interval(limits);
            if min <= max {
                let begin = Event {
                    at: min,
                    face,
                    ends: false,
                };
                let end = Event {
                    at: max,
                    face,
                    ends: true,
                };
                events.extend([begin, end]);
            }
        }
        // Closed intervals: what begins where another ends has a point in common with it.
        events.sort_unstable_by(|a, b| {
            let order = a.at.total_cmp(&b.at).then(a.ends.cmp(&b.ends));
            order.then(a.face.cmp(&b.face))
        });
        Self { events }
    }

    /// The offsets where the values of faces add up to most, the smallest such; forgets faces of no value.
    pub(super) fn best(&mut self, value: impl Fn(u32) -> u64) -> Stab {
        self.events.retain(|event| value(event.face) > 0);
        let mut best = Stab { gain: 0, rho: 0.0 };
        let (mut sum, mut low) = (0_u64, f64::NAN);
        let mut rising = false;
        for event in &self.events {
            if event.ends {
                if rising && sum > best.gain {
                    best = Stab {
                        gain: sum,
                        rho: middle(low, event.at),
                    };
                }
                rising = false;
                sum -= value(event.face);
            } else {
                sum += value(event.face);
                low = event.at;
                rising = true;
            }
        }
        best
    }
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
