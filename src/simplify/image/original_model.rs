//! The original as an image-driven run needs it: as pictures and as a surface.

use super::{DistancePenalty, HeldOutViews, ImageOptions, ReferenceImages};
use crate::{
    Progress, Result, collapse::LiveMesh, mesh::FramedMesh, metric::Orientation, num::Frame,
    raster::Scene, view::ViewSet,
};

/// The original in the driving views, in views that drive nothing, and as a surface. It depends on no collapse: it is
/// made beside the part of the run that needs no pictures.
#[derive(Debug)]
pub struct OriginalModel {
    mesh: FramedMesh,
    frame: Frame,
    scene: Scene,
    reference: ReferenceImages,
    held_out: Option<HeldOutViews>,
    sides: Option<Orientation>,
}

impl OriginalModel {
    /// Draws `mesh`, in units of `frame`, in the views of `set`; `own` must have been resolved. In other views
    /// as well where the result is to be `contested`. O(n log n + pixels).
    ///
    /// # Errors
    /// As [`ImageOptions::views`]; [`crate::Error::Interrupted`].
    pub fn draw(
        mesh: FramedMesh,
        frame: Frame,
        set: ViewSet,
        own: &ImageOptions,
        contested: bool,
        progress: &dyn Progress,
    ) -> Result<Self> {
        let scene = Scene::of(&mesh);
        let held_out = || HeldOutViews::new(&scene, &mesh, frame, own, progress);
        Ok(Self {
            reference: ReferenceImages::draw(&scene, set, progress)?,
            held_out: contested.then(held_out).transpose()?,
            sides: Orientation::new(&mesh),
            mesh,
            frame,
            scene,
        })
    }

    /// Its pictures in the driving views.
    pub fn reference(&self) -> &ReferenceImages {
        &self.reference
    }

    /// Its pictures with cameras turned for a later round.
    ///
    /// # Errors
    /// As [`OriginalModel::draw`].
    pub fn turned(
        &self,
        own: &ImageOptions,
        round: u32,
        progress: &dyn Progress,
    ) -> Result<ReferenceImages> {
        let set = own.views(&self.mesh, self.frame, round)?;
        ReferenceImages::draw(&self.scene, set, progress)
    }

    /// Its pictures in views that drive nothing, once: no other part of the run needs them.
    pub fn take_held_out(&mut self) -> Option<HeldOutViews> {
        self.held_out.take()
    }

    /// The sides of its surface; `None` where it has no triangle with an area.
    pub fn sides(&self) -> Option<&Orientation> {
        self.sides.as_ref()
    }

    /// The penalty on distance from its surface for a run on `live`: see [`DistancePenalty::new`].
    pub fn deviation(&self, live: &LiveMesh, weight: f64) -> Option<DistancePenalty<'_>> {
        DistancePenalty::new(self.sides()?.surface(), live, weight)
    }
}
