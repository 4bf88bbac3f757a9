//! The z-buffer: the nearest triangle at every sample, and how deep it is there.
//!
//! Most triangles of a large mesh are smaller than a sample: they are told from their bounding box alone. Small ones
//! are tested at every sample of the box, without anything that only shading needs; the others go through
//! [`Setup`](super::Setup). Every way leads to the same keys: the minimum of [`SampleKey`]s is commutative and
//! associative, so parts of the triangles can be drawn on their own and merged, and neither the number of parts nor
//! the order of triangles changes a bit.

use super::{
    Drawn, Grid, Paint, PixelRect, Projector, SampleKey, Scene, coverage::quotient,
    projector::ScreenPoint, setup::is_top_left,
};
use crate::{
    num::fixed::SubpixelBits,
    parallel,
    view::{Cull, View, ViewSet},
};

/// Triangles below which a picture is not worth splitting into parts.
const PART: usize = 32_768;

/// Up to this width and height, in samples, a bounding box is small.
const SMALL: i32 = 8;

/// A z-buffer whose memory is used again for every picture it draws.
#[derive(Clone, Debug)]
pub struct ZBuffer {
    limit: usize,
    points: Vec<ScreenPoint>,
    parts: Vec<Grid<SampleKey>>,
    dropped: u64,
}

impl ZBuffer {
    /// A buffer that draws on at most `threads` threads. Choose 1 where pictures are drawn in parallel.
    pub fn new(threads: usize) -> Self {
        Self {
            limit: threads.max(1),
            points: Vec::new(),
            parts: vec![Grid::filled(0, 0, SampleKey::BACKGROUND)],
            dropped: 0,
        }
    }

    /// Draws a scene as `view` sees it, in place of what was there.
    pub fn draw(&mut self, scene: &Scene, view: &View, set: &ViewSet) {
        let projector = Projector::new(view, set);
        let image = projector.image();
        let (width, height) = (image.x1 as u32, image.y1 as u32);
        let count = scene.triangle_count();
        let parts = count.div_ceil(PART).clamp(1, self.limit);
        self.parts
            .resize_with(parts, || Grid::filled(0, 0, SampleKey::BACKGROUND));
        for plane in &mut self.parts {
            if (plane.width(), plane.height()) != (width, height) {
                *plane = Grid::filled(width, height, SampleKey::BACKGROUND);
            }
        }
        let positions = scene.positions();
        self.points.resize(positions.len(), ScreenPoint::OUTSIDE);
        let project = |points: &mut [ScreenPoint], positions: &[glam::DVec3]| {
            for (point, &p) in points.iter_mut().zip(positions) {
                *point = projector.point(p);
            }
        };
        if parts == 1 {
            project(&mut self.points, positions);
            let range = 0..count;
            self.dropped = draw_part(
                scene,
                view,
                &projector,
                &self.points,
                range,
                &mut self.parts[0],
            );
            return;
        }
        let share = positions.len().div_ceil(parts).max(1);
        parallel::for_chunks(&mut self.points, share, |i, points| {
            project(points, &positions[i * share..]);
        });
        let points = &self.points;
        let dropped = parallel::sum_mut(&mut self.parts, &|i, plane| {
            let range = i * count / parts..(i + 1) * count / parts;
            draw_part(scene, view, &projector, points, range, plane) as i64
        });
        self.dropped = dropped as u64;
        let [first, others @ ..] = self.parts.as_mut_slice() else {
            return;
        };
        let rows = (first.values().len() / parts).max(1);
        parallel::for_chunks(first.values_mut(), rows, |i, keys| {
            for other in others.iter() {
                let other = &other.values()[i * rows..][..keys.len()];
                for (key, &k) in keys.iter_mut().zip(other) {
                    *key = (*key).min(k);
                }
            }
        });
    }

    /// The key of the nearest triangle at every sample of the last picture.
    pub fn keys(&self) -> &Grid<SampleKey> {
        &self.parts[0]
    }

    /// Triangles of the last picture that could not be drawn because a coordinate is not finite after the transform.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// The keys of the last picture, without a copy.
    pub(super) fn into_keys(mut self) -> Grid<SampleKey> {
        self.parts.swap_remove(0)
    }
}

/// Draws some of the triangles; returns how many were dropped.
fn draw_part(
    scene: &Scene,
    view: &View,
    projector: &Projector,
    points: &[ScreenPoint],
    range: std::ops::Range<usize>,
    plane: &mut Grid<SampleKey>,
) -> u64 {
    let image = projector.image();
    let bits = projector.bits();
    let keys = plane.values_mut();
    keys.fill(SampleKey::BACKGROUND);
    let mut dropped = 0;
    let triangles = scene.triangles()[range.clone()].iter();
    for (triangle, t) in triangles.zip(range) {
        let corners = triangle.map(|v| points[v as usize]);
        let [a, b, c] = corners;
        let (left, right) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let (top, bottom) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
        if left == ScreenPoint::OUTSIDE.x {
            dropped += u64::from(draw_any(scene, view, projector, t, keys));
            continue;
        }
        let hull = PixelRect::with_centers_in([left, right], [top, bottom], bits);
        if hull.is_empty() {
            continue;
        }
        if hull.x1 - hull.x0 > SMALL || hull.y1 - hull.y0 > SMALL {
            dropped += u64::from(draw_any(scene, view, projector, t, keys));
            continue;
        }
        let bounds = hull.intersection(image);
        if !bounds.is_empty()
            && !draw_small(
                corners,
                bits,
                view.cull,
                bounds,
                scene.id(t),
                image.x1,
                keys,
            )
        {
            dropped += u64::from(draw_any(scene, view, projector, t, keys));
        }
    }
    dropped
}

/// Tests every sample of `bounds`. False, and nothing drawn, where 64 bits do not hold the depths.
#[inline]
fn draw_small(
    [a, mut b, mut c]: [ScreenPoint; 3],
    bits: SubpixelBits,
    cull: Cull,
    bounds: PixelRect,
    id: u32,
    stride: i32,
    keys: &mut [SampleKey],
) -> bool {
    // No depth of the triangle is nearer than its nearest corner.
    let depth_min = a.depth.min(b.depth).min(c.depth);
    let nearest = SampleKey::new(depth_min, id);
    if bounds.x1 - bounds.x0 == 1
        && bounds.y1 - bounds.y0 == 1
        && keys[bounds.y0 as usize * stride as usize + bounds.x0 as usize] <= nearest
    {
        return true;
    }
    let difference = |from: i32, to: i32| i64::from(to - from);
    let mut area =
        difference(a.x, b.x) * difference(a.y, c.y) - difference(a.y, b.y) * difference(a.x, c.x);
    if area == 0 || (area > 0 && cull == Cull::Back) || (area < 0 && cull == Cull::Front) {
        return true;
    }
    if area < 0 {
        (b, c) = (c, b);
        area = -area;
    }
    let above = [a, b, c].map(|p| i64::from(p.depth - depth_min));
    let depth_range = above[0].max(above[1]).max(above[2]);
    if area.leading_zeros() + depth_range.leading_zeros() < 66 {
        return false;
    }
    // Edge i is opposite to corner i: its value at the first centre, its steps, and 1 unless it is a top or left edge.
    let (x, y) = (
        (bounds.x0 << bits.bits()) + bits.scale() / 2,
        (bounds.y0 << bits.bits()) + bits.scale() / 2,
    );
    let edge = |from: ScreenPoint, to: ScreenPoint| {
        let (dx, dy) = (difference(from.x, to.x), difference(from.y, to.y));
        let value = dx * difference(from.y, y) - dy * difference(from.x, x);
        let bias = i64::from(!is_top_left(dx, dy));
        (value, -dy << bits.bits(), dx << bits.bits(), bias)
    };
    let (mut row0, x0, y0, bias0) = edge(b, c);
    let (mut row1, x1, y1, bias1) = edge(c, a);
    let (mut row2, x2, y2, bias2) = edge(a, b);
    for y in bounds.y0..bounds.y1 {
        let (mut w0, mut w1, mut w2) = (row0, row1, row2);
        let start = y as usize * stride as usize;
        for key in &mut keys[start + bounds.x0 as usize..start + bounds.x1 as usize] {
            // No depth of the triangle is nearer than its nearest corner.
            if ((w0 - bias0) | (w1 - bias1) | (w2 - bias2)) >= 0 && nearest < *key {
                let sum = w0 * above[0] + w1 * above[1] + w2 * above[2];
                let depth = depth_min + quotient(sum, area);
                *key = (*key).min(SampleKey::new(depth, id));
            }
            w0 += x0;
            w1 += x1;
            w2 += x2;
        }
        row0 += y0;
        row1 += y1;
        row2 += y2;
    }
    true
}

/// Draws a triangle of any size, clipped where it must be; true where it was dropped.
#[inline(never)]
fn draw_any(
    scene: &Scene,
    view: &View,
    projector: &Projector,
    t: usize,
    keys: &mut [SampleKey],
) -> bool {
    let image = projector.image();
    let face = scene.painted(t, projector, Paint::Flat(0));
    let id = scene.id(t);
    let pieces = face.pieces(projector, view.cull, |setup, _| {
        setup.fragments(image, |x, y, depth| {
            let at = y as usize * image.x1 as usize + x as usize;
            keys[at] = keys[at].min(SampleKey::new(depth, id));
        });
    });
    pieces == Drawn::Dropped
}
