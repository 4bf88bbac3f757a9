//! Quadric error metrics: Garland & Heckbert 1997 (planes, boundary constraint planes), 1998 (area weights),
//! optionally the probabilistic quadrics of Trettner & Kobbelt 2020.
//!
//! A vertex carries the sum of the squared distances to the planes of its faces; an edge the sum of its ends', so a
//! face with both ends counts twice, as in the papers. The new vertex minimises it where the minimum is well
//! conditioned; otherwise it is the best point of the edge. Costs: length^2 (unit weights) or length^4 (area
//! weights), in frame units.

use std::any::Any;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::{
    collapse::{
        Estimates, Evaluation, LiveMesh, Method, MethodScratch, Patch, Plan, Proposal, Refusal,
        Review, Site, Tileable,
    },
    geometry::Sym3,
    num::math,
};

/// How much the plane of a face counts at each of its corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Weighting {
    /// 1 (the paper of 1997): depends on the tessellation.
    Unit,
    /// The face's area (1998).
    #[default]
    Area,
}

/// How uncertain planes are taken to be (Trettner & Kobbelt 2020); makes every minimum unique.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Uncertainty {
    /// Standard deviation of unit normals.
    pub normal: f64,
    /// Standard deviation of positions, as a fraction of the mean edge length.
    pub position: f64,
}

/// Options of the method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct QuadricOptions {
    /// Weight of the planes of faces.
    pub weighting: Weighting,
    /// Weight of the planes that stand on boundary edges; times the squared length of the edge for area weights.
    pub boundary_weight: f64,
    /// Probabilistic quadrics, or `None` for exact planes.
    pub uncertainty: Option<Uncertainty>,
}

impl QuadricOptions {
    /// Probabilistic quadrics with CGAL's usual standard deviation of positions, 0.05 of the mean edge length.
    #[must_use]
    pub fn probabilistic() -> Self {
        Self {
            uncertainty: Some(Uncertainty {
                normal: 0.05,
                position: 0.05,
            }),
            ..Self::default()
        }
    }
}

impl Default for QuadricOptions {
    fn default() -> Self {
        Self {
            weighting: Weighting::default(),
            boundary_weight: 1.0,
            uncertainty: None,
        }
    }
}

/// A quadratic function of a position: `v^T A v + 2 b . v + c`, with a symmetric `A`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quadric {
    a: Sym3,
    b: DVec3,
    c: f64,
}

/// Smallest share of the largest eigenvalue that the smallest may have for a minimum to be trusted.
const WELL_CONDITIONED: f64 = 1e-5;

impl Quadric {
    /// `weight` times the squared distance to the plane through `point` with unit normal `normal`.
    #[must_use]
    pub fn plane(point: DVec3, normal: DVec3, weight: f64) -> Self {
        Self::uncertain_plane(point, normal, weight, 0.0, 0.0)
    }

    /// The expected squared distance to a plane whose normal and point have the given standard deviations.
    #[must_use]
    pub fn uncertain_plane(
        point: DVec3,
        n: DVec3,
        weight: f64,
        normal: f64,
        position: f64,
    ) -> Self {
        let (n2, p2) = (normal * normal, position * position);
        let d = n.dot(point);
        let c = d * d + n2 * point.dot(point) + p2 * n.dot(n) + 3.0 * p2 * n2;
        Self {
            a: Sym3([
                n.x * n.x + n2,
                n.x * n.y,
                n.x * n.z,
                n.y * n.y + n2,
                n.y * n.z,
                n.z * n.z + n2,
            ]),
            b: -(n * d + point * n2),
            c,
        }
        .scaled(weight)
    }

    /// This function times a number.
    #[must_use]
    pub fn scaled(mut self, weight: f64) -> Self {
        for a in &mut self.a.0 {
            *a *= weight;
        }
        self.b *= weight;
        self.c *= weight;
        self
    }

    /// The sum of two.
    #[must_use]
    pub fn plus(mut self, other: &Self) -> Self {
        self.a.add(&other.a);
        self.b += other.b;
        self.c += other.c;
        self
    }

    /// Its value at `v`; rounding below 0 is 0.
    #[must_use]
    pub fn error(&self, v: DVec3) -> f64 {
        (v.dot(self.a.times(v)) + 2.0 * self.b.dot(v) + self.c).max(0.0)
    }

    /// Where it is smallest; `None` where that is ill-conditioned (planes nearly parallel to one line).
    #[must_use]
    pub fn minimum(&self) -> Option<DVec3> {
        let [xx, xy, xz, yy, yz, zz] = self.a.0;
        let (c0, c1, c2) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
        let (c4, c5, c8) = (xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy);
        let determinant = xx * c0 + xy * c1 + xz * c2;
        // Eigenvalues l1 >= l2 >= l3: the minors are about l1 l2, the determinant over them lies in [l3 / 3, l3].
        let (trace, minors) = (xx + yy + zz, c0 + c4 + c8);
        let well = minors > WELL_CONDITIONED * (trace * trace)
            && determinant > WELL_CONDITIONED * (trace * minors);
        let b = self.b;
        let v = -DVec3::new(
            c0 * b.x + c1 * b.y + c2 * b.z,
            c1 * b.x + c4 * b.y + c5 * b.z,
            c2 * b.x + c5 * b.y + c8 * b.z,
        ) / determinant;
        (well && v.is_finite()).then_some(v)
    }

    /// The best point of the segment from `u` to `w`; `None` where it is constant along it.
    #[must_use]
    pub fn minimum_on(&self, [u, w]: [DVec3; 2]) -> Option<DVec3> {
        let d = w - u;
        let curvature = d.dot(self.a.times(d));
        let least = f64::EPSILON * self.a.trace() * d.dot(d);
        let t = -(d.dot(self.a.times(u)) + self.b.dot(d)) / curvature;
        (curvature > least && t.is_finite()).then(|| u + d * t.clamp(0.0, 1.0))
    }

    /// Where the new vertex of an edge between `u` and `w` belongs: the minimum, else the best point of the edge,
    /// else the best of midpoint and ends (the first on a tie).
    #[must_use]
    pub fn place(&self, ends: [DVec3; 2]) -> DVec3 {
        let middle = (ends[0] + ends[1]) * 0.5;
        self.minimum()
            .or_else(|| self.minimum_on(ends))
            .unwrap_or_else(|| {
                let mut best = middle;
                for end in ends {
                    if self.error(end) < self.error(best) {
                        best = end;
                    }
                }
                best
            })
    }
}

/// The method: a quadric per vertex.
#[derive(Clone, Debug)]
pub struct QuadricMethod {
    quadrics: Vec<Quadric>,
}

impl QuadricMethod {
    /// The quadrics of a mesh: the planes of its faces, and planes that stand on its boundary edges. O(n).
    #[must_use]
    pub fn new(live: &LiveMesh, options: &QuadricOptions) -> Self {
        Self::weighted(live, options, |_| 1.0)
    }

    /// As [`QuadricMethod::new`], with the planes of a face and of its boundary edges times `factor` of the face's id.
    #[must_use]
    pub fn weighted(
        live: &LiveMesh,
        options: &QuadricOptions,
        factor: impl Fn(u32) -> f64,
    ) -> Self {
        let mut quadrics = vec![Quadric::default(); live.vertex_ids() as usize];
        let deviation = options.uncertainty.unwrap_or(Uncertainty {
            normal: 0.0,
            position: 0.0,
        });
        let position = if deviation.position > 0.0 {
            deviation.position * mean_edge(live)
        } else {
            0.0
        };
        for t in 0..live.triangle_ids() {
            let (Some(corners), Some(points)) = (live.triangle(t), live.points(t)) else {
                continue;
            };
            let n = (points[1] - points[0]).cross(points[2] - points[0]);
            let Some(unit) = math::unit(n) else { continue };
            let weight = match options.weighting {
                Weighting::Unit => 1.0,
                Weighting::Area => math::length(n) * 0.5,
            };
            let factor = factor(t);
            let q = Quadric::uncertain_plane(points[0], unit, weight, deviation.normal, position)
                .scaled(factor);
            for v in corners {
                quadrics[v as usize] = quadrics[v as usize].plus(&q);
            }
            for k in 0..3 {
                let (s, e) = (corners[k], corners[(k + 1) % 3]);
                let alone = live
                    .find_edge(s, e)
                    .is_some_and(|e| live.faces_at_edge(e) == 1);
                let along = points[(k + 1) % 3] - points[k];
                if !alone {
                    continue;
                }
                let Some(m) = math::unit(along.cross(unit)) else {
                    continue;
                };
                let weight = match options.weighting {
                    Weighting::Unit => options.boundary_weight,
                    Weighting::Area => options.boundary_weight * along.dot(along),
                };
                let wall = Quadric::plane(points[k], m, weight).scaled(factor);
                for v in [s, e] {
                    quadrics[v as usize] = quadrics[v as usize].plus(&wall);
                }
            }
        }
        Self { quadrics }
    }

    /// The quadric of a vertex.
    ///
    /// # Panics
    /// Where there is no such vertex.
    #[must_use]
    pub fn quadric(&self, vertex: u32) -> &Quadric {
        &self.quadrics[vertex as usize]
    }
}

fn mean_edge(live: &LiveMesh) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for t in 0..live.triangle_ids() {
        if let Some(p) = live.points(t) {
            for k in 0..3 {
                sum += math::length(p[(k + 1) % 3] - p[k]);
                count += 1.0;
            }
        }
    }
    if count > 0.0 { sum / count } else { 0.0 }
}

impl Method for QuadricMethod {
    fn plan(&self) -> Plan {
        Plan::default()
    }

    fn estimates(&self) -> Option<&dyn Estimates> {
        Some(self)
    }

    fn propose(
        &self,
        site: &Site<'_>,
        _: Evaluation,
        _: &mut MethodScratch,
    ) -> Result<Proposal, Refusal> {
        let [u, w] = site.star.ends;
        let sum = self.quadric(u).plus(self.quadric(w));
        let wanted = site.fixed().unwrap_or_else(|| sum.place(site.star.points));
        let position = site.admit(wanted)?;
        Ok(Proposal {
            position,
            primary: 0,
            secondary: sum.error(position.position()),
        })
    }

    fn review(&mut self, _: &LiveMesh, _: &Patch, _: &Proposal) -> Review {
        Review::Commit
    }

    fn committed(&mut self, _: &LiveMesh, patch: &Patch) {
        if let (Some(moved), Some(gone)) = (patch.moved, patch.gone) {
            let sum = self.quadric(moved.vertex).plus(self.quadric(gone));
            self.quadrics[moved.vertex as usize] = sum;
        }
    }
}

impl Estimates for QuadricMethod {
    fn estimate(&self, live: &LiveMesh, edge: u32) -> Option<f64> {
        let [u, w] = live.edge(edge)?;
        let sum = self.quadric(u).plus(self.quadric(w));
        Some(sum.error(sum.place([live.position(u), live.position(w)])))
    }

    fn may_fall(&self, _: &LiveMesh, _: u32) -> bool {
        true
    }
}

impl QuadricMethod {
    /// The quadrics of some vertices, under new ids.
    pub(in crate::simplify) fn part_of(&self, vertices: &[u32]) -> Self {
        Self {
            quadrics: vertices.iter().map(|&v| *self.quadric(v)).collect(),
        }
    }

    /// Takes over the quadrics of a part.
    pub(in crate::simplify) fn take_back(&mut self, part: &Self, vertices: &[u32]) {
        for (&v, quadric) in vertices.iter().zip(&part.quadrics) {
            self.quadrics[v as usize] = *quadric;
        }
    }
}

impl Tileable for QuadricMethod {
    fn part(&self, _: &LiveMesh, vertices: &[u32]) -> Box<dyn Tileable> {
        Box::new(self.part_of(vertices))
    }

    fn unite(&mut self, part: &dyn Tileable, vertices: &[u32]) {
        let part: &dyn Any = part;
        if let Some(part) = part.downcast_ref() {
            self.take_back(part, vertices);
        }
    }

    fn relinked(&mut self, _: &LiveMesh) {}
}
