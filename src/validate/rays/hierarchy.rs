//! The triangles that a ray may meet: a bounding-volume hierarchy of obvhs, used so that it can leave nothing out.
//!
//! obvhs computes in `f32`. So that rounding never hides a triangle, rays and boxes are brought into a frame of the
//! hierarchy's own, in `f64`: the middle of the bounding box at the origin, every vertex within 0.87 of it. There a ray
//! starts 2 before its point nearest to the origin, wherever the eye is; it meets triangles at t = 1 to 3.
//! Boxes are larger by [`MARGIN`] on every side. The margin covers, in the same unit: the origin in `f32` 1.2e-7 per
//! axis, the direction 1e-7 at t = 3, directions below 1.2e-7 that obvhs replaces 8e-7, subtraction, inversion and
//! multiplication of the slab test 7.2e-7, corners of boxes 6e-8. Together below 1.9e-6, a quarter of the margin.
//! A ray whose planes are so nearly parallel that `f64` does not say where it is has no [`Line`], and every triangle is
//! its candidate. Limits: fewer than 2^31 triangles.

#![expect(
    clippy::disallowed_types,
    reason = "obvhs takes Vec3A; it only chooses candidates, and no result depends on which superset it chooses"
)]

use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2},
    ray::Ray,
};

use crate::num::{
    Each, Frame,
    math::{length, unit},
};

/// By how much every side of every box is moved out, in units of the hierarchy's frame: 2^-17.
const MARGIN: f32 = 7.629_394_5e-6;
/// Least sine of the angle between the planes of a line.
const STEEPEST: f64 = 1e-4;

/// A point in the precision of obvhs.
fn narrow(p: DVec3) -> Vec3A {
    Vec3A::from_array(p.to_array().each(|x| x as f32))
}

/// A hierarchy of the triangles of a mesh.
pub(super) struct Hierarchy {
    tree: Bvh2,
    count: u32,
    center: DVec3,
    frame: Frame,
}

/// A ray in the frame of the hierarchy.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// The point nearest to the origin.
    nearest: DVec3,
    /// Of length 1, either way.
    direction: DVec3,
}

impl Line {
    /// Where two planes `n . p + offset = 0` (in the frame of the hierarchy) meet, those of a ray's column and row; `None`
    /// where one is ill defined, or that is.
    pub(super) fn new(planes: [Option<(DVec3, f64)>; 2]) -> Option<Self> {
        let [a, b] = [planes[0]?, planes[1]?];
        let (size_a, size_b) = (length(a.0), length(b.0));
        let (normal_a, normal_b) = (unit(a.0)?, unit(b.0)?);
        let (offset_a, offset_b) = (a.1 / size_a, b.1 / size_b);
        let along = normal_a.cross(normal_b);
        let square = along.dot(along);
        let nearest =
            (normal_b.cross(along) * offset_a + along.cross(normal_a) * offset_b) / -square;
        (square >= STEEPEST * STEEPEST && nearest.is_finite()).then_some(Self {
            nearest,
            direction: unit(along)?,
        })
    }
}

impl Hierarchy {
    /// Builds the hierarchy on one thread, which gives the same tree every time; O(n log n).
    pub(super) fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut corners = triangles.iter().flatten().map(|&v| positions[v as usize]);
        let first = corners.next().unwrap_or(DVec3::ZERO);
        let (low, high) = corners.fold((first, first), |(low, high), p| (low.min(p), high.max(p)));
        // Neither can overflow; twice the half extent may, but not its exponent.
        let half = Frame::for_size((high * 0.5 - low * 0.5).max_element());
        let mut hierarchy = Self {
            tree: Bvh2::default(),
            count: triangles.len() as u32,
            center: low * 0.5 + high * 0.5,
            frame: Frame {
                exponent: half.exponent + 1,
            },
        };
        let bounds = |t: &[u32; 3]| hierarchy.bounds(t.each(|v| positions[v as usize]));
        let boxes: Vec<Aabb> = triangles.iter().map(bounds).collect();
        if !boxes.is_empty() {
            let params = BvhBuildParams::medium_build();
            hierarchy.tree = build_bvh2(&boxes, params, &mut Duration::default());
        }
        hierarchy
    }

    /// The middle of the bounding box, in the units of the positions.
    pub(super) fn center(&self) -> DVec3 {
        self.center
    }

    /// From a length of the hierarchy's frame to the units of the positions.
    pub(super) fn frame(&self) -> Frame {
        self.frame
    }

    fn bounds(&self, corners: [DVec3; 3]) -> Aabb {
        let [a, b, c] = corners.each(|p| self.frame.enter(p - self.center));
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let margin = Vec3A::splat(MARGIN);
        Aabb::new(narrow(low) - margin, narrow(high) + margin)
    }

    /// Calls `visit` at least for every triangle that the line meets; for all of them where there is no line.
    pub(super) fn candidates(&self, line: Option<&Line>, mut visit: impl FnMut(u32)) {
        let Some(line) = line else {
            (0..self.count).for_each(visit);
            return;
        };
        // Every vertex lies well within 1 of the origin.
        if length(line.nearest) > 1.0 {
            return;
        }
        let origin = narrow(line.nearest - line.direction * 2.0);
        let ray = Ray::new_inf(origin, narrow(line.direction));
        self.tree.ray_traverse_anyhit(ray, |_, at| {
            visit(self.tree.primitive_indices[at]);
        });
    }
}
