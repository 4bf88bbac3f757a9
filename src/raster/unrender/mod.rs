//! Pictures that follow a change of the mesh without being drawn again (Lindstrom & Turk 2000, section 4.2.3).
//!
//! "Un-rendering" takes triangles out of pictures that already exist and puts others in. The engines differ in how
//! they find what the removed triangles hid; the pictures are the same, bit for bit, as drawn from scratch.

mod buckets;
mod layers;
mod scene_edit;

pub use buckets::BucketEngine;
pub use layers::LayerEngine;
pub use scene_edit::SceneEdit;

use std::{any::Any, fmt};

use glam::DVec3;

use super::{Grid, SampleKey, Scene};
use crate::view::{Interpolation, ViewSet};

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
    /// Buffers for one thread of several that evaluate at the same time.
    fn scratch(&self) -> UnrenderScratch;

    /// Buffers for evaluations that nothing else runs beside: views may then be divided among threads.
    fn lone_scratch(&self) -> UnrenderScratch;

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

/// `(y0 - new)^2 - (y0 - old)^2`.
#[inline]
pub(super) fn difference(y0: u16, old: u16, new: u16) -> i64 {
    let (y0, old, new) = (i64::from(y0), i64::from(old), i64::from(new));
    (new - old) * (new + old - 2 * y0)
}

/// The mesh that the pictures show: what does not depend on the view.
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) positions: Vec<DVec3>,
    /// Vertices by triangle id.
    pub(super) corners: Vec<[u32; 3]>,
    /// Unit vertex normals; empty where no view needs them.
    pub(super) normals: Vec<DVec3>,
    /// Corner colours by triangle id; empty where everything is white.
    pub(super) colors: Vec<[[f64; 3]; 3]>,
}

impl Model {
    /// The model of a scene whose ids count from 0 without gaps.
    pub fn new(scene: &Scene, set: &ViewSet) -> Self {
        let gouraud = set
            .views
            .iter()
            .any(|v| v.shading.interpolation == Interpolation::Gouraud);
        Self {
            positions: scene.positions().to_vec(),
            corners: scene.triangles().to_vec(),
            normals: if gouraud {
                scene.normals().to_vec()
            } else {
                Vec::new()
            },
            colors: scene.colors().to_vec(),
        }
    }

    pub(super) fn apply(&mut self, edit: &SceneEdit) {
        for &(v, p) in &edit.moved {
            self.positions[v as usize] = p;
        }
        if !self.normals.is_empty() {
            let shaded = |v: u32| edit.normals.iter().any(|n| n.0 == v);
            debug_assert!(edit.moved.iter().all(|m| shaded(m.0)));
            for &(v, n) in &edit.normals {
                self.normals[v as usize] = n;
            }
        }
        for face in edit.after() {
            self.corners[face.id as usize] = face.corners.map(|c| c.vertex);
            if let Some(colors) = self.colors.get_mut(face.id as usize) {
                *colors = face.colors;
            }
        }
    }

    /// The position of a vertex after the change.
    #[inline]
    pub(super) fn position_after(&self, edit: &SceneEdit, vertex: u32) -> DVec3 {
        edit.moved
            .iter()
            .find(|m| m.0 == vertex)
            .map_or_else(|| self.positions[vertex as usize], |m| m.1)
    }
}
