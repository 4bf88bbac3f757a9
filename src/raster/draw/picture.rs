//! Whole pictures: every pixel is the minimum over `(depth, id)` of the triangles that cover it.
//!
//! The z-buffer finds the triangles; then only those that are seen are shaded, each where it is seen.

use super::{
    FaceGeometry, Grid, Paint, Projector, SampleKey, Scene, Setup, Shader, zbuffer::ZBuffer,
};
use crate::{
    num::fixed,
    parallel,
    view::{Interpolation, View, ViewSet},
};

/// A picture of one view, at sample resolution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture<T> {
    /// The nearest triangle of every sample, and how deep it is there.
    pub keys: Grid<SampleKey>,
    /// Luma or colour of every sample.
    pub tones: Grid<T>,
    /// Triangles that could not be drawn because a coordinate is not finite after the transform.
    pub dropped: u64,
}

impl Picture<[u8; 3]> {
    /// Luma at every sample: the same bits as [`luma`] draws.
    pub fn luma(&self) -> Grid<u8> {
        self.tones.map(fixed::luma)
    }
}

fn draw<T: Copy>(
    scene: &Scene,
    view: &View,
    set: &ViewSet,
    tones: impl FnOnce(&Grid<SampleKey>) -> Grid<T>,
) -> Picture<T> {
    let mut buffer = ZBuffer::new(parallel::threads());
    buffer.draw(scene, view, set);
    let dropped = buffer.dropped();
    let keys = buffer.into_keys();
    Picture {
        tones: tones(&keys),
        keys,
        dropped,
    }
}

/// Shades the samples of one picture, and remembers what the next sample may need again.
struct Shading<'a> {
    scene: &'a Scene,
    view: &'a View,
    projector: Projector,
    shader: Shader,
    /// Gouraud shading: the intensity of every vertex that was needed, else NaN.
    intensities: Vec<f64>,
    /// The triangle whose pieces are at hand.
    id: Option<u32>,
    pieces: Vec<(Setup, Paint)>,
}

impl<'a> Shading<'a> {
    fn new(scene: &'a Scene, view: &'a View, set: &ViewSet) -> Self {
        let gouraud = view.shading.interpolation == Interpolation::Gouraud;
        let vertices = if gouraud { scene.positions().len() } else { 0 };
        Self {
            scene,
            view,
            projector: Projector::new(view, set),
            shader: Shader::new(view),
            intensities: vec![f64::NAN; vertices],
            id: None,
            pieces: Vec::new(),
        }
    }

    /// The paint of a whole triangle.
    fn paint(&mut self, t: usize) -> Paint {
        let scene = self.scene;
        let colors = scene.colors().get(t);
        match self.view.shading.interpolation {
            Interpolation::Flat => {
                let g = FaceGeometry::new(scene.points(t));
                Paint::flat(self.shader.intensity(g.centroid, g.normal), colors)
            }
            Interpolation::Gouraud => {
                let corners = scene.triangles()[t].map(|v| self.intensity(v as usize));
                Paint::gouraud(corners, colors)
            }
            Interpolation::Lit => {
                let corners = self
                    .shader
                    .lit(scene.points(t), scene.stored_normals().get(t));
                Paint::gouraud(corners, colors)
            }
        }
    }

    /// The Gouraud intensity of a vertex.
    fn intensity(&mut self, v: usize) -> f64 {
        if self.intensities[v].is_nan() {
            let (point, normal) = (self.scene.positions()[v], self.scene.normals()[v]);
            self.intensities[v] = self.shader.intensity(point, normal);
        }
        self.intensities[v]
    }

    /// Applies `tone` to the piece that the sample shows; `background` where it shows none.
    fn tone<T: Copy>(
        &mut self,
        key: SampleKey,
        (x, y): (i32, i32),
        background: T,
        tone: impl Fn(&Paint, &Setup, i32, i32) -> T,
    ) -> T {
        if key.is_background() {
            return background;
        }
        let id = key.id();
        if self.id != Some(id) {
            self.id = Some(id);
            self.pieces.clear();
            if let Some(t) = self.scene.triangle_of(id) {
                let paint = self.paint(t);
                let face = self.scene.painted(t, &self.projector, paint);
                let pieces = &mut self.pieces;
                face.pieces(&self.projector, self.view.cull, |setup, paint| {
                    pieces.push((*setup, *paint));
                });
            }
        }
        // A triangle that had to be clipped covers the sample with one of its pieces.
        let shown = match self.pieces.as_slice() {
            [only] => Some(only),
            several => several.iter().find(|(setup, _)| setup.covers(x, y)),
        };
        shown.map_or(background, |(setup, paint)| tone(paint, setup, x, y))
    }

    /// Every sample of a picture with these keys.
    fn plane<T: Copy>(
        mut self,
        keys: &Grid<SampleKey>,
        background: T,
        tone: impl Fn(&Paint, &Setup, i32, i32) -> T,
    ) -> Grid<T> {
        let mut tones = Grid::filled(keys.width(), keys.height(), background);
        let width = keys.width() as usize;
        let rows = keys.values().chunks_exact(width.max(1));
        for (y, (keys, row)) in rows
            .zip(tones.values_mut().chunks_exact_mut(width.max(1)))
            .enumerate()
        {
            for (x, (&key, value)) in keys.iter().zip(row).enumerate() {
                *value = self.tone(key, (x as i32, y as i32), background, &tone);
            }
        }
        tones
    }

    /// True where every triangle has one level.
    fn is_flat_white(&self) -> bool {
        let flat = self.view.shading.interpolation == Interpolation::Flat;
        flat && self.scene.colors().is_empty()
    }

    /// As [`Shading::plane`] for levels, where every triangle has one.
    fn levels(mut self, keys: &Grid<SampleKey>, background: u8) -> Grid<u8> {
        const UNKNOWN: u16 = u16::MAX;
        let mut levels = vec![UNKNOWN; self.scene.triangle_count()];
        keys.map(|key| {
            let shown = (!key.is_background()).then(|| self.scene.triangle_of(key.id()));
            let Some(t) = shown.flatten() else {
                return background;
            };
            if levels[t] == UNKNOWN
                && let Paint::Flat(level) = self.paint(t)
            {
                levels[t] = u16::from(level);
            }
            levels[t] as u8
        })
    }
}

/// Draws the nearest triangle of every sample, and how deep it is: see [`Picture::keys`]. Where many pictures are drawn, a
/// [`ZBuffer`] does the same and keeps its memory.
pub fn keys(scene: &Scene, view: &View, set: &ViewSet) -> Picture<()> {
    draw(scene, view, set, |keys| keys.map(|_| ()))
}

/// Draws the luma of every sample, 0 to 255; the set's background where nothing is.
pub fn luma(scene: &Scene, view: &View, set: &ViewSet) -> Picture<u8> {
    draw(scene, view, set, |keys| {
        let shading = Shading::new(scene, view, set);
        if shading.is_flat_white() {
            shading.levels(keys, set.background)
        } else {
            shading.plane(keys, set.background, Paint::luma)
        }
    })
}

/// Draws red, green and blue of every sample; a grey of the set's background where nothing is.
pub fn rgb(scene: &Scene, view: &View, set: &ViewSet) -> Picture<[u8; 3]> {
    draw(scene, view, set, |keys| {
        let shading = Shading::new(scene, view, set);
        if shading.is_flat_white() {
            shading.levels(keys, set.background).map(|v| [v; 3])
        } else {
            shading.plane(keys, [set.background; 3], Paint::rgb)
        }
    })
}

/// Triangle ids of a picture: id + 1, and 0 for the background.
pub fn ids<T>(picture: &Picture<T>) -> Grid<u32> {
    picture
        .keys
        .map(|k| if k.is_background() { 0 } else { k.id() + 1 })
}

/// Depths of a picture in units of 2^-32; `u32::MAX` for the background.
pub fn depths<T>(picture: &Picture<T>) -> Grid<u32> {
    picture.keys.map(SampleKey::depth)
}

/// Coverage of a picture: 255 where a triangle is, 0 elsewhere.
pub fn coverage<T>(picture: &Picture<T>) -> Grid<u8> {
    picture
        .keys
        .map(|k| if k.is_background() { 0 } else { 255 })
}
