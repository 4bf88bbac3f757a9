//! The faces around a collapsed edge before and after, laid out in one plane so that points of one can be found in the
//! other.
//!
//! Both fans are projected along the mean normal of the faces before; a fan that is not a graph over that plane, before or
//! after, has no layout. Projection moves no point of a flat surface. At a boundary the outlines differ: there the new
//! vertex stands, in the plane, for the point of the old boundary next to it, and the old boundary vertices beside that
//! for points of the new boundary edges, so that both layouts fill the same polygon: some new faces consist of two parts.
//! That they do fill it exactly once is not assumed but measured, by the areas of all intersections.
//! Plane coordinates are scaled so that the fan has a size near 1.

use glam::{DVec2, DVec3};

use super::clip::{Bounded, Corner, clip, double_area};
use crate::num::math::unit;

/// A face of the mesh that changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Its id, the same before and after.
    pub id: u32,
    /// Its vertices.
    pub corners: [u32; 3],
    /// Their positions.
    pub points: [DVec3; 3],
}

/// The collapse of an edge.
#[derive(Clone, Copy, Debug)]
pub struct Collapse<'a> {
    /// All faces at either end, before.
    pub removed: &'a [Face],
    /// Those of them that stay, after: every one has the vertex `keep`.
    pub added: &'a [Face],
    /// The end whose number the new vertex has.
    pub keep: u32,
    /// The other end.
    pub gone: u32,
    /// Where the new vertex lies.
    pub to: DVec3,
}

/// Twice the least area of a triangle in the plane, where the fan has a size near 1: weights in it are good to 1e-10.
const LEAST_AREA: f64 = 1e-6;
/// By how much areas may fail to add up.
const AREA_ERROR: f64 = 1e-9;
/// Where a boundary vertex may lie on its new edge: not on the ends.
const ENDS: f64 = 1e-3;

/// A triangle of the plane that is a face before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Before {
    pub(super) face: Face,
    pub(super) plane: [DVec2; 3],
}

/// A triangle of the plane that is a face after, or a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct After {
    pub(super) face: Face,
    pub(super) plane: Bounded,
    /// The weights of the face's corners at the corners of the part.
    pub(super) weights: [[f64; 3]; 3],
}

impl After {
    /// The weights of the face's corners at a point of the plane inside the part.
    pub(super) fn weights_at(&self, p: DVec2) -> [f64; 3] {
        let part = self.plane.weights(p);
        let of = |k: usize| {
            part[0] * self.weights[0][k]
                + part[1] * self.weights[1][k]
                + part[2] * self.weights[2][k]
        };
        [of(0), of(1), of(2)]
    }
}

/// Two triangulations of one polygon.
#[derive(Clone, Debug, Default)]
pub struct Fan {
    pub(super) before: Vec<Before>,
    pub(super) after: Vec<After>,
    /// For every face before, which parts after may overlap it: one bit each.
    pub(super) overlaps: Vec<Vec<u16>>,
}

/// A face before with exactly one end, and its side across from that end.
#[derive(Clone, Copy)]
struct Sector {
    face: Face,
    apex: usize,
}

impl Sector {
    fn from(&self) -> u32 {
        self.face.corners[(self.apex + 1) % 3]
    }

    fn to(&self) -> u32 {
        self.face.corners[(self.apex + 2) % 3]
    }
}

impl Fan {
    /// Lays out a collapse; `None` where the faces form no disc, are not all turned the same way, or are folded, before
    /// or after.
    #[must_use]
    pub fn new(collapse: &Collapse<'_>) -> Option<Self> {
        let is_end = |v: &u32| *v == collapse.keep || *v == collapse.gone;
        let mut sectors = Vec::with_capacity(collapse.removed.len());
        let mut beside = 0;
        for &face in collapse.removed {
            let mut ends = face.corners.iter().filter(|v| is_end(v));
            match (ends.next(), ends.next()) {
                (Some(_), None) => {
                    let apex = face.corners.iter().position(is_end)?;
                    sectors.push(Sector { face, apex });
                }
                _ => beside += 1,
            }
        }
        if sectors.len() != collapse.added.len() || sectors.is_empty() {
            return None;
        }
        let closed = in_order(&mut sectors)?;
        let ends = [sectors[0], sectors[sectors.len() - 1]].map(|s| s.face.corners[s.apex]);
        let whole = match (closed, beside) {
            (true, 2) => true,
            (false, 2) => ends[0] == ends[1],
            (false, 1) => ends[0] != ends[1],
            _ => false,
        };
        if !whole {
            return None;
        }
        let projection = Projection::of(collapse)?;
        let mut fan = Self::default();
        for &face in collapse.removed {
            let plane = face.points.map(|p| projection.of_point(p));
            if double_area(&plane) <= LEAST_AREA {
                return None;
            }
            fan.before.push(Before { face, plane });
        }
        if closed {
            fan.surround(collapse, &sectors, projection.of_point(collapse.to))?;
        } else {
            fan.border(collapse, &sectors, &projection)?;
        }
        fan.find_overlaps()?;
        Some(fan)
    }

    /// The parts after the collapse of an edge inside: one for each face.
    fn surround(&mut self, collapse: &Collapse<'_>, sectors: &[Sector], new: DVec2) -> Option<()> {
        for sector in sectors {
            let face = after(collapse, sector)?;
            let mut plane = self.plane_of(sector);
            plane[sector.apex] = new;
            self.push(face, plane, CORNERS)?;
        }
        Some(())
    }

    /// The parts after the collapse of an edge with an end on the boundary, or both.
    fn border(
        &mut self,
        collapse: &Collapse<'_>,
        sectors: &[Sector],
        projection: &Projection,
    ) -> Option<()> {
        let (first, last) = (sectors[0], sectors[sectors.len() - 1]);
        let [at_first, at_last] = [first, last].map(|s| s.face.points[s.apex]);
        // Which point of the old boundary the new vertex stands for: along the edge where both ends are on it.
        let both = first.face.corners[first.apex] != last.face.corners[last.apex];
        let along = if both {
            share(collapse.to, at_last, at_first)
        } else {
            0.0
        };
        let new = if along <= 0.0 {
            projection.of_point(at_last)
        } else if along >= 1.0 {
            projection.of_point(at_first)
        } else {
            projection
                .of_point(at_last)
                .lerp(projection.of_point(at_first), along)
        };
        let count = sectors.len();
        for (i, sector) in sectors.iter().enumerate() {
            let face = after(collapse, sector)?;
            let plane = self.plane_of(sector);
            let (apex, from, to) = (sector.apex, (sector.apex + 1) % 3, (sector.apex + 2) % 3);
            let mut moved = plane;
            moved[apex] = new;
            // At either end of the row an old boundary vertex may come to lie on the new boundary edge.
            let on_edge = if both && i == 0 && along < 1.0 {
                Some((from, at_first))
            } else if both && i == count - 1 && along > 0.0 {
                Some((to, at_last))
            } else {
                None
            };
            let Some((corner, old)) = on_edge else {
                self.push(face, moved, CORNERS)?;
                continue;
            };
            let s = share(old, collapse.to, face.points[corner]).clamp(ENDS, 1.0 - ENDS);
            let mut weights = [0.0; 3];
            weights[apex] = 1.0 - s;
            weights[corner] = s;
            // The outer part is the old face itself, its apex now a point of the new edge.
            let mut outer = CORNERS;
            outer[apex] = weights;
            self.push(face, plane, outer)?;
            let mut inner = CORNERS;
            inner[corner] = weights;
            let mut within = moved;
            within[corner] = plane[apex];
            self.push(face, within, inner)?;
        }
        Some(())
    }

    fn plane_of(&self, sector: &Sector) -> [DVec2; 3] {
        let id = sector.face.id;
        let known = self.before.iter().find(|b| b.face.id == id);
        known.map_or([DVec2::ZERO; 3], |b| b.plane)
    }

    fn push(&mut self, face: Face, plane: [DVec2; 3], weights: [[f64; 3]; 3]) -> Option<()> {
        if double_area(&plane) <= LEAST_AREA {
            return None;
        }
        self.after.push(After {
            face,
            plane: Bounded::new(plane),
            weights,
        });
        Some(())
    }

    /// Finds what overlaps what, and that each layout fills the other exactly once.
    fn find_overlaps(&mut self) -> Option<()> {
        let mut after: Vec<f64> = self
            .after
            .iter()
            .map(|a| -double_area(&a.plane.corners))
            .collect();
        let (mut polygon, mut spare) = (Vec::new(), Vec::new());
        for before in &self.before {
            let mut missing = double_area(&before.plane);
            let mut overlaps = Vec::new();
            for (j, part) in self.after.iter().enumerate() {
                if part.plane.is_apart(&before.plane) {
                    continue;
                }
                overlaps.push(j as u16);
                polygon.clear();
                polygon.extend(before.plane.map(|plane| Corner {
                    plane,
                    source: [0.0; 2],
                }));
                if clip(&mut polygon, &mut spare, &part.plane) {
                    let area = polygon_area(&polygon);
                    missing -= area;
                    after[j] += area;
                }
            }
            if missing.abs() > AREA_ERROR {
                return None;
            }
            self.overlaps.push(overlaps);
        }
        after.iter().all(|a| a.abs() <= AREA_ERROR).then_some(())
    }
}

const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The face of a sector after the collapse, as it was handed over.
fn after(collapse: &Collapse<'_>, sector: &Sector) -> Option<Face> {
    let face = collapse.added.iter().find(|f| f.id == sector.face.id)?;
    (face.corners[sector.apex] == collapse.keep
        && face.corners[(sector.apex + 1) % 3] == sector.from()
        && face.corners[(sector.apex + 2) % 3] == sector.to())
    .then_some(*face)
}

/// Brings sectors into the order of their sides, each beginning where the one before ends; true where the last one ends
/// where the first begins. `None` where they form no single row.
fn in_order(sectors: &mut [Sector]) -> Option<bool> {
    let starts = |sectors: &[Sector], v: u32| sectors.iter().filter(|s| s.from() == v).count();
    let comes = |sectors: &[Sector], v: u32| sectors.iter().filter(|s| s.to() == v).count();
    if sectors
        .iter()
        .any(|s| starts(sectors, s.from()) > 1 || comes(sectors, s.to()) > 1)
    {
        return None;
    }
    let first = (0..sectors.len()).find(|&i| comes(sectors, sectors[i].from()) == 0);
    sectors.swap(0, first.unwrap_or(0));
    for i in 1..sectors.len() {
        let end = sectors[i - 1].to();
        let next = (i..sectors.len()).find(|&k| sectors[k].from() == end)?;
        sectors.swap(i, next);
    }
    let closed = sectors[sectors.len() - 1].to() == sectors[0].from();
    (closed == first.is_none()).then_some(closed)
}

/// Where the foot of `p` lies between `from` (0) and `to` (1), not clamped; 0 where these are one point.
fn share(p: DVec3, from: DVec3, to: DVec3) -> f64 {
    let side = to - from;
    let along = (p - from).dot(side) / side.dot(side);
    if along.is_finite() { along } else { 0.0 }
}

fn polygon_area(polygon: &[Corner]) -> f64 {
    let mut sum = 0.0;
    for pair in polygon.windows(2).skip(1) {
        sum += double_area(&[polygon[0].plane, pair[0].plane, pair[1].plane]);
    }
    sum
}

/// From space to the plane of a fan.
struct Projection {
    origin: DVec3,
    axes: [DVec3; 2],
    scale: f64,
}

impl Projection {
    fn of(collapse: &Collapse<'_>) -> Option<Self> {
        let mut sum = DVec3::ZERO;
        for Face {
            points: [a, b, c], ..
        } in collapse.removed
        {
            sum += (*b - *a).cross(*c - *a);
        }
        let normal = unit(sum)?;
        let size = normal.abs();
        let other = if size.x <= size.y && size.x <= size.z {
            DVec3::X
        } else if size.y <= size.z {
            DVec3::Y
        } else {
            DVec3::Z
        };
        let across = unit(other.cross(normal))?;
        let origin = collapse.to;
        let reach = collapse.removed.iter().flat_map(|f| f.points);
        let reach = reach.fold(0.0_f64, |r, p| r.max((p - origin).abs().max_element()));
        let scale = 1.0 / reach;
        (reach > 0.0 && scale.is_finite()).then_some(Self {
            origin,
            axes: [across, normal.cross(across)],
            scale,
        })
    }

    fn of_point(&self, p: DVec3) -> DVec2 {
        let d = (p - self.origin) * self.scale;
        DVec2::new(d.dot(self.axes[0]), d.dot(self.axes[1]))
    }
}
