//! Checks the claim that no viewer in a cell sees a point of the original and what stands for it under more than an
//! angle.
//!
//! Replacements are read from a [`Record`], and three things are checked: that the pieces of every original
//! triangle leave nothing of it out, in whole numbers; for every piece the largest angle for all its points and all
//! viewpoints, from below and above, as near as it takes to know the largest one of all to a five-hundredth and
//! whether it is above the claim; and, as a check of that, the angle at points spread over the original, from every
//! corner of the cell and from viewpoints all over it.
//! Without a record only a weaker property can be checked: that every original point has *some* point of the simplified
//! surface within the angle ([`Property::NearestInAngle`]). Endless cells are looked from within at least four sizes of
//! the original around the foot of its centre; beyond, displacements are bounded by their lengths. An angle breaks a
//! claim where it is larger by a hundred-millionth or 1e-10 radians. Meshes that are far from the origin for their size
//! are seen from nearby, so that this is above rounding for them too. The same result for any number of threads.

use glam::DVec3;
use serde::Serialize;

use super::{
    angle_tally::{AngleTally, FrameSighting},
    gaps::Gap,
    nearest::Facets,
    piece_bounds::PieceBounds,
    record::{ONE, Record},
    samples::{Sample, Samples},
    viewpoints::{Viewpoints, angle, tangent2},
};
use crate::{
    Error, Progress, Result,
    bound::view_cell::ViewCell,
    mesh::Mesh,
    num::{
        Each, Frame,
        math::{atan2, cos, length, sin, sqrt},
    },
    parallel,
};

/// Samples of a task, and tasks between two reports.
const CHUNK: u64 = 4_096;
const GROUP: usize = 256;
/// Beyond rounding: of the tangent, and in radians.
const SLACK: [f64; 2] = [1e-8, 1e-10];
/// Viewpoints for each sample, beside the corners of the cell.
const VIEWPOINTS: u64 = 2;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The property that was checked.
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
    /// Its replacement.
    pub replacement: [f64; 3],
    /// The place of the viewer.
    pub viewpoint: [f64; 3],
    /// The angle between the two, in degrees.
    pub angle_deg: f64,
}

/// The result of [`angles`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AngleReport {
    /// The claim in degrees.
    pub claimed_deg: f64,
    /// The property that was checked.
    pub property: Property,
    /// Pairs of a point and a viewpoint that were measured.
    pub sightings: u64,
    /// Number of them that are seen under more than the claim.
    pub violations: u64,
    /// The largest angle: with a record, the largest one of all up to a five-hundredth where `at_most_deg` says so.
    pub worst: Option<Sighting>,
    /// Number of pieces; `None` without a record.
    pub pieces: Option<usize>,
    /// The first original triangle that its pieces do not cover, and why.
    pub gap: Option<(u32, Gap)>,
    /// No viewer sees any point and what stands for it under more than this many degrees: proven. `None` without a
    /// record, and where no angle below 90 degrees is.
    pub at_most_deg: Option<f64>,
    /// The share of the area for which the claim is not proven, in [0, 1]; 1 without a record.
    pub undecided_area: f64,
    /// The cell has no end, and viewpoints that were left out may break the claim.
    pub part_of_cell: bool,
    /// Nothing was found that breaks the claim.
    pub holds: bool,
    /// The claim holds for every point, those of faces without area too, and every viewpoint of the cell.
    pub proven: bool,
}

/// Holds a simplified mesh to a claimed angle (degrees) for the viewers in `cell`, with about `samples` points spread
/// over the original, which is in canonical order where there is a record.
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
    let (frame, shift) = frame_near(low, high);
    let check = AngleCheck {
        originals: corners_of(original, frame, shift),
        targets: corners_of(simplified, frame, shift),
        viewpoints: Viewpoints::new(
            &cell.enter_frame(frame).relative_to(shift),
            ((frame.enter(low) - shift) + (frame.enter(high) - shift)) * 0.5,
            length((frame.enter(high) - shift) - (frame.enter(low) - shift)),
        ),
        limit2: tangent_limit(degrees) * tangent_limit(degrees),
        record,
    };
    check.require_numbers()?;
    let mut tally = AngleTally::default();
    let bounds = match record {
        Some(record) => Some(check.piece_bounds(record, &mut tally, progress)?),
        None => None,
    };
    check.sample(samples, &mut tally, progress)?;
    Ok(check.report(degrees, &tally, bounds.as_ref(), |p| {
        frame.leave(p + shift).to_array()
    }))
}

/// Sizes of the original from the origin on which it is far away.
const FAR: f64 = 512.0;
/// Largest coordinate of a mesh or cell, in sizes of the original.
const LARGEST: f64 = 1e60;

/// A frame for a box, and a point of that frame which positions are taken relative to: the box's corner where it is far
/// from the origin for its size, which rounds nothing (coordinates are alike in all but the last bits).
fn frame_near(low: DVec3, high: DVec3) -> (Frame, DVec3) {
    let coarse = Frame::for_size(low.abs().max(high.abs()).max_element());
    let size = length(coarse.enter(high) - coarse.enter(low));
    if size > 0.0 && FAR * size < 1.0 {
        let exponent = coarse.exponent + Frame::for_size(size).exponent;
        let frame = Frame { exponent };
        (frame, frame.enter(low))
    } else {
        (coarse, DVec3::ZERO)
    }
}

/// The triangles of a mesh in units of `frame`, relative to `shift`.
fn corners_of(mesh: &Mesh, frame: Frame, shift: DVec3) -> Vec<[DVec3; 3]> {
    let all = 0..mesh.triangles().len();
    all.map(|t| mesh.corners(t).map(|p| frame.enter(p) - shift))
        .collect()
}

/// The tangent up to which an angle keeps the claim.
fn tangent_limit(degrees: f64) -> f64 {
    let limit = degrees * DEGREE;
    sin(limit) / cos(limit) * (1.0 + SLACK[0]) + SLACK[1]
}

/// A claim and the surfaces and viewpoints that it is about, in frame units.
pub(super) struct AngleCheck<'a> {
    pub(super) originals: Vec<[DVec3; 3]>,
    pub(super) targets: Vec<[DVec3; 3]>,
    pub(super) viewpoints: Viewpoints,
    /// Square of the tangent that is claimed.
    pub(super) limit2: f64,
    record: Option<&'a Record>,
}

impl AngleCheck<'_> {
    /// Refuses coordinates of which the squares of squares are no numbers.
    fn require_numbers(&self) -> Result<()> {
        let mut all = self
            .targets
            .iter()
            .flatten()
            .chain(&self.viewpoints.corners);
        if all.all(|p| p.abs().max_element() <= LARGEST) {
            return Ok(());
        }
        Err(Error::input(
            "-",
            "the simplified mesh or the cell is 10^60 times as large or as far away as the original; check the units of all",
        ))
    }

    /// The report of what was measured and bounded; `leave` takes a position to file units.
    fn report(
        &self,
        claimed_deg: f64,
        tally: &AngleTally,
        bounds: Option<&PieceBounds>,
        leave: impl Fn(DVec3) -> [f64; 3],
    ) -> AngleReport {
        let gap = bounds.and_then(|b| b.gap);
        let within = tally.worst.is_none_or(|w| w.tangent2 <= self.limit2);
        AngleReport {
            claimed_deg,
            property: match self.record {
                Some(_) => Property::Correspondence,
                None => Property::NearestInAngle,
            },
            sightings: tally.sightings,
            violations: tally.violations,
            worst: tally.worst.map(|w| Sighting {
                triangle: w.triangle,
                point: leave(w.point),
                replacement: leave(w.replacement),
                viewpoint: leave(w.viewpoint),
                angle_deg: angle(w.point, w.replacement, w.viewpoint) / DEGREE,
            }),
            pieces: self.record.map(Record::piece_count),
            gap,
            at_most_deg: bounds
                .filter(|b| b.at_most2.is_finite())
                .map(|b| atan2(sqrt(b.at_most2), 1.0) / DEGREE),
            undecided_area: bounds.map_or(1.0, |b| b.undecided),
            part_of_cell: bounds.map_or(self.viewpoints.end.is_some(), |b| b.partial),
            holds: within && gap.is_none(),
            proven: within
                && gap.is_none()
                && bounds.is_some_and(|b| !b.partial && b.at_most2 <= self.limit2),
        }
    }

    fn sample(&self, samples: u64, found: &mut AngleTally, progress: &dyn Progress) -> Result<()> {
        let plan = Samples::new(&self.originals, samples);
        let facets = Facets::new(&self.targets);
        let chunks = plan.len().div_ceil(CHUNK);
        for start in (0..chunks).step_by(GROUP) {
            progress.step("sample angles", start, chunks)?;
            let group = parallel::map((chunks - start).min(GROUP as u64) as usize, |i| {
                let mut own = AngleTally::default();
                let (mut k, mut near, mut corners) = ((start + i as u64) * CHUNK, 0, Vec::new());
                plan.visit(k..plan.len().min(k + CHUNK), &mut |sample| {
                    match self.record {
                        Some(record) => self.follow(record, sample, k, &mut corners, &mut own),
                        None => near = self.look(&facets, sample, k, near, &mut own),
                    }
                    k += 1;
                });
                own
            });
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
        sample: Sample,
        k: u64,
        corners: &mut Vec<[DVec3; 2]>,
        found: &mut AngleTally,
    ) {
        let [_, u, v] = sample.weights.map(|w| w * f64::from(ONE));
        let depth = |piece: u32| {
            let all = record.piece(piece).1;
            let n = all.len();
            (0..n).fold(f64::INFINITY, |least, i| {
                let [p, q] =
                    [all[i], all[(i + 1) % n]].each(|w| [f64::from(w[0]), f64::from(w[1])]);
                let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
                least.min((dx * (v - p[1]) - dy * (u - p[0])) / (dx.abs() + dy.abs()).max(1.0))
            })
        };
        let mut best: Option<(f64, u32)> = None;
        for piece in record.of(sample.triangle) {
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
        self.load(record, sample.triangle, piece, corners);
        // The triangle from the first corner that holds the sample, or comes nearest to that.
        let mut inside: Option<(f64, usize, [f64; 3])> = None;
        for i in 2..all.len() {
            let [a, b, c] =
                [all[0], all[i - 1], all[i]].each(|w| [f64::from(w[0]), f64::from(w[1])]);
            let area = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
                (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
            };
            let x = [u, v];
            let w = [area(x, b, c), area(a, x, c), area(a, b, x)].each(|w| w.max(0.0));
            let sum = w[0] + w[1] + w[2];
            let excess = sum - area(a, b, c).max(0.0);
            if sum > 0.0 && inside.is_none_or(|(least, ..)| excess < least) {
                inside = Some((excess, i, w.each(|w| w / sum)));
            }
        }
        let Some((_, i, w)) = inside else { return };
        let three = [corners[0], corners[i - 1], corners[i]];
        let [point, replacement] =
            [0, 1].each(|k| three[0][k] * w[0] + three[1][k] * w[1] + three[2][k] * w[2]);
        for viewpoint in self.viewpoints_of(k) {
            let seen = FrameSighting::new(sample.triangle, point, replacement, viewpoint);
            found.see(seen, self.limit2);
        }
    }

    /// Measures a sample against the point of the simplified surface that is nearest to it in angle.
    fn look(
        &self,
        facets: &Facets,
        sample: Sample,
        k: u64,
        near: u32,
        found: &mut AngleTally,
    ) -> u32 {
        let point = sample.point(self.originals[sample.triangle as usize]);
        let (_, near) = facets.nearest(point, near, 0.0);
        let nearest = facets.facet(near).nearest_point(point);
        for viewpoint in self.viewpoints_of(k) {
            let mut replacement = nearest;
            if tangent2(point, nearest, viewpoint) > self.limit2 {
                replacement = facets.nearest_in_angle(viewpoint, point, nearest);
            }
            let seen = FrameSighting::new(sample.triangle, point, replacement, viewpoint);
            found.see(seen, self.limit2);
        }
        near
    }
}
