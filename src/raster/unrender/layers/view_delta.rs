//! [`ViewDelta`]: the difference that a change makes to the picture of one view, and how a commit makes it.
//!
//! Pixels have indices in the bounding box of the change, whose rows lie a power of two apart.

use super::{
    fragment_lists::TILE,
    view::{LayerView, ProbeContext},
};
use crate::{
    raster::{
        Face, Paint, PixelRect, Projector, SampleKey, ScreenVertex, Setup,
        draw::{
            projector::ScreenPoint,
            small_triangle::{Covered, Fit, SmallTriangle},
        },
    },
    view::Cull,
};

/// A fresh triangle, or a piece of one, that won a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// The level of all of its pixels; meaningless where they differ.
    pub(super) level: u8,
    /// The input of shading, where pixels differ.
    pub(super) shaded: Option<(Setup, Paint)>,
}

/// The difference that a change makes to the picture of one view, and the buffers to find it; reused.
#[derive(Clone, Debug, Default)]
pub(super) struct ViewDelta {
    /// The pixels that may change, and the logarithm of the stride of the buffers below.
    pub(super) region: PixelRect,
    pub(super) shift: u32,
    /// The buffers below hold the region; not where nothing came near enough to be seen.
    pub(super) entered: bool,
    /// By pixel of the region, the key that a fresh one must be below to be seen. Where the pixel still shows what it did,
    /// or what was behind: a lower bound of that; elsewhere the nearest fresh key. After the probe the keys of touched
    /// pixels.
    pub(super) slots: Vec<SampleKey>,
    /// By pixel: 0 as before, 1 what was behind, more is a piece.
    pub(super) who: Vec<u32>,
    /// Pixels of the region that show something else, and their luma afterwards.
    pub(super) touched: Vec<u32>,
    pub(super) count: usize,
    pub(super) tones: Vec<u8>,
    /// Samples of the picture that only look different, and their luma afterwards.
    pub(super) restyled: Vec<([u16; 2], u8)>,
    /// After a commit: for every touched sample the triangle that it showed and the one it shows; ids above the last
    /// triangle are the background.
    pub(super) swaps: Vec<(u32, u32)>,
    /// Fresh pieces that won a pixel.
    pub(super) pieces: Vec<Piece>,
    pub(super) covered: Covered,
    /// Columns of a row that show a triangle.
    pub(super) columns: Vec<i32>,
    /// By pixel of the picture: the change of the sum of its samples; 0 between probes.
    pub(super) deltas: Vec<i32>,
    /// Pixels of the picture whose sum changes.
    pub(super) pixels: Vec<u32>,
    /// New intensities of the vertices whose normals change, where this view needs them.
    pub(super) intensities: Vec<f64>,
}

impl ViewDelta {
    /// Makes room for a region; the buffers still hold the last one.
    pub(super) fn begin(&mut self, region: PixelRect) {
        self.enter(region);
        let size = region.height() << self.shift;
        if self.slots.len() < size + 1 {
            self.slots.resize(size + 1, SampleKey::BACKGROUND);
            self.touched.resize(size + 1, 0);
            self.who.resize(size + 1, 0);
        }
    }

    /// Makes indices those of a region.
    pub(super) fn enter(&mut self, region: PixelRect) {
        self.region = region;
        self.shift = region.width().next_power_of_two().trailing_zeros();
    }

    /// False where a fresh key is certainly not seen at a pixel.
    #[inline]
    pub(super) fn may_win(&self, at: u32, key: SampleKey) -> bool {
        key.bits() >> 48 <= self.slots[at as usize].bits() >> 48 || self.who[at as usize] == 1
    }

    /// Gives a pixel to a piece.
    #[inline]
    pub(super) fn win(&mut self, at: u32, key: SampleKey, number: u32) {
        let i = at as usize;
        self.touched[self.count] = at;
        self.count += usize::from(self.who[i] == 0);
        self.slots[i] = key;
        self.who[i] = number;
    }

    /// The sample of the picture where a pixel of the region is.
    #[inline]
    pub(super) fn sample(&self, at: u32, width: usize) -> usize {
        let (row, column) = (at >> self.shift, at & ((1 << self.shift) - 1));
        (self.region.y0 as usize + row as usize) * width + self.region.x0 as usize + column as usize
    }

    /// Column and row of a pixel of the region.
    #[inline]
    pub(super) fn place(&self, at: u32) -> (i32, i32) {
        let (row, column) = (at >> self.shift, at & ((1 << self.shift) - 1));
        (self.region.x0 + column as i32, self.region.y0 + row as i32)
    }

    /// True for pixels of the region that show something else.
    pub(super) fn is_touched(&self, x: i32, y: i32) -> bool {
        let r = self.region;
        if x < r.x0 || x >= r.x1 || y < r.y0 || y >= r.y1 {
            return false;
        }
        self.who[((y - r.y0) as usize) << self.shift | (x - r.x0) as usize] != 0
    }

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
        for &id in &context.edit.gone {
            let face = self.flat_face(context, id);
            let lists = &mut self.lists;
            delta.fragments(&face, &self.projector, cull, width, |sample, _, _| {
                lists.remove(sample, id);
            });
        }
        for after in &context.edit.fresh {
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
