//! The method: places and prices collapses, and estimates prices from the sums around vertices.

use super::{MemorylessOptions, Objective, vertex_sums::Fans};
use crate::collapse::{
    Admitted, Estimates, LiveMesh, Method, MethodScratch, Patch, Proposal, Refusal, Site, Tileable,
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

/// Places and prices the collapse of a site; also the placement and second key of the image-driven method.
///
/// # Errors
/// The rule that forbids it.
pub fn propose(site: &Site<'_>, options: &MemorylessOptions) -> Result<Proposal, Refusal> {
    let objective = Objective::of(site.star, options);
    let position = match site.fixed() {
        Some(position) => site.admit(position)?,
        None => {
            let optimum = objective.place().position.ok_or(Refusal::Unplaced);
            match optimum.and_then(|position| site.admit(position)) {
                Ok(position) => position,
                Err(_) => best_of_three(site, &objective)?,
            }
        }
    };
    Ok(Proposal {
        position,
        primary: 0,
        secondary: objective.cost(site.star, position.position()),
    })
}

/// The cheapest admitted position of midpoint and ends, the earlier on a tie.
fn best_of_three(site: &Site<'_>, objective: &Objective) -> Result<Admitted, Refusal> {
    let mut best = None;
    let mut refusal = Refusal::Unplaced;
    for candidate in [
        site.star.midpoint(),
        site.star.points[0],
        site.star.points[1],
    ] {
        match site.admit(candidate) {
            Ok(admitted) => {
                let cost = objective.cost(site.star, admitted.position());
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, admitted));
                }
            }
            Err(reason) => refusal = reason,
        }
    }
    best.map(|(_, admitted)| admitted).ok_or(refusal)
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
