//! The pictures of one view, and how a change of the mesh changes them.

use glam::DVec3;

use super::{
    super::scene_edit::{EditedFace, Model, SceneEdit, difference},
    lines::{Buckets, Stamps},
};
use crate::{
    num::fixed::level,
    raster::{
        Face, FaceGeometry, Grid, Paint, PixelRect, Projector, SampleKey, ScreenVertex, Setup,
        Shader,
    },
    view::{Interpolation, View, ViewSet},
};

/// One view: its pictures and what is needed to change them.
#[derive(Clone, Debug)]
pub(super) struct BucketView {
    view: View,
    projector: Projector,
    shader: Shader,
    /// Every vertex on the screen.
    screen: Vec<ScreenVertex>,
    /// Flat shading of white triangles: the level of every triangle. Other shadings: empty.
    levels: Vec<u8>,
    /// Gouraud shading: the intensity of every vertex. Other shadings: empty.
    intensities: Vec<f64>,
    /// The pixels every triangle can touch, as it is entered in the buckets.
    extents: Vec<PixelRect>,
    buckets: Buckets,
    pub(super) keys: Grid<SampleKey>,
    pub(super) luma: Grid<u8>,
    /// Luma sums of every pixel of the picture that this one is compared with.
    reference: Grid<u16>,
    background: u8,
}

/// Buffers of a thread that works on some of the views.
#[derive(Clone, Debug, Default)]
pub(super) struct PartScratch {
    stamps: Stamps,
    found: Vec<u32>,
    moved: Vec<ScreenVertex>,
    shaded: Vec<f64>,
    setups: Vec<(u32, Setup, Paint)>,
    added_extents: Vec<PixelRect>,
    keys: Vec<SampleKey>,
    luma: Vec<u8>,
}

impl PartScratch {
    /// Buffers for a model with this number of triangles.
    pub(super) fn new(triangles: usize) -> Self {
        Self {
            stamps: Stamps::new(triangles),
            ..Self::default()
        }
    }
}

impl BucketView {
    pub(super) fn new(model: &Model, view: &View, set: &ViewSet, reference: Grid<u16>) -> Self {
        let projector = Projector::new(view, set);
        let shader = Shader::new(view);
        let image = projector.image();
        let (width, height) = (image.x1 as u32, image.y1 as u32);
        let positions = model.positions.iter();
        let mut pictures = Self {
            view: *view,
            shader,
            screen: positions.map(|&p| projector.screen(p)).collect(),
            levels: Vec::new(),
            intensities: Vec::new(),
            extents: vec![PixelRect::EMPTY; model.corners.len()],
            buckets: Buckets::new(width, height),
            keys: Grid::filled(width, height, SampleKey::BACKGROUND),
            luma: Grid::filled(width, height, set.background),
            reference,
            background: set.background,
            projector,
        };
        match view.shading.interpolation {
            Interpolation::Flat => {
                let points = |c: &[u32; 3]| c.map(|v| model.positions[v as usize]);
                let faces = model.corners.iter().map(|c| FaceGeometry::new(points(c)));
                pictures.levels = faces.map(|face| pictures.level(&face)).collect();
            }
            Interpolation::Gouraud => {
                let vertices = model.positions.iter().zip(&model.normals);
                pictures.intensities = vertices.map(|(&p, &n)| shader.intensity(p, n)).collect();
            }
            Interpolation::Lit => {}
        }
        let (mut keys, mut luma) = (pictures.keys.clone(), pictures.luma.clone());
        for id in 0..model.corners.len() as u32 {
            let mut extent = PixelRect::EMPTY;
            pictures
                .face(model, id)
                .pieces(&pictures.projector, view.cull, |setup, paint| {
                    extent = extent.union(setup.bounds());
                    let (keys, luma) = (keys.values_mut(), luma.values_mut());
                    draw(setup, paint, id, [image; 2], keys, luma);
                });
            pictures.extents[id as usize] = extent;
            pictures.buckets.insert(id, extent);
        }
        (pictures.keys, pictures.luma) = (keys, luma);
        pictures
    }

    /// The flat level of a white triangle.
    fn level(&self, geometry: &FaceGeometry) -> u8 {
        level(self.shader.intensity(geometry.centroid, geometry.normal))
    }

    /// A triangle as it is now.
    #[inline]
    fn face(&self, model: &Model, id: u32) -> Face {
        let corners = model.corners[id as usize];
        let positions = corners.map(|v| model.positions[v as usize]);
        let colors = model.colors.get(id as usize);
        let paint = match self.view.shading.interpolation {
            Interpolation::Flat if colors.is_none() => Paint::Flat(self.levels[id as usize]),
            Interpolation::Flat => {
                let g = FaceGeometry::new(positions);
                Paint::flat(self.shader.intensity(g.centroid, g.normal), colors)
            }
            Interpolation::Gouraud => {
                Paint::gouraud(corners.map(|v| self.intensities[v as usize]), colors)
            }
            Interpolation::Lit => {
                let normals = model.stored_normals.get(id as usize);
                Paint::gouraud(self.shader.lit(positions, normals), colors)
            }
        };
        Face {
            positions,
            screen: corners.map(|v| self.screen[v as usize]),
            paint,
        }
    }

    /// An added triangle as it will be.
    fn face_after(
        &self,
        model: &Model,
        added: &EditedFace,
        (moved, shaded): (&[ScreenVertex], &[f64]),
    ) -> Face {
        let colors = model.colors_after(added);
        let paint = match self.view.shading.interpolation {
            Interpolation::Flat => {
                let g = &added.geometry;
                Paint::flat(self.shader.intensity(g.centroid, g.normal), colors)
            }
            Interpolation::Gouraud => {
                let intensities = added.corners.map(|c| match c.shaded() {
                    Some(entry) => shaded[entry],
                    None => self.intensities[c.vertex as usize],
                });
                Paint::gouraud(intensities, colors)
            }
            Interpolation::Lit => {
                let normals = model.normals_after(added);
                Paint::gouraud(self.shader.lit(added.positions, normals), colors)
            }
        };
        Face {
            positions: added.positions,
            screen: added.corners.map(|c| match c.moved() {
                Some(entry) => moved[entry],
                None => self.screen[c.vertex as usize],
            }),
            paint,
        }
    }

    /// Draws what the region of the change shows after it into the scratch planes, and returns the region.
    pub(super) fn redraw(
        &self,
        model: &Model,
        edit: &SceneEdit,
        scratch: &mut PartScratch,
    ) -> PixelRect {
        let region = self.set_up(model, edit, scratch);
        scratch.keys.clear();
        scratch.luma.clear();
        if region.is_empty() {
            return region;
        }
        let uncovered = self.clear_removed(edit, region, scratch);
        let PartScratch {
            stamps,
            found,
            setups,
            keys,
            luma,
            ..
        } = scratch;
        if !uncovered.is_empty() {
            self.buckets.query(uncovered, stamps, found);
            let cull = self.view.cull;
            for &id in found.iter() {
                let face = self.face(model, id);
                face.pieces(&self.projector, cull, |setup, paint| {
                    draw(setup, paint, id, [uncovered, region], keys, luma);
                });
            }
        }
        for (id, setup, paint) in setups {
            draw(setup, paint, *id, [region; 2], keys, luma);
        }
        region
    }

    /// Sets up the added triangles, and returns the bounding box of those that go and come.
    fn set_up(&self, model: &Model, edit: &SceneEdit, scratch: &mut PartScratch) -> PixelRect {
        let moved = edit.moved.iter().map(|m| self.projector.screen(m.1));
        scratch.moved.clear();
        scratch.moved.extend(moved);
        scratch.shaded.clear();
        if !self.intensities.is_empty() {
            let normals = edit.normals.iter();
            let intensity =
                |&(v, n): &(u32, DVec3)| self.shader.intensity(model.position_after(edit, v), n);
            scratch.shaded.extend(normals.map(intensity));
        }
        let mut region = PixelRect::EMPTY;
        for id in edit.before() {
            region = region.union(self.extents[id as usize]);
        }
        scratch.setups.clear();
        scratch.added_extents.clear();
        for added in edit.after() {
            let face = self.face_after(model, added, (&scratch.moved, &scratch.shaded));
            let mut extent = PixelRect::EMPTY;
            face.pieces(&self.projector, self.view.cull, |setup, paint| {
                extent = extent.union(setup.bounds());
                scratch.setups.push((added.id, *setup, *paint));
            });
            scratch.added_extents.push(extent);
            region = region.union(extent);
        }
        region
    }

    /// Copies the region to the scratch planes, the background where it shows a removed triangle, and returns the
    /// bounding box of such pixels.
    fn clear_removed(
        &self,
        edit: &SceneEdit,
        region: PixelRect,
        scratch: &mut PartScratch,
    ) -> PixelRect {
        scratch.stamps.leave_out(edit.before());
        let mut uncovered = PixelRect::EMPTY;
        for y in region.y0..region.y1 {
            let start = y as usize * self.luma.width() as usize;
            let row = start + region.x0 as usize..start + region.x1 as usize;
            let keys = &self.keys.values()[row.clone()];
            let shown = keys.iter().zip(&self.luma.values()[row]);
            for (x, (&key, &luma)) in (region.x0..).zip(shown) {
                if !key.is_background() && scratch.stamps.is_left_out(key.id()) {
                    scratch.keys.push(SampleKey::BACKGROUND);
                    scratch.luma.push(self.background);
                    uncovered = uncovered.union(PixelRect::pixel(x, y));
                } else {
                    scratch.keys.push(key);
                    scratch.luma.push(luma);
                }
            }
        }
        uncovered
    }

    /// Returns what the drawn region would add to the squared differences; the pixels that it meets are summed anew.
    pub(super) fn difference(&self, region: PixelRect, scratch: &PartScratch) -> i64 {
        if region.is_empty() {
            return 0;
        }
        let samples = (self.luma.width() / self.reference.width()) as i32;
        let (width, columns) = (region.width(), self.luma.width() as usize);
        let mut total = 0;
        for y in region.y0 / samples..=(region.y1 - 1) / samples {
            for x in region.x0 / samples..=(region.x1 - 1) / samples {
                let (mut old, mut new) = (0, 0);
                for sy in y * samples..(y + 1) * samples {
                    for sx in x * samples..(x + 1) * samples {
                        let now = self.luma.values()[sy as usize * columns + sx as usize];
                        let inside = (region.x0..region.x1).contains(&sx)
                            && (region.y0..region.y1).contains(&sy);
                        let at = |x: i32, y: i32| {
                            (y - region.y0) as usize * width + (x - region.x0) as usize
                        };
                        old += u16::from(now);
                        new += u16::from(if inside {
                            scratch.luma[at(sx, sy)]
                        } else {
                            now
                        });
                    }
                }
                if old != new {
                    total += difference(self.reference.at(x as u32, y as u32), old, new);
                }
            }
        }
        total
    }

    /// Makes the change that [`BucketView::redraw`] has drawn.
    pub(super) fn apply(&mut self, edit: &SceneEdit, region: PixelRect, scratch: &PartScratch) {
        for id in edit.before() {
            self.buckets.remove(id, self.extents[id as usize]);
            self.extents[id as usize] = PixelRect::EMPTY;
        }
        for (added, extent) in edit.after().zip(&scratch.added_extents) {
            self.extents[added.id as usize] = *extent;
            self.buckets.insert(added.id, *extent);
            if !self.levels.is_empty() {
                self.levels[added.id as usize] = self.level(&added.geometry);
            }
        }
        for (&(v, _), &screen) in edit.moved.iter().zip(&scratch.moved) {
            self.screen[v as usize] = screen;
        }
        for (&(v, _), &intensity) in edit.normals.iter().zip(&scratch.shaded) {
            self.intensities[v as usize] = intensity;
        }
        let (width, stride) = (region.width(), self.luma.width() as usize);
        let keys = scratch.keys.chunks_exact(width.max(1));
        let rows = keys.zip(scratch.luma.chunks_exact(width.max(1)));
        for (y, (keys, luma)) in rows.enumerate() {
            let start = (region.y0 as usize + y) * stride + region.x0 as usize;
            self.keys.values_mut()[start..start + width].copy_from_slice(keys);
            self.luma.values_mut()[start..start + width].copy_from_slice(luma);
        }
    }
}

/// Draws a set-up triangle into the part `within` of planes that hold `region`.
#[inline]
fn draw(
    setup: &Setup,
    paint: &Paint,
    id: u32,
    [within, region]: [PixelRect; 2],
    keys: &mut [SampleKey],
    luma: &mut [u8],
) {
    let width = region.width();
    setup.fragments(within, |x, y, depth| {
        let at = (y - region.y0) as usize * width + (x - region.x0) as usize;
        let key = SampleKey::new(depth, id);
        if key < keys[at] {
            keys[at] = key;
            luma[at] = paint.luma(setup, x, y);
        }
    });
}
