//! The map from the surface as it was to the surface as it is: every original triangle in convex pieces, each mapped by
//! one affine map into one live face.
//!
//! A collapse cuts the pieces of the faces before along the faces after (in the plane of their [`Fan`]). Displacement is a
//! convex function on a piece, so it is largest at a corner: nothing is added up over collapses, and a surface that
//! returns to where it was is as good as one that never moved. The notes (4.9) propose a number per face that adds up the
//! steps instead; here that only accepts quickly what is far from the limit.
//! Weights are kept in units of 2^-31, and judged as kept. Memory: 16 bytes per corner of a piece.

use glam::DVec3;

use super::{
    clip::{Corner as PlaneCorner, Place, clip, place},
    fan::{After, Fan},
};
use crate::num::{fixed::Weights31, math::sqrt};

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
    /// A convex polygon, counter-clockwise in the triangle.
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

/// The pieces that a face stands for.
#[derive(Clone, Debug, Default)]
struct FacePieces {
    /// Original triangle and the end of its corners.
    heads: Vec<(u32, u32)>,
    corners: Vec<Corner>,
    /// Largest displacement of any corner.
    displacement: f64,
    /// Least radius that is allowed to all of them.
    radius: f64,
    /// The face never changed and stands for itself.
    itself: bool,
}

impl FacePieces {
    fn iter(&self) -> impl Iterator<Item = Piece<'_>> {
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
fn itself() -> [Corner; 3] {
    CORNERS.map(|weights| Corner {
        source: Weights31::new(weights),
        target: Weights31::new(weights),
    })
}

/// Buffers of an evaluation.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    whole: Vec<PlaneCorner>,
    polygon: Vec<PlaneCorner>,
    spare: Vec<PlaneCorner>,
    corners: Vec<Corner>,
    from: Vec<DVec3>,
    to: Vec<DVec3>,
}

/// What became of every point of an original surface.
#[derive(Clone, Debug)]
pub struct Correspondence {
    originals: Vec<[DVec3; 3]>,
    faces: Vec<FacePieces>,
    /// The corners of every piece that is a whole face.
    itself: [Corner; 3],
}

impl Correspondence {
    /// Every triangle stands for itself, under its index as the face's id; `alive` says which ones exist. O(n).
    #[must_use]
    pub fn new(
        originals: Vec<[DVec3; 3]>,
        alive: impl Fn(u32) -> bool,
        allowance: &impl Allowance,
    ) -> Self {
        let faces = (0..originals.len() as u32)
            .map(|t| FacePieces {
                itself: alive(t),
                radius: allowance.radius(t),
                ..FacePieces::default()
            })
            .collect();
        Self {
            originals,
            faces,
            itself: itself(),
        }
    }

    /// The triangles of a mesh, each standing for itself. O(n).
    #[must_use]
    pub fn identity(originals: Vec<[DVec3; 3]>) -> Self {
        let whole = FacePieces {
            itself: true,
            ..FacePieces::default()
        };
        Self {
            faces: vec![whole; originals.len()],
            originals,
            itself: itself(),
        }
    }

    /// The same map with the faces `ids[0]`, `ids[1]`, ... as faces 0, 1, ..., and lengths in other units.
    #[must_use]
    pub fn renumbered(
        mut self,
        ids: &[u32],
        units: impl Fn(DVec3) -> DVec3,
        length: impl Fn(f64) -> f64,
    ) -> Self {
        let faces = ids.iter().map(|&id| {
            let mut pieces = std::mem::take(&mut self.faces[id as usize]);
            if pieces.itself && pieces.heads.is_empty() {
                pieces.itself = false;
                pieces.heads = vec![(id, 3)];
                pieces.corners = itself().to_vec();
            }
            pieces.displacement = length(pieces.displacement);
            pieces.radius = length(pieces.radius);
            pieces
        });
        let faces = faces.collect();
        Self {
            originals: self.originals.iter().map(|t| t.map(&units)).collect(),
            faces,
            itself: self.itself,
        }
    }

    /// Number of face ids.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// Number of original triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.originals.len()
    }

    /// Corners of an original triangle.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[must_use]
    pub fn original(&self, triangle: u32) -> [DVec3; 3] {
        self.originals[triangle as usize]
    }

    /// Number of pieces of a face: 0 where the face is gone.
    ///
    /// # Panics
    /// Where there is no such face.
    #[must_use]
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
    #[must_use]
    pub fn displacement(&self, face: u32) -> f64 {
        self.faces[face as usize].displacement
    }

    /// Whether everything that the faces of a fan stand for may be where the collapse would put it.
    ///
    /// Time: a few clips per piece of the fan, less where the fan as a whole is far from its limits.
    #[must_use]
    pub fn allows(&self, fan: &Fan, allowance: &impl Allowance, scratch: &mut Scratch) -> bool {
        (0..fan.before.len()).all(|i| {
            self.allows_by_step(fan, i, scratch)
                || self.visit(fan, i, scratch, |piece, _, scratch| {
                    allowance.allows(piece.triangle, &scratch.from, &scratch.to)
                })
        })
    }

    /// The displacement so far and the step together are allowed to everything in a face.
    fn allows_by_step(&self, fan: &Fan, i: usize, scratch: &mut Scratch) -> bool {
        let before = &fan.before[i];
        let known = &self.faces[before.face.id as usize];
        let mut step = 0.0_f64;
        for &j in &fan.overlaps[i] {
            let after = &fan.after[j as usize];
            scratch.polygon.clear();
            for (plane, source) in before.plane.iter().zip(CORNERS) {
                scratch.polygon.push(PlaneCorner {
                    plane: *plane,
                    source,
                });
            }
            if clip(&mut scratch.polygon, &mut scratch.spare, &after.plane) {
                for corner in &scratch.polygon {
                    let [_, u, v] = after.weights_at(corner.plane);
                    let d = at(after.face.points, [u, v]) - at(before.face.points, corner.source);
                    step = step.max(d.dot(d));
                }
            }
        }
        known.displacement + sqrt(step) <= known.radius
    }

    /// Calls `visit` with every part of every piece of face `i` of the fan, the part after that it goes to, and its
    /// corners in `scratch`; false as soon as `visit` is.
    fn visit(
        &self,
        fan: &Fan,
        i: usize,
        scratch: &mut Scratch,
        mut visit: impl FnMut(Piece<'_>, &After, &mut Scratch) -> bool,
    ) -> bool {
        let before = &fan.before[i];
        let [a, b, c] = before.plane;
        let within = |[u, v]: [f64; 2]| a + (b - a) * u + (c - a) * v;
        for piece in self.pieces(before.face.id) {
            let mut parts = 0;
            scratch.whole.clear();
            scratch
                .whole
                .extend(piece.corners.iter().map(|corner| PlaneCorner {
                    plane: within(corner.target.get()),
                    source: corner.source.get(),
                }));
            for &j in &fan.overlaps[i] {
                let after = &fan.after[j as usize];
                let place = place(&scratch.whole, &after.plane);
                if place == Place::Outside {
                    continue;
                }
                scratch.polygon.clone_from(&scratch.whole);
                if place == Place::Inside
                    || clip(&mut scratch.polygon, &mut scratch.spare, &after.plane)
                {
                    parts += 1;
                    self.place(piece.triangle, after, scratch);
                    if !visit(piece, after, scratch) {
                        return false;
                    }
                    if place == Place::Inside {
                        break;
                    }
                }
            }
            if parts == 0 {
                // Thinner than rounding and between two parts: it goes whole to the one it is nearest to.
                scratch.polygon.clone_from(&scratch.whole);
                let nearest = fan.overlaps[i].iter().map(|&j| &fan.after[j as usize]);
                let nearest = nearest.max_by(|x, y| {
                    let depth = |p: &After| p.plane.depth(scratch.whole[0].plane);
                    depth(x).total_cmp(&depth(y))
                });
                if let Some(after) = nearest {
                    self.place(piece.triangle, after, scratch);
                    if !visit(piece, after, scratch) {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// From a polygon in the plane to corners in space.
    fn place(&self, triangle: u32, after: &After, scratch: &mut Scratch) {
        scratch.corners.clear();
        scratch.from.clear();
        scratch.to.clear();
        for corner in &scratch.polygon {
            let [_, u, v] = after.weights_at(corner.plane);
            // What is judged is what is kept.
            let corner = Corner {
                source: Weights31::new(corner.source),
                target: Weights31::new([u, v]),
            };
            scratch.corners.push(corner);
            let from = at(self.original(triangle), corner.source.get());
            scratch.from.push(from);
            scratch.to.push(at(after.face.points, corner.target.get()));
        }
    }

    /// Takes a collapse over.
    pub fn apply(&mut self, fan: &Fan, allowance: &impl Allowance, scratch: &mut Scratch) {
        let mut new: Vec<(u32, FacePieces)> = Vec::with_capacity(fan.after.len());
        for after in &fan.after {
            if new.iter().all(|(id, _)| *id != after.face.id) {
                let empty = FacePieces {
                    radius: f64::INFINITY,
                    ..FacePieces::default()
                };
                new.push((after.face.id, empty));
            }
        }
        for i in 0..fan.before.len() {
            self.visit(fan, i, scratch, |piece, after, scratch| {
                let Some((_, into)) = new.iter_mut().find(|(id, _)| *id == after.face.id) else {
                    return true;
                };
                into.corners.extend_from_slice(&scratch.corners);
                into.heads.push((piece.triangle, into.corners.len() as u32));
                for (from, to) in scratch.from.iter().zip(&scratch.to) {
                    let d = *to - *from;
                    into.displacement = into.displacement.max(sqrt(d.dot(d)));
                }
                into.radius = into.radius.min(allowance.radius(piece.triangle));
                true
            });
        }
        for before in &fan.before {
            self.faces[before.face.id as usize] = FacePieces::default();
        }
        for (id, mut pieces) in new {
            pieces.heads.shrink_to_fit();
            pieces.corners.shrink_to_fit();
            self.faces[id as usize] = pieces;
        }
    }
}

/// A point of a triangle by the weights of its second and third corner.
pub(super) fn at([a, b, c]: [DVec3; 3], [u, v]: [f64; 2]) -> DVec3 {
    a + (b - a) * u + (c - a) * v
}
