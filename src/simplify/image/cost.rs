//! Equation 8 of Lindstrom & Turk 2000 over all views, as an exact integer.

use rayon::prelude::*;

use crate::{
    num::math::sqrt,
    raster::{self, Change, Plane, Scene, Unrender},
    view::ViewSet,
};

/// The pictures of the original, those of the current mesh, and the sum of their squared luma differences.
///
/// The sum is never taken from a cost that was computed earlier: every commit adds its own difference.
#[derive(Clone, Debug)]
pub struct ImageError<E> {
    reference: Vec<Plane<u8>>,
    engine: E,
    sum: u64,
}

impl<E: Unrender> ImageError<E> {
    /// Compares the pictures in `engine`, which shows `current`, with those of `original`.
    #[must_use]
    pub fn new(original: &Scene, current: &Scene, set: &ViewSet, engine: E) -> Self {
        debug_assert!(
            set.views
                .iter()
                .enumerate()
                .all(|(i, view)| { raster::luma(current, view, set).tones == *engine.luma(i) }),
            "the engine shows the current mesh"
        );
        let reference: Vec<Plane<u8>> = set
            .views
            .par_iter()
            .map(|view| raster::luma(original, view, set).tones)
            .collect();
        let differences = reference.iter().enumerate().map(|(i, y0)| {
            let pairs = y0.values().iter().zip(engine.luma(i).values());
            pairs.map(|(&a, &b)| square(a, b) as u64).sum::<u64>()
        });
        Self {
            sum: differences.sum(),
            reference,
            engine,
        }
    }

    /// Sum over views and pixels of the squared luma differences, in squared levels.
    #[must_use]
    pub fn sum(&self) -> u64 {
        self.sum
    }

    /// Root mean square of the differences over all views, in levels (equation 2).
    #[must_use]
    pub fn rms(&self) -> f64 {
        let pixels: usize = self.reference.iter().map(|p| p.values().len()).sum();
        sqrt(self.sum as f64 / pixels.max(1) as f64)
    }

    /// The engine that keeps the pictures.
    #[must_use]
    pub fn engine(&self) -> &E {
        &self.engine
    }

    /// Buffers for a thread.
    #[must_use]
    pub fn scratch(&self) -> E::Scratch {
        self.engine.scratch()
    }

    /// What the change would add to the sum; negative where it makes the pictures better.
    #[must_use]
    pub fn cost(&self, change: &Change<'_>, scratch: &mut E::Scratch) -> i64 {
        self.engine
            .evaluate(change, scratch, &|view, at, old, new| {
                difference(&self.reference[view], at, old, new)
            })
    }

    /// Makes the change and returns what it added to the sum.
    pub fn commit(&mut self, change: &Change<'_>, scratch: &mut E::Scratch) -> i64 {
        let reference = &self.reference;
        let cost = self.engine.commit(change, scratch, &|view, at, old, new| {
            difference(&reference[view], at, old, new)
        });
        self.sum = self.sum.wrapping_add_signed(cost);
        cost
    }
}

/// `(y0 - new)^2 - (y0 - old)^2` at one pixel.
#[inline]
fn difference(reference: &Plane<u8>, at: usize, old: u8, new: u8) -> i64 {
    let y0 = reference.values()[at];
    square(y0, new) - square(y0, old)
}

#[inline]
fn square(a: u8, b: u8) -> i64 {
    let d = i64::from(a) - i64::from(b);
    d * d
}
