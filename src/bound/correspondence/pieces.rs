//! The map from the surface as it was to the surface as it is: every original triangle in convex pieces, each mapped by
//! one affine map into one live face.
//!
//! A collapse puts together what a triangle has in the faces before (in the plane of their [`Layout`]), as far as its
//! outline, and cuts that along the faces after. Displacement is a convex function on a piece, so it is largest at a
//! corner: nothing is added up over collapses, and a surface that returns to where it was is as good as one that never
//! moved. The notes (4.9) propose a number per face that adds up the steps instead, and that cuts are kept for ever;
//! here no more is kept of old faces, whose sides would cut every triangle into ever smaller pieces: between the
//! corners that are left the map is a new one, and is judged as such.
//! Weights are in units of 2^-31, and judged as kept. Pieces fit together exactly: every side of one is, bit for bit in
//! weights of the original triangle, a side of another one in the opposite direction, or lies on a side of the triangle,
//! and those together make up that side. So every point of the triangle lies in a piece, in a triangle from its first
//! corner, whatever rounding did to the corners: the winding numbers of all pieces add up to that of the triangle. It
//! lies in no more than one up to rounding, as those triangles all lie the right way up. Target weights are in their
//! faces. Triangles that share a side map it to the same points, up to rounding, as far as tests find with
//! displacements of up to a third of a side; of surfaces that are pushed together farther than that no more is promised
//! than the limit. Memory: 16 bytes per corner of a piece.

use glam::DVec3;

use super::{
    layout::{Before, Layout, Part},
    outline::{OutlineCorner, OutlineScratch, outlines, tidy, turn_to_fan},
    piece::{Allowance, Answer, Corner, FacePieces, Piece, is_whole, itself},
    sectors::CutScratch,
};
use crate::num::{fixed::Weights31, math::sqrt};

/// Corners that all pieces may have together, for each original triangle and for small meshes: this bounds the memory.
/// Simplified scans need some five for each triangle.
const CORNERS_PER_TRIANGLE: usize = 64;
const CORNERS_AT_LEAST: usize = 1 << 16;

/// Buffers of an evaluation.
#[derive(Clone, Debug, Default)]
pub struct PieceScratch {
    /// Pieces of triangles that are in several: triangle, face before, and corners in `cut`.
    split: Vec<(u32, u32, [u32; 2])>,
    cut: Vec<OutlineCorner>,
    outline: Vec<OutlineCorner>,
    ends: Vec<usize>,
    outlining: OutlineScratch,
    cutting: CutScratch,
    placed: Placed,
}

/// A part of a piece where it would be.
#[derive(Clone, Debug, Default)]
struct Placed {
    part: Vec<OutlineCorner>,
    corners: Vec<Corner>,
    from: Vec<DVec3>,
    to: Vec<DVec3>,
}

impl Placed {
    /// From a polygon in the plane to corners in space; false where it covers nothing, `None` where it lies over itself.
    fn place(
        &mut self,
        original: [DVec3; 3],
        polygon: &[OutlineCorner],
        part: &Part,
    ) -> Option<bool> {
        tidy(polygon, &mut self.part);
        if !self.part.is_empty() && !turn_to_fan(&mut self.part) {
            return None;
        }
        self.corners.clear();
        self.from.clear();
        self.to.clear();
        for corner in &self.part {
            // The rounded weights are judged, which are those that are kept.
            let target = Weights31::new(part.weights_at(corner.plane));
            let source = corner.source;
            self.corners.push(Corner { source, target });
            self.from.push(at(original, source.get()));
            self.to.push(at(part.face.points, target.get()));
        }
        Some(!self.part.is_empty())
    }
}

/// The map of an original surface to the live faces that its parts have become.
#[derive(Clone, Debug)]
pub struct Correspondence {
    originals: Vec<[DVec3; 3]>,
    faces: Vec<FacePieces>,
    /// The corners of every piece that is a whole face.
    itself: [Corner; 3],
    /// Corners of all pieces that were cut.
    total: usize,
}

impl Correspondence {
    /// Every triangle stands for itself, under its index as the face's id; `alive` says which ones exist. O(n).
    pub fn new(originals: Vec<[DVec3; 3]>, alive: impl Fn(u32) -> bool) -> Self {
        let whole = |t| FacePieces {
            itself: alive(t),
            ..FacePieces::default()
        };
        Self {
            faces: (0..originals.len() as u32).map(whole).collect(),
            originals,
            itself: itself(),
            total: 0,
        }
    }

    /// The triangles of a mesh, each standing for itself. O(n).
    pub fn identity(originals: Vec<[DVec3; 3]>) -> Self {
        Self::new(originals, |_| true)
    }

    /// The same map with the faces `ids[0]`, `ids[1]`, ... as faces 0, 1, ..., and lengths in other units.
    pub fn renumbered(
        mut self,
        ids: impl Iterator<Item = u32>,
        units: impl Fn(DVec3) -> DVec3,
        length: impl Fn(f64) -> f64,
    ) -> Self {
        let faces = ids.map(|id| {
            let mut pieces = std::mem::take(&mut self.faces[id as usize]);
            if pieces.itself && pieces.heads.is_empty() {
                pieces.itself = false;
                pieces.heads = vec![(id, 3)];
                pieces.corners = itself().to_vec();
            }
            pieces.displacement = length(pieces.displacement);
            pieces
        });
        self.faces = faces.collect();
        for corner in self.originals.iter_mut().flatten() {
            *corner = units(*corner);
        }
        self
    }

    /// Number of face ids.
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Number of original triangles.
    pub fn triangle_count(&self) -> usize {
        self.originals.len()
    }

    /// Corners of an original triangle.
    ///
    /// # Panics
    /// Where there is no such triangle.
    pub fn original(&self, triangle: u32) -> [DVec3; 3] {
        self.originals[triangle as usize]
    }

    /// Number of pieces of a face: 0 where the face is gone.
    ///
    /// # Panics
    /// Where there is no such face.
    pub fn piece_count(&self, face: u32) -> usize {
        let pieces = &self.faces[face as usize];
        pieces.heads.len() + usize::from(pieces.itself)
    }

    /// The pieces that a face stands for.
    ///
    /// # Panics
    /// Where there is no such face.
    pub fn pieces(&self, face: u32) -> impl Iterator<Item = Piece<'_>> {
        let pieces = &self.faces[face as usize];
        let itself = pieces.itself.then_some(Piece {
            triangle: face,
            corners: &self.itself,
        });
        itself.into_iter().chain(pieces.iter())
    }

    /// The largest displacement of any point that a face stands for.
    ///
    /// # Panics
    /// Where there is no such face.
    pub fn displacement(&self, face: u32) -> f64 {
        self.faces[face as usize].displacement
    }

    /// Decides whether everything that the faces of a layout stand for may be where the collapse would put it.
    ///
    /// Time: linear in the corners of the pieces of the layout, and that of the allowance for each piece after.
    pub fn allows(
        &self,
        layout: &Layout,
        allowance: &dyn Allowance,
        scratch: &mut PieceScratch,
    ) -> Answer {
        let mut corners = self.total;
        let all = self.visit(layout, scratch, &mut |triangle, _, placed| {
            corners += placed.corners.len();
            allowance.allows(triangle, &placed.from, &placed.to)
        });
        let most = CORNERS_AT_LEAST.max(CORNERS_PER_TRIANGLE * self.originals.len());
        match all {
            Some(true) if corners - self.cut_corners(layout) > most => Answer::Tangled,
            Some(true) => Answer::Allowed,
            Some(false) => Answer::Denied,
            None => Answer::Tangled,
        }
    }

    /// Corners of the pieces of a layout that were cut.
    fn cut_corners(&self, layout: &Layout) -> usize {
        let of = |b: &Before| self.faces[b.face.id as usize].corners.len();
        layout.before.iter().map(of).sum()
    }

    /// Calls `visit` with every piece after the collapse, its original triangle and the part that it goes to, as long as
    /// that says true. `None` for a tangle.
    fn visit(
        &self,
        layout: &Layout,
        scratch: &mut PieceScratch,
        visit: &mut dyn FnMut(u32, &Part, &Placed) -> bool,
    ) -> Option<bool> {
        let PieceScratch {
            split,
            cut,
            outline,
            ends,
            outlining,
            cutting,
            placed,
        } = scratch;
        split.clear();
        cut.clear();
        for (i, before) in layout.before.iter().enumerate() {
            for piece in self.pieces(before.face.id) {
                let start = cut.len();
                cut.extend(in_plane(before, piece));
                let triangle = piece.triangle;
                let mut place = |part: &Part, polygon: &[OutlineCorner]| {
                    let covers = placed.place(self.original(triangle), polygon, part)?;
                    Some(!covers || visit(triangle, part, placed))
                };
                if let Some(part) = &before.outer {
                    if !place(part, &cut[start..])? {
                        return Some(false);
                    }
                } else if is_whole(piece) {
                    if !layout.sectors.cut(&cut[start..], cutting, &mut place)? {
                        return Some(false);
                    }
                } else {
                    split.push((triangle, i as u32, [start as u32, cut.len() as u32]));
                    continue;
                }
                cut.truncate(start);
            }
        }
        split.sort_unstable();
        for same in split.chunk_by(|a, b| a.0 == b.0) {
            let triangle = same[0].0;
            let piece = |&(.., [a, b]): &(u32, u32, [u32; 2])| &cut[a as usize..b as usize];
            outlines(same.iter().map(piece), outlining, outline, ends)?;
            let mut start = 0;
            for &end in ends.iter() {
                let mut place = |part: &Part, polygon: &[OutlineCorner]| {
                    let covers = placed.place(self.original(triangle), polygon, part)?;
                    Some(!covers || visit(triangle, part, placed))
                };
                let outline = &outline[start..end];
                if !layout.sectors.cut(outline, cutting, &mut place)? {
                    return Some(false);
                }
                start = end;
            }
        }
        Some(true)
    }

    /// Takes over a collapse that was allowed; false, and nothing is changed, for one that would tangle up.
    pub fn apply(&mut self, layout: &Layout, scratch: &mut PieceScratch) -> bool {
        let mut new: Vec<(u32, FacePieces)> = Vec::with_capacity(layout.before.len());
        let all = self.visit(layout, scratch, &mut |triangle, part, placed| {
            let known = new.iter().position(|(id, _)| *id == part.face.id);
            let i = known.unwrap_or(new.len());
            if known.is_none() {
                new.push((part.face.id, FacePieces::default()));
            }
            let into = &mut new[i].1;
            into.corners.extend_from_slice(&placed.corners);
            into.heads.push((triangle, into.corners.len() as u32));
            for (from, to) in placed.from.iter().zip(&placed.to) {
                let d = *to - *from;
                into.displacement = into.displacement.max(sqrt(d.dot(d)));
            }
            true
        });
        if all != Some(true) {
            return false;
        }
        self.total -= self.cut_corners(layout);
        for before in &layout.before {
            self.faces[before.face.id as usize] = FacePieces::default();
        }
        for (id, mut pieces) in new {
            self.total += pieces.corners.len();
            pieces.heads.shrink_to_fit();
            pieces.corners.shrink_to_fit();
            self.faces[id as usize] = pieces;
        }
        true
    }
}

/// Units that the weight of a corner on a side may be off by: a few roundings.
const OFF: u32 = 8;

/// The corners of a piece of a face in the plane.
fn in_plane(before: &Before, piece: Piece<'_>) -> impl Iterator<Item = OutlineCorner> {
    let [a, b, c] = before.plane;
    piece.corners.iter().map(move |corner| {
        let [u, v] = corner.target.get();
        let [x, y] = corner.target.bits();
        let weights = [Weights31::ONE - x - y, x, y];
        OutlineCorner {
            source: corner.source,
            plane: a + (b - a) * u + (c - a) * v,
            fixed: (0..3).any(|k| before.fixed[k] && weights[k] <= OFF),
        }
    })
}

/// A point of a triangle by the weights of its second and third corner.
pub(super) fn at([a, b, c]: [DVec3; 3], [u, v]: [f64; 2]) -> DVec3 {
    a + (b - a) * u + (c - a) * v
}
