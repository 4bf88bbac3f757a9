//! How the picture of one view, and its layers, take on a change.

use super::{
    fragment_lists::TILE,
    probe::ViewDelta,
    view::{LayerView, ProbeContext},
};
use crate::{
    raster::{
        Face, Projector, SampleKey, ScreenVertex,
        draw::{
            projector::ScreenPoint,
            small_triangle::{Fit, SmallTriangle},
        },
    },
    view::Cull,
};

impl LayerView {
    /// Makes the change that the look has seen.
    pub(super) fn apply(&mut self, context: &ProbeContext<'_>, delta: &mut ViewDelta) {
        delta.swaps.clear();
        delta.enter(self.region(context));
        // (1) The picture.
        for i in 0..delta.count {
            let at = delta.touched[i];
            let sample = delta.sample(at, self.width);
            let (x, y) = delta.place(at);
            self.recolor(x, y, delta.tones[i]);
            let before = self.lists.shown()[sample].id();
            delta.swaps.push((before, delta.slots[at as usize].id()));
        }
        for i in 0..delta.restyled.len() {
            let ([x, y], tone) = delta.restyled[i];
            self.recolor(i32::from(x), i32::from(y), tone);
        }
        // (2) The layers.
        let (cull, width, columns) = (self.view.cull, self.width, self.tile_columns);
        for &id in &context.changes.gone {
            let face = self.flat_face(context, id);
            let lists = &mut self.lists;
            delta.fragments(&face, &self.projector, cull, width, |sample, _, _| {
                lists.remove(sample, id);
            });
        }
        for after in &context.changes.fresh {
            let face = self.flat_face_after(context, after);
            let lists = &mut self.lists;
            delta.fragments(
                &face,
                &self.projector,
                cull,
                width,
                |sample, (x, y), depth| {
                    let tile = (y >> TILE) as usize * columns + (x >> TILE) as usize;
                    lists.insert(sample, tile, SampleKey::new(depth, after.id));
                },
            );
            if self.plain {
                self.levels[after.id as usize] = self.level(&after.geometry);
            }
        }
        // (3) What is derived from them.
        if delta.count > 0 {
            let image = self.projector.image();
            self.hi_z.measure(delta.region, image, self.lists.shown());
        }
    }

    fn recolor(&mut self, x: i32, y: i32, tone: u8) {
        let sample = y as usize * self.width + x as usize;
        if self.samples > 0 {
            let pixel = self.pixel(x, y);
            let old = self.lists.shown()[sample].luma();
            let sum = &mut self.sums[pixel][1];
            *sum = *sum - u16::from(old) + u16::from(tone);
        }
        self.lists.set_luma(sample, tone);
    }
}

impl ViewDelta {
    /// Calls `visit(sample, (x, y), depth)` for every fragment of a face in the region.
    #[inline]
    pub(super) fn fragments(
        &mut self,
        face: &Face,
        projector: &Projector,
        cull: Cull,
        width: usize,
        mut visit: impl FnMut(usize, (i32, i32), u32),
    ) {
        if !face.screen.iter().any(ScreenVertex::is_outside) {
            let corners = face.screen.map(ScreenPoint::from);
            match SmallTriangle::fit(corners, projector.bits(), cull, projector.image()) {
                Fit::Nothing => return,
                Fit::Small(small) => {
                    let origin = (self.region.x0, self.region.y0);
                    let count = small.list(origin, self.shift, &mut self.covered);
                    for j in 0..count {
                        let at = self.covered.at[j];
                        let depth = small.depth(self.covered.above[j]);
                        visit(self.sample(at, width), self.place(at), depth);
                    }
                    return;
                }
                Fit::Large => {}
            }
        }
        face.pieces(projector, cull, |setup, _| {
            setup.fragments(projector.image(), |x, y, depth| {
                visit(y as usize * width + x as usize, (x, y), depth);
            });
        });
    }
}
