//! The pictures that drive a run, and what a patch of the mesh does to them.

use super::{
    EngineName, ImageError, Reference,
    scene_edit::{ImageChange, Slots},
};
use crate::{
    collapse::{LiveMesh, Patch},
    raster::{UnrenderScratch, ViewSubset},
    view::Interpolation,
};

/// Pictures of a mesh as it is, and how far they are from those of the original.
#[derive(Debug)]
pub struct Pictures {
    error: ImageError,
    slots: Slots,
    gouraud: bool,
}

/// Buffers of one thread.
#[derive(Debug)]
pub struct PictureScratch {
    engine: UnrenderScratch,
    change: ImageChange,
}

impl Pictures {
    /// Draws `live` in the views of the original's pictures (in the same frame), to be compared with them.
    #[must_use]
    pub fn new(reference: &Reference, live: &LiveMesh, engine: EngineName) -> Self {
        let (slots, scene) = Slots::of(live);
        let mut views = reference.set().views.iter();
        Self {
            error: ImageError::new(reference, &scene, engine),
            slots,
            gouraud: views.any(|v| v.shading.interpolation == Interpolation::Gouraud),
        }
    }

    /// The pictures and their distance from the original's.
    #[must_use]
    pub fn error(&self) -> &ImageError {
        &self.error
    }

    /// Buffers for a thread.
    #[must_use]
    pub fn scratch(&self) -> PictureScratch {
        PictureScratch {
            engine: self.error.engine().scratch(),
            change: ImageChange::default(),
        }
    }

    /// Buffers for evaluations that nothing else runs beside; see [`Unrender::lone_scratch`](crate::raster::Unrender::lone_scratch).
    #[must_use]
    pub fn lone_scratch(&self) -> PictureScratch {
        PictureScratch {
            engine: self.error.engine().lone_scratch(),
            change: ImageChange::default(),
        }
    }

    /// What the patch, not yet committed, would add to the error in the views of a glance; negative where it makes
    /// those better.
    #[must_use]
    pub fn cost(
        &self,
        live: &LiveMesh,
        patch: &Patch,
        glance: ViewSubset,
        scratch: &mut PictureScratch,
    ) -> i64 {
        let PictureScratch { engine, change } = scratch;
        change.fill(&self.slots, live, patch, self.gouraud);
        self.error.cost(&change.as_change(), glance, engine)
    }

    /// Follows a patch, before or after `live` has it, and returns what it added to the error.
    pub fn commit(&mut self, live: &LiveMesh, patch: &Patch, scratch: &mut PictureScratch) -> i64 {
        let PictureScratch { engine, change } = scratch;
        change.fill(&self.slots, live, patch, self.gouraud);
        self.error.commit(&change.as_change(), engine)
    }
}
