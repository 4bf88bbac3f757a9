//! Whole pictures: every pixel is the minimum over `(depth, id)` of the triangles that cover it.
//!
//! The minimum is commutative and associative, so chunks of triangles can be drawn on their own and merged: neither
//! the number of threads nor the order of triangles changes a bit.

use rayon::prelude::*;

use super::{Paint, Pieces, Plane, Projector, Scene, ScreenVertex, Setup, Shader};
use crate::view::{View, ViewSet};

/// The key of a sample that nothing covers: behind everything.
pub(super) const EMPTY: u64 = u64::MAX;

/// Triangles below which a picture is not worth splitting into chunks.
const CHUNK: usize = 32_768;

/// A picture of one view, at sample resolution.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture<T> {
    /// `depth << 32 | id` of the nearest triangle, or `u64::MAX` for the background.
    pub keys: Plane<u64>,
    /// What it looks like there.
    pub tones: Plane<T>,
    /// Triangles that could not be drawn because a coordinate is not finite after the transform.
    pub dropped: u64,
}

/// What a picture stores of a paint: nothing, luma, or red, green and blue.
trait Tone: Copy + Send + Sync {
    fn of(paint: &Paint, setup: &Setup, x: i32, y: i32) -> Self;
}

impl Tone for () {
    #[inline]
    fn of(_: &Paint, _: &Setup, _: i32, _: i32) -> Self {}
}

impl Tone for u8 {
    #[inline]
    fn of(paint: &Paint, setup: &Setup, x: i32, y: i32) -> Self {
        paint.luma(setup, x, y)
    }
}

impl Tone for [u8; 3] {
    #[inline]
    fn of(paint: &Paint, setup: &Setup, x: i32, y: i32) -> Self {
        paint.rgb(setup, x, y)
    }
}

fn draw<T: Tone>(scene: &Scene, view: &View, set: &ViewSet, background: T) -> Picture<T> {
    let projector = Projector::new(view, set);
    let screen = scene.project(&projector);
    let intensities = scene.intensities(view);
    let shader = Shader::new(view);
    let count = scene.triangle_count();
    let chunks = count
        .div_ceil(CHUNK)
        .min(rayon::current_num_threads())
        .max(1);
    let part = |chunk: usize| {
        let range = chunk * count / chunks..(chunk + 1) * count / chunks;
        draw_range(
            scene,
            view,
            &projector,
            (&screen, &intensities, &shader),
            range,
            background,
        )
    };
    if chunks == 1 {
        return part(0);
    }
    let mut parts = (0..chunks)
        .into_par_iter()
        .map(part)
        .collect::<Vec<_>>()
        .into_iter();
    let mut picture = parts.next().expect("at least one chunk");
    for other in parts {
        picture.dropped += other.dropped;
        let tones = picture
            .tones
            .values_mut()
            .iter_mut()
            .zip(other.tones.values());
        for ((key, &k), (tone, &t)) in picture
            .keys
            .values_mut()
            .iter_mut()
            .zip(other.keys.values())
            .zip(tones)
        {
            if k < *key {
                *key = k;
                *tone = t;
            }
        }
    }
    picture
}

fn draw_range<T: Tone>(
    scene: &Scene,
    view: &View,
    projector: &Projector,
    (screen, intensities, shader): (&[ScreenVertex], &[f64], &Shader),
    triangles: std::ops::Range<usize>,
    background: T,
) -> Picture<T> {
    let image = projector.image();
    let (width, height) = (image.x1 as u32, image.y1 as u32);
    let mut keys = Plane::filled(width, height, EMPTY);
    let mut tones = Plane::filled(width, height, background);
    let mut dropped = 0;
    for t in triangles {
        let id = u64::from(scene.id(t));
        let drawn = scene.face(t, shader, screen, intensities).pieces(
            projector,
            view.cull,
            |setup, paint| {
                let (keys, tones) = (keys.values_mut(), tones.values_mut());
                setup.fragments(image, |x, y, depth| {
                    let at = y as usize * width as usize + x as usize;
                    let key = u64::from(depth) << 32 | id;
                    if key < keys[at] {
                        keys[at] = key;
                        tones[at] = T::of(paint, setup, x, y);
                    }
                });
            },
        );
        dropped += u64::from(drawn == Pieces::Dropped);
    }
    Picture {
        keys,
        tones,
        dropped,
    }
}

/// Which triangle is nearest at every sample, and how deep: see [`Picture::keys`].
#[must_use]
pub fn keys(scene: &Scene, view: &View, set: &ViewSet) -> Picture<()> {
    draw(scene, view, set, ())
}

/// Luma at every sample, 0 to 255; the set's background where nothing is.
#[must_use]
pub fn luma(scene: &Scene, view: &View, set: &ViewSet) -> Picture<u8> {
    draw(scene, view, set, set.background)
}

/// Red, green and blue at every sample; a grey of the set's background where nothing is.
#[must_use]
pub fn rgb(scene: &Scene, view: &View, set: &ViewSet) -> Picture<[u8; 3]> {
    draw(scene, view, set, [set.background; 3])
}

/// Triangle ids of a picture: id + 1, and 0 for the background.
#[must_use]
pub fn ids<T>(picture: &Picture<T>) -> Plane<u32> {
    picture
        .keys
        .map(|k| if k == EMPTY { 0 } else { k as u32 + 1 })
}

/// Depths of a picture in units of 2^-32; `u32::MAX` for the background.
#[must_use]
pub fn depths<T>(picture: &Picture<T>) -> Plane<u32> {
    picture.keys.map(|k| (k >> 32) as u32)
}

/// Coverage of a picture: 255 where a triangle is, 0 elsewhere.
#[must_use]
pub fn coverage<T>(picture: &Picture<T>) -> Plane<u8> {
    picture.keys.map(|k| if k == EMPTY { 0 } else { 255 })
}
