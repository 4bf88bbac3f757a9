//! Cutting convex polygons along the sides of triangles so that neighbours fit together.
//!
//! Sutherland & Hodgman 1974. A side that two triangles share gives each the same distances up to the sign, bit for bit,
//! so both sides of a cut have the same corners. Corners nearer than [`SNAP`] to a side lie on it: cuts make no slivers
//! thinner than that, and what is thinner goes whole to one side.

use glam::DVec2;

/// Distances that count as 0, in a plane where fans have a size near 1.
pub(super) const SNAP: f64 = 1e-12;
/// Triangles farther apart than this have nothing in common.
const APART: f64 = 1e-9;

/// A corner of a piece in the plane, with its weights in the original triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    pub(super) plane: DVec2,
    pub(super) source: [f64; 2],
}

/// Twice the signed area.
pub(super) fn double_area([a, b, c]: &[DVec2; 3]) -> f64 {
    (*b - *a).perp_dot(*c - *a)
}

/// A side as a line: distances from it are positive on the left.
#[derive(Clone, Copy, Debug)]
struct Side {
    from: DVec2,
    /// Unit length.
    along: DVec2,
    /// The line runs the other way: from the lesser of its ends.
    turned: bool,
}

impl Side {
    fn new(from: DVec2, to: DVec2) -> Self {
        let turned = (to.x, to.y) < (from.x, from.y);
        let (low, high) = if turned { (to, from) } else { (from, to) };
        let d = high - low;
        Self {
            from: low,
            along: d / crate::num::math::sqrt(d.dot(d)),
            turned,
        }
    }

    fn distance(&self, p: DVec2) -> f64 {
        let d = self.along.perp_dot(p - self.from);
        if self.turned { -d } else { d }
    }
}

/// A triangle with its sides as lines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounded {
    pub(super) corners: [DVec2; 3],
    sides: [Side; 3],
}

impl Bounded {
    /// Of corners in counter-clockwise order, with an area.
    pub(super) fn new(corners: [DVec2; 3]) -> Self {
        let [a, b, c] = corners;
        Self {
            corners,
            sides: [Side::new(a, b), Side::new(b, c), Side::new(c, a)],
        }
    }

    /// Weights of the corners at a point inside: not negative, with the sum 1 up to rounding.
    pub(super) fn weights(&self, p: DVec2) -> [f64; 3] {
        let [a, b, c] = self.corners;
        let of = |q: DVec2, r: DVec2| (q - p).perp_dot(r - p).max(0.0);
        let w = [of(b, c), of(c, a), of(a, b)];
        let sum = w[0] + w[1] + w[2];
        w.map(|x| x / sum)
    }

    /// Distance from the nearest side, negative outside.
    pub(super) fn depth(&self, p: DVec2) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|k| self.sides[k].distance(p));
        x.min(y).min(z)
    }

    /// True where a side of either triangle has the other on its outside, with a margin.
    pub(super) fn is_apart(&self, other: &[DVec2; 3]) -> bool {
        let outside =
            |side: &Side, corners: &[DVec2; 3]| corners.iter().all(|&p| side.distance(p) < -APART);
        let [a, b, c] = *other;
        self.sides.iter().any(|s| outside(s, other))
            || [Side::new(a, b), Side::new(b, c), Side::new(c, a)]
                .iter()
                .any(|s| outside(s, &self.corners))
    }
}

/// How a polygon lies to a triangle, as far as a look at its corners tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// All of it inside, and none of it in a neighbour of the triangle.
    Inside,
    /// None of it inside.
    Outside,
    /// To be cut.
    Across,
}

/// Where `polygon` lies; says the same as [`clip`] would, sooner.
pub(super) fn place(polygon: &[Corner], triangle: &Bounded) -> Place {
    let mut place = Place::Inside;
    for side in &triangle.sides {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for corner in polygon {
            let d = side.distance(corner.plane);
            low = low.min(d);
            high = high.max(d);
        }
        if high < -SNAP {
            return Place::Outside;
        }
        if low < -SNAP || high <= SNAP {
            place = Place::Across;
        }
    }
    place
}

/// Keeps of `polygon` what lies in the triangle; false where nothing is left. `spare` is a buffer.
pub(super) fn clip(polygon: &mut Vec<Corner>, spare: &mut Vec<Corner>, triangle: &Bounded) -> bool {
    triangle
        .sides
        .iter()
        .all(|side| clip_by_side(polygon, spare, side))
}

fn clip_by_side(polygon: &mut Vec<Corner>, spare: &mut Vec<Corner>, side: &Side) -> bool {
    let snapped = |p: DVec2| {
        let d = side.distance(p);
        if d.abs() <= SNAP { 0.0 } else { d }
    };
    let (mut low, mut high) = (0.0_f64, 0.0_f64);
    for corner in polygon.iter() {
        let d = snapped(corner.plane);
        low = low.min(d);
        high = high.max(d);
    }
    if low >= 0.0 && high <= 0.0 {
        // All on the line: it belongs to the side that most of it is on.
        let sum: f64 = polygon.iter().map(|c| side.distance(c.plane)).sum();
        return sum > 0.0 || (sum >= 0.0 && !side.turned);
    }
    if low >= 0.0 {
        return true;
    }
    if high <= 0.0 {
        return false;
    }
    spare.clear();
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (da, db) = (snapped(a.plane), snapped(b.plane));
        if da >= 0.0 {
            spare.push(a);
        }
        if (da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0) {
            let t = da / (da - db);
            spare.push(Corner {
                plane: a.plane + (b.plane - a.plane) * t,
                source: [0, 1].map(|k| a.source[k] + (b.source[k] - a.source[k]) * t),
            });
        }
    }
    std::mem::swap(polygon, spare);
    polygon.len() >= 3
}
