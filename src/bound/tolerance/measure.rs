//! The deviation of new faces from the old ones (section 2.2).
//!
//! Every new triangle is cut by the walls of every column; the height over the old triangle is linear in a piece, so its
//! corners have the largest. Deviation: at convex edges there are gaps between columns where the published measure sees
//! nothing; there a piece counts with the distance of its farthest corner from the old triangle for which that is least,
//! which is no less than the distance from the old surface. Columns have no ends: where the neighbourhood folds back
//! over itself the measure is too large, never too small.

use glam::DVec3;

use super::{HalfSpace, Neighborhood, Prism};
use crate::{bound::envelope::Facet, num::math};

/// A polygon that is cut; three corners and one more for every cut.
#[derive(Clone, Copy)]
struct Polygon {
    points: [DVec3; 12],
    count: usize,
}

impl Polygon {
    fn triangle([a, b, c]: [DVec3; 3]) -> Self {
        let mut points = [DVec3::ZERO; 12];
        points[..3].copy_from_slice(&[a, b, c]);
        Self { points, count: 3 }
    }

    fn corners(&self) -> &[DVec3] {
        &self.points[..self.count]
    }

    fn push(&mut self, p: DVec3) {
        if self.count < self.points.len() {
            self.points[self.count] = p;
            self.count += 1;
        }
    }

    /// Its parts inside and outside of a half-space.
    fn split(&self, by: HalfSpace) -> [Self; 2] {
        let empty = Self {
            points: [DVec3::ZERO; 12],
            count: 0,
        };
        let [mut inside, mut outside] = [empty; 2];
        for (i, &p) in self.corners().iter().enumerate() {
            let q = self.points[(i + 1) % self.count];
            let (hp, hq) = (by.excess(p), by.excess(q));
            if hp <= 0.0 {
                inside.push(p);
            }
            if hp >= 0.0 {
                outside.push(p);
            }
            if (hp < 0.0 && hq > 0.0) || (hp > 0.0 && hq < 0.0) {
                let between = p + (q - p) * (hp / (hp - hq));
                inside.push(between);
                outside.push(between);
            }
        }
        [inside, outside]
    }
}

impl Prism {
    /// The largest height, up or down, of the part of a triangle that is in the column; 0 where there is none.
    pub fn largest_height(&self, triangle: [DVec3; 3]) -> f64 {
        self.height_of(Polygon::triangle(triangle))
    }

    fn height_of(&self, whole: Polygon) -> f64 {
        let walls = self.walls.iter();
        let inside = walls.fold(whole, |piece, &wall| piece.split(wall)[0]);
        let heights = inside.corners().iter().map(|&p| self.height(p).abs());
        heights.fold(0.0, f64::max)
    }
}

impl Neighborhood {
    /// An upper bound of the distance from every point of the new triangles with the apex `v` (relative to the origin) to
    /// the old ones.
    ///
    /// O(faces * link edges), more where there are gaps.
    pub fn deviation(&self, v: DVec3) -> f64 {
        self.measure(v, f64::INFINITY)
    }

    /// True where [`Neighborhood::deviation`] is at most `bound`; faster where it is not.
    pub fn keeps(&self, v: DVec3, bound: f64) -> bool {
        self.measure(v, bound) <= bound
    }

    /// The deviation, or a smaller number above `enough`.
    fn measure(&self, v: DVec3, enough: f64) -> f64 {
        let mut most: f64 = 0.0;
        for &[p, q] in &self.links {
            let whole = Polygon::triangle([v, p, q]);
            for prism in &self.prisms {
                most = most.max(prism.height_of(whole));
                if most > enough {
                    return most;
                }
            }
        }
        let facets: Vec<Facet> = self.faces.iter().map(|f| Facet::new(f.points)).collect();
        for &[p, q] in &self.links {
            most = most.max(self.gaps(&facets, [v, p, q], most));
            if most > enough {
                return most;
            }
        }
        most
    }

    /// The distance of what is in no column; at most `known` where a single old triangle is as near to all of it.
    fn gaps(&self, facets: &[Facet], corners: [DVec3; 3], known: f64) -> f64 {
        let distance = |corners: &[DVec3]| {
            let farthest = |f: &Facet| {
                let distances = corners.iter().map(|&p| f.distance2(p));
                distances.fold(0.0, f64::max)
            };
            let nearest = facets.iter().map(farthest).fold(f64::INFINITY, f64::min);
            math::sqrt(nearest)
        };
        let whole = distance(&corners);
        if whole <= known {
            return whole;
        }
        let mut left = vec![Polygon::triangle(corners)];
        let mut next = Vec::new();
        for prism in &self.prisms {
            for mut piece in left.drain(..) {
                for &wall in &prism.walls {
                    let [inside, outside] = piece.split(wall);
                    if outside.count >= 3 {
                        if outside.count >= 9 {
                            // No room for more corners: the piece counts whole, which is no less.
                            return whole;
                        }
                        next.push(outside);
                    }
                    piece = inside;
                    if piece.count < 3 {
                        break;
                    }
                }
            }
            std::mem::swap(&mut left, &mut next);
        }
        let gaps = left.iter().map(|piece| distance(piece.corners()));
        gaps.fold(0.0, f64::max)
    }
}
