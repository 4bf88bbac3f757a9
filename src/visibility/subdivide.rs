//! Large triangles in pieces: each is seen or hidden on its own.
//!
//! Zhang & Turk 2002, section 4: a vertex in the middle of every edge longer than l, triangles split by how many of
//! their edges have one, repeated until no edge is longer. Whether an edge is split, and where, depends on the positions
//! of its ends alone, so neighbours agree and no T-vertex appears, shared vertices or not. Lengths in frame units.
//! Limit: [`PIECE_LIMIT`] pieces; beyond it the measurement is refused.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::{Error, Result, num::math};

/// Most pieces that are measured: about 4 GiB of buffers on two threads.
pub(super) const PIECE_LIMIT: usize = 1 << 25;

/// Triangles to measure, in the order of the faces they are part of.
#[derive(Clone, Debug)]
pub(super) struct Pieces {
    /// Positions in frame units; those of the mesh come first.
    pub(super) positions: Vec<DVec3>,
    /// The pieces.
    pub(super) triangles: Vec<[u32; 3]>,
    /// First piece of every face, and the number of pieces; empty where every face is its own piece.
    starts: Vec<u32>,
}

impl Pieces {
    /// The triangles in pieces whose edges are no longer than `limit`; as they are where it is `None`.
    pub(super) fn new(
        positions: Vec<DVec3>,
        triangles: &[[u32; 3]],
        limit: Option<f64>,
    ) -> Result<Self> {
        let mut pieces = Self {
            positions,
            triangles: triangles.to_vec(),
            starts: Vec::new(),
        };
        if let Some(limit) = limit {
            while pieces.split(limit * limit)? {}
        }
        Ok(pieces)
    }

    /// The pieces of a face.
    #[inline]
    pub(super) fn of(&self, face: usize) -> std::ops::Range<usize> {
        if self.starts.is_empty() {
            face..face + 1
        } else {
            self.starts[face] as usize..self.starts[face + 1] as usize
        }
    }

    /// True where every face is its own piece.
    pub(super) fn are_whole(&self) -> bool {
        self.starts.is_empty()
    }

    /// The area of a piece.
    pub(super) fn area(&self, piece: usize) -> f64 {
        let [a, b, c] = self.triangles[piece].map(|v| self.positions[v as usize]);
        0.5 * math::length((b - a).cross(c - a))
    }

    /// Splits every edge whose squared length exceeds `limit` once; false where there is none.
    fn split(&mut self, limit: f64) -> Result<bool> {
        let long = |positions: &[DVec3], a: u32, b: u32| {
            let edge = positions[b as usize] - positions[a as usize];
            edge.dot(edge) > limit
        };
        let any = |&[a, b, c]: &[u32; 3]| {
            long(&self.positions, a, b)
                || long(&self.positions, b, c)
                || long(&self.positions, c, a)
        };
        if !self.triangles.iter().any(any) {
            return Ok(false);
        }
        let faces = if self.starts.is_empty() {
            self.triangles.len()
        } else {
            self.starts.len() - 1
        };
        let mut middles: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut finer = Vec::with_capacity(2 * self.triangles.len());
        let mut starts = Vec::with_capacity(faces + 1);
        for face in 0..faces {
            starts.push(finer.len() as u32);
            for piece in self.of(face) {
                let corners = self.triangles[piece];
                let positions = &mut self.positions;
                let mut middle = |a: u32, b: u32| {
                    if !long(positions, a, b) {
                        return None;
                    }
                    Some(*middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                        positions.push((positions[a as usize] + positions[b as usize]) * 0.5);
                        positions.len() as u32 - 1
                    }))
                };
                let [a, b, c] = corners;
                let marks = [middle(a, b), middle(b, c), middle(c, a)];
                divide(corners, marks, &self.positions, &mut finer);
            }
            if finer.len() > PIECE_LIMIT {
                return Err(Error::Unsupported(format!(
                    "the triangles are so large or long that they make more than {PIECE_LIMIT} pieces; try a larger \
                     edge limit, smaller ID buffers, or whole triangles"
                )));
            }
        }
        starts.push(finer.len() as u32);
        self.triangles = finer;
        self.starts = starts;
        Ok(true)
    }
}

/// The pieces of a triangle whose edges ab, bc and ca have the given middles, orientation kept.
fn divide(
    [a, b, c]: [u32; 3],
    marks: [Option<u32>; 3],
    positions: &[DVec3],
    into: &mut Vec<[u32; 3]>,
) {
    match marks {
        [None, None, None] => into.push([a, b, c]),
        [Some(m), Some(n), Some(o)] => {
            into.extend([[a, m, o], [m, b, n], [o, n, c], [m, n, o]]);
        }
        [Some(m), None, None] => into.extend([[a, m, c], [m, b, c]]),
        [None, Some(m), None] => into.extend([[b, m, a], [m, c, a]]),
        [None, None, Some(m)] => into.extend([[c, m, b], [m, a, b]]),
        [Some(m), None, Some(o)] => cut_corner([a, b, c], [m, o], positions, into),
        [Some(m), Some(n), None] => cut_corner([b, c, a], [n, m], positions, into),
        [None, Some(n), Some(o)] => cut_corner([c, a, b], [o, n], positions, into),
    }
}

/// Both edges at `a` have a middle: m on ab, o on ca. The rest is cut along its shorter diagonal.
fn cut_corner(
    [a, b, c]: [u32; 3],
    [m, o]: [u32; 2],
    positions: &[DVec3],
    into: &mut Vec<[u32; 3]>,
) {
    let squared = |p: u32, q: u32| {
        let edge = positions[q as usize] - positions[p as usize];
        edge.dot(edge)
    };
    into.push([a, m, o]);
    if squared(m, c) <= squared(o, b) {
        into.extend([[m, b, c], [m, c, o]]);
    } else {
        into.extend([[m, b, o], [o, b, c]]);
    }
}
