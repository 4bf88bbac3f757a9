//! The tolerance volume: all polyhedra in which a new vertex may lie (section 2).

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{Neighborhood, Polyhedron, Quadratic, shadows};
use crate::num::Each;

/// Polyhedra of a volume, at most; with more of them the collapse counts as not allowed.
pub const MOST_POLYHEDRA: usize = 256;

/// Volume below which a polyhedron is dropped, in cubes of the bound.
const LEAST: f64 = 1e-6;

/// From where caps cast their shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// From the edges of the link: no new face pierces a cap.
    #[default]
    Edges,
    /// As published: from the own edge of a boundary triangle, the apex of an internal one, and from the vertices of the
    /// link that see a cap from inside.
    Vertices,
}

/// The places that a new vertex may have; relative to the neighbourhood's origin.
#[derive(Clone, Debug, Default)]
pub struct Volume {
    polyhedra: Vec<Polyhedron>,
    tolerance: f64,
}

impl Volume {
    /// The volume for a bound; empty where nothing is allowed. `tolerance`: length below which points count as on a
    /// plane.
    ///
    /// O(polyhedra * faces * link edges).
    pub fn new(around: &Neighborhood, bound: f64, source: Source, tolerance: f64) -> Self {
        let mut own = Self {
            polyhedra: base(around, bound, tolerance),
            tolerance,
        };
        let least = LEAST * (bound * bound * bound);
        let mut next = Vec::new();
        for (i, prism) in around.prisms.iter().enumerate() {
            for normal in [prism.normal, -prism.normal] {
                let cap = prism.points.each(|p| p + normal * bound);
                for from in sources(around, i, source) {
                    for shadow in shadows(cap, normal, from, tolerance) {
                        next.clear();
                        for polyhedron in own.polyhedra.drain(..) {
                            if polyhedron.misses(&shadow, tolerance) {
                                next.push(polyhedron);
                            } else {
                                polyhedron.outside(&shadow, tolerance, least, &mut next);
                            }
                        }
                        std::mem::swap(&mut own.polyhedra, &mut next);
                        if own.polyhedra.is_empty() || own.polyhedra.len() > MOST_POLYHEDRA {
                            own.polyhedra.clear();
                            return own;
                        }
                    }
                }
            }
        }
        own
    }

    /// The polyhedra.
    pub fn polyhedra(&self) -> &[Polyhedron] {
        &self.polyhedra
    }

    /// True where a position, relative to the neighbourhood's origin, lies in a polyhedron.
    pub fn contains(&self, p: DVec3) -> bool {
        self.polyhedra.iter().any(|c| c.contains(p, self.tolerance))
    }

    /// The point of the volume at which a convex function is least, relative to the neighbourhood's origin; that of the
    /// first polyhedron on a tie.
    pub fn minimum(&self, of: &Quadratic) -> Option<DVec3> {
        let mut best: Option<(DVec3, f64)> = None;
        for polyhedron in &self.polyhedra {
            if let Some((v, value)) = polyhedron.minimum(of, self.tolerance)
                && best.is_none_or(|(_, least)| value < least)
            {
                best = Some((v, value));
            }
        }
        best.map(|(v, _)| v)
    }
}

/// The prisms inside the convex kernel.
fn base(around: &Neighborhood, bound: f64, tolerance: f64) -> Vec<Polyhedron> {
    let mut polyhedra = Vec::new();
    for prism in &around.prisms {
        let margin = DVec3::splat(2.0 * bound);
        let [a, b, c] = prism.points;
        let cuboid = Polyhedron::cuboid(a.min(b).min(c) - margin, a.max(b).max(c) + margin);
        let mut bounds = prism.sides(bound).into_iter().chain(around.kernel());
        let polyhedron =
            bounds.try_fold(cuboid, |polyhedron, bound| polyhedron.cut(bound, tolerance));
        polyhedra.extend(polyhedron);
    }
    polyhedra
}

/// Where the faces stand that might pierce the caps of prism `i`.
fn sources(around: &Neighborhood, i: usize, source: Source) -> Vec<[DVec3; 2]> {
    if source == Source::Edges {
        return around.links.to_vec();
    }
    let face = &around.faces[i];
    let prism = &around.prisms[i];
    let mut sources: Vec<[DVec3; 2]> = face.link().into_iter().collect();
    if sources.is_empty() {
        let apex = face.ends.iter().position(|&e| !e);
        sources.extend(apex.map(|k| [face.points[k]; 2]));
    }
    // Walls over the edges that touch an end of the collapsing edge.
    let inner: Vec<usize> = (0..3)
        .filter(|&k| face.ends[k] || face.ends[(k + 1) % 3])
        .collect();
    for &[b, _] in &around.links {
        let own = face.points.contains(&b);
        if !own && inner.iter().any(|&k| prism.walls[k].excess(b) <= 0.0) {
            sources.push([b; 2]);
        }
    }
    sources
}
