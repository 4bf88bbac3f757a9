//! Pieces of original triangles, the pieces that a face stands for, and the answers about them.

use glam::DVec3;

use crate::num::fixed::Weights31;

/// A corner of a piece: weights of the second and third corner of the original triangle, and of the live face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Corner {
    /// In the original triangle.
    pub source: Weights31,
    /// In the live face.
    pub target: Weights31,
}

/// A part of an original triangle and the part of a live face that stands for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece<'a> {
    /// The original triangle.
    pub triangle: u32,
    /// A polygon, counter-clockwise in the triangle up to rounding; mapped linearly on the triangles from its first
    /// corner.
    pub corners: &'a [Corner],
}

/// Decides what a piece may be displaced to.
pub trait Allowance {
    /// True where every point of the piece may be replaced: `from` and `to` are corresponding corners of the piece of an
    /// original triangle and of what stands for it.
    fn allows(&self, triangle: u32, from: &[DVec3], to: &[DVec3]) -> bool;

    /// A displacement that is allowed for every point of an original triangle, whatever its direction.
    fn radius(&self, triangle: u32) -> f64;
}

/// The answer about a collapse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Everything may be where the collapse would put it.
    Allowed,
    /// Something may not.
    Denied,
    /// The map would tangle up.
    Tangled,
}

/// The pieces that a face stands for.
#[derive(Clone, Debug, Default)]
pub(super) struct FacePieces {
    /// Original triangle and the end of its corners.
    pub(super) heads: Vec<(u32, u32)>,
    pub(super) corners: Vec<Corner>,
    /// Largest displacement of any corner.
    pub(super) displacement: f64,
    /// The face never changed and stands for itself.
    pub(super) itself: bool,
}

impl FacePieces {
    pub(super) fn iter(&self) -> impl Iterator<Item = Piece<'_>> {
        let mut start = 0;
        self.heads.iter().map(move |&(triangle, end)| {
            let corners = &self.corners[start..end as usize];
            start = end as usize;
            Piece { triangle, corners }
        })
    }
}

/// The corners of a face as weights.
const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// The only piece of a face that never changed.
pub(super) fn itself() -> [Corner; 3] {
    CORNERS.map(|weights| Corner {
        source: Weights31::new(weights),
        target: Weights31::new(weights),
    })
}

/// True where a piece is all of its triangle.
pub(super) fn is_whole(piece: Piece<'_>) -> bool {
    let is_corner = |c: &Corner| {
        let [u, v] = c.source.bits();
        u == Weights31::ONE || v == Weights31::ONE || (u == 0 && v == 0)
    };
    piece.corners.len() == 3 && piece.corners.iter().all(is_corner)
}
