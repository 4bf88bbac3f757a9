//! The ID buffer of one view, drawn into buffers that are used again for the next view.
//!
//! The same pixels as [`raster::keys`](crate::raster::keys), without paint; a test holds the two together.

use super::subdivide::Pieces;
use crate::{
    raster::{Face, Paint, Projector, Region, ScreenVertex, Setup},
    view::{Cull, View, ViewSet},
};

/// The key of a pixel that nothing covers.
pub(super) const EMPTY: u64 = u64::MAX;

/// What one view shows.
#[derive(Clone, Debug, Default)]
pub(super) struct IdPicture {
    /// `depth << 32 | piece` of the nearest piece at every pixel, row by row; [`EMPTY`] for the background.
    pub(super) keys: Vec<u64>,
    /// Number of samples that every piece covers, shown or not; empty where it was not asked for.
    pub(super) covered: Vec<u32>,
    screen: Vec<ScreenVertex>,
}

impl IdPicture {
    /// Draws a view of `pieces`; `count` asks for [`IdPicture::covered`].
    pub(super) fn draw(&mut self, pieces: &Pieces, view: &View, set: &ViewSet, count: bool) {
        let projector = Projector::new(view, set);
        let image = projector.image();
        self.keys.clear();
        self.keys.resize(image.width() * image.height(), EMPTY);
        self.covered.clear();
        self.screen.clear();
        let on_screen = pieces.positions.iter().map(|&p| projector.screen(p));
        self.screen.extend(on_screen);
        for (piece, &corners) in pieces.triangles.iter().enumerate() {
            let screen = corners.map(|v| self.screen[v as usize]);
            let (mut samples, keys) = (0, &mut self.keys);
            if screen.iter().any(ScreenVertex::is_outside) {
                // Rounding can put a vertex on the bounding sphere behind the near plane.
                let face = Face {
                    positions: corners.map(|v| pieces.positions[v as usize]),
                    screen,
                    paint: Paint::Flat(0),
                };
                face.pieces(&projector, Cull::None, |setup, _| {
                    samples += put(setup, piece as u32, image, keys);
                });
            } else if let Some(setup) = Setup::new(screen, projector.bits(), Cull::None, image) {
                samples = put(&setup, piece as u32, image, keys);
            }
            if count {
                self.covered.push(samples);
            }
        }
    }
}

/// Draws a set-up piece; the number of samples it covers.
#[inline]
fn put(setup: &Setup, piece: u32, image: Region, keys: &mut [u64]) -> u32 {
    let mut samples = 0;
    let width = image.x1 as usize;
    setup.fragments(image, |x, y, depth| {
        let at = y as usize * width + x as usize;
        let key = u64::from(depth) << 32 | u64::from(piece);
        if key < keys[at] {
            keys[at] = key;
        }
        samples += 1;
    });
    samples
}
