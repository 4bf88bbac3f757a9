//! The distance from a view cell to points, segments and triangles, as a lower bound that holds.
//!
//! Bounded cells: Gilbert, Johnson & Keerthi 1988, the point closest to the origin in the hull of all differences. The
//! answer is not what the iteration believes but what its last direction proves: both sets lie on two sides of a slab
//! across it, whose width is computed and lessened by its rounding error. Cells without an end: closed forms, lessened
//! alike. So an answer is never above the distance, and below it by at most some 1e-14 of the extent of both sets
//! where they are apart. Units of the positions, whose magnitudes should be near 1 ([`Frame`](crate::num::Frame)).

use glam::DVec3;

use super::{Shape, ViewCell};
use crate::num::{Frame, math::length};

/// Upper bound of the rounding error of a signed distance, as a multiple of the sum of the magnitudes of the
/// coordinates of the difference it is computed from.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Steps of the iteration; it takes 3 to 6, and what it has proved at any step holds.
const STEPS: u32 = 64;

impl ViewCell {
    /// A lower bound of the distance from `p` to the cell, 0 where `p` lies inside.
    #[must_use]
    pub fn distance_to_point(&self, p: DVec3) -> f64 {
        self.distance_to_hull(&[p])
    }

    /// A lower bound of the smallest distance between a point of the triangle and a viewpoint, 0 where they meet.
    #[must_use]
    pub fn distance_to_triangle(&self, corners: [DVec3; 3]) -> f64 {
        self.distance_to_hull(&corners)
    }

    /// A lower bound of the distance between the convex hull of `points` and the cell, 0 where they meet or there are
    /// no points.
    #[must_use]
    pub fn distance_to_hull(&self, points: &[DVec3]) -> f64 {
        match self.shape() {
            Shape::Point(at) => between(points, &[*at]),
            Shape::Segment(ends) => between(points, ends),
            Shape::Polygon { corners, .. } | Shape::Polyhedron { corners, .. } => {
                between(points, corners)
            }
            Shape::Line { point, direction } => from_line(points, *point, *direction),
            Shape::Plane { point, normal } => {
                above(points, *point, *normal).max(above(points, *point, -*normal))
            }
            Shape::HalfSpace { point, normal } => above(points, *point, *normal),
        }
    }

    /// True where `p` is a viewpoint of the cell or so near to one that rounding cannot tell: within some 1e-14 of the
    /// distance to the farthest corner.
    #[must_use]
    pub fn contains(&self, p: DVec3) -> bool {
        self.distance_to_point(p) <= 0.0
    }
}

/// A length that has to be subtracted from a signed distance of the difference `d` so that it is none too large.
fn rounding(d: DVec3) -> f64 {
    ROUNDING * ((d.x.abs() + d.y.abs()) + d.z.abs())
}

/// The least height of the points above a plane, 0 where one lies below.
fn above(points: &[DVec3], point: DVec3, normal: DVec3) -> f64 {
    let heights = points.iter().map(|&p| {
        let d = p - point;
        d.dot(normal) - rounding(d)
    });
    heights
        .reduce(|a, b| if a <= b { a } else { b })
        .filter(|h| h.is_finite())
        .unwrap_or(0.0)
        .max(0.0)
}

/// Seen along the line, which is then one point.
fn from_line(points: &[DVec3], point: DVec3, direction: DVec3) -> f64 {
    let across = |&p: &DVec3| {
        let d = p - point;
        d - direction * d.dot(direction)
    };
    let seen: Vec<DVec3> = points.iter().map(across).collect();
    let lost = points.iter().map(|&p| rounding(p - point));
    let lost = lost.fold(0.0, f64::max);
    (between(&seen, &[DVec3::ZERO]) - lost).max(0.0)
}

/// The distance between two convex hulls.
fn between(points: &[DVec3], corners: &[DVec3]) -> f64 {
    let (Some(&p), Some(&c)) = (points.first(), corners.first()) else {
        return 0.0;
    };
    let mut simplex = Simplex::new(p - c);
    let mut nearest = p - c;
    let mut proved = 0.0;
    for _ in 0..STEPS {
        let Some((size, along)) = size_and_direction(nearest) else {
            break;
        };
        let slab = Slab::new(points, corners, along);
        if slab.width > proved {
            proved = slab.width;
        }
        // The closest difference is within rounding of what is proved, or the iteration has nothing new to offer.
        if size - slab.width <= 4.0 * slab.error || simplex.has(slab.closest) {
            break;
        }
        simplex.push(slab.closest);
        let next = simplex.reduce();
        if next.dot(next) >= nearest.dot(nearest) {
            break;
        }
        nearest = next;
    }
    proved
}

/// Length and unit direction of `d`, also where its square would be subnormal or overflow: a direction longer than 1
/// would prove too much. `None` where there is none.
fn size_and_direction(d: DVec3) -> Option<(f64, DVec3)> {
    let square = d.dot(d);
    let frame = if square > 1e-280 && square < 1e280 {
        Frame::default()
    } else {
        Frame::for_size(d.abs().max_element())
    };
    let near_one = frame.enter(d);
    let size = length(near_one);
    (size > 0.0 && size < f64::INFINITY).then(|| (frame.leave_length(size, 1), near_one / size))
}

/// A unit direction along which the points lie beyond the corners by at least `width`.
struct Slab {
    /// Computed width less its rounding error; may be negative.
    width: f64,
    error: f64,
    /// The difference of a point and a corner with the least coordinate along the direction.
    closest: DVec3,
}

impl Slab {
    fn new(points: &[DVec3], corners: &[DVec3], along: DVec3) -> Self {
        let origin = corners[0];
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut first, mut last) = (points[0], origin);
        let mut error = 0.0_f64;
        for &p in points {
            let h = (p - origin).dot(along);
            error = error.max(rounding(p - origin));
            if h < low {
                (low, first) = (h, p);
            }
        }
        for &c in corners {
            let h = (c - origin).dot(along);
            error = error.max(rounding(c - origin));
            if h > high {
                (high, last) = (h, c);
            }
        }
        Self {
            width: low - high - 2.0 * error,
            error,
            closest: first - last,
        }
    }
}

/// At most four differences; the closest point of their hull is wanted.
struct Simplex {
    vertices: [DVec3; 4],
    count: usize,
}

impl Simplex {
    fn new(vertex: DVec3) -> Self {
        Self {
            vertices: [vertex; 4],
            count: 1,
        }
    }

    fn has(&self, vertex: DVec3) -> bool {
        self.vertices[..self.count].contains(&vertex)
    }

    fn push(&mut self, vertex: DVec3) {
        if self.count < 4 {
            self.vertices[self.count] = vertex;
            self.count += 1;
        }
    }

    /// The point of the hull that is closest to the origin; keeps the vertices of the side it lies on. Every side is
    /// tried: there are 15, and none of them is decided by a sign that rounding could turn.
    fn reduce(&mut self) -> DVec3 {
        let mut best = (f64::INFINITY, self.vertices[0], 1_usize);
        for subset in 1_usize..1 << self.count {
            let mut side = [DVec3::ZERO; 4];
            let mut n = 0;
            for (i, &v) in self.vertices[..self.count].iter().enumerate() {
                if subset >> i & 1 == 1 {
                    side[n] = v;
                    n += 1;
                }
            }
            let candidate = match n {
                1 => Some(side[0]),
                2 => on_edge(side[0], side[1]),
                3 => on_face(side[0], side[1], side[2]),
                _ => inside(side).then_some(DVec3::ZERO),
            };
            if let Some(q) = candidate
                && q.dot(q) < best.0
            {
                best = (q.dot(q), q, subset);
            }
        }
        let old = self.vertices;
        let before = self.count;
        self.count = 0;
        for (i, &v) in old[..before].iter().enumerate() {
            if best.2 >> i & 1 == 1 {
                self.push(v);
            }
        }
        best.1
    }
}

/// The foot of the origin where it lies between two points.
fn on_edge(a: DVec3, b: DVec3) -> Option<DVec3> {
    let ab = b - a;
    let t = -(a.dot(ab) / ab.dot(ab));
    (t > 0.0 && t < 1.0).then(|| a + ab * t)
}

/// The foot of the origin where it lies in a triangle.
fn on_face(a: DVec3, b: DVec3, c: DVec3) -> Option<DVec3> {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let norm = normal.dot(normal);
    let v = (-a).cross(ac).dot(normal) / norm;
    let w = ab.cross(-a).dot(normal) / norm;
    (v > 0.0 && w > 0.0 && v + w < 1.0).then(|| normal * (a.dot(normal) / norm))
}

/// True where the origin lies in a tetrahedron that has a volume.
fn inside([a, b, c, d]: [DVec3; 4]) -> bool {
    let side = |p: DVec3, q: DVec3, r: DVec3, other: DVec3| {
        let normal = (q - p).cross(r - p);
        let (origin, other) = (-p.dot(normal), (other - p).dot(normal));
        (origin >= 0.0 && other > 0.0) || (origin <= 0.0 && other < 0.0)
    };
    side(a, b, c, d) && side(a, b, d, c) && side(a, c, d, b) && side(b, c, d, a)
}
