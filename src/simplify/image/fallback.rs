//! Images may not do worse than geometry.
//!
//! The image-driven method orders collapses and moves vertices by pictures of some size. Where those cannot resolve what
//! a mesh still has (many triangles left on a smooth surface, differences below one level of luma), it fits their noise,
//! and the memoryless method, which knows nothing of noise, looks better. So both results are compared in views that
//! drove neither, [`HeldOut`], and the memoryless one is returned where images did not pay, or hardly: with the very bits that its
//! own run has. To be sure of a case that is plainly better costs little: the memoryless method only continues from the
//! mesh that images started from, which is as good as its own result within a few percent.

use serde::Serialize;

use super::{
    super::{Amount, MethodOptions, Options, Outcome},
    HeldOut,
};
use crate::{Result, collapse::Rules, mesh::Mesh, metric::luma::SquaredError};

/// Images pay where they leave less than this share of the RMS: views differ by about as much (0.974 in these views was
/// 1.014 in those of `lodmark compare` for Gouraud pictures of a torus of 4,608 triangles). Where no picture can tell the
/// results apart, geometry decides.
const PAYS: f64 = 0.97;

/// And where geometry leaves at least so many levels: luma is rounded to whole ones, and less than this is its noise.
const RESOLVED: f64 = 0.25;

/// Up to this share of what the quick continuation leaves, the memoryless method itself is run: it can be better.
const PLAIN: f64 = 0.92;

/// As [`RESOLVED`], for the quick continuation.
const PLAINLY_RESOLVED: f64 = 2.0 * RESOLVED;

/// What images and geometry made of one target, by root mean square of the luma differences in views that drove neither.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Comparison {
    /// Of the image-driven result, in levels.
    pub image: f64,
    /// Of the memoryless method's, in levels.
    pub memoryless: f64,
    /// Whether the latter was returned.
    pub fell_back: bool,
}

/// What the comparison needs of an image-driven run.
#[derive(Debug)]
pub(in super::super) struct Contest {
    pub(in super::super) held_out: HeldOut,
    /// The mesh that images started from, in file units.
    pub(in super::super) start: Mesh,
}

impl Contest {
    /// The better one of `images`, a result for `mesh`, and what `run` makes of a mesh by the memoryless method.
    pub(in super::super) fn decide(
        &self,
        mesh: &Mesh,
        images: Outcome,
        run: impl Fn(&Mesh, &Options) -> Result<Outcome>,
    ) -> Result<Outcome> {
        if images.history.is_empty() {
            return Ok(images);
        }
        let ours = self.held_out.error(&images.mesh)?;
        let triangles = images.options.target.triangles(mesh.triangles().len())?;
        let options = memoryless(&images.options, Amount::Triangles(triangles as u64));
        let quick = run(&self.start, &options)?;
        let others = self.held_out.error(&quick.mesh)?;
        if below(ours, others, PLAIN) && others.rms() >= PLAINLY_RESOLVED {
            return Ok(images);
        }
        let rival = run(mesh, &options)?;
        let theirs = self.held_out.error(&rival.mesh)?;
        // One that stopped above the target is no rival for one that reached it.
        let as_small = rival.mesh.triangles().len() <= images.mesh.triangles().len().max(triangles);
        let pays = below(ours, theirs, PAYS) && theirs.rms() >= RESOLVED;
        let fell_back = as_small && !pays;
        let comparison = Comparison {
            image: ours.rms(),
            memoryless: theirs.rms(),
            fell_back,
        };
        let mut outcome = images;
        if fell_back {
            outcome.mesh = rival.mesh;
            outcome.history = rival.history;
            outcome.stop = rival.stop;
            outcome.phases = rival.phases;
            // They describe a mesh that is not returned.
            outcome.polish = None;
            outcome.error_rms = None;
        }
        outcome.comparison = Some(comparison);
        Ok(outcome)
    }
}

/// True where `ours` is below this `share` of `theirs`, both as RMS.
fn below(ours: SquaredError, theirs: SquaredError, share: f64) -> bool {
    ours.rms() < share * theirs.rms()
}

/// The memoryless method as its own defaults have it, to `target` and within the topology of `images`.
fn memoryless(images: &Options, target: Amount) -> Options {
    let mut options = Options::memoryless(target);
    options.rules = Rules {
        topology: images.rules.topology,
        ..options.rules
    };
    if let MethodOptions::Image(own) = &images.method {
        options.method = MethodOptions::Memoryless(own.placement);
    }
    options
}
