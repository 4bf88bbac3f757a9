//! A triangle on its way to the screen: drawn as it is, or in pieces where it needs clipping.

use glam::DVec3;

use super::{Paint, Projector, ScreenVertex, Setup, clip::clip};
use crate::view::Cull;

/// A triangle of a view: positions, their projections, and its paint.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Corner positions in the world.
    pub positions: [DVec3; 3],
    /// The same corners on the screen.
    pub screen: [ScreenVertex; 3],
    /// Light that it sends to the eye.
    pub paint: Paint,
}

/// Completeness of a face that was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// Every piece was visited (there may be none).
    Whole,
    /// A coordinate is not finite after the transform: nothing, or not all, was drawn.
    Dropped,
}

impl Face {
    /// Calls `visit` for every set-up piece of the face that can cover a pixel of the image, with the paint of that
    /// piece. Nearly always one piece; several where the near plane or the guard band cuts it.
    #[inline]
    pub fn pieces(
        &self,
        projector: &Projector,
        cull: Cull,
        mut visit: impl FnMut(&Setup, &Paint),
    ) -> Drawn {
        if !self.screen.iter().any(ScreenVertex::is_outside) {
            if let Some(setup) = Setup::new(self.screen, projector.bits(), cull, projector.image())
            {
                visit(&setup, &self.paint);
            }
            return Drawn::Whole;
        }
        self.clipped(projector, cull, &mut visit)
    }

    #[cold]
    fn clipped(
        &self,
        projector: &Projector,
        cull: Cull,
        visit: &mut dyn FnMut(&Setup, &Paint),
    ) -> Drawn {
        let corners = self.positions.map(|p| projector.clip(p));
        let (bits, image) = (projector.bits(), projector.image());
        let mut draw = |screen, paint: Paint| {
            if let Some(setup) = Setup::new(screen, bits, cull, image) {
                visit(&setup, &paint);
            }
        };
        let complete = match self.paint {
            Paint::Flat(_) => clip(projector, corners, [[]; 3], |piece| {
                draw(piece.map(|c| c.0), self.paint);
            }),
            Paint::Smooth(attributes) => clip(projector, corners, attributes, |piece| {
                draw(piece.map(|c| c.0), Paint::Smooth(piece.map(|c| c.1)));
            }),
            Paint::Colored(attributes) => clip(projector, corners, attributes, |piece| {
                draw(piece.map(|c| c.0), Paint::Colored(piece.map(|c| c.1)));
            }),
        };
        if complete {
            Drawn::Whole
        } else {
            Drawn::Dropped
        }
    }
}
