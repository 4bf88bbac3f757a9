//! The plan view: what faces and cells are when seen from above.
//!
//! A vertical wall is one segment; any other triangle is its three edges, because at a fixed abscissa the limit grows
//! with the coordinate along the direction, so that its smallest value over a plan triangle lies on an edge.

use glam::{DVec2, DVec3};

use super::{Limit, bearing::Bearing};
use crate::{
    Error, Result,
    bound::{
        planar::{Interval, Projection, ViewerSegment},
        view_cell::{Shape, ViewCell},
    },
    mesh::Mesh,
};

/// Which axis points up; the other two, in cyclic order, span the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Up {
    /// The x-axis.
    X,
    /// The y-axis.
    Y,
    /// The z-axis.
    Z,
}

impl Up {
    /// Seen from above.
    #[must_use]
    pub fn plan(self, p: DVec3) -> DVec2 {
        match self {
            Self::X => DVec2::new(p.y, p.z),
            Self::Y => DVec2::new(p.z, p.x),
            Self::Z => DVec2::new(p.x, p.y),
        }
    }

    /// Height.
    #[must_use]
    pub fn height(self, p: DVec3) -> f64 {
        match self {
            Self::X => p.x,
            Self::Y => p.y,
            Self::Z => p.z,
        }
    }

    /// The point above `plan` at some height.
    #[must_use]
    pub fn place(self, plan: DVec2, height: f64) -> DVec3 {
        match self {
            Self::X => DVec3::new(height, plan.x, plan.y),
            Self::Y => DVec3::new(plan.y, height, plan.x),
            Self::Z => DVec3::new(plan.x, plan.y, height),
        }
    }
}

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
    /// Where `(p - point) . normal <= 0`.
    HalfPlane { point: DVec2, normal: DVec2 },
}

impl PlanCell {
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
        let x = if first.is_finite() {
            (first + last) / 2.0
        } else {
            0.0
        };
        side.viewpoint(x)
    }

    /// What limits projections on planes of `bearing`; a distance is measured along their normal.
    pub(super) fn limits(&self, bearing: Bearing, limit: Limit) -> Limits {
        let Bearing { normal, along } = bearing;
        match limit {
            Limit::Angle(aperture) => {
                let new = |side| Projection::oblique(side, along, normal, aperture);
                let sides: Result<Vec<Projection>> = self.sides.iter().map(new).collect();
                sides.map_or(Limits::Parallel, Limits::Viewers)
            }
            Limit::Distance(distance) => Limits::Distance {
                direction: normal,
                distance,
            },
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
        (!apart).then(|| {
            if along.is_finite() {
                [p.x + (q.x - p.x) * along; 2]
            } else {
                [p.x.min(q.x), p.x.max(q.x)]
            }
        })
    });
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let [low, high] = meetings.fold(none, |[low, high], [from, to]| {
        [low.min(from), high.max(to)]
    });
    let [first, last] = side.ends();
    low <= last && first <= high
}

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
        let t = if t.is_finite() {
            t.clamp(0.0, 1.0)
        } else {
            0.0
        };
        p.distance(a + along * t)
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

/// Triangles that are one and the same in plan: a wall, or the three edges of a triangle.
#[derive(Clone, Debug)]
pub(super) struct PlanFace {
    /// One segment, or three.
    pub(super) segments: Vec<[DVec2; 2]>,
    /// The triangles.
    pub(super) triangles: Vec<u32>,
    /// Sum of normals times area of the triangles, each turned to the same side, seen from above.
    pub(super) area: DVec2,
}

impl PlanFace {
    /// True for a vertical wall.
    pub(super) fn is_wall(&self) -> bool {
        self.segments.len() == 1
    }

    /// The offsets that the face may be projected on.
    pub(super) fn interval(&self, limits: &Limits) -> Interval {
        let mut all = Interval::ALL;
        for &[a, b] in &self.segments {
            match limits {
                Limits::Parallel => return Interval::NONE,
                Limits::Viewers(sides) => {
                    for side in sides {
                        all = all.and(side.interval(a, b));
                        if all.is_empty() {
                            return all;
                        }
                    }
                }
                Limits::Distance {
                    direction,
                    distance,
                } => {
                    for rho in [a.dot(*direction), b.dot(*direction)] {
                        all = all.and(Interval {
                            min: rho - distance,
                            max: rho + distance,
                        });
                    }
                }
            }
        }
        all
    }
}

impl PlanFace {
    /// Whether the face may be projected on the plane at `rho`.
    pub(super) fn fits(&self, limits: &Limits, rho: f64) -> bool {
        self.may_reach(limits, Interval { min: rho, max: rho })
            && self.interval(limits).contains(rho)
    }

    /// False only where the face may be projected on no plane at one of `offsets`.
    pub(super) fn may_reach(&self, limits: &Limits, offsets: Interval) -> bool {
        let Limits::Viewers(sides) = limits else {
            return !matches!(limits, Limits::Parallel);
        };
        let [a, b] = self.segments[0];
        sides
            .iter()
            .all(|side| side.may_reach(a, offsets) && side.may_reach(b, offsets))
    }
}

/// What limits projections of one bearing.
#[derive(Clone, Debug)]
pub(super) enum Limits {
    /// The sides of a cell.
    Viewers(Vec<Projection>),
    /// Nothing reaches planes along the direction of projection.
    Parallel,
    /// A distance.
    Distance { direction: DVec2, distance: f64 },
}

/// The faces of a mesh in plan; triangles that meet the cell are listed apart.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    pub(super) faces: Vec<PlanFace>,
    /// Triangles that viewers stand on, under or in.
    pub(super) touched: Vec<u32>,
}

impl Plan {
    pub(super) fn new(mesh: &Mesh, cell: &PlanCell, up: Up) -> Self {
        let mut plan = Self::default();
        let mut keyed: Vec<([u64; 12], u32, Vec<[DVec2; 2]>)> = Vec::new();
        for t in 0..mesh.triangles().len() {
            let corners = mesh.corners(t).map(|c| up.plan(c));
            if cell.meets(&corners) {
                plan.touched.push(t as u32);
                continue;
            }
            let segments = segments(corners);
            let mut key = [0; 12];
            let coordinates = segments.iter().flatten().flat_map(|p| p.to_array());
            for (slot, x) in key.iter_mut().zip(coordinates) {
                // Both zeros are one place.
                *slot = (x + 0.0).to_bits();
            }
            keyed.push((key, t as u32, segments));
        }
        keyed.sort_by_key(|&(key, t, _)| (key, t));
        let mut last = None;
        for (key, t, segments) in keyed {
            let corners = mesh.corners(t as usize);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]) / 2.0;
            let across = up.plan(normal);
            if last == Some(key)
                && let Some(face) = plan.faces.last_mut()
            {
                face.triangles.push(t);
                let turned = if face.area.dot(across) < 0.0 {
                    -across
                } else {
                    across
                };
                face.area += turned;
            } else {
                plan.faces.push(PlanFace {
                    segments,
                    triangles: vec![t],
                    area: across,
                });
            }
            last = Some(key);
        }
        // In the order of the mesh, not of coordinates.
        plan.faces.sort_by_key(|face| face.triangles[0]);
        plan
    }
}

/// The longest edge of a triangle that is a segment in plan; else all three. Edges go from the smaller end.
fn segments([a, b, c]: [DVec2; 3]) -> Vec<[DVec2; 2]> {
    let ordered = |p: DVec2, q: DVec2| {
        let first = p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).is_le();
        if first { [p, q] } else { [q, p] }
    };
    let mut edges = [ordered(a, b), ordered(b, c), ordered(c, a)].to_vec();
    edges.sort_by(|e, f| {
        let length = |e: &[DVec2; 2]| e[0].distance_squared(e[1]);
        length(f).total_cmp(&length(e))
    });
    if (b - a).perp_dot(c - a) == 0.0 {
        edges.truncate(1);
    }
    edges
}
