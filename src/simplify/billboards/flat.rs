//! Horizontal faces: seen from above they are where they are, at whatever height they are drawn, so that the plan has
//! nothing to say about them. They go on horizontal planes within their bound in space, as few as there can be.

use super::{Limit, plan::Up};
use crate::{
    bound::{face::face_interval, planar::Interval, view_cell::ViewCell},
    mesh::Mesh,
};

/// A height and the triangles that are drawn at it.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub(super) height: f64,
    /// Ascending.
    pub(super) triangles: Vec<u32>,
}

/// The heights that a horizontal triangle may be drawn at.
pub(super) fn heights(
    mesh: &Mesh,
    triangle: u32,
    cell: &ViewCell,
    up: Up,
    limit: Limit,
) -> Interval {
    let corners = mesh.corners(triangle as usize);
    let height = up.height(corners[0]);
    match limit {
        Limit::Angle(aperture) => {
            let axis = up.place(glam::DVec2::ZERO, 1.0);
            let bound = face_interval(cell, &corners, axis, aperture).offsets;
            // Its own height is always valid, whatever rounding says.
            Interval::new(bound.min.min(height), bound.max.max(height))
        }
        Limit::Distance(distance) => Interval::around(height, distance),
    }
}

/// The fewest heights such that every triangle has one in its interval: always the lowest end of an interval that has
/// none yet, then moved to the middle of what its triangles have in common.
pub(super) fn levels(mut triangles: Vec<(Interval, u32)>) -> Vec<Level> {
    triangles.sort_by(|a, b| a.0.max.total_cmp(&b.0.max).then(a.1.cmp(&b.1)));
    let mut found: Vec<(Interval, Vec<u32>)> = Vec::new();
    for (interval, triangle) in triangles {
        match found.last_mut() {
            Some((common, members)) if !common.and(interval).is_empty() => {
                *common = common.and(interval);
                members.push(triangle);
            }
            _ => found.push((interval, vec![triangle])),
        }
    }
    let level = |(common, mut triangles): (Interval, Vec<u32>)| {
        triangles.sort_unstable();
        Level {
            height: (common.min + (common.max - common.min) / 2.0).clamp(common.min, common.max),
            triangles,
        }
    };
    found.into_iter().map(level).collect()
}
