//! A convex polyhedron that half-spaces cut.

use std::cmp::Ordering;

use glam::DVec3;

use super::{HalfSpace, Quadratic};
use crate::{
    geometry::Box3,
    num::{Each, math},
};

/// A side of a polyhedron.
#[derive(Clone, Debug, PartialEq)]
struct Side {
    bound: HalfSpace,
    points: Vec<DVec3>,
}

/// A bounded convex polyhedron: an intersection of half-spaces, with its corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyhedron {
    sides: Vec<Side>,
}

impl Polyhedron {
    /// The box between two corners, each coordinate of the second above that of the first.
    pub fn cuboid(low: DVec3, high: DVec3) -> Self {
        let at = |i: usize| Box3 { low, high }.corner(i);
        let sides = [
            (-DVec3::X, [0, 4, 6, 2]),
            (DVec3::X, [1, 3, 7, 5]),
            (-DVec3::Y, [0, 1, 5, 4]),
            (DVec3::Y, [2, 6, 7, 3]),
            (-DVec3::Z, [0, 2, 3, 1]),
            (DVec3::Z, [4, 5, 7, 6]),
        ];
        let side = |(normal, corners): (DVec3, [usize; 4])| {
            let points = corners.each(at).to_vec();
            let offset = normal.dot(points[0]);
            let bound = HalfSpace { normal, offset };
            Side { bound, points }
        };
        Self {
            sides: sides.map(side).to_vec(),
        }
    }

    /// Every corner, once for every side that has it.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> {
        self.sides.iter().flat_map(|s| s.points.iter().copied())
    }

    /// The half-spaces that bound it.
    pub fn bounds(&self) -> impl Iterator<Item = HalfSpace> {
        self.sides.iter().map(|s| s.bound)
    }

    /// True where a point is inside, or outside by no more than `tolerance`.
    pub fn contains(&self, p: DVec3, tolerance: f64) -> bool {
        self.bounds().all(|b| b.excess(p) <= tolerance)
    }

    /// The part of it in a half-space; `None` where that is no more than `tolerance` thick there.
    pub fn cut(&self, by: HalfSpace, tolerance: f64) -> Option<Self> {
        let [low, high] = math::range(self.corners().map(|p| by.excess(p)));
        if high <= tolerance {
            return Some(self.clone());
        }
        if low >= -tolerance {
            return None;
        }
        let mut sides = Vec::with_capacity(self.sides.len() + 1);
        let mut rim: Vec<DVec3> = Vec::new();
        for side in &self.sides {
            let mut points: Vec<DVec3> = Vec::with_capacity(side.points.len() + 1);
            for (i, &p) in side.points.iter().enumerate() {
                let q = side.points[(i + 1) % side.points.len()];
                let (hp, hq) = (by.excess(p), by.excess(q));
                if hp <= 0.0 {
                    points.push(p);
                }
                if (hp < 0.0 && hq > 0.0) || (hp > 0.0 && hq < 0.0) {
                    // In one direction for both sides of the edge, so that both get the same point.
                    let mut ends = [(p, hp), (q, hq)];
                    if hp >= hq {
                        ends.swap(0, 1);
                    }
                    let [(a, ha), (b, hb)] = ends;
                    points.push(a + (b - a) * (ha / (ha - hb)));
                }
            }
            rim.extend(points.iter().filter(|&&p| by.excess(p) >= -tolerance));
            if points.len() >= 3 {
                let bound = side.bound;
                sides.push(Side { bound, points });
            }
        }
        let points = around(rim, by.normal, tolerance);
        if points.len() >= 3 {
            sides.push(Side { bound: by, points });
        }
        (sides.len() >= 4).then_some(Self { sides })
    }

    /// Puts what is left of it outside the intersection of half-spaces into `into`: disjoint polyhedra, or itself where
    /// there is nothing of it inside. Parts of no more volume than `least` are dropped.
    pub fn outside(self, of: &[HalfSpace], tolerance: f64, least: f64, into: &mut Vec<Self>) {
        let start = into.len();
        let mut rest = self.clone();
        // What is cut off first stays in one piece: the larger, the fewer polyhedra in the end.
        let mut order: Vec<(f64, HalfSpace)> = of
            .iter()
            .map(|b| (self.corners().map(|p| b.excess(p)).fold(0.0, f64::max), *b))
            .filter(|(depth, _)| *depth > tolerance)
            .collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, bound) in &order {
            if let Some(part) = rest.cut(bound.complement(), tolerance)
                && part.volume() > least
            {
                into.push(part);
            }
            match rest.cut(*bound, tolerance) {
                Some(inside) => rest = inside,
                None => {
                    into.truncate(start);
                    into.push(self);
                    return;
                }
            }
        }
    }

    /// True where all of it is outside one of the half-spaces.
    pub fn misses(&self, all: &[HalfSpace], tolerance: f64) -> bool {
        all.iter()
            .any(|b| self.corners().all(|p| b.excess(p) >= -tolerance))
    }

    /// Its volume.
    pub fn volume(&self) -> f64 {
        let Some(apex) = self.corners().next() else {
            return 0.0;
        };
        let mut six = 0.0;
        for side in &self.sides {
            let height = -side.bound.excess(apex);
            let mut area2 = DVec3::ZERO;
            for pair in side.points.windows(2) {
                area2 += (pair[0] - side.points[0]).cross(pair[1] - side.points[0]);
            }
            six += height * area2.dot(side.bound.normal).abs();
        }
        six / 6.0
    }

    /// The point of it at which a convex function is least, and the value there.
    pub fn minimum(&self, of: &Quadratic, tolerance: f64) -> Option<(DVec3, f64)> {
        if let Some(v) = of.minimum()
            && self.contains(v, tolerance)
        {
            return Some((v, of.at(v)));
        }
        let mut best: Option<(DVec3, f64)> = None;
        let mut offer = |v: DVec3| {
            let value = of.at(v);
            if best.is_none_or(|(_, least)| value < least) {
                best = Some((v, value));
            }
        };
        for side in &self.sides {
            if let Some(v) = of.minimum_on_plane(side.points[0], side.bound.normal)
                && self.contains(v, tolerance)
            {
                offer(v);
            }
            for (i, &p) in side.points.iter().enumerate() {
                offer(of.minimum_between(p, side.points[(i + 1) % side.points.len()]));
            }
        }
        best
    }
}

/// The corners of a convex polygon in order around its normal, points nearer than `tolerance` united.
fn around(points: Vec<DVec3>, normal: DVec3, tolerance: f64) -> Vec<DVec3> {
    let mut few: Vec<DVec3> = Vec::with_capacity(points.len());
    for p in points {
        let near = |q: &DVec3| (*q - p).dot(*q - p) <= tolerance * tolerance;
        if !few.iter().any(near) {
            few.push(p);
        }
    }
    if few.len() < 3 {
        return few;
    }
    let middle = few.iter().fold(DVec3::ZERO, |sum, &p| sum + p) / few.len() as f64;
    let x = few[0] - middle;
    let y = normal.cross(x);
    // Grows with the angle from 0 to 4, without an arc tangent.
    let turn = |p: &DVec3| {
        let (a, b) = ((*p - middle).dot(x), (*p - middle).dot(y));
        let share = b.abs() / (a.abs() + b.abs());
        match (a >= 0.0, b >= 0.0) {
            (true, true) => share,
            (false, true) => 2.0 - share,
            (false, false) => 2.0 + share,
            (true, false) => 4.0 - share,
        }
    };
    few.sort_by(|p, q| turn(p).partial_cmp(&turn(q)).unwrap_or(Ordering::Equal));
    few
}
