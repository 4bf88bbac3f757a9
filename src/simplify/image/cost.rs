//! Equation 8 of Lindstrom & Turk 2000 over all views, as an exact integer.

use super::{EngineName, Reference};
use crate::{
    num::math::sqrt,
    raster::{
        self, BucketEngine, Change, Grid, LayerEngine, Model, Scene, Unrender, UnrenderScratch,
        ViewSubset,
    },
};

/// The pictures of the original, those of the current mesh, and the sum of their squared luma differences.
///
/// A pixel with `samples` x `samples` samples is the integer sum of them, and the difference is squared per pixel: the
/// unit of sums and costs is `(1 / samples^2)^2` squared levels, one squared level where there is one sample.
/// The sum is never taken from a cost that was computed earlier: every commit adds its own difference.
#[derive(Debug)]
pub struct ImageError {
    engine: Box<dyn Unrender>,
    sum: u64,
    /// Views, and pixels of all of them.
    views: usize,
    pixels: u64,
    /// Samples in a pixel.
    samples: u32,
}

impl ImageError {
    /// Draws `current` in the views of the original's pictures and compares them.
    #[must_use]
    pub fn new(reference: &Reference, current: &Scene, engine: EngineName) -> Self {
        let set = reference.set();
        let (model, sums) = (Model::new(current, set), reference.sums());
        let engine: Box<dyn Unrender> = match engine {
            EngineName::Layers => Box::new(LayerEngine::new(model, set, sums)),
            EngineName::Buckets => Box::new(BucketEngine::new(model, set, sums)),
        };
        let mut error = Self {
            engine,
            sum: 0,
            views: set.views.len(),
            pixels: set.views.len() as u64 * u64::from(set.width) * u64::from(set.height),
            samples: set.samples * set.samples,
        };
        error.sum = error.sum_from_scratch(reference);
        error
    }

    /// The sum of squared differences between the engine's pictures and those of the original.
    fn sum_from_scratch(&self, reference: &Reference) -> u64 {
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
    #[must_use]
    pub fn sum(&self) -> u64 {
        self.sum
    }

    /// Root mean square of the differences over all views, in levels (equation 2).
    #[must_use]
    pub fn rms(&self) -> f64 {
        sqrt(self.sum as f64 / self.pixels.max(1) as f64) / f64::from(self.samples)
    }

    /// The sum that a root mean square in levels stands for.
    #[must_use]
    pub fn sum_of_rms(&self, rms: f64) -> f64 {
        let sum = rms * f64::from(self.samples);
        sum * sum * self.pixels as f64
    }

    /// Number of views.
    #[must_use]
    pub fn views(&self) -> usize {
        self.views
    }

    /// The engine that keeps the pictures.
    #[must_use]
    pub fn engine(&self) -> &dyn Unrender {
        &*self.engine
    }

    /// What the change would add to the sum over the views of a glance; negative where it makes them better.
    #[must_use]
    pub fn cost(
        &self,
        change: &Change<'_>,
        glance: ViewSubset,
        scratch: &mut UnrenderScratch,
    ) -> i64 {
        self.engine.evaluate(change, glance, scratch)
    }

    /// Makes the change and returns what it added to the sum.
    pub fn commit(&mut self, change: &Change<'_>, scratch: &mut UnrenderScratch) -> i64 {
        let cost = self.engine.commit(change, scratch);
        self.sum = self.sum.wrapping_add_signed(cost);
        cost
    }
}
