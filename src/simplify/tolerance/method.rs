//! The method: proposals that are certified.

use glam::DVec3;

use super::{
    super::memoryless::{Memoryless, Objective},
    Distance, Guarantee, ToleranceOptions,
};
use crate::{
    Error, Result,
    bound::{
        envelope::{Coverage, OriginalSurface, PieceQueue, Reach, Trial, WitnessChange},
        tolerance::{Neighborhood, OldFace, Quadratic, Volume},
    },
    collapse::{
        Estimates, LiveMesh, Method, MethodScratch, Patch, Plan, Proposal, Reason, Refusal, Review,
        Site, legality,
    },
    num::{Each, math},
};

/// Number of doublings of the local bound, in two steps each: it starts at 1/32 of the bound.
const DOUBLINGS: u32 = 5;
/// Half-space tests of volumes: a share of the diagonal.
const TOLERANCE: f64 = 1e-9;
/// Bounds beyond this many diagonals mean the same.
const FAR: f64 = 4.0;
/// Most faces around an edge that [`Coverage`] can tell apart when it has collapsed: two go, and count twice.
const STAR_LIMIT: usize = Coverage::FACES + 4;
/// Faces around an edge beyond which its work is limited: every collapse there changes that many stars. Collapses at
/// the rim make such a hub smaller.
const MANY: usize = 32;
/// Most original triangles times faces of such an edge.
const WORK: usize = 1 << 17;
/// Edges that are evaluated together. Part of the result's making, not of the result.
const AHEAD: usize = 32;

/// A new face would be too far from the faces before it.
const TOO_FAR_AT_ONCE: Refusal = Refusal::Method(&Reason::new(0, "local-bound", true));

/// A new face would be too far from the original.
const TOO_FAR: Refusal = Refusal::Method(&Reason::new(1, "strays", true));

/// A part of the original would be too far from the new mesh.
const UNCOVERED: Refusal = Refusal::Method(&Reason::new(2, "uncovers", true));

/// The method on an original.
#[derive(Clone, Debug)]
pub struct ToleranceMethod {
    options: ToleranceOptions,
    memoryless: Memoryless,
    surface: OriginalSurface,
    /// The faces near every triangle of the original; `None` where only the other direction counts.
    coverage: Option<Coverage>,
    diagonal: f64,
    reach: Reach,
    /// The bound of a single collapse against the faces before it; infinite for none.
    local: f64,
    guarantee: Guarantee,
    change: WitnessChange,
    own: Scratch,
}

/// Buffers of an evaluation.
#[derive(Clone, Debug, Default)]
struct Scratch {
    trial: Trial,
    pieces: PieceQueue,
    removed: Vec<u32>,
    added: Vec<u32>,
}

impl ToleranceMethod {
    /// The method on the original, `live`. O(n log n).
    ///
    /// # Errors
    /// [`Error::Usage`] where the bound is as small as the rounding of the coordinates.
    pub fn new(live: &LiveMesh, options: ToleranceOptions) -> Result<Self> {
        let triangles: Vec<[u32; 3]> = (0..live.triangle_ids())
            .map(|t| live.triangle(t).unwrap_or_default())
            .collect();
        let corners = (0..live.triangle_ids()).filter_map(|t| live.points(t));
        let points = || corners.clone().flatten();
        let low = points().reduce(DVec3::min).unwrap_or_default();
        let high = points().reduce(DVec3::max).unwrap_or_default();
        let diagonal = math::length(high - low);
        let frame = live.frame();
        let (length, wanted) = match options.error {
            Distance::OfDiagonal(share) => (share * diagonal, share),
            Distance::Length(length) => (frame.enter_length(length), length),
        };
        let largest = low.abs().max(high.abs()).max_element();
        let bound = length.min(FAR * diagonal);
        let reach = Reach::new(bound, largest).ok_or_else(|| {
            Error::Usage(format!(
                "the error {wanted:e} is a distance of {:e}, which is lost in the rounding of coordinates as large as {:e}; expected a larger one",
                frame.leave_length(length, 1),
                frame.leave_length(largest, 1),
            ))
        })?;
        Ok(Self {
            memoryless: Memoryless::new(live, options.placement),
            coverage: (!options.one_sided).then(|| Coverage::new(live.positions(), &triangles)),
            surface: OriginalSurface::new(corners),
            diagonal,
            reach,
            local: f64::INFINITY,
            guarantee: Guarantee {
                distance: frame.leave_length(bound, 1),
                of_diagonal: (diagonal > 0.0).then_some(bound / diagonal),
                two_sided: !options.one_sided,
            },
            change: WitnessChange::default(),
            own: Scratch::default(),
            options,
        })
    }

    /// The bound that holds for the mesh at any time.
    pub fn guarantee(&self) -> Guarantee {
        self.guarantee
    }

    /// The local bounds that a run goes through, in frame units; infinite is none. The last one is.
    pub fn local_bounds(&self) -> Vec<f64> {
        let mut bounds = Vec::new();
        if self.options.growing {
            let own = self.reach.length;
            for doublings in 0..DOUBLINGS {
                let bound = own / f64::from(1_u32 << (DOUBLINGS - doublings));
                bounds.extend([bound, bound * std::f64::consts::SQRT_2]);
            }
            bounds.push(own);
        }
        bounds.push(f64::INFINITY);
        bounds
    }

    /// Bounds every collapse by the faces before it: by `bound` in frame units.
    pub fn set_local_bound(&mut self, bound: f64) {
        self.local = bound;
    }

    /// Tests a position that the rules admit.
    fn certify(
        &self,
        site: &Site<'_>,
        position: DVec3,
        around: &mut Around,
        scratch: &mut Scratch,
    ) -> Result<(), Refusal> {
        let fan = || {
            let faces = site.star.faces.iter().filter(|f| f.survives);
            faces.map(|f| f.points_after(position))
        };
        let keeps = |a: &Neighborhood| a.keeps(position - a.origin(), self.local);
        if self.local < f64::INFINITY && !around.of(site).is_some_and(keeps) {
            return Err(TOO_FAR_AT_ONCE);
        }
        if !self.surface.reaches(position, self.reach) {
            return Err(TOO_FAR);
        }
        if self.coverage.is_some() && !scratch.trial.covers(fan(), self.reach) {
            return Err(UNCOVERED);
        }
        if !self.surface.holds(fan(), self.reach, &mut scratch.pieces) {
            return Err(TOO_FAR);
        }
        Ok(())
    }

    /// The place of least cost in the tolerance volume of a star without boundary.
    fn in_volume(&self, site: &Site<'_>, of: &Objective, around: &mut Around) -> Option<DVec3> {
        let source = self.options.volume?;
        if !site.star.boundary.is_empty() {
            return None;
        }
        let around = around.of(site)?;
        let bound = self.local.min(self.reach.length);
        let volume = Volume::new(around, bound, source, TOLERANCE * self.diagonal);
        let (matrix, linear) = of.quadratic();
        let place = volume.minimum(&Quadratic { matrix, linear })?;
        Some(place + around.origin())
    }
}

/// The neighbourhood of a star, made where it is asked for.
#[derive(Default)]
struct Around(Option<Option<Neighborhood>>);

impl Around {
    fn of(&mut self, site: &Site<'_>) -> Option<&Neighborhood> {
        let star = site.star;
        let faces = || {
            star.faces.iter().map(|f| OldFace {
                points: f.points,
                ends: [0, 1, 2].each(|k| f.at.contains(&k)),
            })
        };
        let around = || Neighborhood::new(star.midpoint(), faces());
        self.0.get_or_insert_with(around).as_ref()
    }
}

impl Method for ToleranceMethod {
    fn plan(&self) -> Plan {
        Plan {
            // A larger star than the certificate can tell apart would be refused after all the work.
            star_limit: if self.coverage.is_some() {
                STAR_LIMIT
            } else {
                legality::STAR_LIMIT
            },
            look_ahead: AHEAD,
            shared_batch: 2,
            ..Plan::default()
        }
    }

    fn estimates(&self) -> Option<&dyn Estimates> {
        self.memoryless.estimates()
    }

    fn propose(&self, site: &Site<'_>, scratch: &mut MethodScratch) -> Result<Proposal, Refusal> {
        let scratch = scratch.of(|_| Scratch::default());
        let objective = Objective::of(site.star, &self.options.placement);
        if let Some(coverage) = &self.coverage {
            scratch.removed.clear();
            scratch.removed.extend(site.star.faces.iter().map(|f| f.id));
            let faces = scratch.removed.len();
            if faces > MANY && faces * coverage.load(&scratch.removed) > WORK {
                return Err(Refusal::Valence);
            }
            let corners = |f| site.live.points(f);
            coverage.gather(&scratch.removed, corners, self.reach, &mut scratch.trial);
        }
        let mut around = Around::default();
        let attempt = |position, around: &mut Around, scratch: &mut Scratch| {
            let position = site.admit(position)?;
            self.certify(site, position.position(), around, scratch)?;
            Ok(Proposal {
                position,
                primary: 0,
                secondary: objective.cost(site.star, position.position()),
            })
        };
        if let Some(fixed) = site.fixed() {
            return attempt(fixed, &mut around, scratch);
        }
        // The reason of a refused edge is the last test that any place came to.
        let mut refusal = Refusal::Unplaced;
        if let Some(optimum) = objective.place().position {
            match attempt(optimum, &mut around, scratch) {
                Ok(proposal) => return Ok(proposal),
                Err(reason) => refusal = refusal.max(reason),
            }
        }
        let [u, w] = site.star.points;
        let mut others = [u, w, site.star.midpoint()].each(|p| (objective.cost(site.star, p), p));
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, place) in others {
            match attempt(place, &mut around, scratch) {
                Ok(proposal) => return Ok(proposal),
                Err(reason) => refusal = refusal.max(reason),
            }
        }
        if let Some(place) = self.in_volume(site, &objective, &mut around)
            && let Ok(proposal) = attempt(place, &mut around, scratch)
        {
            return Ok(proposal);
        }
        Err(refusal)
    }

    /// Another collapse may have changed a witness outside the star: the test is made again, and finds the witnesses.
    fn review(&mut self, live: &LiveMesh, patch: &Patch) -> Review {
        let Some(coverage) = &self.coverage else {
            return Review::Commit;
        };
        let own = &mut self.own;
        own.removed.clear();
        own.removed.extend(patch.removed.iter().map(|f| f.id));
        own.added.clear();
        own.added.extend(patch.added.iter().map(|f| f.id));
        let corners = |f| live.points(f);
        coverage.gather(&own.removed, corners, self.reach, &mut own.trial);
        let fan = patch.added.iter().map(|f| patch.after(live, f));
        let (removed, added, change) = (&own.removed, &own.added, &mut self.change);
        match own.trial.assign(removed, added, fan, self.reach, change) {
            true => Review::Commit,
            false => Review::Outdated,
        }
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        if let Some(coverage) = &mut self.coverage {
            coverage.apply(&self.change);
        }
        self.memoryless.committed(live, patch);
    }
}
