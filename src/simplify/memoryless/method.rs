//! The method: places and prices collapses, and estimates prices from the sums around vertices.

use super::{MemorylessOptions, propose, vertex_sums::Fans};
use crate::collapse::{
    Estimates, LiveMesh, Method, MethodScratch, Patch, Proposal, Refusal, Site, Tileable,
};

/// The memoryless method. By default it keeps no sums: every edge whose cost is wanted is evaluated in full.
#[derive(Clone, Debug, Default)]
pub struct Memoryless {
    options: MemorylessOptions,
    fans: Fans,
}

impl Memoryless {
    /// The method on a mesh, with sums around every vertex, so that the engine can estimate costs. O(n).
    pub fn new(live: &LiveMesh, options: MemorylessOptions) -> Self {
        Self {
            options,
            fans: Fans::of(live),
        }
    }
}

impl Method for Memoryless {
    fn estimates(&self) -> Option<&dyn Estimates> {
        Some(self)
    }

    fn propose(&self, site: &Site<'_>, _: &mut MethodScratch) -> Result<Proposal, Refusal> {
        propose(site, &self.options)
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        self.fans.follow(live, patch);
    }
}

impl Estimates for Memoryless {
    fn estimate(&self, live: &LiveMesh, edge: u32) -> Option<f64> {
        self.fans.estimate(live, edge, &self.options)
    }

    fn may_fall(&self, live: &LiveMesh, edge: u32) -> bool {
        self.fans.may_fall(live, edge)
    }
}

impl Tileable for Memoryless {
    fn part(&self, part: &LiveMesh, _: &[u32]) -> Box<dyn Tileable> {
        Box::new(Self::new(part, self.options))
    }

    fn unite(&mut self, _: &dyn Tileable, _: &[u32]) {}

    fn relinked(&mut self, live: &LiveMesh) {
        self.fans = Fans::of(live);
    }
}
