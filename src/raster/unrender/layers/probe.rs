//! Probe: finds the difference that a change makes to the picture of one view, without making it.
//!
//! It goes through the pixels of the bounding box of the triangles that go and come. Where one that goes is the
//! nearest, the next layer that stays takes its place; the fresh triangles compete for every pixel they cover. Triangles
//! that only look different are visited where they are seen. Most fresh fragments are decided by a bound: no layer behind
//! the first of a tile is nearer, or the upper half of what a pixel shows is. Only the others search the layers.

use super::{
    super::scene_edit::{EditedFace, difference},
    projected::clipped_pixels,
    view::{LayerView, ProbeContext},
    view_delta::{Piece, ViewDelta},
};
use crate::raster::{
    Face, Paint, PixelRect, SampleKey, ScreenVertex, Setup,
    draw::small_triangle::{Fit, SmallTriangle},
};

impl LayerView {
    /// Fills `delta`, and returns what the change would add to the squared differences of this view.
    pub(super) fn probe(&self, context: &ProbeContext<'_>, delta: &mut ViewDelta) -> i64 {
        delta.count = 0;
        delta.restyled.clear();
        let uncovers = context.uncovers();
        let restyles = self.restyles(context);
        let hidden = !uncovers && self.is_hidden(context);
        if hidden && !restyles {
            return 0;
        }
        delta.pieces.clear();
        delta.intensities.clear();
        if self.gouraud {
            let normals = context.edit.normals.iter();
            delta.intensities.extend(normals.map(|&(v, n)| {
                let position = context.model.position_after(context.edit, v);
                self.shader.intensity(position, n)
            }));
        }
        delta.entered = false;
        if !hidden {
            if uncovers {
                self.enter(context, delta);
            }
            self.draw_fresh(context, delta);
            self.tone(context, delta);
        }
        if restyles {
            self.restyle(context, delta);
        }
        self.sum(delta)
    }

    /// The pixels that the triangles can touch that go and come.
    #[inline]
    pub(super) fn region(&self, context: &ProbeContext<'_>) -> PixelRect {
        match context
            .screens
            .all
            .pixels(context.lane, self.projector.bits())
        {
            Some(pixels) => pixels.intersection(self.projector.image()),
            None => self.clipped_region(context),
        }
    }

    /// The pixels that the triangles can touch that go and come, where some are clipped.
    #[cold]
    fn clipped_region(&self, context: &ProbeContext<'_>) -> PixelRect {
        let mut region = PixelRect::EMPTY;
        let mut add = |face: &Face| {
            region = region.union(clipped_pixels(face, &self.projector, self.view.cull));
        };
        for &id in &context.edit.gone {
            add(&self.flat_face(context, id));
        }
        for face in &context.edit.fresh {
            add(&self.flat_face_after(context, face));
        }
        region
    }

    /// True where a triangle that stays in its place and looks different is seen.
    fn restyles(&self, context: &ProbeContext<'_>) -> bool {
        !self.plain && context.edit.restyled.iter().any(|f| context.sees(f.id))
    }

    /// True where the fresh triangles are behind everything that is seen around their box.
    #[inline]
    fn is_hidden(&self, context: &ProbeContext<'_>) -> bool {
        let fresh = &context.screens.fresh;
        let Some(pixels) = fresh.pixels(context.lane, self.projector.bits()) else {
            return false;
        };
        let pixels = pixels.intersection(self.projector.image());
        self.hi_z.hides(pixels, fresh.nearest(context.lane))
    }

    /// Fills the slots of the region with lower bounds, and finds the pixels that show a triangle that goes.
    fn enter(&self, context: &ProbeContext<'_>, delta: &mut ViewDelta) {
        delta.begin(self.region(context));
        delta.entered = true;
        let uncovers = context.uncovers();
        let region = delta.region;
        let width = region.width();
        let fates = context.edit.fates();
        let mut count = 0;
        for (row, y) in (region.y0..region.y1).enumerate() {
            let from = y as usize * self.width + region.x0 as usize;
            let start = row << delta.shift;
            let slots = &mut delta.slots[start..start + width];
            delta.who[start..start + width].fill(0);
            let shown = &self.lists.shown()[from..from + width];
            if !uncovers {
                for (slot, shown) in slots.iter_mut().zip(shown) {
                    *slot = shown.least_key();
                }
                continue;
            }
            for (x, (slot, shown)) in slots.iter_mut().zip(shown).enumerate() {
                *slot = shown.least_key();
                delta.touched[count] = (start + x) as u32;
                count += usize::from(fates[shown.id() as usize] == 1);
            }
        }
        for &at in &delta.touched[..count] {
            let (x, y) = delta.place(at);
            delta.slots[at as usize] = self.lists.bound(self.tile(x, y));
            delta.who[at as usize] = 1;
        }
        delta.count = count;
    }

    /// True where a fresh key is seen at a pixel for which [`ViewDelta::may_win`] holds.
    #[inline]
    fn wins(&self, context: &ProbeContext<'_>, delta: &ViewDelta, at: u32, key: SampleKey) -> bool {
        key < delta.slots[at as usize] || self.wins_exactly(context, delta, at, key)
    }

    /// True where a fresh key that is not below the slot of a pixel, a lower bound, is seen there all the same.
    fn wins_exactly(
        &self,
        context: &ProbeContext<'_>,
        delta: &ViewDelta,
        at: u32,
        key: SampleKey,
    ) -> bool {
        match delta.who[at as usize] {
            0 => key < self.lists.nearest(delta.sample(at, self.width)),
            1 => key < self.behind(context, delta, at),
            _ => false,
        }
    }

    /// The key that a pixel shows when the triangles that go are gone and nothing comes.
    #[inline]
    fn behind(&self, context: &ProbeContext<'_>, delta: &ViewDelta, at: u32) -> SampleKey {
        let sample = delta.sample(at, self.width);
        self.lists.below(sample, |id| context.edit.goes(id))
    }

    /// Lets the fresh triangles compete for the pixels they cover.
    fn draw_fresh(&self, context: &ProbeContext<'_>, delta: &mut ViewDelta) {
        let (bits, image) = (self.projector.bits(), self.projector.image());
        let uncovers = context.uncovers();
        for face in &context.edit.fresh {
            let corners = face.corners.map(|c| match c.moved() {
                Some(entry) => context.screens.moved.corner(entry, context.lane),
                None => context
                    .part
                    .vertices
                    .corner(c.vertex as usize, context.lane),
            });
            if let [Some(a), Some(b), Some(c)] = corners {
                match SmallTriangle::fit([a, b, c], bits, self.view.cull, image) {
                    Fit::Nothing => continue,
                    Fit::Small(small) => {
                        if !uncovers && self.hi_z.hides(small.bounds, small.nearest()) {
                            continue;
                        }
                        if !delta.entered {
                            self.enter(context, delta);
                        }
                        if self.draw_small(context, &small, face.id, delta) {
                            let piece = self.piece(context, face, delta);
                            delta.pieces.push(piece);
                        }
                        continue;
                    }
                    Fit::Large => {}
                }
            }
            if !delta.entered {
                self.enter(context, delta);
            }
            let whole = self.face_after(context, face, &delta.intensities);
            whole.pieces(&self.projector, self.view.cull, |setup, paint| {
                if self.draw_large(context, setup, face.id, delta) {
                    delta.pieces.push(Piece {
                        level: match paint {
                            Paint::Flat(level) => *level,
                            _ => 0,
                        },
                        shaded: (!self.plain).then_some((*setup, *paint)),
                    });
                }
            });
        }
    }

    /// Lets a small triangle compete under the next number; true where it won a pixel.
    #[inline]
    fn draw_small(
        &self,
        context: &ProbeContext<'_>,
        small: &SmallTriangle,
        id: u32,
        delta: &mut ViewDelta,
    ) -> bool {
        let origin = (delta.region.x0, delta.region.y0);
        let covered = small.list(origin, delta.shift, &mut delta.covered);
        let number = delta.pieces.len() as u32 + 2;
        let mut any = false;
        for j in 0..covered {
            let (at, above) = (delta.covered.at[j], delta.covered.above[j]);
            let key = SampleKey::new(small.depth(above), id);
            if delta.may_win(at, key) && self.wins(context, delta, at, key) {
                delta.win(at, key, number);
                any = true;
            }
        }
        any
    }

    /// Lets a triangle of any size compete under the next number; true where it won a pixel.
    fn draw_large(
        &self,
        context: &ProbeContext<'_>,
        setup: &Setup,
        id: u32,
        delta: &mut ViewDelta,
    ) -> bool {
        let region = delta.region;
        let number = delta.pieces.len() as u32 + 2;
        let mut any = false;
        setup.fragments(region, |x, y, depth| {
            let at = ((y - region.y0) as u32) << delta.shift | (x - region.x0) as u32;
            let key = SampleKey::new(depth, id);
            if delta.may_win(at, key) && self.wins(context, delta, at, key) {
                delta.win(at, key, number);
                any = true;
            }
        });
        any
    }

    /// Level or paint of a small fresh triangle.
    #[inline]
    fn piece(&self, context: &ProbeContext<'_>, face: &EditedFace, delta: &ViewDelta) -> Piece {
        if self.plain {
            return Piece {
                level: self.level(&face.geometry),
                shaded: None,
            };
        }
        let face = self.face_after(context, face, &delta.intensities);
        let setup = Setup::new(
            face.screen,
            self.projector.bits(),
            self.view.cull,
            self.projector.image(),
        );
        Piece {
            level: 0,
            shaded: setup.map(|setup| (setup, face.paint)),
        }
    }

    /// Finds the luma of every touched pixel.
    fn tone(&self, context: &ProbeContext<'_>, delta: &mut ViewDelta) {
        delta.tones.clear();
        for j in 0..delta.count {
            let at = delta.touched[j];
            let tone = match delta.who[at as usize].checked_sub(2) {
                Some(piece) => {
                    let piece = &delta.pieces[piece as usize];
                    match &piece.shaded {
                        None => piece.level,
                        Some((setup, paint)) => {
                            let (x, y) = delta.place(at);
                            paint.luma(setup, x, y)
                        }
                    }
                }
                None => {
                    let key = self.behind(context, delta, at);
                    delta.slots[at as usize] = key;
                    if self.plain {
                        self.levels[key.id() as usize]
                    } else {
                        self.luma_behind(context, key.id(), delta.place(at), &delta.intensities)
                    }
                }
            };
            delta.tones.push(tone);
        }
    }

    /// Finds the luma of pixels that keep their triangle where it looks different.
    fn restyle(&self, context: &ProbeContext<'_>, delta: &mut ViewDelta) {
        let (bits, image) = (self.projector.bits(), self.projector.image());
        for after in &context.edit.restyled {
            if !context.sees(after.id) {
                continue;
            }
            let face = self.face_after(context, after, &delta.intensities);
            let whole = match face.screen.iter().any(ScreenVertex::is_outside) {
                true => None,
                false => Setup::new(face.screen, bits, self.view.cull, image),
            };
            let bounds = match &whole {
                Some(setup) => setup.bounds(),
                None => clipped_pixels(&face, &self.projector, self.view.cull),
            };
            for y in bounds.y0..bounds.y1 {
                let start = y as usize * self.width;
                let row = start + bounds.x0 as usize..start + bounds.x1 as usize;
                let shown = &self.lists.shown()[row];
                delta
                    .columns
                    .resize(shown.len().max(delta.columns.len()), 0);
                let mut count = 0;
                for (x, shown) in (bounds.x0..).zip(shown) {
                    delta.columns[count] = x;
                    count += usize::from(shown.id() == after.id);
                }
                for i in 0..count {
                    let x = delta.columns[i];
                    if delta.entered && delta.is_touched(x, y) {
                        continue;
                    }
                    let luma = match &whole {
                        Some(setup) => face.paint.luma(setup, x, y),
                        None => self.luma_at(&face, (x, y)),
                    };
                    delta.restyled.push(([x as u16, y as u16], luma));
                }
            }
        }
    }

    /// Sums what the touched and restyled samples add to the squared differences.
    fn sum(&self, delta: &mut ViewDelta) -> i64 {
        let shown = self.lists.shown();
        let mut total = 0;
        if self.samples == 0 {
            let add = |sample: usize, tone: u8| {
                let [y0, now] = [shown[sample].reference(), shown[sample].luma()];
                difference(u16::from(y0), u16::from(now), u16::from(tone))
            };
            for (&at, &tone) in delta.touched[..delta.count].iter().zip(&delta.tones) {
                total += add(delta.sample(at, self.width), tone);
            }
            for &([x, y], tone) in &delta.restyled {
                total += add(usize::from(y) * self.width + usize::from(x), tone);
            }
            return total;
        }
        let ViewDelta { deltas, pixels, .. } = delta;
        let (mut deltas, mut pixels) = (std::mem::take(deltas), std::mem::take(pixels));
        deltas.resize(self.sums.len(), 0);
        pixels.clear();
        let mut add = |x: i32, y: i32, tone: u8| {
            let sample = y as usize * self.width + x as usize;
            let pixel = self.pixel(x, y);
            if deltas[pixel] == 0 {
                pixels.push(pixel as u32);
            }
            deltas[pixel] += i32::from(tone) - i32::from(shown[sample].luma());
        };
        for (&at, &tone) in delta.touched[..delta.count].iter().zip(&delta.tones) {
            let (x, y) = delta.place(at);
            add(x, y, tone);
        }
        for &([x, y], tone) in &delta.restyled {
            add(i32::from(x), i32::from(y), tone);
        }
        for &pixel in &pixels {
            let delta = std::mem::take(&mut deltas[pixel as usize]);
            let [y0, now] = self.sums[pixel as usize];
            total += difference(y0, now, (i32::from(now) + delta) as u16);
        }
        (delta.deltas, delta.pixels) = (deltas, pixels);
        total
    }
}
