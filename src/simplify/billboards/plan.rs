//! The plan view: faces of a mesh seen from above.
//!
//! A vertical wall is one segment; any other triangle is its three edges, because at a fixed abscissa the limit grows
//! with the coordinate along the direction, so that its smallest value over a plan triangle lies on an edge.

use glam::{DVec2, DVec3};

use super::viewers_in_plan::PlanCell;
use crate::{
    bound::planar::{Interval, Projection},
    geometry::area_normal,
    mesh::Mesh,
    num::Each,
};

/// The axis that points up; the other two, in cyclic order, span the ground.
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
    pub fn plan(self, p: DVec3) -> DVec2 {
        match self {
            Self::X => DVec2::new(p.y, p.z),
            Self::Y => DVec2::new(p.z, p.x),
            Self::Z => DVec2::new(p.x, p.y),
        }
    }

    /// Height.
    pub fn height(self, p: DVec3) -> f64 {
        match self {
            Self::X => p.x,
            Self::Y => p.y,
            Self::Z => p.z,
        }
    }

    /// The point above `plan` at some height.
    pub fn place(self, plan: DVec2, height: f64) -> DVec3 {
        match self {
            Self::X => DVec3::new(height, plan.x, plan.y),
            Self::Y => DVec3::new(plan.y, height, plan.x),
            Self::Z => DVec3::new(plan.x, plan.y, height),
        }
    }
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
    /// A wall of one triangle, for tests.
    #[cfg(test)]
    pub(super) fn wall(triangle: u32, from: DVec2, along: DVec2) -> Self {
        Self {
            segments: vec![[from, from + along]],
            triangles: vec![triangle],
            area: along.perp(),
        }
    }

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
                Limits::Distance(direction, distance) => {
                    for rho in [a.dot(*direction), b.dot(*direction)] {
                        all = all.and(Interval::around(rho, *distance));
                    }
                }
            }
        }
        all
    }

    /// True where the face may be projected on the plane at `rho`.
    pub(super) fn fits(&self, limits: &Limits, rho: f64) -> bool {
        self.may_reach(limits, Interval::at(rho)) && self.interval(limits).contains(rho)
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

/// The limits of projections of one bearing.
#[derive(Clone, Debug)]
pub(super) enum Limits {
    /// The sides of a cell.
    Viewers(Vec<Projection>),
    /// Nothing reaches planes along the direction of projection.
    Parallel,
    /// A distance along a direction.
    Distance(DVec2, f64),
}

/// The faces of a mesh in plan; triangles that meet the cell are listed apart.
#[derive(Clone, Debug, Default)]
pub(super) struct Plan {
    pub(super) faces: Vec<PlanFace>,
    /// Triangles that viewers stand on, under or in.
    pub(super) touched: Vec<u32>,
}

impl Plan {
    /// The faces of a mesh, in the order of their first triangles. O(n log n).
    pub(super) fn new(mesh: &Mesh, cell: &PlanCell, up: Up) -> Self {
        let mut plan = Self::default();
        let mut keyed: Vec<([u64; 12], u32, Vec<[DVec2; 2]>)> = Vec::new();
        for t in 0..mesh.triangles().len() {
            let corners = mesh.corners(t).each(|c| up.plan(c));
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
            let across = up.plan(area_normal(mesh.corners(t as usize)) / 2.0);
            if last == Some(key)
                && let Some(face) = plan.faces.last_mut()
            {
                face.triangles.push(t);
                let against = face.area.dot(across) < 0.0;
                face.area += if against { -across } else { across };
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
