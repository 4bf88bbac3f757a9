//! The method: the order and places of the memoryless method, and the account of where every point went.

use glam::DVec3;

use super::{
    super::{
        memoryless::{self, Memoryless, MemorylessOptions, Objective},
        methods::MethodRun,
    },
    ViewBoundedOptions,
};
use crate::{
    Error, Progress, Result,
    bound::correspondence::{
        AngleLimit, Answer, Collapse, Correspondence, Face, Layout, PieceScratch,
    },
    collapse::{
        Admitted, Estimates, LiveMesh, Method, MethodScratch, Patch, PatchFace, Plan, Proposal,
        Reason, Refusal, Site,
    },
    geometry::Box3,
    num::Each,
};

/// The order and places of [`Memoryless`], and the account of where every point went.
#[derive(Debug)]
pub struct ViewBounded {
    placing: Memoryless,
    placement: MemorylessOptions,
    limit: AngleLimit,
    map: Correspondence,
    /// Origin of the map's positions, in frame units.
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
    pieces: PieceScratch,
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
            .map(|t| live.points(t).unwrap_or([origin; 3]).each(|p| p - origin))
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
    pub fn correspondence(&self) -> &Correspondence {
        &self.map
    }

    /// The map onto the mesh that `live` becomes: file units, faces numbered as in [`LiveMesh::to_mesh`].
    ///
    /// # Errors
    /// [`Error::Internal`] where a collapse was committed that was never allowed.
    pub(in super::super) fn into_correspondence(self, live: &LiveMesh) -> Result<Correspondence> {
        if self.lost {
            let told = "a collapse was committed that has no map";
            return Err(Error::Internal(told.into()));
        }
        let ids = (0..live.triangle_ids()).filter(|&t| live.triangle(t).is_some());
        let (frame, origin) = (live.frame(), self.origin);
        let units = |p| frame.leave(p + origin);
        Ok(self
            .map
            .renumbered(ids, units, |x| frame.leave_length(x, 1)))
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
const NO_MAP: Refusal = Refusal::Method(&Reason::new(0, "unmapped", false));

/// A point would be farther from its replacement than is allowed.
const BOUND_EXCEEDED: Refusal = Refusal::Method(&Reason::new(1, "bound", true));

/// Most faces around an edge that may collapse, its own counted at both ends: every piece of the map in them is cut along all of them.
const STAR_LIMIT: usize = 64;

/// Least coordinates along the axes along which a mesh is this many sizes away from the origin; 0 along others.
/// Differences of coordinates that are alike in their leading bits are exact.
const FAR: f64 = 512.0;

fn origin(live: &LiveMesh) -> DVec3 {
    let points = (0..live.triangle_ids()).filter_map(|t| live.points(t));
    let Some(Box3 { low, high }) = Box3::of(points.flatten()) else {
        return DVec3::ZERO;
    };
    let size = (high - low).max_element();
    let along = |axis: usize| {
        let (low, high) = (low[axis], high[axis]);
        let far = low.abs().min(high.abs()) > FAR * size && (low < 0.0) == (high < 0.0);
        if far { low } else { 0.0 }
    };
    DVec3::new(along(0), along(1), along(2))
}

/// The fan of a patch relative to `origin`, before or after it is committed.
fn lay_out(
    live: &LiveMesh,
    patch: &Patch,
    origin: DVec3,
    removed: &mut Vec<Face>,
    added: &mut Vec<Face>,
) -> Option<Layout> {
    let (moved, gone) = (patch.moved?, patch.gone?);
    let face = |f: &PatchFace, points: [DVec3; 3]| Face {
        id: f.id,
        corners: f.corners,
        points: points.each(|p| p - origin),
    };
    removed.clear();
    removed.extend(patch.removed.iter().map(|f| face(f, patch.before(live, f))));
    added.clear();
    added.extend(patch.added.iter().map(|f| face(f, patch.after(live, f))));
    Layout::new(&Collapse {
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

    fn propose(&self, site: &Site<'_>, scratch: &mut MethodScratch) -> Result<Proposal, Refusal> {
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
            let proposal = Proposal {
                position,
                primary: 0,
                secondary: cost,
            };
            match self.bounded(site, position, buffers) {
                Ok(()) => return Ok(proposal),
                Err(reason) => refusal = reason,
            }
        }
        Err(refusal)
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
