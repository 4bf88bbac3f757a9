//! View-bounded simplification: no point of the original surface is seen under a larger angle from what stands for it
//! than allowed, by any viewer in a cell (after Eisemann & Décoret 2007; notes, 4.9).
//!
//! Collapses come in the order of the memoryless method and are placed by it; where its place is refused, the midpoint and
//! the ends are tried, the cheapest first. Legal is what keeps every point within the angle of where its whole history
//! has put it, exactly and not by adding up steps: see [`Correspondence`]. Deviation from the notes: not a sum of
//! displacements but the displacement itself decides, and beside its length its direction (see [`AngleLimit`]).
//! A mesh that is far from the origin for its size is moved there first, exactly, so that the rounding of large
//! coordinates has no part in what is decided. The bound is on positions; texture coordinates are carried along as by every other method. Angles: degrees in options,
//! radians inside.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::super::memoryless::{self, Memoryless, MemorylessOptions, Objective};
use crate::{
    Error, Progress, Result,
    bound::{
        correspondence::{AngleLimit, Answer, Collapse, Correspondence, Face, Fan, Scratch},
        view_cell::ViewCell,
    },
    collapse::{
        Admitted, Estimates, Evaluation, LiveMesh, Method, MethodScratch, Patch, PatchFace, Plan,
        Proposal, Reason, Refusal, Review, Site,
    },
};

/// Options of the method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ViewBoundedOptions {
    /// The viewpoints, in the units of the mesh.
    pub cell: ViewCell,
    /// Largest angle between an original point and what stands for it, in degrees; from 0 to below 90.
    pub error_deg: f64,
    /// Where new vertices are wanted.
    pub placement: MemorylessOptions,
}

impl ViewBoundedOptions {
    /// The bound `error_deg` (degrees) for the viewers in `cell` (units of the mesh), with default placement.
    #[must_use]
    pub fn new(cell: ViewCell, error_deg: f64) -> Self {
        Self {
            cell,
            error_deg,
            placement: MemorylessOptions::default(),
        }
    }

    pub(in super::super) fn check(&self) -> Result<()> {
        if !(0.0..90.0).contains(&self.error_deg) {
            return Err(Error::Usage(format!(
                "the angle is {} degrees; expected at least 0 and less than 90",
                self.error_deg
            )));
        }
        if !(0.0..=1.0).contains(&self.placement.volume_weight) {
            return Err(Error::Usage(format!(
                "volume-weight is {}; expected a number from 0 to 1",
                self.placement.volume_weight
            )));
        }
        Ok(())
    }
}

/// The method: the order and places of [`Memoryless`], and an account of what became of every point.
#[derive(Debug)]
pub struct ViewBounded {
    placing: Memoryless,
    placement: MemorylessOptions,
    limit: AngleLimit,
    map: Correspondence,
    /// What the map's positions are relative to, in frame units.
    origin: DVec3,
    scratch: Buffers,
    /// A collapse was committed without a map: the account is worthless.
    lost: bool,
}

/// Buffers of an evaluation.
#[derive(Debug, Default)]
struct Buffers {
    patch: Patch,
    removed: Vec<Face>,
    added: Vec<Face>,
    pieces: Scratch,
}

impl ViewBounded {
    /// The method on a mesh. O(n).
    ///
    /// # Errors
    /// [`Error::Usage`] for an angle out of range, [`Error::Interrupted`].
    pub fn new(
        live: &LiveMesh,
        options: &ViewBoundedOptions,
        progress: &dyn Progress,
    ) -> Result<Self> {
        options.check()?;
        let origin = origin(live);
        let originals: Vec<[DVec3; 3]> = (0..live.triangle_ids())
            .map(|t| live.points(t).unwrap_or([origin; 3]).map(|p| p - origin))
            .collect();
        progress.step("measure the way to the cell", 0, 0)?;
        let cell = options.cell.enter_frame(live.frame());
        let cell = cell.relative_to(origin);
        let angle = options.error_deg * (std::f64::consts::PI / 180.0);
        let limit = AngleLimit::new(&originals, &cell, angle);
        let alive = |t| live.triangle(t).is_some();
        Ok(Self {
            placing: Memoryless::new(live, options.placement),
            placement: options.placement,
            map: Correspondence::new(originals, alive),
            limit,
            origin,
            scratch: Buffers::default(),
            lost: false,
        })
    }

    /// The map so far: frame units from the method's own origin, faces by their live ids.
    #[must_use]
    pub fn correspondence(&self) -> &Correspondence {
        &self.map
    }

    /// The map onto the mesh that `live` becomes: file units, faces numbered as in [`LiveMesh::to_mesh`].
    ///
    /// # Errors
    /// [`Error::Internal`] where a collapse was committed that was never allowed.
    pub(in super::super) fn into_correspondence(self, live: &LiveMesh) -> Result<Correspondence> {
        if self.lost {
            return Err(Error::Internal(
                "a collapse was committed that has no map".into(),
            ));
        }
        let ids: Vec<u32> = (0..live.triangle_ids())
            .filter(|&t| live.triangle(t).is_some())
            .collect();
        let (frame, origin) = (live.frame(), self.origin);
        Ok(self.map.renumbered(
            &ids,
            |p| frame.leave(p + origin),
            |x| frame.leave_length(x, 1),
        ))
    }

    /// Whether the collapse to an admitted place keeps every point within the limit.
    fn bounded(&self, site: &Site<'_>, to: Admitted, buffers: &mut Buffers) -> Result<(), Refusal> {
        let Buffers {
            patch,
            removed,
            added,
            pieces,
        } = buffers;
        site.patch(to, patch);
        let fan = lay_out(site.live, patch, self.origin, removed, added).ok_or(NO_MAP)?;
        match self.map.allows(&fan, &self.limit, pieces) {
            Answer::Allowed => Ok(()),
            Answer::Denied => Err(BOUND_EXCEEDED),
            Answer::Tangled => Err(NO_MAP),
        }
    }
}

/// The faces before cannot be mapped onto the faces after: no disc, or folded.
const NO_MAP: Refusal = Refusal::Method(&Reason {
    index: 0,
    name: "unmapped",
    is_bound: false,
});

/// A point would be farther from what stands for it than is allowed.
const BOUND_EXCEEDED: Refusal = Refusal::Method(&Reason {
    index: 1,
    name: "bound",
    is_bound: true,
});

/// Most faces around an edge that may collapse, its own counted at both ends: every piece of the map in them is cut along all of them.
const STAR_LIMIT: usize = 64;

/// Least coordinates along the axes along which a mesh is this many sizes away from the origin; 0 along others.
/// Differences of coordinates that are alike in all but so many bits are exact.
const FAR: f64 = 512.0;

fn origin(live: &LiveMesh) -> DVec3 {
    let points = (0..live.triangle_ids()).filter_map(|t| live.points(t));
    let bounds = points
        .flatten()
        .fold(None, |bounds: Option<(DVec3, DVec3)>, p| {
            Some(bounds.map_or((p, p), |(low, high)| (low.min(p), high.max(p))))
        });
    let Some((low, high)) = bounds else {
        return DVec3::ZERO;
    };
    let size = (high - low).max_element();
    let along = |low: f64, high: f64| {
        if low.abs().min(high.abs()) > FAR * size && (low < 0.0) == (high < 0.0) {
            low
        } else {
            0.0
        }
    };
    DVec3::new(
        along(low.x, high.x),
        along(low.y, high.y),
        along(low.z, high.z),
    )
}

/// The fan of a patch relative to `origin`, before or after it is committed.
fn lay_out(
    live: &LiveMesh,
    patch: &Patch,
    origin: DVec3,
    removed: &mut Vec<Face>,
    added: &mut Vec<Face>,
) -> Option<Fan> {
    let (moved, gone) = (patch.moved?, patch.gone?);
    let face = |f: &PatchFace, points: [DVec3; 3]| Face {
        id: f.id,
        corners: f.corners,
        points: points.map(|p| p - origin),
    };
    removed.clear();
    removed.extend(patch.removed.iter().map(|f| face(f, patch.before(live, f))));
    added.clear();
    added.extend(patch.added.iter().map(|f| face(f, patch.after(live, f))));
    Fan::new(&Collapse {
        removed,
        added,
        keep: moved.vertex,
        gone,
        to: moved.to - origin,
    })
}

impl Method for ViewBounded {
    fn plan(&self) -> Plan {
        Plan {
            star_limit: STAR_LIMIT,
            ..Plan::default()
        }
    }

    fn estimates(&self) -> Option<&dyn Estimates> {
        self.placing.estimates()
    }

    fn propose(
        &self,
        site: &Site<'_>,
        _: Evaluation,
        scratch: &mut MethodScratch,
    ) -> Result<Proposal, Refusal> {
        let buffers = scratch.of(|_| Buffers::default());
        let wanted = memoryless::propose(site, &self.placement)?;
        let mut refusal = match self.bounded(site, wanted.position, buffers) {
            Ok(()) => return Ok(wanted),
            Err(refusal) => refusal,
        };
        let objective = Objective::of(site.star, &self.placement);
        let [u, w] = site.star.points;
        let mut others: Vec<(f64, Admitted)> = [site.star.midpoint(), u, w]
            .into_iter()
            .filter_map(|place| site.admit(place).ok())
            .filter(|place| place.position() != wanted.position.position())
            .map(|place| (objective.cost(site.star, place.position()), place))
            .collect();
        others.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (cost, position) in others {
            match self.bounded(site, position, buffers) {
                Ok(()) => {
                    return Ok(Proposal {
                        position,
                        primary: 0,
                        secondary: cost,
                    });
                }
                Err(reason) => refusal = reason,
            }
        }
        Err(refusal)
    }

    fn review(&mut self, _: &LiveMesh, _: &Patch, _: &Proposal) -> Review {
        Review::Commit
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        self.placing.committed(live, patch);
        let Buffers {
            removed,
            added,
            pieces,
            ..
        } = &mut self.scratch;
        let applied = lay_out(live, patch, self.origin, removed, added)
            .is_some_and(|fan| self.map.apply(&fan, pieces));
        self.lost |= !applied;
    }
}
