//! The options of a comparison.

use crate::{
    Result,
    metric::{appearance::image_error_views, surface::DEFAULT_SAMPLES},
    view::{self, Projection, Sphere, ViewSet, ViewsName},
};

/// Which errors are measured, in which views, at how many points.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CompareOptions {
    /// Views that the pictures are compared in, flat, Gouraud, and lit where both meshes store normals [default: the 24 of a small rhombicuboctahedron];
    /// `None` draws none and leaves silhouettes out.
    pub views: Option<ViewsName>,
    /// Width and height of the pictures [default: 512]; a view file says its own.
    pub size: u32,
    /// Samples per pixel along each axis: 1, 2 or 4 [default: 2]; a view file says its own.
    pub samples: u32,
    /// Measures equation 5.11 of Zhang & Turk 2002 too: flat, from the 20 corners of a dodecahedron [default: no].
    pub image_error: bool,
    /// Points on each surface that distances are measured at [default: 500,000]; `None` measures no distances.
    pub distance_samples: Option<u32>,
    /// Counts silhouette edges of every mesh in the views [default: yes].
    pub silhouettes: bool,
    /// Counts folded edges and flipped faces of the candidates [default: yes].
    pub folds: bool,
}

impl Default for CompareOptions {
    fn default() -> Self {
        Self {
            views: Some(ViewsName::Rhombicuboctahedron),
            size: 512,
            samples: 2,
            image_error: false,
            distance_samples: Some(DEFAULT_SAMPLES),
            silhouettes: true,
            folds: true,
        }
    }
}

impl CompareOptions {
    /// Compares pictures in these views.
    #[must_use]
    pub fn views(mut self, views: ViewsName) -> Self {
        self.views = Some(views);
        self
    }

    /// Draws pictures of `size` x `size` pixels with `samples` x `samples` samples each.
    #[must_use]
    pub fn pictures(mut self, size: u32, samples: u32) -> Self {
        (self.size, self.samples) = (size, samples);
        self
    }

    /// Measures distances at about this many points of each surface.
    #[must_use]
    pub fn distance_samples(mut self, samples: u32) -> Self {
        self.distance_samples = Some(samples);
        self
    }

    /// The views of the pictures around the reference's sphere, in the units of the sphere.
    ///
    /// # Errors
    /// As [`view::resolve`] and [`ViewSet::with_samples`].
    pub(super) fn picture_views(&self, sphere: &Sphere) -> Result<Option<ViewSet>> {
        let Some(name) = &self.views else {
            return Ok(None);
        };
        let set = view::resolve(name, sphere, [self.size; 2], Projection::Perspective)?;
        match name {
            ViewsName::File(_) => Ok(set),
            _ => set.with_samples(self.samples),
        }
        .map(Some)
    }

    /// The views of equation 5.11 around the reference's sphere, in the units of the sphere.
    ///
    /// # Errors
    /// As [`image_error_views`].
    pub(super) fn image_error_views(&self, sphere: &Sphere) -> Result<Option<ViewSet>> {
        let views = || image_error_views(sphere, self.size, self.samples);
        self.image_error.then(views).transpose()
    }
}
