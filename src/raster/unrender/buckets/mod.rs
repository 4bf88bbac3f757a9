//! The bucket engine: un-rendering by drawing again what the buckets find (Lindstrom & Turk 2000, section 4.2.3).
//!
//! The region of a change is the bounding box of the triangles it removes and adds. Pixels there that show none of the
//! removed triangles are the minimum of what they show and what is added. The others are cleared, and all triangles
//! that meet their bounding box, but for the removed ones, are drawn again; then the added ones. The paper clears and
//! draws the whole region, with the same result. The oracle for any faster engine.

mod lines;
mod view;

use self::view::{BucketView, PartScratch};
use super::{Model, SceneEdit, Unrender, UnrenderScratch, ViewSubset};
use crate::{
    parallel,
    raster::{Grid, SampleKey},
    view::ViewSet,
};

/// Pictures of a mesh in all views, un-rendered with row and column buckets.
#[derive(Clone, Debug)]
pub struct BucketEngine {
    model: Model,
    views: Vec<BucketView>,
}

/// Most parts that the views are divided into: with fewer views each, handing over costs more than it saves.
const PARTS: usize = 4;

impl BucketEngine {
    /// Draws the model in every view of the set. `reference` has the luma sums of every view (see
    /// [`luma_sums`](crate::raster::luma_sums)).
    pub fn new(model: Model, set: &ViewSet, reference: &[Grid<u16>]) -> Self {
        let views = set.views.iter().zip(reference).collect();
        let views = parallel::map_vec(views, |(view, reference)| {
            BucketView::new(&model, view, set, reference.clone())
        });
        Self { model, views }
    }
}

impl Unrender for BucketEngine {
    /// One buffer for every part of the views that has a thread of its own.
    fn scratch(&self, alone: bool) -> UnrenderScratch {
        let most = if alone { PARTS } else { 1 };
        let parts = parallel::threads().min(most).min(self.views.len()).max(1);
        UnrenderScratch::new(vec![PartScratch::new(self.model.corners.len()); parts])
    }

    fn evaluate(&self, edit: &SceneEdit, views: ViewSubset, scratch: &mut UnrenderScratch) -> i64 {
        let chosen = self.views.iter().enumerate();
        let chosen = chosen.filter(|&(i, _)| views.contains(i));
        let chosen: Vec<&BucketView> = chosen.map(|(_, view)| view).collect();
        let parts: &mut Vec<PartScratch> = scratch.of();
        in_parts(chosen, parts, &|view: &BucketView, part| {
            let region = view.redraw(&self.model, edit, part);
            view.difference(region, part)
        })
    }

    fn commit(&mut self, edit: &SceneEdit, scratch: &mut UnrenderScratch) -> i64 {
        let model = &self.model;
        let views: Vec<&mut BucketView> = self.views.iter_mut().collect();
        let parts: &mut Vec<PartScratch> = scratch.of();
        let sum = in_parts(views, parts, &|view: &mut BucketView, part| {
            let region = view.redraw(model, edit, part);
            let sum = view.difference(region, part);
            view.apply(edit, region, part);
            sum
        });
        self.model.apply(edit);
        sum
    }

    fn luma(&self, view: usize) -> Grid<u8> {
        self.views[view].luma.clone()
    }

    fn keys(&self, view: usize) -> Grid<SampleKey> {
        self.views[view].keys.clone()
    }
}

/// The sum of `work` over all views, in as many parts as there are scratches.
fn in_parts<V: Send>(
    views: Vec<V>,
    parts: &mut [PartScratch],
    work: &(impl Fn(V, &mut PartScratch) -> i64 + Sync),
) -> i64 {
    let share = views.len().div_ceil(parts.len().max(1));
    let mut views = views.into_iter();
    let dealt = parts
        .iter_mut()
        .map(|part| (views.by_ref().take(share).collect(), part));
    let mut dealt: Vec<(Vec<V>, &mut PartScratch)> = dealt.collect();
    parallel::sum_mut(&mut dealt, &|_, (views, part)| {
        views.drain(..).map(|view| work(view, part)).sum()
    })
}
