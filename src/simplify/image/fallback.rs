//! The fallback: images may not do worse than geometry.
//!
//! The image-driven method orders collapses and moves vertices by pictures of some size. Where those cannot resolve
//! the details that a mesh still has (many triangles left on a smooth surface, differences below one level of luma), it
//! fits their noise, and the memoryless method, which knows nothing of noise, looks better. So both results are compared
//! in views that drove neither, [`HeldOutViews`], and the memoryless one is returned where images did not pay, or hardly:
//! with the very bits that its own run has. To be sure of a case that is plainly better costs little: the memoryless
//! method only continues from the mesh that images started from, which is as good as its own result within a few
//! percent.

use serde::Serialize;

use super::{
    super::{Normals, Options, Outcome, Report, Tangents, Target, Weights, run::simplify_in_pool},
    HeldOutViews, ImageOptions, ImageReport,
};
use crate::{Progress, Result, mesh::Mesh, metric::luma::SquaredError};

/// Images pay where they leave less than this share of the RMS: views differ by about as much (0.974 in these views was
/// 1.014 in those of `lodmark compare` for Gouraud pictures of a torus of 4,608 triangles). Where no picture can tell the
/// results apart, geometry decides.
const PAYS: f64 = 0.97;

/// And where geometry leaves at least this many levels: luma is rounded to whole ones, and smaller differences are
/// rounding noise.
const RESOLVED: f64 = 0.25;

/// Up to this share of the error that the quick continuation leaves, the memoryless method itself is run: it can be better.
const PLAIN: f64 = 0.92;

/// As [`RESOLVED`], for the quick continuation.
const PLAINLY_RESOLVED: f64 = 2.0 * RESOLVED;

/// The errors of images and geometry for one target: root mean square of the luma differences in views that drove neither.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Comparison {
    /// Error of the image-driven result, in levels.
    pub image: f64,
    /// Error of the memoryless method's result, in levels.
    pub memoryless: f64,
    /// Whether the latter was returned.
    pub fell_back: bool,
}

/// The parts of an image-driven run that the comparison needs.
#[derive(Debug)]
pub(super) struct Contest<'a> {
    pub(super) own: &'a ImageOptions,
    pub(super) held_out: HeldOutViews,
    /// The input, in file units.
    pub(super) mesh: &'a Mesh,
    /// The options of the run, with what gave way from its start.
    pub(super) options: Options,
    /// The mesh that images started from, in file units.
    pub(super) start: Mesh,
    /// The weights of its vertices, where there are some.
    pub(super) start_weights: Option<Weights>,
}

impl Contest<'_> {
    /// The better one of `images` and the result of the memoryless method for as many triangles.
    ///
    /// # Errors
    /// As [`simplify_with`](crate::simplify::simplify_with).
    pub(super) fn decide(
        &self,
        images: Outcome,
        triangles: usize,
        progress: &dyn Progress,
    ) -> Result<Outcome> {
        if images.history.is_empty() {
            return Ok(images);
        }
        let ours = self.held_out.error(&images.mesh)?;
        let options = self.memoryless(triangles);
        let mut plain = options.clone().normals(Normals::Carry);
        plain.tangents = Tangents::Carry;
        plain.weights.clone_from(&self.start_weights);
        let quick = simplify_in_pool(&self.start, &plain, progress)?;
        let others = self.held_out.error(&quick.mesh)?;
        if below(ours, others, PLAIN) && others.rms() >= PLAINLY_RESOLVED {
            return Ok(images);
        }
        let rival = simplify_in_pool(self.mesh, &options, progress)?;
        let theirs = self.held_out.error(&rival.mesh)?;
        // One that stopped above the target is no rival for one that reached it.
        let as_small = rival.mesh.triangles().len() <= images.mesh.triangles().len().max(triangles);
        let pays = below(ours, theirs, PAYS) && theirs.rms() >= RESOLVED;
        let fell_back = as_small && !pays;
        let comparison = Some(Comparison {
            image: ours.rms(),
            memoryless: theirs.rms(),
            fell_back,
        });
        if fell_back {
            // The rest of the report describes a mesh that is not returned.
            let report = ImageReport {
                comparison,
                ..ImageReport::default()
            };
            return Ok(Outcome {
                options: images.options,
                report: Report::Image(report),
                ..rival
            });
        }
        let mut images = images;
        if let Report::Image(report) = &mut images.report {
            report.comparison = comparison;
        }
        Ok(images)
    }

    /// The memoryless method as its own defaults have it, with the topology, the concessions, the locks, the weights, the
    /// normals and the tangents of the run.
    fn memoryless(&self, triangles: usize) -> Options {
        let target = Target::triangles(triangles as u64);
        let mut options = Options::new(self.own.placement, target)
            .topology(self.options.rules.topology)
            .normals(self.options.normals)
            .tangents(self.options.tangents);
        options.rules.concession = self.options.rules.concession;
        options.rules.drop_pieces = self.options.rules.drop_pieces;
        options.locks = self.options.locks;
        options.weights.clone_from(&self.options.weights);
        options.per_mesh = self.options.per_mesh;
        options.settled = true;
        options
    }
}

/// True where `ours` is below this `share` of `theirs`, both as RMS.
fn below(ours: SquaredError, theirs: SquaredError, share: f64) -> bool {
    ours.rms() < share * theirs.rms()
}
