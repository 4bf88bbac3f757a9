//! A tree of boxes over plan faces, which finds those that may be projected on a plane.
//!
//! A plane takes a strip of the ground that is narrow beside the scene, so that most boxes are left out as a whole.
//! A search finds a superset by ascending numbers; the caller decides about each, so that nothing depends on the tree.

use glam::DVec2;

use super::plan::{Limits, PlanFace};
use crate::bound::planar::{Disc, Interval};

/// Faces in a leaf.
const LEAF: usize = 8;

#[derive(Clone, Copy, Debug)]
struct Node {
    /// Holds the first points of its faces.
    disc: Disc,
    /// Largest distance of the middle of a face from its first point.
    half: f64,
    /// First face of a leaf, or the second child; the first child is the next node.
    link: u32,
    /// Faces of a leaf; 0 for an inner node.
    faces: u32,
}

/// Faces by place.
#[derive(Clone, Debug, Default)]
pub(super) struct PlanTree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

/// Growth of offsets with the distance of a face's middle from a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Growth {
    /// Offset per distance.
    pub(super) slope: f64,
    /// The point.
    pub(super) centre: DVec2,
}

impl PlanTree {
    /// Sorts faces into a tree. O(n log n).
    pub(super) fn new(faces: &[PlanFace]) -> Self {
        let mut order: Vec<u32> = (0..faces.len() as u32).collect();
        let mut own = Self::default();
        if !faces.is_empty() {
            own.grow(faces, &mut order, 0);
        }
        own.order = order;
        own
    }

    fn grow(&mut self, faces: &[PlanFace], order: &mut [u32], first: usize) {
        let segment = |f: u32| faces[f as usize].segments[0];
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for &f in order.iter() {
            let [a, _] = segment(f);
            (low, high) = (low.min(a), high.max(a));
        }
        let centre = (low + high) / 2.0;
        let (mut radius, mut half) = (0.0_f64, 0.0_f64);
        for &f in order.iter() {
            let [a, b] = segment(f);
            radius = radius.max(a.distance(centre));
            half = half.max(a.distance(b) / 2.0);
        }
        let at = self.nodes.len();
        self.nodes.push(Node {
            disc: Disc { centre, radius },
            half,
            link: first as u32,
            faces: order.len() as u32,
        });
        if order.len() <= LEAF {
            return;
        }
        let axis = usize::from(high.y - low.y > high.x - low.x);
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |&f, &g| {
            let place = |f: u32| segment(f)[0][axis];
            place(f).total_cmp(&place(g)).then(f.cmp(&g))
        });
        let (left, right) = order.split_at_mut(middle);
        self.grow(faces, left, first);
        self.nodes[at].link = self.nodes.len() as u32;
        self.nodes[at].faces = 0;
        self.grow(faces, right, first + middle);
    }

    /// The faces, ascending, but for some of those that may be projected on no plane at one of the offsets around `rho`,
    /// which grow for a face by `growth`, at either end.
    pub(super) fn near(&self, limits: &Limits, rho: f64, growth: Growth) -> Vec<u32> {
        let mut found = Vec::new();
        let mut open = vec![0_u32];
        while let Some(at) = open.pop() {
            let Some(node) = self.nodes.get(at as usize) else {
                break;
            };
            let away = node.disc.centre.distance(growth.centre) + node.disc.radius + node.half;
            let more = growth.slope * away;
            if !limits.may_reach_any(node.disc, Interval::around(rho, more)) {
                continue;
            }
            let first = node.link as usize;
            if node.faces > 0 {
                found.extend_from_slice(&self.order[first..first + node.faces as usize]);
            } else {
                open.extend([node.link, at + 1]);
            }
        }
        found.sort_unstable();
        found
    }

    /// As [`PlanTree::near`] for a single offset.
    pub(super) fn at(&self, limits: &Limits, rho: f64) -> Vec<u32> {
        self.near(limits, rho, Growth::default())
    }
}

impl Limits {
    /// False only where no face with a point in a disc may be projected on a plane at one of `offsets`.
    fn may_reach_any(&self, disc: Disc, offsets: Interval) -> bool {
        match self {
            Self::Parallel => false,
            Self::Viewers(sides) => sides.iter().all(|side| side.may_reach_any(disc, offsets)),
            Self::Distance(direction, distance) => {
                let (rho, radius) = (disc.centre.dot(*direction), disc.radius);
                // Far above rounding.
                let reach = (distance + radius) * (1.0 + 1e-9) + rho.abs() * 1e-12;
                offsets.min - rho <= reach && rho - offsets.max <= reach
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        bound::planar::{Aperture, Projection, ViewerSegment},
        mesh::generate::Pcg32,
    };

    #[test]
    fn no_face_that_may_reach_an_offset_is_left_out() {
        let mut random = Pcg32::new(2007, 402);
        let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
        let (mut all, mut kept) = (0, 0);
        for case in 0..120 {
            let mut at = |size: f64| DVec2::new(between(-size, size), between(-size, size));
            let faces = (0..400).map(|t| PlanFace::wall(t, at(9.0), at(2.0)));
            let faces: Vec<PlanFace> = faces.collect();
            let (from, to, centre) = (at(4.0), at(4.0), at(9.0));
            let cells = [
                ViewerSegment::between(from, to),
                ViewerSegment::between(from, from),
                ViewerSegment::line(from, to),
            ];
            let degrees = between(0.0, 1.0) * [0.1, 1.0, 20.0][case % 3];
            let aperture = Aperture::degrees(degrees).expect("an angle");
            let turn = between(0.0, 6.3);
            let normal = DVec2::new(libm::cos(turn), libm::sin(turn));
            let slant = turn + between(-1.4, 1.4) * f64::from(u8::from(case % 2 == 0));
            let along = DVec2::new(libm::cos(slant), libm::sin(slant));
            let project =
                |cell| Projection::oblique(&cell, along, normal, aperture).expect("not parallel");
            let limits = match case % 5 {
                0..4 => {
                    let some = cells.into_iter().take(1 + case % 3);
                    Limits::Viewers(some.flatten().map(project).collect())
                }
                _ => Limits::Distance(normal, degrees),
            };
            let rho = between(-9.0, 9.0);
            let tree = PlanTree::new(&faces);
            let found = tree.at(&limits, rho);
            let slope = between(0.0, 0.1);
            let wide = tree.near(&limits, rho, Growth { slope, centre });
            for (i, face) in (0_u32..).zip(&faces) {
                if face.fits(&limits, rho) {
                    assert!(found.contains(&i), "case {case}, face {i}");
                }
                let [a, b] = face.segments[0];
                let more = slope * ((a + b) / 2.0).distance(centre);
                let own = face.interval(&limits);
                if own.min <= rho + more && rho - more <= own.max {
                    assert!(wide.contains(&i), "case {case}, face {i}");
                }
            }
            all += faces.len();
            kept += found.len();
        }
        // And many of the others are.
        assert!(4 * kept < 3 * all, "{kept} of {all}");
    }
}
