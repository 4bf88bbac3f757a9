//! The viewers of a cell in plan: segments around an inside.

use glam::DVec2;

use super::{Limit, Up, bearing::Bearing, plan::Limits};
use crate::{
    Error, Result,
    bound::{
        planar::{Projection, ViewerSegment},
        view_cell::{Shape, ViewCell},
    },
    num::math::range,
};

/// Viewers seen from above.
#[derive(Clone, Debug)]
pub(super) struct PlanCell {
    /// Boundary: whoever is inside sees no more than the boundary does.
    pub(super) sides: Vec<ViewerSegment>,
    inside: Inside,
}

#[derive(Clone, Debug)]
enum Inside {
    /// The cell has no inside.
    Nothing,
    /// A convex polygon, counter-clockwise.
    Polygon(Vec<DVec2>),
    /// The points `p` with `(p - point) . normal <= 0`.
    HalfPlane { point: DVec2, normal: DVec2 },
}

impl PlanCell {
    /// The viewers of a cell seen from above.
    ///
    /// # Errors
    /// [`Error::Usage`] where they cover the ground.
    pub(super) fn new(cell: &ViewCell, up: Up) -> Result<Self> {
        let everywhere = |what: &str| {
            Err(Error::Usage(format!(
                "seen from above, the {what} covers the ground, so that viewers are everywhere; give a cell that leaves \
                 room for the scene, or another up axis"
            )))
        };
        let nothing = |sides| {
            Ok(Self {
                sides,
                inside: Inside::Nothing,
            })
        };
        match cell.shape() {
            Shape::HalfSpace { point, normal } | Shape::Plane { point, normal } => {
                let half_space = matches!(cell.shape(), Shape::HalfSpace { .. });
                if up.height(*normal).abs() > 1e-12 {
                    return everywhere(if half_space { "half-space" } else { "plane" });
                }
                let (point, normal) = (up.plan(*point), up.plan(*normal));
                let sides = vec![ViewerSegment::line(point, normal.perp())?];
                if !half_space {
                    return nothing(sides);
                }
                let inside = Inside::HalfPlane { point, normal };
                Ok(Self { sides, inside })
            }
            Shape::Line { point, direction } => {
                let along = up.plan(*direction);
                let point = up.plan(*point);
                nothing(vec![if along.length_squared() < 1e-24 {
                    ViewerSegment::between(point, point)?
                } else {
                    ViewerSegment::line(point, along)?
                }])
            }
            Shape::Point(_)
            | Shape::Segment(_)
            | Shape::Polygon { .. }
            | Shape::Polyhedron { .. } => {
                let corners = cell.corners().unwrap_or_default();
                let hull = convex_hull(corners.iter().map(|&c| up.plan(c)).collect());
                match hull[..] {
                    [a] => nothing(vec![ViewerSegment::between(a, a)?]),
                    [a, b] => nothing(vec![ViewerSegment::between(a, b)?]),
                    _ => {
                        let side =
                            |i: usize| ViewerSegment::between(hull[i], hull[(i + 1) % hull.len()]);
                        let sides = (0..hull.len()).map(side).collect::<Result<_>>()?;
                        let inside = Inside::Polygon(hull);
                        Ok(Self { sides, inside })
                    }
                }
            }
        }
    }

    /// True where part of the convex hull of `points` lies among the viewers, its border included. A cell without an
    /// inside meets triangles that are no wall; walls are told by their intervals.
    pub(super) fn meets(&self, points: &[DVec2]) -> bool {
        match &self.inside {
            Inside::Nothing => match *points {
                [a, b, c] => self.sides.iter().any(|side| stands_in(side, [a, b, c])),
                _ => false,
            },
            Inside::HalfPlane { point, normal } => {
                points.iter().any(|p| (p - point).dot(*normal) <= 0.0)
            }
            Inside::Polygon(hull) => !(separated(hull, points) || separated(points, hull)),
        }
    }

    /// A lower bound of the distance between viewers and the segment from `a` to `b`, 0 where they meet.
    pub(super) fn distance(&self, a: DVec2, b: DVec2) -> f64 {
        if self.meets(&[a, b]) {
            return 0.0;
        }
        let distances = self.sides.iter().map(|side| segment_distance(side, a, b));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Some viewpoint, to tell on which side of a plane viewers are.
    pub(super) fn somewhere(&self) -> DVec2 {
        let side = &self.sides[0];
        let [first, last] = side.ends();
        let ends = first.is_finite();
        side.viewpoint(if ends { (first + last) / 2.0 } else { 0.0 })
    }

    /// The limits of projections on planes of `bearing`; a distance is measured along their normal.
    pub(super) fn limits(&self, bearing: Bearing, limit: Limit) -> Limits {
        let Bearing { normal, along } = bearing;
        match limit {
            Limit::Angle(aperture) => {
                let new = |side| Projection::oblique(side, along, normal, aperture);
                let sides: Result<Vec<Projection>> = self.sides.iter().map(new).collect();
                sides.map_or(Limits::Parallel, Limits::Viewers)
            }
            Limit::Distance(distance) => Limits::Distance(normal, distance),
        }
    }
}

/// True where a side of `polygon` has all of `points` outside.
fn separated(polygon: &[DVec2], points: &[DVec2]) -> bool {
    let n = polygon.len();
    (0..n).any(|i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        let side = b - a;
        let all = |sign: f64, of: &[DVec2], least: f64| {
            of.iter().all(|&p| sign * side.perp_dot(p - a) > least)
        };
        // Of two points, either side may be the outside one.
        [1.0, -1.0].into_iter().any(|sign| {
            let scale = side.length_squared() * 1e-12;
            polygon
                .iter()
                .all(|&p| sign * side.perp_dot(p - a) <= scale)
                && all(sign, points, scale)
        })
    })
}

/// True where viewers on a segment stand in a triangle that is no segment itself, its border included.
fn stands_in(side: &ViewerSegment, corners: [DVec2; 3]) -> bool {
    let [a, b, c] = corners.map(|p| side.enter(p));
    if (b - a).perp_dot(c - a) == 0.0 {
        return false;
    }
    // Where the triangle's border meets the axis of the segment.
    let meetings = [(a, b), (b, c), (c, a)].into_iter().filter_map(|(p, q)| {
        let apart = (p.y > 0.0 && q.y > 0.0) || (p.y < 0.0 && q.y < 0.0);
        let along = p.y / (p.y - q.y);
        (!apart).then(|| match along.is_finite() {
            true => [p.x + (q.x - p.x) * along; 2],
            false => [p.x, q.x],
        })
    });
    let [low, high] = range(meetings.flatten());
    let [first, last] = side.ends();
    low <= last && first <= high
}

/// Distance between viewers on a segment and the segment from `a` to `b`.
fn segment_distance(side: &ViewerSegment, a: DVec2, b: DVec2) -> f64 {
    let (a, b) = (side.enter(a), side.enter(b));
    let [first, last] = side.ends();
    let crosses = (a.y < 0.0) != (b.y < 0.0) && {
        let x = a.x + (b.x - a.x) * (a.y / (a.y - b.y));
        first <= x && x <= last
    };
    if crosses {
        return 0.0;
    }
    let to_side = |p: DVec2| DVec2::new(p.x - p.x.clamp(first, last), p.y).length();
    let to_face = |x: f64| {
        let (p, along) = (DVec2::new(x, 0.0), b - a);
        let t = (p - a).dot(along) / along.length_squared();
        let share = if t.is_finite() { t } else { 0.0 };
        p.distance(a + along * share.clamp(0.0, 1.0))
    };
    let ends = [first, last].into_iter().filter(|x| x.is_finite());
    ends.map(to_face).fold(to_side(a).min(to_side(b)), f64::min)
}

/// The corners of the convex hull, counter-clockwise; one for a point, two for a segment.
fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - a) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}
