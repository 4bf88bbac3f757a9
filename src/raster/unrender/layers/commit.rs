//! Commit: brings the picture of one view and its layers up to date.

use super::{
    fragment_lists::TILE,
    view::{LayerView, ProbeContext},
    view_delta::ViewDelta,
};
use crate::raster::SampleKey;

impl LayerView {
    /// Makes the change that `delta` is the probe of.
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
