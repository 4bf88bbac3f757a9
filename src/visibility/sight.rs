//! F(t, v): how much of every triangle one view sees (Zhang & Turk 2002, section 4).
//!
//! F is a whole number of [`FULL`]ths: all or nothing for a piece, or, as an option, the share of its covered samples
//! that show it (their future work); for a face in pieces the mean over its area. A face of which anything is seen has
//! at least one part, rounded down otherwise, so that "never seen" and "always seen" stay exact.

use super::{
    Options,
    cameras::Cameras,
    picture::{EMPTY, IdPicture},
    subdivide::Pieces,
    unseen::DepthTest,
};

/// All of a triangle is seen.
pub(super) const FULL: u16 = 1 << 15;

/// Buffers of one thread.
#[derive(Clone, Debug, Default)]
pub(super) struct Sight {
    picture: IdPicture,
    test: DepthTest,
    /// Number of pixels that show every piece.
    shown: Vec<u32>,
}

impl Sight {
    /// Looks at the pieces from camera `index`, and writes the part of every face that it sees.
    pub(super) fn look(
        &mut self,
        pieces: &Pieces,
        areas: &[f64],
        (cameras, index): (&Cameras, usize),
        options: &Options,
        faces: &mut [u16],
    ) {
        let view = &cameras.set.views[index];
        self.picture
            .draw(pieces, view, &cameras.set, options.fractional);
        self.shown.clear();
        self.shown.resize(pieces.triangles.len(), 0);
        for &key in &self.picture.keys {
            if key != EMPTY {
                self.shown[key as u32 as usize] += 1;
            }
        }
        self.test
            .prepare(options.unseen, pieces, view, &self.picture, options.size);
        if pieces.are_whole() {
            for (piece, part) in faces.iter_mut().enumerate() {
                *part = self.part(pieces, piece);
            }
            return;
        }
        for (face, part) in faces.iter_mut().enumerate() {
            let range = pieces.of(face);
            *part = if range.len() == 1 {
                self.part(pieces, range.start)
            } else {
                self.mean(pieces, range, areas)
            };
        }
    }

    /// The seen part of a piece.
    #[inline]
    fn part(&self, pieces: &Pieces, piece: usize) -> u16 {
        let shown = self.shown[piece];
        if shown > 0 {
            match self.picture.covered.get(piece) {
                Some(&covered) => share(shown, covered),
                None => FULL,
            }
        } else if self.test.sees(pieces.triangles[piece]) {
            FULL
        } else {
            0
        }
    }

    /// The seen part of a face in several pieces.
    fn mean(&self, pieces: &Pieces, range: std::ops::Range<usize>, areas: &[f64]) -> u16 {
        let (mut seen, mut all) = (0.0, 0.0);
        let (mut anything, mut everything) = (false, true);
        for piece in range {
            let part = self.part(pieces, piece);
            anything |= part > 0;
            everything &= part == FULL;
            seen += areas[piece] * f64::from(part);
            all += areas[piece];
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
}

/// `shown` of `covered` samples in parts of [`FULL`].
fn share(shown: u32, covered: u32) -> u16 {
    let parts = u64::from(shown) * u64::from(FULL) / u64::from(covered.max(1));
    (parts as u16).clamp(1, FULL)
}
