//! Visibility-guided simplification: Zhang & Turk 2002, section 5.
//!
//! A vertex carries two quadrics. `Q`, that of [`quadric`](super::super::quadric), decides where the new vertex lies. `Q_v`,
//! in which the planes of a face and of its boundary edges count by the square of its visibility (equations 5.8 to
//! 5.10), decides which edge is next; it never places, because it is singular where nothing is seen. Both are sums
//! over the ends of an edge. Deviation: the cost is `Q_v + 1e-6 Q`. Where nothing is seen all `Q_v` are 0, and the
//! second term lets such parts keep their shape as long as possible, as under the method without visibility.
//! Weights belong to the triangles of the input; nothing is measured again during a run. Costs: as those of the
//! quadric method, in frame units.

use std::any::Any;

use serde::{Deserialize, Serialize};

use super::super::quadric::{QuadricMethod, QuadricOptions};
use crate::{
    Error, Result,
    collapse::{
        Estimates, Evaluation, LiveMesh, Method, MethodScratch, Patch, Plan, Proposal, Refusal,
        Review, Site, Tileable,
    },
    visibility,
};

/// How much `Q` counts beside `Q_v`: enough to order what nobody sees, and no more than a visibility of 0.001.
pub const TIE_WEIGHT: f64 = 1e-6;

/// Options of the method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct VisibilityOptions {
    /// The planes of faces and boundaries.
    pub quadric: QuadricOptions,
    /// How much the cost without visibility counts beside the cost with it; at least 0.
    pub tie_weight: f64,
    /// How the visibility of the input's triangles is measured, or was.
    pub measure: visibility::MeasureOptions,
}

impl Default for VisibilityOptions {
    fn default() -> Self {
        Self {
            quadric: QuadricOptions::default(),
            tie_weight: TIE_WEIGHT,
            measure: visibility::MeasureOptions::default(),
        }
    }
}

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
        if let Some((t, v)) = (0..)
            .zip(visibility)
            .find(|(_, v)| !(0.0..=1.0).contains(*v))
            .map(|(t, v): (usize, _)| (t, v))
        {
            return Err(Error::Usage(format!(
                "the visibility of triangle {t} is {v}; expected a number from 0 to 1"
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
    #[must_use]
    pub fn placing(&self) -> &QuadricMethod {
        &self.placing
    }

    /// `Q_v`: which edge is next.
    #[must_use]
    pub fn ordering(&self) -> &QuadricMethod {
        &self.ordering
    }
}

impl Method for VisibilityMethod {
    fn plan(&self) -> Plan {
        Plan::default()
    }

    fn estimates(&self) -> Option<&dyn Estimates> {
        Some(self)
    }

    fn propose(
        &self,
        site: &Site<'_>,
        how: Evaluation,
        scratch: &mut MethodScratch,
    ) -> Result<Proposal, Refusal> {
        let placed = self.placing.propose(site, how, scratch)?;
        let [u, w] = site.star.ends;
        let seen = self.ordering.quadric(u).plus(self.ordering.quadric(w));
        Ok(Proposal {
            secondary: seen.error(placed.position.position()) + self.tie_weight * placed.secondary,
            ..placed
        })
    }

    fn review(&mut self, _: &LiveMesh, _: &Patch, _: &Proposal) -> Review {
        Review::Commit
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
