//! The pictures that drive a run, their error (equation 8 of Lindstrom & Turk 2000, over all views, as an exact
//! integer), and its change by a patch of the mesh.

use super::{
    EngineName, ReferenceImages,
    scene_edit::{Slots, Translator},
};
use crate::{
    collapse::{LiveMesh, Patch},
    num::math::sqrt,
    raster::{self, BucketEngine, Grid, LayerEngine, Model, Unrender, UnrenderScratch, ViewSubset},
    view::Interpolation,
};

/// Pictures of a mesh as it is, and the sum of the squared luma differences from those of the original.
///
/// A pixel with `samples` x `samples` samples is the integer sum of them, and the difference is squared per pixel: the
/// unit of sums and costs is `(1 / samples^2)^2` squared levels, one squared level where there is one sample.
/// The sum is never taken from a cost that was computed earlier: every commit adds its own difference.
#[derive(Debug)]
pub struct Pictures {
    engine: Box<dyn Unrender>,
    slots: Slots,
    /// A view is flat shaded.
    flat: bool,
    /// A view is Gouraud shaded.
    gouraud: bool,
    sum: u64,
    /// Number of views.
    views: usize,
    /// Pixels of all views.
    pixels: u64,
    /// Samples in a pixel.
    samples: u32,
}

/// Buffers of one thread.
#[derive(Debug)]
pub struct PictureScratch {
    engine: UnrenderScratch,
    translator: Translator,
}

impl Pictures {
    /// Draws `live` in the views of the original's pictures (in the same frame), and compares them.
    pub fn new(reference: &ReferenceImages, live: &LiveMesh, engine: EngineName) -> Self {
        let (slots, scene) = Slots::of(live);
        let set = reference.set();
        let shaded = |by| set.views.iter().any(|v| v.shading.interpolation == by);
        let (model, sums) = (Model::new(&scene, set), reference.sums());
        let engine: Box<dyn Unrender> = match engine {
            EngineName::Layers => Box::new(LayerEngine::new(model, set, sums)),
            EngineName::Buckets => Box::new(BucketEngine::new(model, set, sums)),
        };
        let mut pictures = Self {
            engine,
            slots,
            flat: shaded(Interpolation::Flat),
            gouraud: shaded(Interpolation::Gouraud),
            sum: 0,
            views: set.views.len(),
            pixels: set.views.len() as u64 * u64::from(set.width) * u64::from(set.height),
            samples: set.samples * set.samples,
        };
        pictures.sum = pictures.sum_from_scratch(reference);
        pictures
    }

    /// The sum of squared differences between the engine's pictures and those of the original.
    fn sum_from_scratch(&self, reference: &ReferenceImages) -> u64 {
        let view = |(i, y0): (usize, &Grid<u16>)| {
            let sums = raster::sum_samples(&self.engine.luma(i), reference.set().samples);
            let pairs = y0.values().iter().zip(sums.values());
            pairs
                .map(|(&a, &b)| u64::from(a.abs_diff(b)).pow(2))
                .sum::<u64>()
        };
        reference.sums().iter().enumerate().map(view).sum()
    }

    /// Sum over views and pixels of the squared luma differences, in squared levels over `samples^4`.
    pub fn sum(&self) -> u64 {
        self.sum
    }

    /// Root mean square of the differences over all views, in levels (equation 2).
    pub fn rms(&self) -> f64 {
        sqrt(self.sum as f64 / self.pixels.max(1) as f64) / f64::from(self.samples)
    }

    /// The sum that a root mean square in levels stands for.
    pub fn sum_of_rms(&self, rms: f64) -> f64 {
        let sum = rms * f64::from(self.samples);
        sum * sum * self.pixels as f64
    }

    /// Number of views.
    pub fn views(&self) -> usize {
        self.views
    }

    /// The engine that keeps the pictures.
    pub fn engine(&self) -> &dyn Unrender {
        &*self.engine
    }

    /// Buffers for one thread of several that evaluate at the same time.
    pub fn scratch(&self) -> PictureScratch {
        PictureScratch {
            engine: self.engine.scratch(),
            translator: Translator::new(&self.slots, self.flat),
        }
    }

    /// Buffers for evaluations that nothing else runs beside; see [`Unrender::lone_scratch`].
    pub fn lone_scratch(&self) -> PictureScratch {
        PictureScratch {
            engine: self.engine.lone_scratch(),
            translator: Translator::new(&self.slots, self.flat),
        }
    }

    /// Prices a patch, not yet committed: its addition to the error in some views, negative where it makes those better.
    pub fn cost(
        &self,
        live: &LiveMesh,
        patch: &Patch,
        views: ViewSubset,
        scratch: &mut PictureScratch,
    ) -> i64 {
        let PictureScratch { engine, translator } = scratch;
        translator.fill(&self.slots, live, patch, self.gouraud);
        self.engine.evaluate(&translator.edit, views, engine)
    }

    /// Follows a patch, before or after `live` has it, and returns its addition to the error.
    pub fn commit(&mut self, live: &LiveMesh, patch: &Patch, scratch: &mut PictureScratch) -> i64 {
        let PictureScratch { engine, translator } = scratch;
        translator.fill(&self.slots, live, patch, self.gouraud);
        let cost = self.engine.commit(&translator.edit, engine);
        self.sum = self.sum.wrapping_add_signed(cost);
        cost
    }
}
