//! The method: a quadric per vertex.

use std::any::Any;

use super::{AttributeQuadrics, Quadric, QuadricOptions, Weighting};
use crate::{
    collapse::{
        Estimates, LiveMesh, Method, MethodScratch, Patch, Proposal, Refusal, Site, Tileable,
        wedge::WedgeValues,
    },
    num::math,
};

/// The error that stands for a unit of area, squared, in the wrong chart: as if it had moved off the surface by its own
/// width.
const SEAM_PRICE: f64 = 1.0;

/// The method: a quadric per vertex.
#[derive(Clone, Debug)]
pub struct QuadricMethod {
    quadrics: Vec<Quadric>,
    /// Those of texture coordinates and colours, where they count and the mesh has some.
    attributes: Option<AttributeQuadrics>,
}

impl QuadricMethod {
    /// The quadrics of a mesh: the planes of its faces, and planes that stand on its boundary edges. O(n).
    pub fn new(live: &LiveMesh, options: &QuadricOptions) -> Self {
        let attributes = options.attributes;
        let attributes = attributes.then(|| AttributeQuadrics::new(live, options.weighting));
        Self {
            attributes: attributes.flatten(),
            ..Self::weighted(live, options, |_| 1.0)
        }
    }

    /// As [`QuadricMethod::new`], with the planes of a face and of its boundary edges times `factor` of the face's id, and
    /// without attributes.
    pub fn weighted(
        live: &LiveMesh,
        options: &QuadricOptions,
        factor: impl Fn(u32) -> f64,
    ) -> Self {
        let mut quadrics = vec![Quadric::default(); live.vertex_ids() as usize];
        let deviation = options.uncertainty.unwrap_or_default();
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
                let edge = live.find_edge(s, e);
                let alone = edge.is_some_and(|e| live.faces_at_edge(e) == 1);
                let along = points[(k + 1) % 3] - points[k];
                let wall = alone.then(|| math::unit(along.cross(unit)));
                let Some(m) = wall.flatten() else { continue };
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
        Self {
            quadrics,
            attributes: None,
        }
    }

    /// The quadric of a vertex.
    ///
    /// # Panics
    /// Where there is no such vertex.
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
    fn estimates(&self) -> Option<&dyn Estimates> {
        Some(self)
    }

    fn propose(&self, site: &Site<'_>, _: &mut MethodScratch) -> Result<Proposal, Refusal> {
        let [u, w] = site.star.ends;
        let sum = self.quadric(u).plus(self.quadric(w));
        let wanted = site.fixed().unwrap_or_else(|| {
            let own = self.attributes.as_ref();
            let sum = own.map_or(sum, |own| own.placing(site, sum));
            sum.place(site.star.points)
        });
        let position = site.admit(wanted)?;
        let lost = site.seam_loss(position);
        let mut error = sum.error(position.position());
        if let Some(own) = &self.attributes {
            error += own.error(site, position);
        }
        Ok(Proposal {
            position,
            primary: 0,
            secondary: error + SEAM_PRICE * (lost * lost),
        })
    }

    fn wedge_values(&self) -> Option<&dyn WedgeValues> {
        self.attributes.as_ref().map(|own| own as &dyn WedgeValues)
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        if let Some(own) = &mut self.attributes {
            own.committed(live, patch);
        }
        if let (Some(moved), Some(gone)) = (patch.moved, patch.gone) {
            let sum = self.quadric(moved.vertex).plus(self.quadric(gone));
            self.quadrics[moved.vertex as usize] = sum;
        }
    }
}

/// Of positions alone, below the cost with attributes: an edge with such waits under that until it comes to the front.
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
    /// The quadrics of some vertices, under new ids, without attributes, which no part of a mesh has.
    pub(in crate::rooms::simplify) fn part_of(&self, vertices: &[u32]) -> Self {
        Self {
            quadrics: vertices.iter().map(|&v| *self.quadric(v)).collect(),
            attributes: None,
        }
    }

    /// Takes over the quadrics of a part.
    pub(in crate::rooms::simplify) fn take_back(&mut self, part: &Self, vertices: &[u32]) {
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
