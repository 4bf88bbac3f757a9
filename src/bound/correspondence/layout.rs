//! The faces around a collapsed edge before and after, laid out in one plane so that points of one can be found in the
//! other.
//!
//! Both are projected along the mean normal of the faces before; faces that are not a graph over that plane, before or
//! after, have no layout. Projection moves no point of a flat surface. At a boundary the outlines differ: there the new
//! vertex stands, in the plane, for the point of the old boundary next to it, and the old boundary vertices beside that
//! for points of the new boundary edges, so that both layouts fill the same polygon: some new faces consist of two parts.
//! Every triangle is turned the same way, those after go around the new vertex no more than once, and the areas are the
//! same: so both fill the polygon once.
//! Plane coordinates are scaled so that the faces have a size near 1.

use glam::{DVec2, DVec3};

use super::{projection::Projection, sectors::Sectors};
use crate::num::Each;

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
    /// The position of the new vertex.
    pub to: DVec3,
}

/// Twice the least area of a triangle in the plane, where the faces have a size near 1: weights in it are good to 1e-10.
const LEAST_AREA: f64 = 1e-6;
/// Largest difference of the areas before and after.
const AREA_ERROR: f64 = 1e-9;
/// Least share of its new edge between a boundary vertex and an end.
const ENDS: f64 = 1e-3;

/// A face before, in the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Before {
    pub(super) face: Face,
    pub(super) plane: [DVec2; 3],
    /// The face keeps its place in the plane and becomes this part; nothing of it lies in the sectors.
    pub(super) outer: Option<Part>,
    /// For each corner true where the side across from it is shared with faces that do not change, or keep their place.
    pub(super) fixed: [bool; 3],
}

/// A triangle of the plane that is a face after, or a part of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) face: Face,
    pub(super) plane: [DVec2; 3],
    /// The weights of the face's corners at the corners of the part.
    weights: [[f64; 3]; 3],
}

impl Part {
    fn new(face: Face, plane: [DVec2; 3], weights: [[f64; 3]; 3]) -> Option<Self> {
        (double_area(&plane) > LEAST_AREA).then_some(Self {
            face,
            plane,
            weights,
        })
    }

    /// The weights of the second and third corner of the face at a point of the plane, or at one of the part next to it.
    pub(super) fn weights_at(&self, p: DVec2) -> [f64; 2] {
        let [a, b, c] = self.plane;
        let of = |q: DVec2, r: DVec2| (q - p).perp_dot(r - p).max(0.0);
        let w = [of(b, c), of(c, a), of(a, b)];
        let sum = w[0] + w[1] + w[2];
        let of = |k: usize| {
            (w[0] * self.weights[0][k] + w[1] * self.weights[1][k] + w[2] * self.weights[2][k])
                / sum
        };
        [of(1), of(2)]
    }
}

/// Two triangulations of one polygon: the faces before, and after them the sectors around the new vertex and parts that
/// keep their place.
#[derive(Clone, Debug)]
pub struct Layout {
    pub(super) before: Vec<Before>,
    pub(super) sectors: Sectors,
}

/// A face before with exactly one end, and its side across from that end.
#[derive(Clone, Copy)]
struct Sector {
    face: Face,
    /// Its place among the faces before.
    index: usize,
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

impl Layout {
    /// Lays out a collapse; `None` where the faces form no disc, are not all turned the same way, or are folded, before
    /// or after.
    pub fn new(collapse: &Collapse<'_>) -> Option<Self> {
        let is_end = |v: &u32| *v == collapse.keep || *v == collapse.gone;
        let mut sectors = Vec::with_capacity(collapse.removed.len());
        let mut beside = 0;
        for (index, &face) in collapse.removed.iter().enumerate() {
            let mut ends = face.corners.iter().filter(|v| is_end(v));
            match (ends.next(), ends.next()) {
                (Some(_), None) => {
                    let apex = face.corners.iter().position(is_end)?;
                    sectors.push(Sector { face, index, apex });
                }
                _ => beside += 1,
            }
        }
        if sectors.len() != collapse.added.len() || sectors.is_empty() {
            return None;
        }
        let closed;
        (sectors, closed) = in_order(&sectors)?;
        let ends = [sectors[0], sectors[sectors.len() - 1]].each(|s| s.face.corners[s.apex]);
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
        let mut layout = LayoutBuilder {
            before: Vec::with_capacity(collapse.removed.len()),
            parts: Vec::with_capacity(sectors.len()),
        };
        for &face in collapse.removed {
            let plane = face.points.each(|p| projection.of_point(p));
            if double_area(&plane) <= LEAST_AREA {
                return None;
            }
            layout.before.push(Before {
                face,
                plane,
                outer: None,
                fixed: [false; 3],
            });
        }
        let hub = if closed {
            let hub = projection.of_point(collapse.to);
            layout.surround(collapse, &sectors, hub)?;
            hub
        } else {
            layout.border(collapse, &sectors, &projection)?
        };
        layout.find_fixed(&is_end);
        if !layout.fills_the_same() {
            return None;
        }
        Some(Self {
            before: layout.before,
            sectors: Sectors::new(hub, closed, layout.parts)?,
        })
    }
}

/// A layout in the making.
struct LayoutBuilder {
    before: Vec<Before>,
    /// The parts around the new vertex, each with the corner that this is.
    parts: Vec<(Part, usize)>,
}

impl LayoutBuilder {
    /// The parts after the collapse of an edge inside: one for each face.
    fn surround(&mut self, collapse: &Collapse<'_>, sectors: &[Sector], new: DVec2) -> Option<()> {
        let after = After::of(collapse);
        for sector in sectors {
            let face = after.face(sector)?;
            let mut plane = self.before[sector.index].plane;
            plane[sector.apex] = new;
            self.parts
                .push((Part::new(face, plane, CORNERS)?, sector.apex));
        }
        Some(())
    }

    /// The parts after the collapse of an edge with an end on the boundary, or both; the answer is where the new vertex
    /// lies in the plane.
    fn border(
        &mut self,
        collapse: &Collapse<'_>,
        sectors: &[Sector],
        projection: &Projection,
    ) -> Option<DVec2> {
        let (first, last) = (sectors[0], sectors[sectors.len() - 1]);
        let [at_first, at_last] = [first, last].each(|s| s.face.points[s.apex]);
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
        let after = After::of(collapse);
        for (i, sector) in sectors.iter().enumerate() {
            let face = after.face(sector)?;
            let before = &mut self.before[sector.index];
            let plane = before.plane;
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
                self.parts.push((Part::new(face, moved, CORNERS)?, apex));
                continue;
            };
            let s = share(old, collapse.to, face.points[corner]).clamp(ENDS, 1.0 - ENDS);
            let mut weights = [0.0; 3];
            weights[apex] = 1.0 - s;
            weights[corner] = s;
            // The outer part is the old face itself, its apex now a point of the new edge.
            let mut outer = CORNERS;
            outer[apex] = weights;
            before.outer = Some(Part::new(face, plane, outer)?);
            let mut inner = CORNERS;
            inner[corner] = weights;
            let mut within = moved;
            within[corner] = plane[apex];
            self.parts.push((Part::new(face, within, inner)?, apex));
        }
        Some(new)
    }

    /// Finds the sides of the link, and those of faces that keep their place.
    fn find_fixed(&mut self, is_end: &impl Fn(&u32) -> bool) {
        let outer: Vec<[u32; 3]> = self
            .before
            .iter()
            .filter(|b| b.outer.is_some())
            .map(|b| b.face.corners)
            .collect();
        for before in &mut self.before {
            let corners = before.face.corners;
            before.fixed = [0, 1, 2].each(|k| {
                let side = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
                let shared =
                    |other: &[u32; 3]| *other != corners && side.iter().all(|v| other.contains(v));
                !side.iter().any(is_end) || outer.iter().any(shared)
            });
        }
    }

    /// True where the parts after fill the polygon of the faces before: at a boundary that is not certain.
    fn fills_the_same(&self) -> bool {
        let before: f64 = self.before.iter().map(|b| double_area(&b.plane)).sum();
        let outer = self.before.iter().filter(|b| b.outer.is_some());
        let kept: f64 = outer.map(|b| double_area(&b.plane)).sum();
        let around: f64 = self.parts.iter().map(|(p, _)| double_area(&p.plane)).sum();
        (before - kept - around).abs() <= AREA_ERROR
    }
}

const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The faces after a collapse, by their ids.
struct After {
    keep: u32,
    faces: Vec<Face>,
}

impl After {
    fn of(collapse: &Collapse<'_>) -> Self {
        let mut faces = collapse.added.to_vec();
        faces.sort_by_key(|f| f.id);
        let keep = collapse.keep;
        Self { keep, faces }
    }

    /// The face of a sector, as it was handed over.
    fn face(&self, sector: &Sector) -> Option<Face> {
        let at = self.faces.binary_search_by_key(&sector.face.id, |f| f.id);
        let face = self.faces[at.ok()?];
        (face.corners[sector.apex] == self.keep
            && face.corners[(sector.apex + 1) % 3] == sector.from()
            && face.corners[(sector.apex + 2) % 3] == sector.to())
        .then_some(face)
    }
}

/// Brings sectors into the order of their sides, each beginning where the one before ends; true where the last one ends
/// where the first begins. `None` where they form no single row.
///
/// O(sectors log sectors).
fn in_order(sectors: &[Sector]) -> Option<(Vec<Sector>, bool)> {
    let by = |vertex: fn(&Sector) -> u32| {
        let all = sectors.iter().enumerate();
        let mut keys: Vec<(u32, usize)> = all.map(|(i, s)| (vertex(s), i)).collect();
        keys.sort_unstable();
        let once = keys.windows(2).all(|k| k[0].0 != k[1].0);
        once.then_some(keys)
    };
    let (starts, ends) = (by(Sector::from)?, by(Sector::to)?);
    let find = |keys: &[(u32, usize)], v: u32| keys.binary_search_by_key(&v, |k| k.0).ok();
    let first = sectors.iter().find(|s| find(&ends, s.from()).is_none());
    let mut row = Vec::with_capacity(sectors.len());
    row.push(*first.unwrap_or(sectors.first()?));
    while row.len() < sectors.len() {
        let end = row[row.len() - 1].to();
        if end == row[0].from() {
            return None;
        }
        row.push(sectors[starts[find(&starts, end)?].1]);
    }
    let closed = row[row.len() - 1].to() == row[0].from();
    (closed == first.is_none()).then_some((row, closed))
}

/// The place of the foot of `p` between `from` (0) and `to` (1), not clamped; 0 where these are one point.
fn share(p: DVec3, from: DVec3, to: DVec3) -> f64 {
    let side = to - from;
    let along = (p - from).dot(side) / side.dot(side);
    if along.is_finite() { along } else { 0.0 }
}

/// Twice the signed area.
fn double_area([a, b, c]: &[DVec2; 3]) -> f64 {
    (*b - *a).perp_dot(*c - *a)
}
