//! F(t, v): the part of every triangle that one view sees (Zhang & Turk 2002, section 4).
//!
//! F is a whole number of [`FULL`]ths: all or nothing for a piece, or, as an option, the share of its covered samples
//! that show it (their future work); for a face in pieces the mean over its area. A face of which anything is seen has
//! at least one part, rounded down otherwise, so that "never seen" and "always seen" stay exact.

use super::{MeasureOptions, cameras::Cameras, depth_test::DepthTest, subdivide::Pieces};
use crate::{
    num::Each,
    raster::{Face, Paint, Projector, ZBuffer},
    view::Cull,
};

/// All of a triangle is seen.
pub(super) const FULL: u16 = 1 << 15;

/// The depth buffer, depth test and pixel counts of one thread.
#[derive(Clone, Debug)]
pub(super) struct SeenParts {
    buffer: ZBuffer,
    test: DepthTest,
    /// Number of pixels that show every piece.
    shown: Vec<u32>,
}

/// One view while its faces are judged.
struct PieceView<'a> {
    sight: &'a SeenParts,
    pieces: &'a Pieces,
    projector: Projector,
    fractional: bool,
}

impl SeenParts {
    /// Empty buffers.
    pub(super) fn new() -> Self {
        Self {
            // Views are drawn in parallel.
            buffer: ZBuffer::new(1),
            test: DepthTest::default(),
            shown: Vec::new(),
        }
    }

    /// Draws the pieces from camera `index`, and writes the part of every face that it sees.
    pub(super) fn measure(
        &mut self,
        pieces: &Pieces,
        (cameras, index): (&Cameras, usize),
        options: &MeasureOptions,
        faces: &mut [u16],
    ) {
        let view = &cameras.set.views[index];
        self.buffer.draw(&pieces.scene, view, &cameras.set);
        let keys = self.buffer.keys();
        self.shown.clear();
        self.shown.resize(pieces.scene.triangle_count(), 0);
        for &key in keys.values() {
            if !key.is_background() {
                self.shown[key.id() as usize] += 1;
            }
        }
        self.test.prepare(options.unseen, &pieces.scene, view, keys);
        let look = PieceView {
            sight: self,
            pieces,
            projector: Projector::new(view, &cameras.set),
            fractional: options.fractional,
        };
        if pieces.are_whole() {
            for (piece, part) in faces.iter_mut().enumerate() {
                *part = look.part(piece);
            }
            return;
        }
        for (face, part) in faces.iter_mut().enumerate() {
            let range = pieces.of(face);
            *part = if range.len() == 1 {
                look.part(range.start)
            } else {
                look.mean(range)
            };
        }
    }
}

impl PieceView<'_> {
    /// The seen part of a piece.
    #[inline]
    fn part(&self, piece: usize) -> u16 {
        let shown = self.sight.shown[piece];
        if shown == 0 {
            let corners = self.pieces.scene.triangles()[piece];
            let seen = self.sight.test.sees(corners)
                && !(self.sight.test.may_cover(corners) && self.covered_samples(piece) > 0);
            if seen { FULL } else { 0 }
        } else if self.fractional {
            let all = u64::from(self.covered_samples(piece).max(shown));
            ((u64::from(shown) * u64::from(FULL) / all) as u16).max(1)
        } else {
            FULL
        }
    }

    /// The seen part of a face in several pieces.
    fn mean(&self, range: std::ops::Range<usize>) -> u16 {
        let (mut seen, mut all) = (0.0, 0.0);
        let (mut anything, mut everything) = (false, true);
        for piece in range {
            let (part, area) = (self.part(piece), self.pieces.area(piece));
            anything |= part > 0;
            everything &= part == FULL;
            seen += area * f64::from(part);
            all += area;
        }
        if everything || (anything && all <= 0.0) {
            FULL
        } else if anything {
            // `as` rounds down.
            ((seen / all) as u16).clamp(1, FULL)
        } else {
            0
        }
    }

    /// Counts the samples that a piece covers, whatever they show.
    fn covered_samples(&self, piece: usize) -> u32 {
        let scene = &self.pieces.scene;
        let positions = scene.triangles()[piece].each(|v| scene.positions()[v as usize]);
        let face = Face {
            positions,
            screen: positions.each(|p| self.projector.screen(p)),
            paint: Paint::Flat(0),
        };
        let mut samples = 0;
        face.pieces(&self.projector, Cull::None, |setup, _| {
            setup.fragments(self.projector.image(), |_, _, _| samples += 1);
        });
        samples
    }
}
