//! One view of the layers engine: what a change does to its picture, and how the change is made.
//!
//! A look at a change goes through the pixels of the bounding box of the triangles that go and come. Where one that goes
//! is the nearest, the next layer that stays takes its place; then the fresh triangles compete for every pixel they
//! cover. Triangles that only look different are visited where they are seen.

use glam::DVec3;

use super::{
    Change, Face, FaceGeometry, Model, Paint, Projector, Region, ScreenVertex, Setup, Shader,
    draw::EMPTY,
    lanes::{Boxes, Lanes, clipped_pixels},
    prepare::{After, Fate, Prepared},
    small::{Covered, Fit, Small},
    stacks::Stacks,
    unrender::difference,
};
use crate::{
    num::fixed::level,
    view::{Interpolation, View, ViewSet},
};

/// Samples in a row and column of a tile, as a power of two.
const TILE: u32 = 3;

/// What a look in any view of a part needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around<'a> {
    pub(super) model: &'a Model,
    pub(super) change: &'a Change<'a>,
    pub(super) prepared: &'a Prepared,
    /// Vertices as they are, and those that move as they will be.
    pub(super) lanes: &'a Lanes,
    pub(super) moved: &'a Lanes,
    /// Intensities by vertex and view; empty without Gouraud shading.
    pub(super) intensities: &'a [f64],
    /// Boxes of the fresh triangles, and of all that go and come.
    pub(super) fresh: &'a Boxes,
    pub(super) all: &'a Boxes,
    /// Views, one bit for each, in which a triangle that goes is seen.
    pub(super) uncovers: u64,
    /// Where a triangle is seen, by triangle.
    pub(super) seen: &'a [u64],
    pub(super) lane: usize,
    pub(super) lane_count: usize,
}

/// A fresh triangle, or a piece of one, that won a pixel.
#[derive(Clone, Copy, Debug)]
struct Piece {
    level: u8,
    /// What pixels need that have no level in common.
    shaded: Option<(Setup, Paint)>,
}

/// Buffers of a look, and what it found.
#[derive(Clone, Debug, Default)]
pub(super) struct Look {
    /// The pixels that may change, and the logarithm of the stride of the buffers below.
    region: Region,
    shift: u32,
    /// What the pixels of the region show afterwards.
    slots: Vec<u64>,
    /// By pixel: 0 as before, 1 what was behind, more is a piece.
    who: Vec<u32>,
    /// Pixels of the region that show something else, and their luma afterwards.
    touched: Vec<u32>,
    count: usize,
    tones: Vec<u8>,
    /// Samples of the picture that only look different, and their luma afterwards.
    restyled: Vec<(u32, u8)>,
    /// After [`LayerView::apply`]: for every touched sample the triangle that it showed and the one it shows; ids above
    /// the last triangle are the background.
    swaps: Vec<(u32, u32)>,
    pieces: Vec<Piece>,
    covered: Covered,
    /// By pixel of the picture: the change of the sum of its samples; 0 between looks.
    deltas: Vec<i32>,
    pixels: Vec<u32>,
    /// New intensities of the vertices in [`Change::normals`], where this view needs them.
    intensities: Vec<f64>,
}

/// A picture with all its layers.
#[derive(Clone, Debug)]
pub(super) struct LayerView {
    view: View,
    pub(super) projector: Projector,
    shader: Shader,
    /// Flat shading of white triangles: a level for every triangle, and that of the background.
    levels: Vec<u8>,
    plain: bool,
    gouraud: bool,
    background: u8,
    pub(super) stacks: Stacks,
    /// Luma of every sample.
    pub(super) luma: Vec<u8>,
    /// Sums of every pixel: the reference and now.
    sums: Vec<[u16; 2]>,
    /// The greatest depth that is seen in every tile.
    tiles: Vec<u32>,
    width: usize,
    /// Logarithm of the samples in a row of a pixel.
    samples: u32,
}

impl LayerView {
    pub(super) fn new(
        model: &Model,
        view: &View,
        set: &ViewSet,
        reference: &[u16],
        colored: bool,
    ) -> Self {
        let projector = Projector::new(view, set);
        let shader = Shader::new(view);
        let image = projector.image();
        let (width, height) = (image.width(), image.height());
        let gouraud = view.shading.interpolation == Interpolation::Gouraud;
        let count = model.corners.len();
        let mut pictures = Self {
            view: *view,
            shader,
            levels: Vec::new(),
            plain: !gouraud && !colored,
            gouraud,
            background: set.background,
            stacks: Stacks::new(width * height, u64::from(u32::MAX) << 32 | count as u64),
            luma: vec![set.background; width * height],
            sums: Vec::new(),
            tiles: vec![u32::MAX; width.div_ceil(1 << TILE) * height.div_ceil(1 << TILE)],
            width,
            samples: set.samples.trailing_zeros(),
            projector,
        };
        if pictures.plain {
            let levels = model.corners.iter().map(|c| {
                let geometry = FaceGeometry::new(c.map(|v| model.positions[v as usize]));
                level(
                    pictures
                        .shader
                        .intensity(geometry.centroid, geometry.normal),
                )
            });
            pictures.levels = levels.collect();
            pictures.levels.push(set.background);
        }
        let screen: Vec<ScreenVertex> = model
            .positions
            .iter()
            .map(|&p| pictures.projector.screen(p))
            .collect();
        for id in 0..count as u32 {
            let corners = model.corners[id as usize];
            let intensities = corners.map(|v| pictures.vertex_intensity(model, v));
            let face = Face {
                positions: corners.map(|v| model.positions[v as usize]),
                screen: corners.map(|v| screen[v as usize]),
                paint: pictures.paint_now(model, id, intensities),
            };
            let Self {
                stacks,
                luma,
                projector,
                ..
            } = &mut pictures;
            face.pieces(projector, view.cull, |setup, paint| {
                setup.fragments(image, |x, y, depth| {
                    let at = y as usize * width + x as usize;
                    let key = u64::from(depth) << 32 | u64::from(id);
                    if key < stacks.nearest()[at] {
                        luma[at] = paint.luma(setup, x, y);
                    }
                    stacks.insert(at, key);
                });
            });
        }
        pictures.sums = reference.iter().map(|&y0| [y0, 0]).collect();
        for at in 0..pictures.luma.len() {
            let pixel = pictures.pixel(at);
            pictures.sums[pixel][1] += u16::from(pictures.luma[at]);
        }
        pictures.measure_tiles(image);
        pictures
    }

    /// The keys of the picture as everyone else writes them.
    pub(super) fn keys(&self) -> Vec<u64> {
        let nothing = self.stacks.nothing();
        let keys = self.stacks.nearest().iter();
        keys.map(|&k| if k == nothing { EMPTY } else { k })
            .collect()
    }

    /// True where pixels of a triangle differ in luma.
    pub(super) fn is_shaded(&self) -> bool {
        !self.plain
    }

    /// True where vertices have intensities.
    pub(super) fn is_gouraud(&self) -> bool {
        self.gouraud
    }

    /// The intensity of a vertex of the model; 0 without Gouraud shading.
    pub(super) fn vertex_intensity(&self, model: &Model, vertex: u32) -> f64 {
        if self.gouraud {
            let v = vertex as usize;
            self.shader.intensity(model.positions[v], model.normals[v])
        } else {
            0.0
        }
    }

    /// What a triangle of the model looks like.
    fn paint_now(&self, model: &Model, id: u32, intensities: [f64; 3]) -> Paint {
        let colors = model.colors.get(id as usize);
        if self.gouraud {
            Paint::gouraud(intensities, colors)
        } else if self.plain {
            Paint::Flat(self.levels[id as usize])
        } else {
            let corners = model.corners[id as usize].map(|v| model.positions[v as usize]);
            let geometry = FaceGeometry::new(corners);
            Paint::flat(
                self.shader.intensity(geometry.centroid, geometry.normal),
                colors,
            )
        }
    }

    /// The pixel of a sample.
    #[inline]
    fn pixel(&self, at: usize) -> usize {
        if self.samples == 0 {
            return at;
        }
        let (y, x) = (at / self.width, at % self.width);
        (y >> self.samples) * (self.width >> self.samples) + (x >> self.samples)
    }

    /// A triangle of the model on this screen.
    fn face_now(&self, around: &Around<'_>, id: u32) -> Face {
        let model = around.model;
        let corners = model.corners[id as usize];
        let intensities = corners.map(|v| {
            let at = v as usize * around.lane_count + around.lane;
            around.intensities.get(at).copied().unwrap_or(0.0)
        });
        Face {
            positions: corners.map(|v| model.positions[v as usize]),
            screen: corners.map(|v| around.lanes.screen(v as usize, around.lane)),
            paint: self.paint_now(model, id, intensities),
        }
    }

    /// A triangle after the change on this screen; `shaded` are the new intensities.
    fn face_after(&self, around: &Around<'_>, face: &After, shaded: &[f64]) -> Face {
        let colors = (!around.model.colors.is_empty()).then_some(&face.colors);
        let paint = if self.gouraud {
            let intensity = |c: super::prepare::Corner| match c.shaded() {
                Some(entry) => shaded[entry],
                None => around.intensities[c.vertex as usize * around.lane_count + around.lane],
            };
            Paint::gouraud(face.corners.map(intensity), colors)
        } else {
            let g = &face.geometry;
            Paint::flat(self.shader.intensity(g.centroid, g.normal), colors)
        };
        Face {
            positions: face.positions,
            screen: face.corners.map(|c| match c.moved() {
                Some(entry) => around.moved.screen(entry, around.lane),
                None => around.lanes.screen(c.vertex as usize, around.lane),
            }),
            paint,
        }
    }

    /// What the change does to the squared differences of this view.
    pub(super) fn look(&self, around: &Around<'_>, look: &mut Look) -> i64 {
        let (lane, bits, image) = (around.lane, self.projector.bits(), self.projector.image());
        look.count = 0;
        look.restyled.clear();
        look.pieces.clear();
        let uncovers = around.uncovers >> lane & 1 != 0;
        let restyles = self.restyles(around);
        let boxes = around.all.pixels(lane, bits);
        let region = match boxes {
            Some(pixels) => pixels.intersection(image),
            None => self.clipped_region(around),
        };
        look.begin(region);
        let hidden = !uncovers && (region.is_empty() || self.is_hidden(around));
        if hidden && !restyles {
            return 0;
        }
        look.intensities.clear();
        if self.gouraud {
            let normals = around.change.normals.iter();
            look.intensities.extend(normals.map(|&(v, n)| {
                let position = around.model.position_after(around.change, v);
                self.shader.intensity(position, n)
            }));
        }
        if !hidden {
            self.uncover(around, uncovers, look);
            self.draw_fresh(around, look);
            self.tone(around, look);
        }
        if restyles {
            self.restyle(around, look, hidden);
        }
        self.sum(look)
    }

    /// True where a triangle that stays in its place and looks different is seen.
    fn restyles(&self, around: &Around<'_>) -> bool {
        let restyled = &around.prepared.restyled;
        !self.plain
            && restyled
                .iter()
                .any(|f| around.seen[f.id as usize] >> around.lane & 1 != 0)
    }

    /// The pixels that the triangles can touch that go and come, where some are clipped.
    #[cold]
    fn clipped_region(&self, around: &Around<'_>) -> Region {
        let mut region = Region::EMPTY;
        let mut add = |face: &Face| {
            region = region.union(clipped_pixels(face, &self.projector, self.view.cull));
        };
        for &id in &around.prepared.gone {
            add(&self.flat_face(around, id));
        }
        for face in &around.prepared.fresh {
            add(&self.flat_face_after(around, face));
        }
        region
    }

    /// A triangle of the model on this screen, whatever it looks like.
    fn flat_face(&self, around: &Around<'_>, id: u32) -> Face {
        let corners = around.model.corners[id as usize];
        Face {
            positions: corners.map(|v| around.model.positions[v as usize]),
            screen: corners.map(|v| around.lanes.screen(v as usize, around.lane)),
            paint: Paint::Flat(0),
        }
    }

    /// A triangle after the change on this screen, whatever it looks like.
    fn flat_face_after(&self, around: &Around<'_>, face: &After) -> Face {
        Face {
            positions: face.positions,
            screen: face.corners.map(|c| match c.moved() {
                Some(entry) => around.moved.screen(entry, around.lane),
                None => around.lanes.screen(c.vertex as usize, around.lane),
            }),
            paint: Paint::Flat(0),
        }
    }

    /// True where the fresh triangles are behind everything that is seen in the tiles of their box.
    fn is_hidden(&self, around: &Around<'_>) -> bool {
        let Some(pixels) = around.fresh.pixels(around.lane, self.projector.bits()) else {
            return false;
        };
        let pixels = pixels.intersection(self.projector.image());
        if pixels.is_empty() {
            return true;
        }
        let nearest = around.fresh.nearest(around.lane);
        let columns = self.width.div_ceil(1 << TILE);
        let tile = |v: i32| (v >> TILE) as usize;
        (tile(pixels.y0)..=tile(pixels.y1 - 1)).all(|row| {
            let row = &self.tiles[row * columns..][..columns];
            row[tile(pixels.x0)..=tile(pixels.x1 - 1)]
                .iter()
                .all(|&deepest| nearest > deepest)
        })
    }

    /// Fills the slots with what is seen when the triangles that go are gone.
    fn uncover(&self, around: &Around<'_>, uncovers: bool, look: &mut Look) {
        let region = look.region;
        let width = region.width();
        let nearest = self.stacks.nearest();
        let fates = around.prepared.fates();
        let mut count = 0;
        for (row, y) in (region.y0..region.y1).enumerate() {
            let from = y as usize * self.width + region.x0 as usize;
            let start = row << look.shift;
            let slots = &mut look.slots[start..start + width];
            let keys = &nearest[from..from + width];
            if !uncovers {
                slots.copy_from_slice(keys);
                continue;
            }
            for (x, (slot, &key)) in slots.iter_mut().zip(keys).enumerate() {
                *slot = key;
                look.touched[count] = (start + x) as u32;
                count += usize::from(fates[key as u32 as usize] == 1);
            }
        }
        for &at in &look.touched[..count] {
            let sample = look.sample(at, self.width);
            look.slots[at as usize] = self.stacks.below(sample, |id| around.prepared.goes(id));
            look.who[at as usize] = 1;
        }
        look.count = count;
    }

    /// Lets the fresh triangles compete for the slots.
    fn draw_fresh(&self, around: &Around<'_>, look: &mut Look) {
        let (bits, image) = (self.projector.bits(), self.projector.image());
        for face in &around.prepared.fresh {
            let corners = face.corners.map(|c| match c.moved() {
                Some(entry) => around.moved.corner(entry, around.lane),
                None => around.lanes.corner(c.vertex as usize, around.lane),
            });
            if let [Some(a), Some(b), Some(c)] = corners {
                match Small::new([a, b, c], bits, self.view.cull, image) {
                    Fit::Nothing => continue,
                    Fit::Small(small) => {
                        if look.draw_small(&small, face.id) {
                            let piece = self.piece(around, face, look);
                            look.pieces.push(piece);
                        }
                        continue;
                    }
                    Fit::Large => {}
                }
            }
            let whole = self.face_after(around, face, &look.intensities);
            whole.pieces(&self.projector, self.view.cull, |setup, paint| {
                if look.draw_large(setup, face.id) {
                    look.pieces.push(Piece {
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

    /// What a small fresh triangle looks like.
    #[inline]
    fn piece(&self, around: &Around<'_>, face: &After, look: &Look) -> Piece {
        if self.plain {
            let g = &face.geometry;
            return Piece {
                level: level(self.shader.intensity(g.centroid, g.normal)),
                shaded: None,
            };
        }
        let face = self.face_after(around, face, &look.intensities);
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

    /// The luma of every touched pixel.
    fn tone(&self, around: &Around<'_>, look: &mut Look) {
        look.tones.clear();
        if self.plain {
            let tones = look.touched[..look.count].iter().map(|&at| {
                match look.who[at as usize].checked_sub(2) {
                    Some(piece) => look.pieces[piece as usize].level,
                    None => self.levels[look.slots[at as usize] as u32 as usize],
                }
            });
            look.tones.extend(tones);
            return;
        }
        for &at in &look.touched[..look.count] {
            let (x, y) = look.place(at);
            let piece = look.who[at as usize].checked_sub(2);
            look.tones.push(match piece {
                Some(piece) => match &look.pieces[piece as usize].shaded {
                    Some((setup, paint)) => paint.luma(setup, x, y),
                    None => self.background,
                },
                None => self.luma_behind(
                    around,
                    look.slots[at as usize] as u32,
                    x,
                    y,
                    &look.intensities,
                ),
            });
        }
    }

    /// The luma of a triangle at a pixel that it covers; of the background where `id` is no triangle.
    fn luma_behind(&self, around: &Around<'_>, id: u32, x: i32, y: i32, shaded: &[f64]) -> u8 {
        if id as usize >= around.model.corners.len() {
            return self.background;
        }
        let face = match around.prepared.fate(id) {
            Fate::Restyled(index) => {
                self.face_after(around, &around.prepared.restyled[index], shaded)
            }
            _ => self.face_now(around, id),
        };
        self.luma_at(&face, x, y)
    }

    /// The luma of a face at a pixel that it covers: of the nearest of its pieces.
    fn luma_at(&self, face: &Face, x: i32, y: i32) -> u8 {
        let pixel = Region {
            x0: x,
            y0: y,
            x1: x + 1,
            y1: y + 1,
        };
        let mut nearest = None;
        face.pieces(&self.projector, self.view.cull, |setup, paint| {
            setup.fragments(pixel, |x, y, depth| {
                if nearest.is_none_or(|(least, _)| depth < least) {
                    nearest = Some((depth, paint.luma(setup, x, y)));
                }
            });
        });
        nearest.map_or(self.background, |(_, luma)| luma)
    }

    /// The luma of pixels that keep their triangle, which looks different.
    fn restyle(&self, around: &Around<'_>, look: &mut Look, hidden: bool) {
        let nearest = self.stacks.nearest();
        for after in &around.prepared.restyled {
            if around.seen[after.id as usize] >> around.lane & 1 == 0 {
                continue;
            }
            let face = self.face_after(around, after, &look.intensities);
            let bounds = clipped_pixels(&face, &self.projector, self.view.cull);
            let whole = (!face.screen.iter().any(ScreenVertex::is_outside)).then(|| {
                Setup::new(
                    face.screen,
                    self.projector.bits(),
                    self.view.cull,
                    self.projector.image(),
                )
            });
            for y in bounds.y0..bounds.y1 {
                let row = y as usize * self.width;
                for x in bounds.x0..bounds.x1 {
                    let sample = row + x as usize;
                    if nearest[sample] as u32 != after.id || (!hidden && look.is_touched(x, y)) {
                        continue;
                    }
                    let luma = match &whole {
                        Some(Some(setup)) => face.paint.luma(setup, x, y),
                        _ => self.luma_at(&face, x, y),
                    };
                    look.restyled.push((sample as u32, luma));
                }
            }
        }
    }

    /// What the luma of the touched and restyled samples add to the squared differences.
    fn sum(&self, look: &mut Look) -> i64 {
        let mut total = 0;
        if self.samples == 0 {
            let touched = look.touched[..look.count].iter().zip(&look.tones);
            for (&at, &tone) in touched {
                let [y0, now] = self.sums[look.sample(at, self.width)];
                total += difference(y0, now, u16::from(tone));
            }
            for &(sample, tone) in &look.restyled {
                let [y0, now] = self.sums[sample as usize];
                total += difference(y0, now, u16::from(tone));
            }
            return total;
        }
        look.deltas.resize(self.sums.len(), 0);
        let mut add = |pixels: &mut Vec<u32>, sample: usize, tone: u8| {
            let pixel = self.pixel(sample);
            if look.deltas[pixel] == 0 {
                pixels.push(pixel as u32);
            }
            look.deltas[pixel] += i32::from(tone) - i32::from(self.luma[sample]);
        };
        look.pixels.clear();
        for (&at, &tone) in look.touched[..look.count].iter().zip(&look.tones) {
            let place = (at >> look.shift, at & ((1 << look.shift) - 1));
            let sample = (look.region.y0 as usize + place.0 as usize) * self.width
                + look.region.x0 as usize
                + place.1 as usize;
            add(&mut look.pixels, sample, tone);
        }
        for &(sample, tone) in &look.restyled {
            add(&mut look.pixels, sample as usize, tone);
        }
        for &pixel in &look.pixels {
            let delta = std::mem::take(&mut look.deltas[pixel as usize]);
            let [y0, now] = self.sums[pixel as usize];
            total += difference(y0, now, (i32::from(now) + delta) as u16);
        }
        total
    }

    /// Makes the change that the look has seen.
    pub(super) fn apply(&mut self, around: &Around<'_>, look: &mut Look) {
        look.swaps.clear();
        // (1) The picture.
        for i in 0..look.count {
            let at = look.touched[i];
            let sample = look.sample(at, self.width);
            self.recolor(sample, look.tones[i]);
            look.swaps.push((
                self.stacks.nearest()[sample] as u32,
                look.slots[at as usize] as u32,
            ));
        }
        for &(sample, tone) in &look.restyled {
            self.recolor(sample as usize, tone);
        }
        // (2) The layers.
        for &id in &around.prepared.gone {
            let face = self.flat_face(around, id);
            let (width, stacks) = (self.width, &mut self.stacks);
            look.fragments(
                &face,
                &self.projector,
                self.view.cull,
                width,
                |sample, _| {
                    stacks.remove(sample, id);
                },
            );
        }
        for after in &around.prepared.fresh {
            let face = self.flat_face_after(around, after);
            let (width, stacks) = (self.width, &mut self.stacks);
            look.fragments(
                &face,
                &self.projector,
                self.view.cull,
                width,
                |sample, depth| {
                    stacks.insert(sample, u64::from(depth) << 32 | u64::from(after.id));
                },
            );
            if self.plain {
                let g = &after.geometry;
                self.levels[after.id as usize] = level(self.shader.intensity(g.centroid, g.normal));
            }
        }
        // (3) What is derived from them.
        if look.count > 0 {
            self.measure_tiles(look.region);
        }
    }

    fn recolor(&mut self, sample: usize, tone: u8) {
        let pixel = self.pixel(sample);
        let old = std::mem::replace(&mut self.luma[sample], tone);
        let sum = &mut self.sums[pixel][1];
        *sum = *sum - u16::from(old) + u16::from(tone);
    }

    /// The intensity of a point with a normal.
    pub(super) fn intensity(&self, position: DVec3, normal: DVec3) -> f64 {
        self.shader.intensity(position, normal)
    }

    /// Finds the greatest visible depth of every tile that meets the region.
    fn measure_tiles(&mut self, region: Region) {
        let columns = self.width.div_ceil(1 << TILE);
        let height = self.projector.image().height();
        let tile = |v: i32| (v >> TILE) as usize;
        for row in tile(region.y0)..=tile(region.y1 - 1) {
            for column in tile(region.x0)..=tile(region.x1 - 1) {
                let (x0, y0) = (column << TILE, row << TILE);
                let (x1, y1) = ((x0 + 8).min(self.width), (y0 + 8).min(height));
                let mut deepest = 0;
                for y in y0..y1 {
                    let keys = &self.stacks.nearest()[y * self.width + x0..y * self.width + x1];
                    deepest = keys
                        .iter()
                        .fold(deepest, |d: u32, &k| d.max((k >> 32) as u32));
                }
                self.tiles[row * columns + column] = deepest;
            }
        }
    }
}

impl Look {
    /// Makes room for a region, and forgets the last one.
    fn begin(&mut self, region: Region) {
        self.region = region;
        self.shift = region.width().next_power_of_two().trailing_zeros();
        let size = region.height() << self.shift;
        if self.slots.len() < size + 1 {
            self.slots.resize(size + 1, 0);
            self.touched.resize(size + 1, 0);
        }
        self.who.clear();
        self.who.resize(size, 0);
    }

    pub(super) fn swaps(&self) -> &[(u32, u32)] {
        &self.swaps
    }

    /// The sample of the picture where a pixel of the region is.
    #[inline]
    fn sample(&self, at: u32, width: usize) -> usize {
        let (row, column) = (at >> self.shift, at & ((1 << self.shift) - 1));
        (self.region.y0 as usize + row as usize) * width + self.region.x0 as usize + column as usize
    }

    /// Column and row of a pixel of the region.
    fn place(&self, at: u32) -> (i32, i32) {
        let (row, column) = (at >> self.shift, at & ((1 << self.shift) - 1));
        (self.region.x0 + column as i32, self.region.y0 + row as i32)
    }

    /// True for pixels of the region that show something else.
    fn is_touched(&self, x: i32, y: i32) -> bool {
        let r = self.region;
        if x < r.x0 || x >= r.x1 || y < r.y0 || y >= r.y1 {
            return false;
        }
        self.who[((y - r.y0) as usize) << self.shift | (x - r.x0) as usize] != 0
    }

    /// Lets a small triangle compete under the next number; true where it won a pixel.
    #[inline]
    fn draw_small(&mut self, small: &Small, id: u32) -> bool {
        let origin = (self.region.x0, self.region.y0);
        let covered = small.list(origin, self.shift, &mut self.covered);
        let number = self.pieces.len() as u32 + 2;
        let list = self.covered.at[..covered].iter().zip(&self.covered.above);
        let mut any = false;
        let mut count = self.count;
        for (&at, &above) in list {
            let key = u64::from(small.depth(above)) << 32 | u64::from(id);
            let i = at as usize;
            let won = key < self.slots[i];
            self.touched[count] = at;
            count += usize::from(won && self.who[i] == 0);
            self.slots[i] = if won { key } else { self.slots[i] };
            self.who[i] = if won { number } else { self.who[i] };
            any |= won;
        }
        self.count = count;
        any
    }

    /// Lets a triangle of any size compete under the next number; true where it won a pixel.
    fn draw_large(&mut self, setup: &Setup, id: u32) -> bool {
        let region = self.region;
        let number = self.pieces.len() as u32 + 2;
        let mut any = false;
        setup.fragments(region, |x, y, depth| {
            let at = (y - region.y0) as usize * (1 << self.shift) + (x - region.x0) as usize;
            let key = u64::from(depth) << 32 | u64::from(id);
            if key < self.slots[at] {
                if self.who[at] == 0 {
                    self.touched[self.count] = at as u32;
                    self.count += 1;
                }
                self.slots[at] = key;
                self.who[at] = number;
                any = true;
            }
        });
        any
    }

    /// Calls `visit(sample, depth)` for every fragment of a face in the region.
    #[inline]
    fn fragments(
        &mut self,
        face: &Face,
        projector: &Projector,
        cull: crate::view::Cull,
        width: usize,
        mut visit: impl FnMut(usize, u32),
    ) {
        if !face.screen.iter().any(ScreenVertex::is_outside) {
            let corners = face.screen.map(|v| super::small::SmallCorner {
                x: v.x,
                y: v.y,
                depth: v.depth,
            });
            match Small::new(corners, projector.bits(), cull, projector.image()) {
                Fit::Nothing => return,
                Fit::Small(small) => {
                    let origin = (self.region.x0, self.region.y0);
                    let count = small.list(origin, self.shift, &mut self.covered);
                    for j in 0..count {
                        let sample = self.sample(self.covered.at[j], width);
                        visit(sample, small.depth(self.covered.above[j]));
                    }
                    return;
                }
                Fit::Large => {}
            }
        }
        face.pieces(projector, cull, |setup, _| {
            setup.fragments(projector.image(), |x, y, depth| {
                visit(y as usize * width + x as usize, depth);
            });
        });
    }
}
