//! Projected vertices: every vertex on the screens of several views at once, so that what a change needs of all views
//! lies together. A lane is a view of these.

use crate::{
    num::fixed::SubpixelBits,
    raster::{Face, PixelRect, Projector, ScreenVertex, draw::projector::ScreenPoint},
};

/// Columns, rows and depths of one vertex in every view: three runs of `lanes` values.
///
/// Depths are stored as signed integers, 2^31 less, because processors compare those in lanes.
#[derive(Clone, Debug)]
pub(super) struct Projected {
    lanes: usize,
    places: Vec<i32>,
    /// 1/w by vertex and view; empty where nothing is interpolated.
    w_inverse: Vec<f64>,
}

impl Projected {
    /// Zeros for `vertices` vertices in `lanes` views; `shaded` where attributes are interpolated in one of them.
    pub(super) fn new(lanes: usize, vertices: usize, shaded: bool) -> Self {
        Self {
            lanes,
            places: vec![0; vertices * 3 * lanes],
            w_inverse: vec![0.0; if shaded { vertices * lanes } else { 0 }],
        }
    }

    /// Makes room for this number of vertices.
    pub(super) fn resize(&mut self, vertices: usize) {
        let room = vertices * 3 * self.lanes;
        if self.places.len() < room {
            self.places.resize(room, 0);
        }
        if self.w_inverse.len() < vertices * self.lanes && self.interpolates() {
            self.w_inverse.resize(vertices * self.lanes, 0.0);
        }
    }

    fn interpolates(&self) -> bool {
        !self.w_inverse.is_empty()
    }

    /// Puts a vertex on one screen.
    #[inline]
    pub(super) fn set(&mut self, vertex: usize, lane: usize, at: ScreenVertex) {
        let start = vertex * 3 * self.lanes + lane;
        self.places[start] = at.x;
        self.places[start + self.lanes] = at.y;
        self.places[start + 2 * self.lanes] = (at.depth ^ 1 << 31) as i32;
        if self.interpolates() {
            self.w_inverse[vertex * self.lanes + lane] = at.w_inverse;
        }
    }

    /// Copies a vertex of `from` to all screens.
    pub(super) fn copy(&mut self, vertex: usize, from: &Self, entry: usize) {
        let run = 3 * self.lanes;
        self.places[vertex * run..][..run].copy_from_slice(&from.places[entry * run..][..run]);
        if self.interpolates() {
            self.w_inverse[vertex * self.lanes..][..self.lanes]
                .copy_from_slice(&from.w_inverse[entry * self.lanes..][..self.lanes]);
        }
    }

    /// A vertex on one screen; `None` where triangles with it need clipping.
    #[inline]
    pub(super) fn corner(&self, vertex: usize, lane: usize) -> Option<ScreenPoint> {
        let start = vertex * 3 * self.lanes + lane;
        let x = self.places[start];
        (x != ScreenVertex::OUTSIDE.x).then(|| ScreenPoint {
            x,
            y: self.places[start + self.lanes],
            depth: self.places[start + 2 * self.lanes] as u32 ^ 1 << 31,
        })
    }

    /// A vertex on one screen with all it has; 1/w is 0 where nothing is interpolated.
    #[inline]
    pub(super) fn screen(&self, vertex: usize, lane: usize) -> ScreenVertex {
        match self.corner(vertex, lane) {
            None => ScreenVertex::OUTSIDE,
            Some(ScreenPoint { x, y, depth }) => ScreenVertex {
                x,
                y,
                depth,
                w_inverse: *self
                    .w_inverse
                    .get(vertex * self.lanes + lane)
                    .unwrap_or(&0.0),
            },
        }
    }
}

/// Bounding boxes in every view: columns, rows, and the least depth.
#[derive(Clone, Debug, Default)]
pub(super) struct ScreenBoxes {
    x_min: Vec<i32>,
    x_max: Vec<i32>,
    y_min: Vec<i32>,
    y_max: Vec<i32>,
    depth_min: Vec<i32>,
}

impl ScreenBoxes {
    /// Makes the boxes empty, one for every view.
    pub(super) fn clear(&mut self, lanes: usize) {
        let most = [&mut self.x_min, &mut self.y_min, &mut self.depth_min];
        for list in most {
            list.clear();
            list.resize(lanes, i32::MAX);
        }
        for list in [&mut self.x_max, &mut self.y_max] {
            list.clear();
            list.resize(lanes, i32::MIN);
        }
    }

    /// Adds a vertex.
    #[inline]
    pub(super) fn add(&mut self, vertices: &Projected, vertex: usize) {
        let n = vertices.lanes;
        let run = &vertices.places[vertex * 3 * n..][..3 * n];
        let (x, rest) = run.split_at(n);
        let (y, depth) = rest.split_at(n);
        let least = |list: &mut [i32], values: &[i32]| {
            for (l, &v) in list.iter_mut().zip(values) {
                *l = (*l).min(v);
            }
        };
        let greatest = |list: &mut [i32], values: &[i32]| {
            for (l, &v) in list.iter_mut().zip(values) {
                *l = (*l).max(v);
            }
        };
        least(&mut self.x_min, x);
        greatest(&mut self.x_max, x);
        least(&mut self.y_min, y);
        greatest(&mut self.y_max, y);
        least(&mut self.depth_min, depth);
    }

    /// Becomes a copy of another.
    pub(super) fn copy(&mut self, other: &Self) {
        let pairs = [
            (&mut self.x_min, &other.x_min),
            (&mut self.x_max, &other.x_max),
            (&mut self.y_min, &other.y_min),
            (&mut self.y_max, &other.y_max),
            (&mut self.depth_min, &other.depth_min),
        ];
        for (to, from) in pairs {
            to.clone_from(from);
        }
    }

    /// The pixels whose centres the box of a view contains, anywhere; `None` where a vertex of it is outside.
    #[inline]
    pub(super) fn pixels(&self, lane: usize, bits: SubpixelBits) -> Option<PixelRect> {
        let x_min = self.x_min[lane];
        if x_min == ScreenVertex::OUTSIDE.x {
            return None;
        }
        if x_min == i32::MAX {
            return Some(PixelRect::EMPTY);
        }
        let columns = [x_min, self.x_max[lane]];
        let rows = [self.y_min[lane], self.y_max[lane]];
        Some(PixelRect::with_centers_in(columns, rows, bits))
    }

    /// The least depth of the vertices in the box of a view.
    #[inline]
    pub(super) fn nearest(&self, lane: usize) -> u32 {
        self.depth_min[lane] as u32 ^ 1 << 31
    }
}

/// The pixels that the pieces of a clipped face can touch.
#[cold]
pub(super) fn clipped_pixels(
    face: &Face,
    projector: &Projector,
    cull: crate::view::Cull,
) -> PixelRect {
    let mut extent = PixelRect::EMPTY;
    face.pieces(projector, cull, |setup, _| {
        extent = extent.union(setup.bounds())
    });
    extent
}
