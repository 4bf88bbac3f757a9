//! Image-driven simplification: Lindstrom & Turk 2000, section 4.
//!
//! Edges collapse in the order of what their collapse does to the pictures: the cost is equation 8, the change of the
//! sum of squared luma differences over all views, as an exact integer that may be negative and is not clamped. The new
//! vertex is placed by the memoryless method (section 4.1), whose own cost is the second key: hidden edges all cost 0,
//! and it keeps hidden parts in shape. Evaluation is lazy as in section 4.2.2; the pictures follow every collapse as
//! in section 4.2.3.

mod change;
mod cost;
mod options;

pub use change::ImageChange;
pub use cost::ImageError;
pub use options::{EngineName, ImageOptions, Preset, Start};

use super::memoryless::{self, MemorylessOptions};
use crate::{
    collapse::{LiveMesh, Method, Patch, Proposal, Refusal, Site},
    raster::{Scene, Unrender},
    view::{Interpolation, ViewSet},
};

/// The method: pictures of the mesh as it is, and how far they are from those of the original.
#[derive(Debug)]
pub struct ImageDriven<E: Unrender> {
    error: ImageError<E>,
    slots: change::Slots,
    gouraud: bool,
    placement: MemorylessOptions,
    /// Largest sum of squared differences that a collapse may lead to.
    limit: Option<f64>,
    scratch: ImageScratch<E::Scratch>,
}

/// Buffers of one thread.
#[derive(Debug)]
pub struct ImageScratch<S> {
    engine: S,
    patch: Patch,
    change: ImageChange,
}

impl<E: Unrender> ImageDriven<E> {
    /// Prepares the pictures of `live` in the views of `set`, to be compared with those of `original` (in the same
    /// frame). `rms_limit` ends the run before the root mean square of the luma differences over all views exceeds it.
    #[must_use]
    pub fn new(
        original: &Scene,
        live: &LiveMesh,
        set: &ViewSet,
        placement: MemorylessOptions,
        rms_limit: Option<f64>,
    ) -> Self {
        let (slots, scene) = change::Slots::of(live);
        let error = ImageError::<E>::new(original, &scene, set);
        let scratch = ImageScratch {
            engine: error.scratch(),
            patch: Patch::default(),
            change: ImageChange::default(),
        };
        Self {
            gouraud: set
                .views
                .iter()
                .any(|v| v.shading.interpolation == Interpolation::Gouraud),
            limit: rms_limit.map(|rms| error.sum_of_rms(rms)),
            error,
            slots,
            placement,
            scratch,
        }
    }

    /// The pictures and their distance from the original's.
    #[must_use]
    pub fn error(&self) -> &ImageError<E> {
        &self.error
    }
}

impl<E: Unrender> Method for ImageDriven<E> {
    type Scratch = ImageScratch<E::Scratch>;

    fn scratch(&self) -> Self::Scratch {
        ImageScratch {
            engine: self.error.scratch(),
            patch: Patch::default(),
            change: ImageChange::default(),
        }
    }

    fn propose(&self, site: &Site<'_>, scratch: &mut Self::Scratch) -> Result<Proposal, Refusal> {
        let proposal = memoryless::propose(site, &self.placement)?;
        site.patch(proposal.position, &mut scratch.patch);
        scratch
            .change
            .fill(&self.slots, site.live, &scratch.patch, self.gouraud);
        let image = self
            .error
            .cost(&scratch.change.as_change(), &mut scratch.engine);
        Ok(Proposal { image, ..proposal })
    }

    fn within_limit(&mut self, live: &LiveMesh, patch: &Patch, _: &Proposal) -> bool {
        let Some(limit) = self.limit else { return true };
        // The proposal's cost may be stale: ask again.
        let ImageScratch { engine, change, .. } = &mut self.scratch;
        change.fill(&self.slots, live, patch, self.gouraud);
        let cost = self.error.cost(&change.as_change(), engine);
        (self.error.sum() as i64 + cost) as f64 <= limit
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        let ImageScratch { engine, change, .. } = &mut self.scratch;
        change.fill(&self.slots, live, patch, self.gouraud);
        self.error.commit(&change.as_change(), engine);
    }

    fn evaluations_per_task(&self) -> usize {
        16
    }
}
