//! Views that drive nothing, to judge a result where no picture was fitted.
//!
//! The error of the driving pictures says nothing about quality, because the run has minimised it: where pictures cannot
//! resolve the details that a mesh still has, ordering and polishing by them fit their noise. These views are between the driving
//! ones and have four times their pixels (at least [`LEAST`] along a side), with the same shading and 2 x 2 samples.

use super::{ImageOptions, ReferenceImages, Size};
use crate::{
    Progress, Result,
    mesh::{FramedMesh, Mesh},
    metric::luma::{SquaredError, ViewErrors, squared_error},
    num::Frame,
    parallel,
    raster::{Scene, luma_sums},
    view::ViewsName,
};

/// Few, because every one is a picture of the original: 12 of them took 5 % of the time of the fastest run.
const VIEWS: u32 = 8;

/// Smallest side in pixels: small pictures favour what was fitted to small pictures.
const LEAST: u32 = 192;

/// Round of the cameras: as no polishing turns them.
const ROUND: u32 = 1_000;

/// Pictures of the original in views that drive nothing.
#[derive(Debug)]
pub struct HeldOutViews {
    frame: Frame,
    reference: ReferenceImages,
}

impl HeldOutViews {
    /// Draws `original`, the scene of `mesh`; both are in units of `frame`. `own` must have been resolved.
    ///
    /// # Errors
    /// As [`ImageOptions::views`]; [`crate::Error::Interrupted`].
    pub fn new(
        original: &Scene,
        mesh: &FramedMesh,
        frame: Frame,
        own: &ImageOptions,
        progress: &dyn Progress,
    ) -> Result<Self> {
        let side = own.size.pixels(None).saturating_mul(2);
        let own = ImageOptions {
            views: ViewsName::Spiral(VIEWS),
            size: Size::Pixels(side.clamp(LEAST, 2 * Size::MOST)),
            samples: 2,
            ..own.clone()
        };
        let set = own.views(mesh, frame, ROUND)?;
        let reference = ReferenceImages::draw(original, set, progress)?;
        Ok(Self { frame, reference })
    }

    /// The error of `result`, in file units, against the original.
    ///
    /// # Errors
    /// [`crate::Error::Unsupported`] for more pixels than sums have bits for; never for views that could be drawn.
    pub fn error(&self, result: &Mesh) -> Result<SquaredError> {
        let scene = Scene::of(&result.enter_frame(self.frame));
        let set = self.reference.set();
        let samples = set.samples * set.samples;
        let errors = parallel::try_map(set.views.len(), |i| {
            let actual = luma_sums(&scene, &set.views[i], set);
            squared_error(&self.reference.sums()[i], &actual, samples)
        });
        Ok(ViewErrors::new(errors?)?.total())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        mesh::{Attributes, ChannelKind, generate},
        metric::appearance::appearance,
        simplify::image::{DrivingShading, Preset},
        view::frame_of,
    };

    #[test]
    fn errors_are_those_that_compare_measures_in_the_same_views() {
        let original = with_normals(generate::torus(1.0, 0.4, 12, 8));
        let coarse = with_normals(generate::torus(1.0, 0.4, 8, 6));
        let frame = frame_of(&original);
        let own = ImageOptions {
            size: Size::Pixels(16),
            ..Preset::Fast.options()
        };
        let mesh = original.enter_frame(frame);
        let scene = Scene::of(&mesh);
        use DrivingShading::{Flat, Gouraud, Lit};
        let found = [Flat, Gouraud, Lit].map(|shading| {
            let own = ImageOptions {
                shading,
                ..own.clone()
            };
            let held_out =
                HeldOutViews::new(&scene, &mesh, frame, &own, &crate::Silent).expect("views");
            let same = held_out.error(&original).expect("drawn");
            assert!(same.is_zero(), "nothing differs from itself");
            let error = held_out.error(&coarse).expect("drawn");
            (held_out, error)
        });
        let candidate = Scene::of(&coarse.enter_frame(frame));
        let set = found[0].0.reference.set();
        assert_eq!((set.width, set.samples), (192, 2));
        let judged = appearance(&scene, &[candidate], set, &crate::Silent).expect("drawn");
        assert_eq!(found[0].1, judged[0].flat.total());
        assert_eq!(found[1].1, judged[0].gouraud.total());
        let lit = judged[0].lit.as_ref().map(ViewErrors::total);
        assert_eq!(Some(found[2].1), lit);
    }

    /// With a normal at every vertex that has little to do with the surface.
    fn with_normals(mesh: Mesh) -> Mesh {
        let values = mesh.positions().iter().flat_map(|p| p.to_array());
        let (values, corners) = (values.collect(), mesh.triangles().to_vec());
        let mut parts = mesh.into_parts();
        parts.attributes =
            Attributes::new(&[ChannelKind::Normal], values, corners).expect("a row for each");
        Mesh::new(parts).expect("valid before")
    }
}
