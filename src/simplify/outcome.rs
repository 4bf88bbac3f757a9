//! What a run gives back: more than a mesh. Falling short of a target is never silent.

use serde::Serialize;

use super::{Comparison, Options, image::PolishCounters, tolerance::Guarantee};
use crate::{
    bound::correspondence::Correspondence,
    collapse::{Counters, History, Stop},
    mesh::Mesh,
};

/// One stretch of a run: pre-simplification and the method itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Phase {
    /// What ordered the collapses.
    pub method: &'static str,
    /// Triangles before it.
    pub triangles_in: usize,
    /// Triangles after it.
    pub triangles_out: usize,
    /// What it did.
    pub counters: Counters,
}

/// The result of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The simplified mesh, in file units.
    pub mesh: Mesh,
    /// Every collapse, to rebuild any level in between.
    pub history: History,
    /// Why the run ended.
    pub stop: Stop,
    /// What the run did, in order.
    pub phases: Vec<Phase>,
    /// What the polishing did, where there was any.
    pub polish: Option<PolishCounters>,
    /// The options as they were used: nothing in them is left to a default.
    pub options: Options,
    /// V(M), the visibility of the input in [0, 1]; only for the method that is guided by it.
    pub v_mesh: Option<f64>,
    /// What became of every point of the input, by triangles of the input and of `mesh`; only for methods that keep
    /// account of it.
    pub correspondence: Option<Correspondence>,
    /// Root mean square of the luma differences over the driving views, in levels; only for methods that look at
    /// images. Never a measure of quality: the run has minimised it.
    pub error_rms: Option<f64>,
    /// How the image-driven method compares with the memoryless one, where they were close.
    pub comparison: Option<Comparison>,
    /// What is proved about the distance from the original; only for the method that keeps one.
    pub guarantee: Option<Guarantee>,
}
