//! Checks the claim that two surfaces are nowhere farther apart than a distance.
//!
//! By samples: points spread over each surface, along its edges, and its vertices, each with its distance to the other
//! surface. And by proof: every triangle is cut until it is certain that it lies within the distance, or a point of it
//! does not ([`super::distance_bound`]). A claim is broken only by a point that was measured; where neither holds, the
//! report says what part of the surface is undecided, and the distance that is proven. Distances are Euclidean,
//! computed in a frame scaled to the reference; a measured distance breaks a claim where it is larger by a billionth
//! and by 2e-10 of the reference's diagonal, far above rounding. The same result for any number of threads.

use glam::DVec3;
use serde::Serialize;

use super::{
    distance_bound,
    nearest::{Facets, double_area},
    samples::{Sample, Samples},
};
use crate::{
    Error, Progress, Result,
    mesh::Mesh,
    num::{
        Frame,
        math::{length, sqrt},
    },
    parallel,
};

/// Points of a task.
const CHUNK: u64 = 4_096;
/// Triangles of a task that proves.
const TRIANGLES: usize = 16;
/// Tasks between two looks at the progress.
const GROUP: usize = 256;
/// Beyond rounding: relative to the claim, and relative to the diagonal.
const SLACK: [f64; 2] = [1e-9, 2e-10];

/// A claimed distance between two surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Claim {
    /// As a fraction of the reference's bounding-box diagonal.
    Relative(f64),
    /// In file units.
    Absolute(f64),
}

/// A point whose distance was measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Witness {
    /// The triangle it lies on, by its index in its file.
    pub triangle: u32,
    /// The point in file units.
    pub point: [f64; 3],
    /// Its distance to the other surface in file units.
    pub distance: f64,
}

/// The distances measured and proven from one surface to the other.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Direction {
    /// The surface whose points were measured: `reference` or `simplified`.
    pub from: &'static str,
    /// Points measured, those of the proof not counted.
    pub samples: u64,
    /// Number of them that are farther away than claimed.
    pub violations: u64,
    /// The point with the largest distance; the first of equals.
    pub farthest: Witness,
    /// No point is farther away than this, in file units: proven.
    #[serde(rename = "proven")]
    pub upper_bound: f64,
    /// The share of the area for which the claim is not proven, in [0, 1].
    pub undecided_area: f64,
    /// The claim holds as far as anybody knows: no point breaks it.
    pub holds: bool,
    /// The claim holds for every point, those of faces without area too.
    pub is_proven: bool,
}

/// The result of [`distance`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DistanceReport {
    /// The claim in file units.
    pub claimed: f64,
    /// Diagonal of the reference's bounding box in file units.
    pub diagonal: f64,
    /// First from the simplified mesh to the reference, then, unless the claim is one-sided, the other way.
    pub directions: Vec<Direction>,
    /// No point was found that breaks the claim.
    pub holds: bool,
    /// The claim is proven for every point.
    pub proven: bool,
}

/// Holds two meshes to a claimed distance: of every point of `simplified` to `reference` and, unless `one_sided`, of
/// every point of `reference` to `simplified`, with `samples` points spread over each.
///
/// Time: some 10^7 samples a second and core where the claim holds with a margin.
///
/// # Errors
/// [`Error::Usage`] for a claim that is negative or not finite; [`Error::Input`] where a mesh has no triangles or the
/// sizes of the two differ by more than 2^200; [`Error::Interrupted`].
pub fn distance(
    reference: &Mesh,
    simplified: &Mesh,
    claim: Claim,
    one_sided: bool,
    samples: u64,
    progress: &dyn Progress,
) -> Result<DistanceReport> {
    let (Claim::Relative(value) | Claim::Absolute(value)) = claim;
    if !(value >= 0.0 && value.is_finite()) {
        return Err(Error::Usage(format!(
            "the claimed error is {value}; expected a number that is not negative"
        )));
    }
    let (low, high) = reference.bounds().ok_or_else(|| empty("reference"))?;
    simplified.bounds().ok_or_else(|| empty("simplified"))?;
    let coarse = Frame::for_size(low.abs().max(high.abs()).max_element());
    let size = length(coarse.enter(high) - coarse.enter(low));
    let frame = Frame {
        exponent: coarse.exponent + Frame::for_size(size).exponent,
    };
    let diagonal = length(frame.enter(high) - frame.enter(low));
    let claim = match claim {
        Claim::Relative(share) => share * diagonal,
        Claim::Absolute(length) => frame.enter_length(length),
    };
    let surfaces = [reference, simplified].map(|mesh| FramedSurface::new(mesh, frame));
    if !surfaces.iter().all(|s| s.is_within(1e60)) {
        return Err(Error::input(
            "-",
            "the simplified mesh is 10^60 times as large as the reference; check the units of both",
        ));
    }
    let most = claim * (1.0 + SLACK[0]) + SLACK[1] * diagonal.max(f64::MIN_POSITIVE);
    let check = |from: usize| {
        let name = ["reference", "simplified"][from];
        let plan = DistanceCheck {
            from: &surfaces[from],
            to: &surfaces[1 - from],
            most,
        };
        plan.run(name, frame, samples, progress)
    };
    let mut directions = vec![check(1)?];
    if !one_sided {
        directions.push(check(0)?);
    }
    Ok(DistanceReport {
        claimed: frame.leave_length(claim, 1),
        diagonal: frame.leave_length(diagonal, 1),
        holds: directions.iter().all(|d| d.holds),
        proven: directions.iter().all(|d| d.is_proven),
        directions,
    })
}

fn empty(which: &str) -> Error {
    Error::input(
        "-",
        format!("the {which} mesh has no triangles; expected at least one"),
    )
}

/// A mesh in frame units.
struct FramedSurface {
    corners: Vec<[DVec3; 3]>,
    facets: Facets,
}

impl FramedSurface {
    fn new(mesh: &Mesh, frame: Frame) -> Self {
        let place = |v: &u32| frame.enter(mesh.positions()[*v as usize]);
        let corners: Vec<_> = mesh
            .triangles()
            .iter()
            .map(|t| [place(&t[0]), place(&t[1]), place(&t[2])])
            .collect();
        Self {
            facets: Facets::new(&corners),
            corners,
        }
    }

    fn is_within(&self, reach: f64) -> bool {
        let mut all = self.corners.iter().flatten();
        all.all(|p| p.abs().max_element() <= reach)
    }
}

/// The largest squared distance so far.
#[derive(Clone, Copy)]
struct Worst {
    squared: f64,
    triangle: u32,
    point: DVec3,
}

impl Worst {
    const NONE: Self = Self {
        squared: -1.0,
        triangle: 0,
        point: DVec3::ZERO,
    };

    fn take(&mut self, other: Self) {
        if other.squared > self.squared {
            *self = other;
        }
    }
}

struct DistanceCheck<'a> {
    from: &'a FramedSurface,
    to: &'a FramedSurface,
    /// The claim with its slack.
    most: f64,
}

impl DistanceCheck<'_> {
    fn run(
        &self,
        name: &'static str,
        frame: Frame,
        samples: u64,
        progress: &dyn Progress,
    ) -> Result<Direction> {
        let mut worst = Worst::NONE;
        let plan = Samples::new(&self.from.corners, samples);
        let violations = self.sample(name, &plan, &mut worst, progress)?;
        let (at_most, undecided) = self.prove(name, &mut worst, progress)?;
        let total: f64 = self.from.corners.iter().copied().map(double_area).sum();
        let farthest = sqrt(worst.squared);
        let share = if total > 0.0 { undecided / total } else { 0.0 };
        Ok(Direction {
            from: name,
            samples: plan.len(),
            violations,
            farthest: Witness {
                triangle: worst.triangle,
                point: frame.leave(worst.point).to_array(),
                distance: frame.leave_length(farthest, 1),
            },
            upper_bound: frame.leave_length(at_most.max(farthest), 1),
            undecided_area: share.min(1.0),
            holds: farthest <= self.most,
            is_proven: at_most.max(farthest) <= self.most,
        })
    }

    /// Measures all points; how many are too far away.
    fn sample(
        &self,
        name: &str,
        plan: &Samples,
        worst: &mut Worst,
        progress: &dyn Progress,
    ) -> Result<u64> {
        let chunks = plan.len().div_ceil(CHUNK);
        let limit = self.most * self.most;
        let mut violations = 0;
        for start in (0..chunks).step_by(GROUP) {
            progress.step(&format!("sample the {name} mesh"), start, chunks)?;
            // Points nearer than the farthest one known, which does not break the claim, tell nothing.
            let known = worst.squared.min(limit);
            let in_group = (chunks - start).min(GROUP as u64) as usize;
            let group = parallel::map(in_group, |i| {
                self.sample_chunk(plan, start + i as u64, known)
            });
            for (other, count) in group {
                worst.take(other);
                violations += count;
            }
        }
        Ok(violations)
    }

    fn sample_chunk(&self, plan: &Samples, chunk: u64, known: f64) -> (Worst, u64) {
        let limit = self.most * self.most;
        let (mut worst, mut count, mut near) = (Worst::NONE, 0, 0);
        let mut enough = known;
        plan.visit(
            chunk * CHUNK..plan.len().min((chunk + 1) * CHUNK),
            &mut |sample: Sample| {
                let point = sample.point(self.from.corners[sample.triangle as usize]);
                let squared;
                (squared, near) = self.to.facets.nearest(point, near, enough);
                count += u64::from(squared > limit);
                if squared > enough || worst.squared < 0.0 {
                    worst.take(Worst {
                        squared,
                        triangle: sample.triangle,
                        point,
                    });
                    enough = enough.max(squared.min(limit));
                }
            },
        );
        (worst, count)
    }

    /// Proves what can be proven: the distance that no point exceeds, and twice the area that is undecided.
    fn prove(&self, name: &str, worst: &mut Worst, progress: &dyn Progress) -> Result<(f64, f64)> {
        let tasks = self.from.corners.len().div_ceil(TRIANGLES);
        let (mut at_most, mut undecided) = (0.0_f64, 0.0);
        for start in (0..tasks).step_by(GROUP) {
            progress.step(
                &format!("prove the {name} mesh"),
                start as u64,
                tasks as u64,
            )?;
            let group: Vec<Vec<_>> = parallel::map((tasks - start).min(GROUP), |i| {
                let first = (start + i) * TRIANGLES;
                let last = self.from.corners.len().min(first + TRIANGLES);
                let mut near = 0;
                let settle = |&corners| {
                    let finding = distance_bound::settle(&self.to.facets, corners, self.most, near);
                    near = finding.near;
                    finding
                };
                self.from.corners[first..last].iter().map(settle).collect()
            });
            for (finding, triangle) in group
                .into_iter()
                .flatten()
                .zip((start * TRIANGLES) as u32..)
            {
                at_most = at_most.max(finding.at_most);
                undecided += finding.undecided;
                worst.take(Worst {
                    squared: finding.largest * finding.largest,
                    triangle,
                    point: finding.point,
                });
            }
        }
        Ok((at_most, undecided))
    }
}
