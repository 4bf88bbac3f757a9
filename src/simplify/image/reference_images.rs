//! Pictures of the original, which those of a mesh are compared with.

use crate::{
    Error, Progress, Result, parallel,
    raster::{Grid, Scene, luma_sums},
    view::{Interpolation, ViewSet},
};

/// Pictures of the original in a set of views.
#[derive(Clone, Debug)]
pub struct ReferenceImages {
    set: ViewSet,
    sums: Vec<Grid<u16>>,
}

impl ReferenceImages {
    /// Draws `original` in the views of `set`, in parallel. O(triangles + pixels) for every view.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn draw(original: &Scene, set: ViewSet, progress: &dyn Progress) -> Result<Self> {
        let sums = parallel::try_map(set.views.len(), |i| {
            // Other work reports meanwhile.
            if progress.interrupted() {
                return Err(Error::Interrupted);
            }
            Ok(luma_sums(original, &set.views[i], &set))
        })?;
        Ok(Self { sums, set })
    }

    /// The views and the format of their pictures.
    pub fn set(&self) -> &ViewSet {
        &self.set
    }

    /// True where a view is lit by stored normals.
    pub fn is_lit(&self) -> bool {
        let mut views = self.set.views.iter();
        views.any(|view| view.shading.interpolation == Interpolation::Lit)
    }

    /// The sum of the lumas of the samples in every pixel, for every view.
    pub fn sums(&self) -> &[Grid<u16>] {
        &self.sums
    }
}
