//! The claim of a picture at a pixel, tested against exact geometry within the tolerances.

use super::{
    cast::RayCaster,
    classify::TOLERANCE,
    hierarchy::Line,
    intersect::{Ray, Rays},
    outline::Outline,
};
use crate::{num::Each, view::Cull};

/// By how many units of 2^-32 depths may differ beyond what a move of the triangles explains: vertices and pixels are
/// rounded down once each.
pub(super) const QUANTA: f64 = 2.0;

/// The fault of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// There is no such triangle.
    Range,
    /// Nothing is claimed where a triangle certainly is.
    Hole,
    /// The triangle is not there.
    Stray,
    /// Another one is certainly in front of it.
    Occluded,
}

/// One pixel.
pub(super) struct Pixel<'a> {
    caster: &'a RayCaster,
    rays: &'a Rays<'a>,
    ray: Ray,
    cull: Cull,
    at: [i64; 2],
}

impl<'a> Pixel<'a> {
    pub(super) fn new(
        caster: &'a RayCaster,
        rays: &'a Rays<'a>,
        cull: Cull,
        [x, y]: [i64; 2],
    ) -> Self {
        Self {
            caster,
            rays,
            ray: rays.ray(x, y),
            cull,
            at: [x, y],
        }
    }

    /// The depth behind which nothing shows: of the triangles that certainly cover the centre, the least of the greatest
    /// depths that each may have here.
    fn certain(&self) -> Option<f64> {
        let [x, y] = self.at;
        // Rows count downwards, planes upwards.
        let planes = [(0, x), (1, self.rays.size[1] - 1 - y)]
            .each(|(axis, i)| self.rays.plane(axis, i, &self.caster.hierarchy));
        let line = Line::new(planes);
        let mut certain: Option<f64> = None;
        self.caster.hierarchy.candidates(line.as_ref(), |t| {
            let triangle = self.caster.triangles[t as usize];
            if self.rays.hit(self.ray, triangle).is_none() {
                return;
            }
            let outline = Outline::new(self.rays, self.ray, triangle);
            if outline.distance > TOLERANCE {
                let [_, high] = outline.depths(TOLERANCE);
                if certain.is_none_or(|least| high < least) {
                    certain = Some(high);
                }
            }
        });
        certain
    }

    /// The outline of a triangle around the pixel; `None` where there is no such triangle.
    pub(super) fn outline(&self, id: u32) -> Option<Outline> {
        let triangle = *self.caster.triangles.get(id as usize)?;
        Some(Outline::new(self.rays, self.ray, triangle))
    }

    /// True where the picture may show this triangle, or nothing.
    pub(super) fn check(&self, claim: Option<u32>) -> Result<(), Fault> {
        let Some(id) = claim else {
            return self.certain().map_or(Ok(()), |_| Err(Fault::Hole));
        };
        let outline = self.outline(id).ok_or(Fault::Range)?;
        let seen = outline.height <= TOLERANCE || self.faces(id);
        if outline.distance < -TOLERANCE || !seen {
            return Err(Fault::Stray);
        }
        let [low, _] = outline.depths(TOLERANCE);
        match self.certain() {
            Some(high) if high + QUANTA < low => Err(Fault::Occluded),
            _ => Ok(()),
        }
    }

    /// True unless the view leaves out this side of the triangle.
    fn faces(&self, id: u32) -> bool {
        let front = self.rays.is_front(self.caster.triangles[id as usize]);
        match self.cull {
            Cull::None => true,
            Cull::Back => front,
            Cull::Front => !front,
        }
    }
}
