//! Pictures that follow a change of the mesh without being drawn again (Lindstrom & Turk 2000, section 4.2.3).
//!
//! "Un-rendering" takes triangles out of pictures that already exist and puts others in. The engines differ in how
//! they find what the removed triangles hid; the pictures are the same, bit for bit, as drawn from scratch.

mod buckets;
mod layers;
mod scene_edit;

pub use buckets::BucketEngine;
pub use layers::LayerEngine;
pub use scene_edit::{CornerValues, Model, SceneEdit};

use std::{any::Any, fmt};

use super::{Grid, SampleKey};

/// The views that an evaluation takes into account.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewSubset {
    /// Every view of the set.
    #[default]
    All,
    /// Every n-th view of the set, from the first; 0 and 1 are all of them.
    EveryNth(u32),
}

impl ViewSubset {
    /// True where the view with this index in its set belongs to the subset.
    #[inline]
    pub fn contains(self, view: usize) -> bool {
        match self {
            Self::All => true,
            Self::EveryNth(n) => n < 2 || view.is_multiple_of(n as usize),
        }
    }
}

/// Pictures of one mesh in all views of a set, kept up to date, and how far they are from reference pictures.
///
/// Differences are sums over pixels of `(y0 - y)^2`, where `y0` and `y` are the sums of the luma of the pixel's
/// samples, in the reference and in the picture. Sums of integers have no order, so views may be looked at in
/// parallel.
pub trait Unrender: fmt::Debug + Send + Sync {
    /// Buffers for one thread; where it evaluates `alone`, views may be divided among threads.
    fn scratch(&self, alone: bool) -> UnrenderScratch;

    /// Returns what the change would add to the sum of squared differences over `views`, without making it.
    fn evaluate(&self, edit: &SceneEdit, views: ViewSubset, scratch: &mut UnrenderScratch) -> i64;

    /// Makes the change and gives what it added to the sum of squared differences.
    fn commit(&mut self, edit: &SceneEdit, scratch: &mut UnrenderScratch) -> i64;

    /// The luma of every sample of a view.
    fn luma(&self, view: usize) -> Grid<u8>;

    /// The key of every sample of a view.
    fn keys(&self, view: usize) -> Grid<SampleKey>;
}

/// Buffers of one thread that evaluates changes: they belong to the engine that has made them.
#[derive(Debug)]
pub struct UnrenderScratch(Box<dyn Any + Send + Sync>);

impl UnrenderScratch {
    fn new(buffers: impl Any + Send + Sync) -> Self {
        Self(Box::new(buffers))
    }

    fn of<T: Any>(&mut self) -> &mut T {
        let own = self.0.downcast_mut();
        own.expect("the scratch was made by this engine")
    }
}
