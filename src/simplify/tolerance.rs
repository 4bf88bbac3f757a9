//! Simplification within a distance of the original, after Cox & Chibelushi 2005.
//!
//! A collapse is made only where the certificate of [`envelope`] holds: every point of the new faces is within the bound of
//! the original, and (unless one-sided) every point of the original within the bound of the new mesh. Positions are
//! proposed by Lindstrom & Turk's constraints first, then the ends and the middle of the edge. Costs are those of the memoryless method, in frame units; the bound is in frame units too.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::memoryless::{Memoryless, MemorylessOptions, Objective};
use crate::{
    Error, Result,
    bound::envelope::{Change, Coverage, Pieces, Reach, Surface, Trial},
    collapse::{LiveMesh, Method, Patch, Proposal, Refusal, Site},
    num::math,
};

/// The largest distance between the result and the original.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Distance {
    /// As a fraction of the diagonal of the original's bounding box.
    OfDiagonal(f64),
    /// In file units.
    Length(f64),
}

/// Options of the method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ToleranceOptions {
    /// The bound.
    pub error: Distance,
    /// Bound only the distance from the result to the original, not that from the original to the result.
    pub one_sided: bool,
    /// What places vertices and orders collapses.
    pub placement: MemorylessOptions,
}

impl ToleranceOptions {
    /// Both directions, with the defaults of the memoryless method.
    #[must_use]
    pub fn new(error: Distance) -> Self {
        Self {
            error,
            one_sided: false,
            placement: MemorylessOptions::default(),
        }
    }

    /// Tests every option that has a range.
    ///
    /// # Errors
    /// [`Error::Usage`] that names the option, its value and the range.
    pub fn check(&self) -> Result<()> {
        let (Distance::OfDiagonal(error) | Distance::Length(error)) = self.error;
        if error > 0.0 && error < f64::INFINITY {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "the error {error} is no distance; expected a number above 0, for example --error 0.005"
        )))
    }
}

/// The method.
#[derive(Clone, Debug)]
pub struct ToleranceMethod {
    options: ToleranceOptions,
    memoryless: Memoryless,
    surface: Surface,
    coverage: Option<Coverage>,
    reach: Reach,
    change: Change,
    own: Scratch,
}

/// Buffers of an evaluation.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    trial: Trial,
    pieces: Pieces,
    removed: Vec<u32>,
    fan: Vec<[DVec3; 3]>,
    ids: Vec<u32>,
}

impl ToleranceMethod {
    /// The method on the original. O(n log n).
    ///
    /// # Errors
    /// [`Error::Usage`] where the bound is not positive, or too small for the rounding of doubles.
    pub fn new(live: &LiveMesh, options: ToleranceOptions) -> Result<Self> {
        let triangles: Vec<[u32; 3]> = (0..live.triangle_ids())
            .map(|t| live.triangle(t).unwrap_or([0; 3]))
            .collect();
        let used = || triangles.iter().filter(|t| t[0] != t[1]).flatten();
        let point = |&v: &u32| live.position(v);
        let low = used().map(point).reduce(DVec3::min).unwrap_or_default();
        let high = used().map(point).reduce(DVec3::max).unwrap_or_default();
        let length = match options.error {
            Distance::OfDiagonal(share) => share * math::length(high - low),
            Distance::Length(length) => live.frame().enter_length(length),
        };
        let largest = low.abs().max(high.abs()).max_element();
        let reach = Reach::new(length, largest).ok_or_else(|| {
            Error::Usage("error bound".into())
        })?;
        let corners = (0..live.triangle_ids()).filter_map(|t| live.points(t));
        Ok(Self {
            options,
            memoryless: Memoryless::new(live, options.placement),
            surface: Surface::new(corners),
            coverage: (!options.one_sided).then(|| Coverage::new(live.positions(), &triangles)),
            reach,
            change: Change::default(),
            own: Scratch::default(),
        })
    }

    fn certify(&self, site: &Site<'_>, position: DVec3, scratch: &mut Scratch) -> bool {
        let fan = || {
            let faces = site.ring.faces.iter().filter(|f| f.survives);
            faces.map(|f| f.points_after(position))
        };
        if !self.surface.reaches(position, self.reach) {
            return false;
        }
        if self.coverage.is_some() && !scratch.trial.covers(fan(), self.reach) {
            return false;
        }
        self.surface.holds(fan(), self.reach, &mut scratch.pieces)
    }
}

impl Method for ToleranceMethod {
    type Scratch = Scratch;

    fn scratch(&self) -> Scratch {
        Scratch::default()
    }

    fn propose(&self, site: &Site<'_>, scratch: &mut Scratch) -> Result<Proposal, Refusal> {
        let objective = Objective::of(site.ring, &self.options.placement);
        if let Some(coverage) = &self.coverage {
            scratch.removed.clear();
            scratch.removed.extend(site.ring.faces.iter().map(|f| f.id));
            let corners = |f| site.live.points(f);
            coverage.gather(&scratch.removed, corners, self.reach, &mut scratch.trial);
        }
        let mut refusal = Refusal::Unplaced;
        let mut attempt = |position: DVec3, scratch: &mut Scratch| -> Option<Proposal> {
            match site.admit(position) {
                Ok(admitted) => {
                    if self.certify(site, admitted.position(), scratch) {
                        return Some(Proposal {
                            position: admitted,
                            image: 0,
                            geometric: objective.cost(site.ring, admitted.position()),
                        });
                    }
                    refusal = refusal.max(Refusal::Method);
                }
                Err(reason) => refusal = refusal.max(reason),
            }
            None
        };
        if let Some(fixed) = site.fixed() {
            return attempt(fixed, scratch).ok_or(refusal);
        }
        if let Some(optimum) = objective.place().position
            && let Some(proposal) = attempt(optimum, scratch)
        {
            return Ok(proposal);
        }
        let [u, w] = site.ring.points;
        let mut others = [u, w, site.ring.midpoint()].map(|p| (objective.cost(site.ring, p), p));
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, p) in others {
            if let Some(proposal) = attempt(p, scratch) {
                return Ok(proposal);
            }
        }
        Err(refusal)
    }

    fn estimate(&self, live: &LiveMesh, edge: u32) -> Option<f64> {
        self.memoryless.estimate(live, edge)
    }

    fn may_fall(&self, live: &LiveMesh, edge: u32) -> bool {
        self.memoryless.may_fall(live, edge)
    }

    fn confirm(&mut self, live: &LiveMesh, patch: &Patch, _: &Proposal) -> bool {
        let Some(coverage) = &self.coverage else {
            return true;
        };
        let own = &mut self.own;
        own.removed.clear();
        own.removed.extend(patch.removed.iter().map(|f| f.id));
        own.ids.clear();
        own.ids.extend(patch.added.iter().map(|f| f.id));
        coverage.gather(&own.removed, |f| live.points(f), self.reach, &mut own.trial);
        let fan = patch.added.iter().map(|f| patch.after(live, f));
        own.trial.assign(&own.removed, &own.ids, fan, self.reach, &mut self.change)
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        if let Some(coverage) = &mut self.coverage {
            coverage.apply(&self.change);
        }
        self.memoryless.committed(live, patch);
    }

    fn looks_ahead(&self) -> usize {
        32
    }

    fn shared_batch(&self) -> usize {
        2
    }
}
