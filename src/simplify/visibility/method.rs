//! The method: two quadrics per vertex, one to place and one to order.

use std::any::Any;

use super::{super::quadric::QuadricMethod, VisibilityOptions};
use crate::{
    Error, Result,
    collapse::{
        Estimates, LiveMesh, Method, MethodScratch, Patch, Proposal, Refusal, Site, Tileable,
    },
};

/// The method: two quadrics per vertex.
#[derive(Clone, Debug)]
pub struct VisibilityMethod {
    placing: QuadricMethod,
    ordering: QuadricMethod,
    tie_weight: f64,
}

impl VisibilityMethod {
    /// The quadrics of a mesh whose triangle `t` has the visibility `visibility[t]`, in [0, 1]. O(n).
    ///
    /// # Errors
    /// [`Error::Usage`] unless there is one visibility for every triangle, each in [0, 1].
    pub fn new(live: &LiveMesh, options: &VisibilityOptions, visibility: &[f64]) -> Result<Self> {
        if visibility.len() != live.triangle_ids() as usize {
            return Err(Error::Usage(format!(
                "{} visibilities for {} triangles; expected as many",
                visibility.len(),
                live.triangle_ids()
            )));
        }
        if let Some(t) = visibility.iter().position(|v| !(0.0..=1.0).contains(v)) {
            return Err(Error::Usage(format!(
                "the visibility of triangle {t} is {}; expected a number from 0 to 1",
                visibility[t]
            )));
        }
        Ok(Self {
            placing: QuadricMethod::new(live, &options.quadric),
            ordering: QuadricMethod::weighted(live, &options.quadric, |t| {
                visibility[t as usize] * visibility[t as usize]
            }),
            tie_weight: options.tie_weight,
        })
    }

    /// `Q`: where new vertices lie.
    pub fn placing(&self) -> &QuadricMethod {
        &self.placing
    }

    /// `Q_v`: which edge is next.
    pub fn ordering(&self) -> &QuadricMethod {
        &self.ordering
    }
}

impl Method for VisibilityMethod {
    fn estimates(&self) -> Option<&dyn Estimates> {
        Some(self)
    }

    fn propose(&self, site: &Site<'_>, scratch: &mut MethodScratch) -> Result<Proposal, Refusal> {
        let placed = self.placing.propose(site, scratch)?;
        let [u, w] = site.star.ends;
        let seen = self.ordering.quadric(u).plus(self.ordering.quadric(w));
        Ok(Proposal {
            secondary: seen.error(placed.position.position()) + self.tie_weight * placed.secondary,
            ..placed
        })
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        self.placing.committed(live, patch);
        self.ordering.committed(live, patch);
    }
}

impl Estimates for VisibilityMethod {
    fn estimate(&self, live: &LiveMesh, edge: u32) -> Option<f64> {
        let [u, w] = live.edge(edge)?;
        let sum = self.placing.quadric(u).plus(self.placing.quadric(w));
        let seen = self.ordering.quadric(u).plus(self.ordering.quadric(w));
        let place = sum.place([live.position(u), live.position(w)]);
        Some(seen.error(place) + self.tie_weight * sum.error(place))
    }

    fn may_fall(&self, _: &LiveMesh, _: u32) -> bool {
        true
    }
}

impl Tileable for VisibilityMethod {
    fn part(&self, _: &LiveMesh, vertices: &[u32]) -> Box<dyn Tileable> {
        Box::new(Self {
            placing: self.placing.part_of(vertices),
            ordering: self.ordering.part_of(vertices),
            tie_weight: self.tie_weight,
        })
    }

    fn unite(&mut self, part: &dyn Tileable, vertices: &[u32]) {
        let part: &dyn Any = part;
        if let Some(part) = part.downcast_ref::<Self>() {
            self.placing.take_back(&part.placing, vertices);
            self.ordering.take_back(&part.ordering, vertices);
        }
    }

    fn relinked(&mut self, live: &LiveMesh) {
        self.placing.relinked(live);
        self.ordering.relinked(live);
    }
}
