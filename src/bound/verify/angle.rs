//! Checks the claim that no viewer in a cell sees a point of the original and what stands for it under more than an angle.
//!
//! What stands for what is read from a [`Record`], and three things are checked: that the pieces of every original
//! triangle cover it exactly once, in whole numbers; the angle at samples: every corner of every piece and points spread
//! over the original, from every corner of the cell and from viewpoints all over it, with a search from the worst of
//! them; and for every piece a proof for all its points and all viewpoints, which either holds or is undecided.
//! Without a record only a weaker property can be checked: that every original point has *some* point of the simplified
//! surface within the angle ([`Property::NearestInAngle`]). Endless cells are looked from only within four sizes of the
//! original around the foot of its centre. An angle breaks a claim where it is larger by a hundred-millionth or 1e-10
//! radians. The same result for any number of threads.

use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

use super::{
    cover::{self, Gap},
    interval,
    nearest::Facets,
    record::{ONE, Record},
    sight::{Viewpoints, angle, tangent2},
    sighting::{Found, Seen, worst_first},
    spread::{Spot, Spread},
};
use crate::{
    Error, Progress, Result,
    bound::cell::ViewCell,
    mesh::Mesh,
    num::{
        Frame,
        math::{cos, length, sin},
    },
};

/// Samples of a task; original triangles of a task.
const CHUNK: u64 = 4_096;
const TRIANGLES: u32 = 64;
const GROUP: usize = 256;
/// Beyond rounding: of the tangent, and in radians.
const SLACK: [f64; 2] = [1e-8, 1e-10];
/// Viewpoints for each sample, beside the corners of the cell.
const VIEWPOINTS: u64 = 2;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// What was checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Property {
    /// Every original point and what stands for it.
    Correspondence,
    /// Every original point and the point of the simplified surface that is nearest in angle: weaker.
    NearestInAngle,
}

/// A pair of points as a viewer sees them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sighting {
    /// The triangle of the original, in canonical order.
    pub triangle: u32,
    /// The point in file units.
    pub point: [f64; 3],
    /// What stands for it.
    pub replacement: [f64; 3],
    /// Where the viewer is.
    pub viewpoint: [f64; 3],
    /// The angle between the two, in degrees.
    pub angle_deg: f64,
}

/// What the check found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AngleReport {
    /// The claim in degrees.
    pub claimed_deg: f64,
    /// What was checked.
    pub property: Property,
    /// Pairs of a point and a viewpoint that were measured.
    pub sightings: u64,
    /// How many of them are seen under more than the claim.
    pub violations: u64,
    /// The largest angle.
    pub worst: Option<Sighting>,
    /// Number of pieces; `None` without a record.
    pub pieces: Option<usize>,
    /// The first original triangle that its pieces do not cover exactly once, and why.
    pub gap: Option<(u32, Gap)>,
    /// The share of the area for which the claim is not proven, in [0, 1]; 1 without a record.
    pub undecided_area: f64,
    /// The cell has no end, and only a part of it was looked from.
    pub part_of_cell: bool,
    /// Nothing was found that breaks the claim.
    pub holds: bool,
}

/// Holds a simplified mesh to a claimed angle (degrees) for the viewers in `cell`, with about `samples` points spread over
/// the original, which is in canonical order where there is a record.
///
/// # Errors
/// [`Error::Usage`] for an angle outside [0, 90); [`Error::Input`] where a mesh has no triangles or the record is not
/// theirs; [`Error::Interrupted`].
pub fn angles(
    original: &Mesh,
    simplified: &Mesh,
    cell: &ViewCell,
    degrees: f64,
    record: Option<&Record>,
    samples: u64,
    progress: &dyn Progress,
) -> Result<AngleReport> {
    if !(0.0..90.0).contains(&degrees) {
        return Err(Error::Usage(format!(
            "the claimed angle is {degrees} degrees; expected at least 0 and less than 90"
        )));
    }
    let empty = || Error::input("-", "a mesh has no triangles; expected at least one");
    let (low, high) = original.bounds().ok_or_else(empty)?;
    simplified.bounds().ok_or_else(empty)?;
    if let Some(record) = record
        && !(record.is_from(original) && record.is_to(simplified))
    {
        return Err(Error::input(
            "-",
            "the correspondence belongs to other meshes than these",
        ));
    }
    let frame = Frame::for_size(low.abs().max(high.abs()).max_element());
    let corners = |mesh: &Mesh| -> Vec<[DVec3; 3]> {
        let all = 0..mesh.triangles().len();
        all.map(|t| mesh.corners(t).map(|p| frame.enter(p)))
            .collect()
    };
    let (low, high) = (frame.enter(low), frame.enter(high));
    let limit = degrees * DEGREE;
    let tangent = sin(limit) / cos(limit) * (1.0 + SLACK[0]) + SLACK[1];
    let check = Check {
        originals: corners(original),
        targets: corners(simplified),
        viewpoints: Viewpoints::new(
            &cell.enter_frame(frame),
            (low + high) * 0.5,
            length(high - low),
        ),
        limit2: tangent * tangent,
        record,
    };
    let mut found = Found::default();
    let (gap, undecided) = match record {
        Some(record) => check.pieces(record, &mut found, progress)?,
        None => (None, 1.0),
    };
    check.sample(samples, &mut found, progress)?;
    let worst = found.worst.map(|w| Sighting {
        triangle: w.triangle,
        point: frame.leave(w.point).to_array(),
        replacement: frame.leave(w.replacement).to_array(),
        viewpoint: frame.leave(w.viewpoint).to_array(),
        angle_deg: angle(w.point, w.replacement, w.viewpoint) / DEGREE,
    });
    let within = found.worst.is_none_or(|w| w.tangent2 <= check.limit2);
    Ok(AngleReport {
        claimed_deg: degrees,
        property: match record {
            Some(_) => Property::Correspondence,
            None => Property::NearestInAngle,
        },
        sightings: found.sightings,
        violations: found.violations,
        worst,
        pieces: record.map(Record::piece_count),
        gap,
        undecided_area: undecided,
        part_of_cell: check.viewpoints.partial,
        holds: within && gap.is_none(),
    })
}

struct Check<'a> {
    originals: Vec<[DVec3; 3]>,
    targets: Vec<[DVec3; 3]>,
    viewpoints: Viewpoints,
    limit2: f64,
    record: Option<&'a Record>,
}

impl Check<'_> {
    /// Corners of a piece and of what stands for it.
    fn load(&self, record: &Record, triangle: u32, piece: u32, into: &mut Vec<[DVec3; 2]>) {
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

    /// Covers, corners and proofs of all pieces: the first gap, and the share of the area that is undecided.
    fn pieces(
        &self,
        record: &Record,
        found: &mut Found,
        progress: &dyn Progress,
    ) -> Result<(Option<(u32, Gap)>, f64)> {
        let count = self.originals.len() as u32;
        let tasks = count.div_ceil(TRIANGLES);
        let (mut gap, mut undecided) = (None, 0.0);
        let mut worst: Vec<Seen> = Vec::new();
        for start in (0..tasks).step_by(GROUP) {
            progress.step("check the pieces", u64::from(start), u64::from(tasks))?;
            let group: Vec<_> = (start..tasks.min(start + GROUP as u32))
                .into_par_iter()
                .map(|i| {
                    let mut all = Found::default();
                    let (mut first, mut open, mut worst) = (None, 0.0, Vec::new());
                    for t in i * TRIANGLES..count.min((i + 1) * TRIANGLES) {
                        let mut own = Found::default();
                        let (wrong, area) = self.pieces_of(record, t, &mut own);
                        first = first.or(wrong.map(|wrong| (t, wrong)));
                        open += area;
                        all.add(&own);
                        worst.extend(own.worst);
                    }
                    worst_first(&mut worst);
                    (all, worst, first, open)
                })
                .collect();
            for (all, seen, first, open) in group {
                found.add(&all);
                worst.extend(seen);
                gap = gap.or(first);
                undecided += open;
            }
            worst_first(&mut worst);
        }
        let searched: Vec<Found> = worst
            .par_iter()
            .flat_map_iter(|&seen| {
                let corners = &self.viewpoints.corners;
                let sum = corners.iter().fold(DVec3::ZERO, |sum, &v| sum + v);
                let middle = sum / corners.len() as f64;
                [seen.viewpoint, middle].map(|viewpoint| Seen { viewpoint, ..seen })
            })
            .map(|start| self.search(record, start))
            .collect();
        for own in &searched {
            found.add(own);
        }
        let total: f64 = self.originals.iter().map(double_area).sum();
        let share = if total > 0.0 { undecided / total } else { 0.0 };
        Ok((gap, share.min(1.0)))
    }

    /// What is wrong with the cover of a triangle, and twice the area of its pieces without a proof.
    fn pieces_of(&self, record: &Record, triangle: u32, found: &mut Found) -> (Option<Gap>, f64) {
        let mut corners = Vec::new();
        let mut undecided = 0.0;
        for piece in record.of(triangle) {
            self.load(record, triangle, piece, &mut corners);
            for &[point, replacement] in &corners {
                for &viewpoint in &self.viewpoints.corners {
                    let seen = Seen {
                        tangent2: tangent2(point, replacement, viewpoint),
                        triangle,
                        piece,
                        point,
                        replacement,
                        viewpoint,
                    };
                    found.see(seen, self.limit2);
                }
            }
            let proven = !self.viewpoints.partial
                && interval::proves(&corners, &self.viewpoints.corners, self.limit2);
            if !proven {
                let area =
                    |i: usize| double_area(&[corners[0][0], corners[i - 1][0], corners[i][0]]);
                undecided += (2..corners.len()).map(area).sum::<f64>();
            }
        }
        (cover::check(record, triangle), undecided)
    }

    /// Looks for a larger angle from a sighting on: points and viewpoints move towards corners by smaller and smaller steps.
    fn search(&self, record: &Record, start: Seen) -> Found {
        let (mut found, mut corners) = (Found::default(), Vec::new());
        self.load(record, start.triangle, start.piece, &mut corners);
        for fan in 2..corners.len() {
            let three = [corners[0], corners[fan - 1], corners[fan]];
            let middle = [0, 1].map(|k| (three[0][k] + three[1][k] + three[2][k]) / 3.0);
            // Where the angle is largest for one viewpoint need not be where it is for the best one.
            for [point, replacement] in [[middle[0], middle[1]], three[0], three[1], three[2]] {
                let from = Seen {
                    tangent2: tangent2(point, replacement, start.viewpoint),
                    point,
                    replacement,
                    ..start
                };
                self.climb(three, from, &mut found);
            }
        }
        found
    }

    /// Moves point and viewpoint towards corners while that makes the angle larger, by smaller and smaller steps.
    fn climb(&self, three: [[DVec3; 2]; 3], mut here: Seen, found: &mut Found) {
        let mut step = 0.5;
        for _ in 0..48 {
            let before = here.tangent2;
            let mut attempt = |point, replacement, viewpoint, here: &mut Seen| {
                let seen = Seen {
                    tangent2: tangent2(point, replacement, viewpoint),
                    point,
                    replacement,
                    viewpoint,
                    ..*here
                };
                found.see(seen, self.limit2);
                if seen.tangent2 > here.tangent2 {
                    *here = seen;
                }
            };
            for [p, s] in three {
                let (point, replacement) =
                    (here.point.lerp(p, step), here.replacement.lerp(s, step));
                attempt(point, replacement, here.viewpoint, &mut here);
            }
            for &v in &self.viewpoints.corners {
                let viewpoint = here.viewpoint.lerp(v, step);
                attempt(here.point, here.replacement, viewpoint, &mut here);
            }
            if here.tangent2 <= before {
                step *= 0.6;
            }
        }
    }

    fn sample(&self, samples: u64, found: &mut Found, progress: &dyn Progress) -> Result<()> {
        let spread = Spread::new(&self.originals, samples);
        let facets = Facets::new(&self.targets);
        let chunks = spread.len().div_ceil(CHUNK);
        for start in (0..chunks).step_by(GROUP) {
            progress.step("sample angles", start, chunks)?;
            let group: Vec<Found> = (start..chunks.min(start + GROUP as u64))
                .into_par_iter()
                .map(|i| {
                    let mut own = Found::default();
                    let (mut k, mut near, mut corners) = (i * CHUNK, 0, Vec::new());
                    spread.visit(k..spread.len().min(k + CHUNK), |spot| {
                        match self.record {
                            Some(record) => self.follow(record, spot, k, &mut corners, &mut own),
                            None => near = self.look(&facets, spot, k, near, &mut own),
                        }
                        k += 1;
                    });
                    own
                })
                .collect();
            for own in &group {
                found.add(own);
            }
        }
        Ok(())
    }

    /// Viewpoints for sample `k`.
    fn viewpoints_of(&self, k: u64) -> impl Iterator<Item = DVec3> {
        let more = (0..VIEWPOINTS).map(move |i| self.viewpoints.viewpoint(k * VIEWPOINTS + i));
        self.viewpoints.corners.iter().copied().chain(more)
    }

    /// Measures a sample and what stands for it by the record.
    fn follow(
        &self,
        record: &Record,
        spot: Spot,
        k: u64,
        corners: &mut Vec<[DVec3; 2]>,
        found: &mut Found,
    ) {
        let [_, u, v] = spot.weights.map(|w| w * f64::from(ONE));
        let depth = |piece: u32| {
            let all = record.piece(piece).1;
            let n = all.len();
            (0..n).fold(f64::INFINITY, |least, i| {
                let [p, q] = [all[i], all[(i + 1) % n]].map(|w| [f64::from(w[0]), f64::from(w[1])]);
                let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
                least.min((dx * (v - p[1]) - dy * (u - p[0])) / (dx.abs() + dy.abs()).max(1.0))
            })
        };
        let mut best: Option<(f64, u32)> = None;
        for piece in record.of(spot.triangle) {
            let d = depth(piece);
            if best.is_none_or(|(most, _)| d > most) {
                best = Some((d, piece));
            }
            if d >= 0.0 {
                break;
            }
        }
        let Some((_, piece)) = best else { return };
        let (_, all) = record.piece(piece);
        self.load(record, spot.triangle, piece, corners);
        // The triangle from the first corner that holds the sample, or comes nearest to that.
        let mut inside: Option<(f64, usize, [f64; 3])> = None;
        for i in 2..all.len() {
            let [a, b, c] =
                [all[0], all[i - 1], all[i]].map(|w| [f64::from(w[0]), f64::from(w[1])]);
            let area = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
                (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
            };
            let x = [u, v];
            let w = [area(x, b, c), area(a, x, c), area(a, b, x)].map(|w| w.max(0.0));
            let sum = w[0] + w[1] + w[2];
            let excess = sum - area(a, b, c).max(0.0);
            if sum > 0.0 && inside.is_none_or(|(least, ..)| excess < least) {
                inside = Some((excess, i, w.map(|w| w / sum)));
            }
        }
        let Some((_, i, w)) = inside else { return };
        let three = [corners[0], corners[i - 1], corners[i]];
        let [point, replacement] =
            [0, 1].map(|k| three[0][k] * w[0] + three[1][k] * w[1] + three[2][k] * w[2]);
        for viewpoint in self.viewpoints_of(k) {
            let seen = Seen {
                tangent2: tangent2(point, replacement, viewpoint),
                triangle: spot.triangle,
                piece,
                point,
                replacement,
                viewpoint,
            };
            found.see(seen, self.limit2);
        }
    }

    /// Measures a sample against the point of the simplified surface that is nearest to it in angle.
    fn look(&self, facets: &Facets, spot: Spot, k: u64, near: u32, found: &mut Found) -> u32 {
        let point = spot.point(self.originals[spot.triangle as usize]);
        let (_, near) = facets.nearest(point, near, 0.0);
        let nearest = facets.facet(near).nearest_point(point);
        for viewpoint in self.viewpoints_of(k) {
            let mut replacement = nearest;
            if tangent2(point, nearest, viewpoint) > self.limit2 {
                replacement = facets.nearest_in_angle(viewpoint, point, nearest);
            }
            let seen = Seen {
                tangent2: tangent2(point, replacement, viewpoint),
                triangle: spot.triangle,
                piece: 0,
                point,
                replacement,
                viewpoint,
            };
            found.see(seen, self.limit2);
        }
        near
    }
}

fn double_area([a, b, c]: &[DVec3; 3]) -> f64 {
    length((*b - *a).cross(*c - *a))
}
