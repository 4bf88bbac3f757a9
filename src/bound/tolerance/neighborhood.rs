//! The faces around a collapsing edge, as tolerance volumes see them.
//!
//! Coordinates are relative to the edge's midpoint, so that plane offsets do not cancel.

use glam::DVec3;

use super::{HalfSpace, Prism};
use crate::num::Each;

/// A triangle at either end of the edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OldFace {
    /// Its corners, counter-clockwise seen from outside.
    pub points: [DVec3; 3],
    /// The ends of the edge among them: one (a boundary triangle) or two (an internal one).
    pub ends: [bool; 3],
}

impl OldFace {
    /// The edge opposite to the end, directed as in the triangle; `None` for an internal triangle.
    pub fn link(&self) -> Option<[DVec3; 2]> {
        match self.ends.iter().filter(|&&e| e).count() {
            1 => {
                let at = self.ends.iter().position(|&e| e)?;
                Some([self.points[(at + 1) % 3], self.points[(at + 2) % 3]])
            }
            _ => None,
        }
    }
}

/// The triangles around an edge, their prisms and the link.
#[derive(Clone, Debug, Default)]
pub struct Neighborhood {
    /// The origin that all else is relative to.
    pub(super) origin: DVec3,
    pub(super) faces: Vec<OldFace>,
    /// Of the faces, one each.
    pub(super) prisms: Vec<Prism>,
    /// The sides of the link that the faces show.
    pub(super) links: Vec<[DVec3; 2]>,
}

impl Neighborhood {
    /// The triangles at the ends of an edge, whose midpoint is `origin`; `None` where one of them is a needle.
    pub fn new(origin: DVec3, faces: impl Iterator<Item = OldFace>) -> Option<Self> {
        let mut own = Self {
            origin,
            ..Self::default()
        };
        for face in faces {
            let points = face.points.each(|p| p - origin);
            let face = OldFace { points, ..face };
            own.prisms.push(Prism::new(points)?);
            own.links.extend(face.link());
            own.faces.push(face);
        }
        Some(own)
    }

    /// The point that coordinates are relative to.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The convex kernel: behind the walls that stand on the link.
    pub fn kernel(&self) -> impl Iterator<Item = HalfSpace> {
        let pairs = self.faces.iter().zip(&self.prisms);
        pairs.filter_map(|(face, prism)| {
            face.link()?;
            let at = face.ends.iter().position(|&e| e)?;
            Some(prism.walls[(at + 1) % 3])
        })
    }
}
