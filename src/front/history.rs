//! Any level of a recorded run.

use crate::{
    Result, Silent,
    collapse::{History, Replay},
    mesh::Mesh,
    simplify::normals::settle_level,
};

impl History {
    /// Rebuilds the mesh at the level of at most `triangles` triangles from the mesh that the run began with.
    ///
    /// The same bytes as a run that stopped there, but for what follows the last collapse and where that run needs fewer
    /// concessions (`Topology::Auto` settles them for the target). O(collapses), and
    /// O(n log n) for its normals.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) where the history belongs to another mesh.
    pub fn level(&self, original: &Mesh, triangles: usize) -> Result<Mesh> {
        let mut replay = Replay::new(original, self)?;
        replay.seek(triangles)?;
        let level = replay.live().to_mesh()?;
        match replay.applied() {
            0 => Ok(level),
            _ => settle_level(original, level, self, &Silent),
        }
    }
}
