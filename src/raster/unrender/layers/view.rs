//! One view of the layers engine: its picture with all layers, and what triangles look like in it.

use super::{
    super::scene_edit::{EditedFace, Model, SceneEdit},
    Part, Screens,
    fragment_lists::{FragmentLists, HiZ, TILE},
};
use crate::{
    num::fixed::level,
    raster::{Face, FaceGeometry, Paint, PixelRect, Projector, SampleKey, ScreenVertex, Shader},
    view::{Interpolation, View, ViewSet},
};

/// Input of [`LayerView::probe`]: an edit, projected to all views of a part, and the view in hand.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProbeContext<'a> {
    pub(super) model: &'a Model,
    pub(super) edit: &'a SceneEdit,
    pub(super) part: &'a Part,
    pub(super) screens: &'a Screens,
    pub(super) lane: usize,
}

impl ProbeContext<'_> {
    /// True where a triangle that goes is seen in the view.
    #[inline]
    pub(super) fn uncovers(&self) -> bool {
        self.screens.uncovers >> self.lane & 1 != 0
    }

    /// True where a triangle is seen in the view.
    #[inline]
    pub(super) fn sees(&self, id: u32) -> bool {
        self.part.seen[id as usize] >> self.lane & 1 != 0
    }

    /// Place of a vertex among the intensities.
    #[inline]
    fn intensity(&self, vertex: u32) -> usize {
        vertex as usize * self.part.indices.len() + self.lane
    }
}

/// A picture with all its layers.
#[derive(Clone, Debug)]
pub(super) struct LayerView {
    pub(super) view: View,
    pub(super) projector: Projector,
    pub(super) shader: Shader,
    /// Flat shading of white triangles: a level for every triangle, and that of the background.
    pub(super) levels: Vec<u8>,
    /// Flat shading of white triangles.
    pub(super) plain: bool,
    pub(super) gouraud: bool,
    pub(super) background: u8,
    pub(super) lists: FragmentLists,
    /// By pixel, the luma sums of the reference and of the picture; empty where pixels have one sample.
    pub(super) sums: Vec<[u16; 2]>,
    pub(super) hi_z: HiZ,
    pub(super) width: usize,
    pub(super) tile_columns: usize,
    /// Logarithm of the samples in a row of a pixel.
    pub(super) samples: u32,
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
        let image = projector.image();
        let (width, height) = (image.width(), image.height());
        let tile_columns = width.div_ceil(1 << TILE);
        let tiles = tile_columns * height.div_ceil(1 << TILE);
        let gouraud = view.shading.interpolation == Interpolation::Gouraud;
        let count = model.corners.len();
        let single: Vec<u8> = match set.samples {
            1 => reference.iter().map(|&y0| y0 as u8).collect(),
            _ => Vec::new(),
        };
        // The id after the last triangle: tables by id have an entry for the background.
        let nothing = SampleKey::new(u32::MAX, count as u32);
        let mut pictures = Self {
            view: *view,
            shader: Shader::new(view),
            levels: Vec::new(),
            plain: view.shading.interpolation == Interpolation::Flat && !colored,
            gouraud,
            background: set.background,
            lists: FragmentLists::new(width * height, set.background, &single, tiles, nothing),
            sums: Vec::new(),
            hi_z: HiZ::new(image),
            width,
            tile_columns,
            samples: set.samples.trailing_zeros(),
            projector,
        };
        if pictures.plain {
            let levels = model.corners.iter().map(|c| {
                pictures.level(&FaceGeometry::new(c.map(|v| model.positions[v as usize])))
            });
            pictures.levels = levels.collect();
            pictures.levels.push(set.background);
        }
        pictures.draw(model);
        if set.samples > 1 {
            pictures.sums = reference.iter().map(|&y0| [y0, 0]).collect();
            for at in 0..width * height {
                let pixel = pictures.pixel((at % width) as i32, (at / width) as i32);
                pictures.sums[pixel][1] += u16::from(pictures.lists.shown()[at].luma());
            }
        }
        pictures.hi_z.measure(image, image, pictures.lists.shown());
        pictures
    }

    /// Draws all triangles into the empty picture.
    fn draw(&mut self, model: &Model) {
        let positions = model.positions.iter();
        let screen: Vec<ScreenVertex> = positions.map(|&p| self.projector.screen(p)).collect();
        let nothing = self.lists.nothing();
        let mut lists =
            std::mem::replace(&mut self.lists, FragmentLists::new(0, 0, &[], 0, nothing));
        for id in 0..model.corners.len() as u32 {
            let corners = model.corners[id as usize];
            let intensities = corners.map(|v| self.vertex_intensity(model, v));
            let face = Face {
                positions: corners.map(|v| model.positions[v as usize]),
                screen: corners.map(|v| screen[v as usize]),
                paint: self.paint_now(model, id, intensities),
            };
            face.pieces(&self.projector, self.view.cull, |setup, paint| {
                setup.fragments(self.projector.image(), |x, y, depth| {
                    let at = y as usize * self.width + x as usize;
                    let key = SampleKey::new(depth, id);
                    if key < lists.nearest(at) {
                        lists.set_luma(at, paint.luma(setup, x, y));
                    }
                    lists.insert(at, self.tile(x, y), key);
                });
            });
        }
        self.lists = lists;
    }

    /// The luma of every sample.
    pub(super) fn luma(&self) -> Vec<u8> {
        self.lists.shown().iter().map(|s| s.luma()).collect()
    }

    /// The keys of the picture as everyone else writes them.
    pub(super) fn keys(&self) -> Vec<SampleKey> {
        let nothing = self.lists.nothing();
        let keys = (0..self.lists.shown().len()).map(|at| self.lists.nearest(at));
        keys.map(|k| {
            if k == nothing {
                SampleKey::BACKGROUND
            } else {
                k
            }
        })
        .collect()
    }

    /// The tile of a sample.
    #[inline]
    pub(super) fn tile(&self, x: i32, y: i32) -> usize {
        (y >> TILE) as usize * self.tile_columns + (x >> TILE) as usize
    }

    /// The flat level of a white triangle.
    #[inline]
    pub(super) fn level(&self, geometry: &FaceGeometry) -> u8 {
        level(self.shader.intensity(geometry.centroid, geometry.normal))
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

    /// Paint of a triangle of the model.
    pub(super) fn paint_now(&self, model: &Model, id: u32, intensities: [f64; 3]) -> Paint {
        let colors = model.colors.get(id as usize);
        let corners = || model.corners[id as usize].map(|v| model.positions[v as usize]);
        match self.view.shading.interpolation {
            Interpolation::Flat if self.plain => Paint::Flat(self.levels[id as usize]),
            Interpolation::Flat => {
                let g = FaceGeometry::new(corners());
                Paint::flat(self.shader.intensity(g.centroid, g.normal), colors)
            }
            Interpolation::Gouraud => Paint::gouraud(intensities, colors),
            Interpolation::Lit => {
                let normals = model.stored_normals.get(id as usize);
                Paint::gouraud(self.shader.lit(corners(), normals), colors)
            }
        }
    }

    /// The pixel of a sample.
    #[inline]
    pub(super) fn pixel(&self, x: i32, y: i32) -> usize {
        (y as usize >> self.samples) * (self.width >> self.samples) + (x as usize >> self.samples)
    }

    /// A triangle of the model on this screen.
    pub(super) fn face_now(&self, context: &ProbeContext<'_>, id: u32) -> Face {
        let model = context.model;
        let corners = model.corners[id as usize];
        let intensities = corners.map(|v| {
            let known = context.part.intensities.get(context.intensity(v));
            known.copied().unwrap_or(0.0)
        });
        Face {
            paint: self.paint_now(model, id, intensities),
            ..self.flat_face(context, id)
        }
    }

    /// A triangle after the change on this screen; `shaded` are the new intensities.
    pub(super) fn face_after(
        &self,
        context: &ProbeContext<'_>,
        face: &EditedFace,
        shaded: &[f64],
    ) -> Face {
        let colors = context.model.colors_after(face);
        let paint = match self.view.shading.interpolation {
            Interpolation::Flat => {
                let g = &face.geometry;
                Paint::flat(self.shader.intensity(g.centroid, g.normal), colors)
            }
            Interpolation::Gouraud => {
                let intensities = face.corners.map(|c| match c.shaded() {
                    Some(entry) => shaded[entry],
                    None => context.part.intensities[context.intensity(c.vertex)],
                });
                Paint::gouraud(intensities, colors)
            }
            Interpolation::Lit => {
                let normals = context.model.normals_after(face);
                Paint::gouraud(self.shader.lit(face.positions, normals), colors)
            }
        };
        Face {
            paint,
            ..self.flat_face_after(context, face)
        }
    }

    /// A triangle of the model on this screen, whatever it looks like.
    pub(super) fn flat_face(&self, context: &ProbeContext<'_>, id: u32) -> Face {
        let corners = context.model.corners[id as usize];
        Face {
            positions: corners.map(|v| context.model.positions[v as usize]),
            screen: corners.map(|v| context.part.vertices.screen(v as usize, context.lane)),
            paint: Paint::Flat(0),
        }
    }

    /// A triangle after the change on this screen, whatever it looks like.
    pub(super) fn flat_face_after(&self, context: &ProbeContext<'_>, face: &EditedFace) -> Face {
        Face {
            positions: face.positions,
            screen: face.corners.map(|c| match c.moved() {
                Some(entry) => context.screens.moved.screen(entry, context.lane),
                None => context
                    .part
                    .vertices
                    .screen(c.vertex as usize, context.lane),
            }),
            paint: Paint::Flat(0),
        }
    }

    /// The luma of a triangle at a pixel that it covers; of the background where `id` is no triangle.
    pub(super) fn luma_behind(
        &self,
        context: &ProbeContext<'_>,
        id: u32,
        place: (i32, i32),
        shaded: &[f64],
    ) -> u8 {
        if id as usize >= context.model.corners.len() {
            return self.background;
        }
        let face = match context.edit.restyled(id) {
            Some(after) => self.face_after(context, after, shaded),
            None => self.face_now(context, id),
        };
        self.luma_at(&face, place)
    }

    /// The luma of a face at a pixel that it covers: of the nearest of its pieces.
    pub(super) fn luma_at(&self, face: &Face, (x, y): (i32, i32)) -> u8 {
        let pixel = PixelRect::pixel(x, y);
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
}
