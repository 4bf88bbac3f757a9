//! The certificate that every point of the original stays near the live mesh.
//!
//! Every triangle of the original has witnesses: live faces such that each of its points is within reach of one of them.
//! A change of the mesh takes faces away; only the triangles that have one of those as a witness must be looked at again,
//! against the faces that come and the witnesses that stay. As in [`OriginalSurface`](super::OriginalSurface), a piece
//! whose three corners are within reach of the same face is near as a whole, others are halved until they are small.
//!
//! For every corner the faces within reach are bits of a mask, so that a triangle is settled by `and`. Limits: 128 faces
//! around a change; beyond that the answer is no.

use glam::DVec3;

use super::{Facet, Reach, reach::halve};
use crate::num::Each;

/// Faces that one test can tell apart.
const FACES: usize = Coverage::FACES;
/// Pieces that one test looks at, at most.
const PIECES: usize = 1 << 16;

/// For every original triangle the live faces that it is near to, its witnesses.
#[derive(Clone, Debug, Default)]
pub struct Coverage {
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The live faces that a triangle is near to, together as a whole.
    witnesses: Vec<Vec<u32>>,
    /// The triangles that have a face as a witness, and some that once had.
    stands_for: Vec<Vec<u32>>,
}

/// A test and its buffers.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    /// The round in which a triangle or point of the original was met, and its place in the lists below.
    met_triangles: Vec<u32>,
    met_points: Vec<(u32, u32)>,
    round: u32,
    ids: Vec<u32>,
    corners: Vec<[u32; 3]>,
    points: Vec<DVec3>,
    /// Witnesses that stay.
    staying: Vec<u32>,
    facets: Vec<Facet>,
    /// For every point the staying witnesses, and all faces, within its reach, as bits.
    staying_masks: Vec<u128>,
    masks: Vec<u128>,
    pieces: Vec<Piece>,
}

/// A part of a triangle, and the faces within reach of each of its corners.
type Piece = ([DVec3; 3], [u128; 3]);

/// The new witnesses after a change that passed its test.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WitnessChange {
    removed: Vec<u32>,
    /// Triangles with the end of their new witnesses in the list.
    triangles: Vec<(u32, usize)>,
    witnesses: Vec<u32>,
}

impl Coverage {
    /// Most faces that may come by a change.
    pub const FACES: usize = u128::BITS as usize;

    /// Every triangle of the original is a live face and its own witness. A triangle that repeats a vertex is none, and
    /// not asked for. O(n).
    pub fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let own = |t: usize| {
            let [a, b, c] = triangles[t];
            if a == b || b == c || c == a {
                Vec::new()
            } else {
                vec![t as u32]
            }
        };
        let witnesses: Vec<Vec<u32>> = (0..triangles.len()).map(own).collect();
        Self {
            points: points.to_vec(),
            triangles: triangles.to_vec(),
            stands_for: witnesses.clone(),
            witnesses,
        }
    }

    /// The faces that are witnesses of a triangle.
    ///
    /// # Panics
    /// Where there is no such triangle.
    pub fn witnesses(&self, triangle: u32) -> &[u32] {
        &self.witnesses[triangle as usize]
    }

    /// About how many triangles have one of some faces as a witness: no fewer, each as often as it has one.
    ///
    /// # Panics
    /// Where there is no such face.
    pub fn load(&self, faces: &[u32]) -> usize {
        let each = faces.iter().map(|&f| self.stands_for[f as usize].len());
        each.sum()
    }

    /// Collects what a change concerns that takes away the faces `removed`; `corners_of` gives the corners of a live
    /// face that stays.
    pub fn gather(
        &self,
        removed: &[u32],
        corners_of: impl Fn(u32) -> Option<[DVec3; 3]>,
        reach: Reach,
        trial: &mut Trial,
    ) {
        trial.begin(self);
        for &face in removed {
            for &t in &self.stands_for[face as usize] {
                let witnesses = &self.witnesses[t as usize];
                if trial.met_triangles[t as usize] == trial.round || !witnesses.contains(&face) {
                    continue;
                }
                trial.met_triangles[t as usize] = trial.round;
                trial.ids.push(t);
                for g in witnesses {
                    if trial.staying.len() < FACES / 2
                        && !removed.contains(g)
                        && !trial.staying.contains(g)
                    {
                        trial.staying.push(*g);
                    }
                }
            }
        }
        trial.staying.retain(|&g| match corners_of(g) {
            Some(corners) => {
                trial.facets.push(Facet::new(corners));
                true
            }
            None => false,
        });
        for i in 0..trial.ids.len() {
            let corners = self.triangles[trial.ids[i] as usize];
            let corners = corners.each(|v| trial.place(v, self.points[v as usize]));
            trial.corners.push(corners);
        }
        for i in 0..trial.points.len() {
            let mask = mask(&trial.facets, trial.points[i], reach);
            trial.staying_masks.push(mask);
        }
    }
}

/// The faces within reach of a point, as bits.
#[inline]
fn mask(facets: &[Facet], p: DVec3, reach: Reach) -> u128 {
    let mut mask = 0;
    for (bit, facet) in facets.iter().enumerate() {
        if facet.may_reach(p, reach.length) && facet.distance2(p) < reach.squared {
            mask |= 1 << bit;
        }
    }
    mask
}

impl Trial {
    fn begin(&mut self, coverage: &Coverage) {
        if self.met_triangles.len() != coverage.triangles.len()
            || self.met_points.len() != coverage.points.len()
            || self.round == u32::MAX
        {
            self.met_triangles = vec![0; coverage.triangles.len()];
            self.met_points = vec![(0, 0); coverage.points.len()];
            self.round = 0;
        }
        self.round += 1;
        self.ids.clear();
        self.corners.clear();
        self.points.clear();
        self.staying.clear();
        self.facets.clear();
        self.staying_masks.clear();
    }

    fn place(&mut self, vertex: u32, point: DVec3) -> u32 {
        let met = &mut self.met_points[vertex as usize];
        if met.0 != self.round {
            *met = (self.round, self.points.len() as u32);
            self.points.push(point);
        }
        met.1
    }

    /// Number of triangles of the original that the change concerns.
    pub fn triangles(&self) -> usize {
        self.ids.len()
    }

    /// True where every point of the original that the change concerns is proved to be within reach of the faces that
    /// come, `fan`, or of a witness that stays.
    pub fn covers(&mut self, fan: impl Iterator<Item = [DVec3; 3]>, reach: Reach) -> bool {
        if !self.arm(fan) || !self.all_within_reach(reach) {
            return false;
        }
        let mut pieces = std::mem::take(&mut self.pieces);
        let mut near = |i| self.triangle(i, reach, &mut pieces, &mut |_, _| {});
        let all = (0..self.corners.len()).all(&mut near);
        self.pieces = pieces;
        all
    }

    /// As [`Trial::covers`]; fills `change` with the new witnesses. `ids` are the faces that come, in the order of
    /// `fan`, and `removed` those that [`Coverage::gather`] was given.
    pub fn assign(
        &mut self,
        removed: &[u32],
        ids: &[u32],
        fan: impl Iterator<Item = [DVec3; 3]>,
        reach: Reach,
        change: &mut WitnessChange,
    ) -> bool {
        change.removed.clear();
        change.removed.extend_from_slice(removed);
        change.triangles.clear();
        change.witnesses.clear();
        if !self.arm(fan) || !self.all_within_reach(reach) {
            return false;
        }
        let mut pieces = std::mem::take(&mut self.pieces);
        for i in 0..self.corners.len() {
            let mut chosen = 0_u128;
            let near = self.triangle(i, reach, &mut pieces, &mut |piece, common| {
                if common & chosen == 0 {
                    chosen |= 1 << nearest(&self.facets, common, piece);
                }
            });
            if !near {
                self.pieces = pieces;
                return false;
            }
            let staying = self.staying.len();
            for bit in (0..FACES).filter(|bit| chosen & (1 << bit) != 0) {
                change.witnesses.push(if bit < staying {
                    self.staying[bit]
                } else {
                    ids[bit - staying]
                });
            }
            change.triangles.push((self.ids[i], change.witnesses.len()));
        }
        self.pieces = pieces;
        true
    }

    fn arm(&mut self, fan: impl Iterator<Item = [DVec3; 3]>) -> bool {
        self.facets.truncate(self.staying.len());
        self.facets.extend(fan.map(Facet::new));
        self.facets.len() <= FACES
    }

    /// Fills the masks; false where a corner is out of reach of all faces.
    fn all_within_reach(&mut self, reach: Reach) -> bool {
        self.masks.clear();
        let staying = self.staying.len();
        for (&p, &known) in self.points.iter().zip(&self.staying_masks) {
            let mask = known | mask(&self.facets[staying..], p, reach) << staying;
            if mask == 0 {
                return false;
            }
            self.masks.push(mask);
        }
        true
    }

    /// Tests one triangle; `settled` hears of every piece that is within reach, and of which faces.
    fn triangle(
        &self,
        i: usize,
        reach: Reach,
        pieces: &mut Vec<Piece>,
        settled: &mut dyn FnMut([DVec3; 3], u128),
    ) -> bool {
        let facets = &self.facets[..];
        let corners = self.corners[i].each(|p| self.points[p as usize]);
        let masks = self.corners[i].each(|p| self.masks[p as usize]);
        let common = masks[0] & masks[1] & masks[2];
        if common != 0 {
            settled(corners, common);
            return true;
        }
        pieces.clear();
        pieces.push((corners, masks));
        let mut count = 0;
        while let Some((corners, masks)) = pieces.pop() {
            let common = masks[0] & masks[1] & masks[2];
            if common != 0 {
                settled(corners, common);
                continue;
            }
            count += 1;
            let (longest2, middle, apex) = halve(corners);
            if longest2 <= reach.finest2 || count >= PIECES {
                return false;
            }
            let known = masks[0] | masks[1] | masks[2];
            let nearest = &facets[nearest(facets, known, corners)];
            if longest2 >= reach.large2
                && let Some(cut) = nearest.cut(corners, reach.length)
            {
                let between = cut.between.each(|p| mask(facets, p, reach));
                if between.contains(&0) {
                    return false;
                }
                let points = cut.parts(corners, cut.between);
                let masks = cut.parts(masks, between);
                pieces.extend(points.into_iter().zip(masks));
                continue;
            }
            let between = mask(facets, middle, reach);
            if between == 0 {
                return false;
            }
            for replaced in [(apex + 1) % 3, (apex + 2) % 3] {
                let (mut corners, mut masks) = (corners, masks);
                corners[replaced] = middle;
                masks[replaced] = between;
                pieces.push((corners, masks));
            }
        }
        true
    }
}

/// Of the faces in `among`, that which is nearest to the middle of a piece.
fn nearest(facets: &[Facet], among: u128, [a, b, c]: [DVec3; 3]) -> usize {
    let middle = ((a + b) + c) / 3.0;
    let mut best = (f64::INFINITY, among.trailing_zeros() as usize);
    for (bit, facet) in facets.iter().enumerate() {
        if among & (1 << bit) != 0 {
            let d = facet.distance2(middle);
            if d < best.0 {
                best = (d, bit);
            }
        }
    }
    best.1
}

impl Coverage {
    /// Makes a change that passed its test: the witnesses are those of the faces as they will be.
    pub fn apply(&mut self, change: &WitnessChange) {
        for &face in &change.removed {
            self.stands_for[face as usize].clear();
        }
        let mut start = 0;
        for &(t, end) in &change.triangles {
            let new = &change.witnesses[start..end];
            start = end;
            let old = &mut self.witnesses[t as usize];
            for &face in new {
                if change.removed.contains(&face) || !old.contains(&face) {
                    self.stands_for[face as usize].push(t);
                }
            }
            old.clear();
            old.extend_from_slice(new);
        }
    }
}
