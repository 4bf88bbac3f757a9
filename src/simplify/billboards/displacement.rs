//! The displacement of points that viewers see: across the horizon, exactly at every vertex, and up or down, from sampled
//! viewpoints.

use glam::DVec2;

use super::{Quad, plan::Up, viewers_in_plan::PlanCell};
use crate::{
    bound::{planar::segment_error, view_cell::ViewCell},
    mesh::Mesh,
    num::math,
};

/// The largest displacements of vertices, in radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// Across the horizon, over all viewpoints.
    pub horizontal: f64,
    /// Up or down, from the viewpoints nearest to every vertex and the ends of the cell, at the lowest and highest eye:
    /// those of the cell, or of the scene where the cell has no end.
    pub vertical: f64,
}

impl Displacement {
    pub(super) fn and(self, other: Self) -> Self {
        Self {
            horizontal: self.horizontal.max(other.horizontal),
            vertical: self.vertical.max(other.vertical),
        }
    }
}

/// The lowest and highest eye.
pub(super) fn eyes(mesh: &Mesh, cell: &ViewCell, up: Up) -> [f64; 2] {
    let points = cell.corners().unwrap_or(mesh.positions());
    math::range(points.iter().map(|&p| up.height(p)))
}

/// Measures the displacement of the vertices of the triangles that a quad replaces.
pub(super) fn displacement(
    mesh: &Mesh,
    quad: &Quad,
    cell: &PlanCell,
    up: Up,
    eyes: [f64; 2],
) -> Displacement {
    let mut worst = Displacement::default();
    for &t in &quad.replaces {
        for p in mesh.corners(t as usize) {
            let s = quad.project(p);
            let (from, to) = (up.plan(p), up.plan(s));
            for side in &cell.sides {
                if !quad.horizontal {
                    let seen = segment_error(side, from, to).angle;
                    worst.horizontal = worst.horizontal.max(seen);
                }
                let [first, last] = side.ends();
                let foot = side.enter(from).x.clamp(first, last);
                let finite = [foot, first, last].into_iter().filter(|x| x.is_finite());
                for x in finite {
                    let viewer = side.viewpoint(x);
                    for eye in eyes {
                        let turn = |plan: DVec2, height: f64| {
                            math::atan2(height - eye, (plan - viewer).length())
                        };
                        let seen = turn(from, up.height(p)) - turn(to, up.height(s));
                        worst.vertical = worst.vertical.max(seen.abs());
                    }
                }
            }
        }
    }
    worst
}
