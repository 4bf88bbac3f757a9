//! The outcome of a run: more than a mesh. Falling short of a target is never silent.

use serde::Serialize;

use super::{NormalsReport, Options, Report, TangentsReport, WeightsReport};
use crate::{
    collapse::{Concession, Counters, History, Stop},
    mesh::Mesh,
};

/// One stretch of a run: pre-simplification and the method itself.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Phase {
    /// The method that ordered the collapses.
    pub method: &'static str,
    /// The rule that gave way because above the target no edge could collapse any more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub concession: Option<Concession>,
    /// Triangles before it.
    pub triangles_in: usize,
    /// Triangles after it.
    pub triangles_out: usize,
    /// Its evaluations and collapses.
    pub counters: Counters,
}

/// The result of a run: the mesh, how to rebuild any level of it, and why it is no smaller.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Outcome {
    /// The simplified mesh, in file units.
    pub mesh: Mesh,
    /// Every collapse, to rebuild any level in between.
    pub history: History,
    /// Why the run ended.
    pub stop: Stop,
    /// Number of vertices that the locks kept where they are, those of weight 1 among them; 0 without.
    pub locked_vertices: usize,
    /// The account of the weights, where some were given.
    pub weights: Option<WeightsReport>,
    /// The stretches of the run, in order.
    pub phases: Vec<Phase>,
    /// The options as they were used: nothing in them is left to a default.
    pub options: Options,
    /// The price of its normals in vertices, where they are not those that the collapses carried.
    pub normals: Option<NormalsReport>,
    /// The account of its tangents, where they are not those that the collapses carried.
    pub tangents: Option<TangentsReport>,
    /// The report of the method.
    pub report: Report,
}
