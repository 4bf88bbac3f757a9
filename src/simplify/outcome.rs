//! What a run gives back: more than a mesh. Falling short of a target is never silent.

use serde::Serialize;

use crate::{
    collapse::{Counters, History, Refusals},
    mesh::Mesh,
};

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "reason")]
pub enum Stop {
    /// There are no more triangles than wanted.
    TargetReached,
    /// The next collapse would exceed the error that is allowed.
    ErrorLimit,
    /// No edge may be collapsed any more.
    NoLegalCollapse {
        /// How many of the edges that are left each rule blocks.
        refusals: Refusals,
    },
    /// The input already had no more triangles than wanted; it is returned as it is.
    TargetAboveInput,
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
    /// What the run did.
    pub counters: Counters,
}
