//! Watching a run: history, charts, tests.

use glam::DVec3;

use super::{LiveMesh, Patch, Proposal};

/// Watches a run.
pub trait Observer {
    /// The collapse that was proposed so is committed next.
    fn chosen(&mut self, proposal: &Proposal) {
        let _ = proposal;
    }

    /// A patch was committed; `live` already has it.
    fn committed(&mut self, live: &LiveMesh, patch: &Patch);

    /// The edge between `keep` and `gone` was collapsed to `to` (frame units) while the mesh was in tiles: its patch
    /// is not known. Only for meshes without attributes.
    fn collapsed_in_tile(&mut self, live: &LiveMesh, keep: u32, gone: u32, to: DVec3) {
        let _ = (live, keep, gone, to);
    }
}

/// Watches nothing.
impl Observer for () {
    fn committed(&mut self, _: &LiveMesh, _: &Patch) {}
}
