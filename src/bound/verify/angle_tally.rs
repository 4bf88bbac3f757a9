//! A tally of measured angles between points and their replacements: their number, the violations, and the worst.

use glam::DVec3;

use super::viewpoints::tangent2;

/// A pair of points as a viewer sees them, in frame units.
#[derive(Clone, Copy)]
pub(super) struct FrameSighting {
    pub(super) tangent2: f64,
    pub(super) triangle: u32,
    pub(super) point: DVec3,
    pub(super) replacement: DVec3,
    pub(super) viewpoint: DVec3,
}

impl FrameSighting {
    /// Measures a pair of points from a viewpoint.
    pub(super) fn new(triangle: u32, point: DVec3, replacement: DVec3, viewpoint: DVec3) -> Self {
        Self {
            tangent2: tangent2(point, replacement, viewpoint),
            triangle,
            point,
            replacement,
            viewpoint,
        }
    }

    /// Looks at another pair of points of the same triangle: the larger angle stays.
    pub(super) fn look(&mut self, point: DVec3, replacement: DVec3, viewpoint: DVec3) {
        let other = Self::new(self.triangle, point, replacement, viewpoint);
        if other.tangent2 > self.tangent2 {
            *self = other;
        }
    }
}

/// The number of measured angles, of those above the claim, and the largest one.
#[derive(Default)]
pub(super) struct AngleTally {
    pub(super) worst: Option<FrameSighting>,
    pub(super) sightings: u64,
    pub(super) violations: u64,
}

impl AngleTally {
    /// Counts one measured angle.
    pub(super) fn see(&mut self, seen: FrameSighting, limit2: f64) {
        self.sightings += 1;
        self.violations += u64::from(seen.tangent2 > limit2);
        if self.worst.is_none_or(|w| seen.tangent2 > w.tangent2) {
            self.worst = Some(seen);
        }
    }

    /// Adds another tally; of equally large angles the first stays.
    pub(super) fn add(&mut self, other: &Self) {
        self.sightings += other.sightings;
        self.violations += other.violations;
        if let Some(seen) = other.worst
            && self.worst.is_none_or(|w| seen.tangent2 > w.tangent2)
        {
            self.worst = Some(seen);
        }
    }
}
