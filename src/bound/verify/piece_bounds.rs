//! Bounds of the angle for all pieces of a record, from below and above, and the check that they leave nothing out.
//!
//! First every piece gets a bound for the cell as a whole. Then those for which that is too far above the largest angle
//! known, or on the other side of the claim than what was seen, get a closer one: the largest bound first, in groups that
//! all know the same largest angle, so that the result is the same for any number of threads.

use glam::DVec3;

use super::{
    angle::AngleCheck,
    angle_bound::{Wanted, first, refine},
    angle_tally::{AngleTally, FrameSighting},
    gaps::{self, Gap},
    nearest::double_area,
    record::{ONE, Record},
};
use crate::{Progress, Result, num::math::length, parallel};

/// Original triangles of a task, tasks between two reports, and pieces that get closer bounds between two reports.
const TRIANGLES: u32 = 64;
const GROUP: u32 = 256;
const CLOSER: usize = 512;

/// Bounds of the angle for all pieces together.
pub(super) struct PieceBounds {
    /// The first triangle of which something is left out.
    pub(super) gap: Option<(u32, Gap)>,
    /// No viewer sees any point under an angle with a larger square of the tangent.
    pub(super) at_most2: f64,
    /// The share of the area for which the claim is not proven.
    pub(super) undecided: f64,
    /// Viewpoints of an endless cell were left out that may break the claim.
    pub(super) partial: bool,
}

/// A piece with the squares of tangents that it attains and stays below.
struct Bounded {
    triangle: u32,
    piece: u32,
    lower2: f64,
    upper2: f64,
    /// From viewpoints that are left out.
    beyond2: f64,
}

impl AngleCheck<'_> {
    /// Bounds every piece, the largest angles closely; what is measured on the way goes into `found`.
    pub(super) fn piece_bounds(
        &self,
        record: &Record,
        found: &mut AngleTally,
        progress: &dyn Progress,
    ) -> Result<PieceBounds> {
        let count = self.originals.len() as u32;
        let tasks = count.div_ceil(TRIANGLES);
        let mut gap = None;
        let mut all: Vec<Bounded> = Vec::with_capacity(record.piece_count());
        for start in (0..tasks).step_by(GROUP as usize) {
            progress.step("check the pieces", u64::from(start), u64::from(tasks))?;
            let in_group = (tasks - start).min(GROUP) as usize;
            let group = parallel::map(in_group, |i| {
                let (mut own, mut wrong, mut bounds) = (AngleTally::default(), None, Vec::new());
                let first = (start + i as u32) * TRIANGLES;
                for t in first..count.min(first + TRIANGLES) {
                    wrong = wrong.or_else(|| Some((t, gaps::check(record, t)?)));
                    self.first_bounds(record, t, &mut own, &mut bounds);
                }
                (own, wrong, bounds)
            });
            for (own, wrong, bounds) in group {
                found.add(&own);
                gap = gap.or(wrong);
                all.extend(bounds);
            }
        }
        self.closer_bounds(record, &mut all, found, progress)?;
        let upper2 = |b: &Bounded| b.upper2.max(b.beyond2);
        let area = |b: &Bounded| {
            let mut corners = Vec::new();
            self.load(record, b.triangle, b.piece, &mut corners);
            let corner = |i: usize| corners[i][0];
            let fan = 2..corners.len();
            fan.map(|i| double_area([corner(0), corner(i - 1), corner(i)]))
                .sum::<f64>()
        };
        let open = all.iter().filter(|b| upper2(b) > self.limit2);
        // A sum of nothing is -0 where it starts as one.
        let undecided = open.map(area).fold(0.0, |sum, x| sum + x);
        let total: f64 = self.originals.iter().copied().map(double_area).sum();
        Ok(PieceBounds {
            gap,
            at_most2: all.iter().map(upper2).fold(0.0, f64::max),
            undecided: if total > 0.0 {
                (undecided / total).min(1.0)
            } else {
                0.0
            },
            partial: all.iter().any(|b| b.beyond2 > self.limit2),
        })
    }

    fn first_bounds(
        &self,
        record: &Record,
        triangle: u32,
        found: &mut AngleTally,
        bounds: &mut Vec<Bounded>,
    ) {
        let mut corners = Vec::new();
        for piece in record.of(triangle) {
            self.load(record, triangle, piece, &mut corners);
            let mut seen = self.start(triangle, &corners);
            let upper2 = first(&corners, &self.viewpoints.parts, &mut seen);
            let moved = corners.iter().map(|[p, s]| length(*s - *p));
            let beyond = self
                .viewpoints
                .beyond(corners.iter().map(|c| c[0]), moved.fold(0.0, f64::max));
            bounds.push(Bounded {
                triangle,
                piece,
                lower2: seen.tangent2,
                upper2,
                beyond2: beyond * beyond,
            });
            found.see(seen, self.limit2);
        }
    }

    /// A first sighting of a piece: from one of its own points, where a viewer may be there.
    fn start(&self, triangle: u32, corners: &[[DVec3; 2]]) -> FrameSighting {
        let within = corners
            .iter()
            .find(|[p, s]| p != s && self.viewpoints.holds(*p));
        let ([point, replacement], viewpoint) = match within {
            Some(&at) => (at, at[0]),
            None => (corners[0], self.viewpoints.corners[0]),
        };
        FrameSighting::new(triangle, point, replacement, viewpoint)
    }

    fn closer_bounds(
        &self,
        record: &Record,
        all: &mut [Bounded],
        found: &mut AngleTally,
        progress: &dyn Progress,
    ) -> Result<()> {
        let known2 = |found: &AngleTally| found.worst.map_or(0.0, |w| w.tangent2);
        let wanted = |known2| Wanted {
            claim2: self.limit2,
            known2,
        };
        let start = wanted(known2(found));
        let mut rest: Vec<usize> = (0..all.len())
            .filter(|&i| !start.is_met(all[i].lower2, all[i].upper2))
            .collect();
        rest.sort_by(|&a, &b| all[b].upper2.total_cmp(&all[a].upper2).then(a.cmp(&b)));
        for (i, group) in rest.chunks(CLOSER).enumerate() {
            let done = (i * CLOSER) as u64;
            progress.step("search the largest angle", done, rest.len() as u64)?;
            let wanted = wanted(known2(found));
            let closer = parallel::filter_map(group.len(), |i| {
                let i = group[i];
                let b = &all[i];
                if wanted.is_met(b.lower2, b.upper2) {
                    return None;
                }
                let mut corners = Vec::new();
                self.load(record, b.triangle, b.piece, &mut corners);
                let mut seen = self.start(b.triangle, &corners);
                let upper2 = refine(&corners, &self.viewpoints.parts, wanted, &mut seen);
                Some((i, seen, upper2.min(b.upper2)))
            });
            for (i, seen, upper2) in closer {
                (all[i].lower2, all[i].upper2) = (seen.tangent2, upper2);
                found.see(seen, self.limit2);
            }
        }
        Ok(())
    }

    /// Corners of a piece and of what stands for it.
    pub(super) fn load(
        &self,
        record: &Record,
        triangle: u32,
        piece: u32,
        into: &mut Vec<[DVec3; 2]>,
    ) {
        let (target, corners) = record.piece(piece);
        let at = |[a, b, c]: [DVec3; 3], u: u32, v: u32| {
            let (u, v) = (f64::from(u) / f64::from(ONE), f64::from(v) / f64::from(ONE));
            a + (b - a) * u + (c - a) * v
        };
        into.clear();
        into.extend(corners.iter().map(|w| {
            [
                at(self.originals[triangle as usize], w[0], w[1]),
                at(self.targets[target as usize], w[2], w[3]),
            ]
        }));
    }
}
