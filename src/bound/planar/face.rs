//! The interval of lines that a face may be projected on, along their normal or any other direction, so that no viewer
//! sees any of its points move by more than an angle.
//!
//! Eisemann & Décoret 2007, section 5 with appendices B and C. For one viewpoint the limit over a face is the smallest
//! value of equation 11, whose stationary points are roots of one quadratic. Its two roots are taken in the form that
//! does not cancel, and then the special cases need no branch: where the limit is a parabola one root goes to infinity
//! and the other is the parabola's (equation 12), where it is a monotone hyperbola or has no extremum the square root
//! is no number, where the face line holds the viewpoint both roots are the viewpoint. For viewpoints between the
//! cell's ends the limit is linear (equation 10). Every candidate is a legal viewpoint with a point of the face, so a
//! superfluous one changes nothing. The alpha of equations 11 to 13 is an abscissa across the direction, not a length
//! along the face.
//!
//! The paper's lines are across the direction of projection. Slanted ones have the normal y + kx, in the frame with y
//! along the direction and x across it, k their [`skew`](Projection::oblique). Moved by t along y, a point goes from the
//! offset y + kx to y + kx + t, so that kx is all that is added to equation 11. On the face line y = m + x tan(g), seen
//! from the origin with x > 0, the limit is
//!
//! ```text
//! f(x) = (A x^2 + B x) / (C x - D)        A = sin + k cos + tan(g) (cos - k sin)        C = cos - tan(g) sin
//!                                         B = m (cos - k sin)                           D = m sin
//! ```
//! sin and cos those of the aperture, of minus the aperture where x < 0. Because D A + C B = m, f' = 0 has the roots
//! m (sin +- sqrt(sin / A)) / C, whose product is -m^2 sin (cos - k sin) / (A C): equations 12 and 13 for k = 0, and the
//! same special cases otherwise. Beyond those of the paper, for a line along the side of the cone (cos = k sin) one root
//! is the viewpoint. What is linear along the face (equation 10) stays linear.

use glam::DVec2;

use super::{
    Aperture, Disc, Interval, ViewerSegment,
    interval::Bounds,
    point::{Tangent, tangents},
};
use crate::{
    Error, Result,
    num::{Each, math},
};

/// A viewpoint this close to a face is on it, as a fraction of the coordinates: where rounding decides on which side it
/// is, it would also decide whether the limit beside it is found.
const CONTACT: f64 = 1e-14;

/// Share of the aperture that [`Projection::may_reach`] lets pass beyond it, against rounding.
const LENIENCE: f64 = 1e-6;

/// A cell, a direction of projection, the normal of the lines that are projected on, and an aperture: what all faces have
/// in common.
#[derive(Clone, Debug)]
pub struct Projection {
    cell: ViewerSegment,
    direction: DVec2,
    sin: f64,
    cos: f64,
    /// Offset that a point gains per unit across the direction; 0 for lines across it.
    skew: f64,
    /// Offset along the normal for an offset along the direction, above 0; 1 for lines across the direction.
    scale: f64,
    /// Ends of the cell by their coordinates across and along the direction; infinite ends are left out.
    ends: [Option<DVec2>; 2],
    /// Tangents by side of the axis (0 left of it), then by sign of the direction (0 along it).
    tangents: [[[Option<Tangent>; 2]; 2]; 2],
    /// Offset of the frame's origin.
    offset: f64,
}

impl Projection {
    /// Projections along the unit vector `direction` on the lines across it, for viewers in `cell` who accept `aperture`.
    pub fn new(cell: &ViewerSegment, direction: DVec2, aperture: Aperture) -> Self {
        let local = cell.turn(direction);
        let end = |x: f64| x.is_finite().then(|| DVec2::new(x * local.y, x * local.x));
        let mirrored = DVec2::new(local.x, -local.y);
        Self {
            cell: *cell,
            direction: local,
            sin: aperture.sin(),
            cos: aperture.cos(),
            ends: cell.ends().each(end),
            tangents: [local, mirrored].each(|d| [d, -d].each(|d| tangents(d, aperture))),
            skew: 0.0,
            scale: 1.0,
            offset: cell.origin().dot(direction),
        }
    }

    /// Projections along the unit vector `direction`, or against it, on lines with the unit vector `normal`: with both
    /// the same, those of [`Projection::new`].
    ///
    /// # Errors
    /// [`Error::Usage`] where the lines are parallel to the direction, so that nothing projected along it reaches them.
    pub fn oblique(
        cell: &ViewerSegment,
        direction: DVec2,
        normal: DVec2,
        aperture: Aperture,
    ) -> Result<Self> {
        // To and fro along a direction is the same projection.
        let against = direction.dot(normal) < 0.0;
        let toward = if against { -direction } else { direction };
        let scale = toward.dot(normal);
        let skew = normal.perp_dot(toward) / scale;
        if !(scale > 0.0 && skew.is_finite()) {
            return Err(Error::Usage(format!(
                "nothing projected along {direction} reaches a line with normal {normal}: give two directions that are \
                 not at right angles"
            )));
        }
        let across = Self::new(cell, toward, aperture);
        if normal == toward {
            return Ok(across);
        }
        Ok(Self {
            skew,
            scale,
            offset: cell.origin().dot(normal),
            ..across
        })
    }

    /// A point of the cell's frame, across and along the direction.
    #[inline(always)]
    fn turned(&self, p: DVec2) -> DVec2 {
        let d = self.direction;
        DVec2::new(p.x * d.y - p.y * d.x, p.x * d.x + p.y * d.y)
    }

    /// The way along the direction to the nearest of `offsets` from points within `spread` of the offset of `at`, and its
    /// sense; `None` where they are there. Points may go any part of the way that they may go: the nearest decides.
    #[inline(always)]
    fn way_to(&self, offsets: Interval, at: DVec2, spread: f64) -> Option<(f64, f64)> {
        let own = self.own(at);
        let low = (offsets.min - self.offset) / self.scale - own - spread;
        let high = (offsets.max - self.offset) / self.scale - own + spread;
        let back = (high < 0.0).then_some((-high, -1.0));
        (low > 0.0).then_some((low, 1.0)).or(back)
    }

    /// The offset of a point given across and along the direction, along the direction.
    #[inline(always)]
    fn own(&self, p: DVec2) -> f64 {
        p.y + self.skew * p.x
    }

    /// The offsets of the lines that the face from `a` to `b` may be projected on. A face may be a point, hold the
    /// viewpoint, or cross the cell's line: it is split there (appendix B). Where it touches the cell, nothing but the
    /// line through the contact is left of the interval. Bounds of the paper's section 5, exact. O(1).
    #[inline]
    pub fn interval(&self, a: DVec2, b: DVec2) -> Interval {
        let (m, n) = (self.cell.enter(a), self.cell.enter(b));
        let (from, to) = (self.turned(m), self.turned(n));
        let offsets = [from, to].each(|p| self.own(p));
        let face = Face { from, to, offsets };
        let local = if self.sin == 0.0 {
            self.interval_without_tolerance(&face)
        } else {
            let mut bounds = Bounds(Interval::ALL);
            self.narrow_by_ends(&face, &mut bounds);
            self.narrow_by_tangents(&face, [m, n], &mut bounds);
            bounds.0
        };
        let place = |rho: f64| rho * self.scale + self.offset;
        Interval::new(place(local.min), place(local.max))
    }

    /// False only where [`Projection::interval`] of every face with the point `p` holds no offset in `offsets`: judged
    /// from the ends of the cell, or for a cell without an end, at a fraction of the cost.
    #[inline]
    pub fn may_reach(&self, p: DVec2, offsets: Interval) -> bool {
        let local = self.cell.enter(p);
        let at = self.turned(local);
        let Some((way, sense)) = self.way_to(offsets, at, 0.0) else {
            return true;
        };
        for end in self.ends.into_iter().flatten() {
            let sight = at - end;
            let size = |p: DVec2| p.x.abs() + p.y.abs();
            let lenience = LENIENCE * size(sight);
            if lenience < 4.0 * CONTACT * (size(at) + size(end)) {
                continue;
            }
            let closing = sight.x.abs() * self.cos - sense * sight.y * self.sin;
            let squared = sight.x * sight.x + sight.y * sight.y;
            if way * (closing - lenience) > squared * (self.sin + LENIENCE) {
                return false;
            }
        }
        if self.ends == [None, None] {
            let (side, toward) = (usize::from(local.y < 0.0), usize::from(sense < 0.0));
            let height = local.y.abs() * (1.0 + LENIENCE) + local.x.abs() * LENIENCE;
            let tangents = self.tangents[side][toward].iter().flatten();
            for Tangent { length, .. } in tangents {
                if way > height * (length + LENIENCE) {
                    return false;
                }
            }
        }
        true
    }

    /// False only where [`Projection::may_reach`] is for every point of a disc.
    pub fn may_reach_any(&self, disc: Disc, offsets: Interval) -> bool {
        let Disc { centre, radius } = disc;
        let local = self.cell.enter(centre);
        let at = self.turned(local);
        let spread = radius * (1.0 + self.skew.abs());
        let Some((way, sense)) = self.way_to(offsets, at, spread) else {
            return true;
        };
        let size = |p: DVec2| p.x.abs() + p.y.abs();
        for end in self.ends.into_iter().flatten() {
            let sight = at - end;
            let lenience = 2.0 * LENIENCE * (size(sight) + 2.0 * radius);
            // What is next to the viewer is not told apart.
            if size(sight) <= 4.0 * radius || lenience < 16.0 * CONTACT * (size(at) + size(end)) {
                continue;
            }
            let closing = (sight.x.abs() - radius).max(0.0) * self.cos
                - (sense * sight.y + radius) * self.sin;
            let [x, y] = [sight.x.abs() + radius, sight.y.abs() + radius];
            if way * (closing - lenience) > (x * x + y * y) * (self.sin + 2.0 * LENIENCE) {
                return false;
            }
        }
        if self.ends == [None, None] && local.y.abs() > radius {
            let (side, toward) = (usize::from(local.y < 0.0), usize::from(sense < 0.0));
            let [x, y] = [local.x.abs() + radius, local.y.abs() + radius];
            let height = y * (1.0 + 2.0 * LENIENCE) + x * (2.0 * LENIENCE);
            let tangents = self.tangents[side][toward].iter().flatten();
            for Tangent { length, .. } in tangents {
                if way > height * (length + 2.0 * LENIENCE) {
                    return false;
                }
            }
        }
        true
    }

    /// With no tolerance a point may move in the direction of sight only, which all points of a face can do alike only
    /// where one viewpoint sees the face from its end.
    fn interval_without_tolerance(&self, face: &Face) -> Interval {
        let (from, to) = (face.from, face.to);
        if let [Some(v), Some(w)] = self.ends
            && v == w
            && DVec2::new(from.x, to.x) == DVec2::splat(v.x)
        {
            let mut bounds = Bounds(Interval::ALL);
            bounds.narrow(from - v, face.offsets[0], 0.0, 1.0);
            bounds.narrow(to - v, face.offsets[1], 0.0, 1.0);
            if (from.y < v.y) != (to.y < v.y) {
                bounds.pin(self.own(v));
            }
            return bounds.0;
        }
        let [from, to] = face.offsets;
        Interval::new(from.max(to), from.min(to))
    }

    /// Narrows `bounds` to those that the ends of the cell allow (equations 11 to 13, appendix C).
    #[inline(always)]
    fn narrow_by_ends(&self, face: &Face, bounds: &mut Bounds) {
        let (sin, cos) = (self.sin, self.cos);
        let run = face.to - face.from;
        let inverse = 1.0 / run.x;
        // Abscissae of the extrema, for a face line at distance 1 of the viewpoint: two for +theta, two for -theta.
        let mut extrema = [f64::NAN; 4];
        if run.x != 0.0 {
            for (sign, pair) in [(1.0, 0), (-1.0, 2)] {
                let s = sign * sin;
                // The cosine less the part of the sine, 0 for a line along the side of the cone.
                let beside = cos - self.skew * s;
                let p = (s + self.skew * cos) * run.x + beside * run.y;
                let q = cos * run.x - s * run.y;
                let root = s + sign * math::sqrt(s * run.x / p);
                extrema[pair] = root / q;
                extrema[pair + 1] = -s * beside / (p * root);
            }
        }
        for end in self.ends.into_iter().flatten() {
            let (from, to) = (face.from - end, face.to - end);
            let here = self.own(end);
            bounds.narrow(from, face.offsets[0], sin, cos);
            bounds.narrow(to, face.offsets[1], sin, cos);
            if run.x == 0.0 {
                if from.x == 0.0 && (from.y < 0.0) != (to.y < 0.0) {
                    bounds.pin(here);
                }
                continue;
            }
            let moment = from.y * run.x - from.x * run.y;
            if (from.x < 0.0) != (to.x < 0.0) {
                // Straight behind the direction, a point may go as far as the viewer and no farther.
                let ahead = moment * inverse;
                let size = |p: DVec2| p.x.abs() + p.y.abs();
                let near = CONTACT * (size(face.from) + size(face.to) + size(end));
                if ahead <= near {
                    bounds.0.max = bounds.0.max.min(here);
                }
                if ahead >= -near {
                    bounds.0.min = bounds.0.min.max(here);
                }
            }
            let (low, high) = (from.x.min(to.x), from.x.max(to.x));
            for extremum in extrema {
                let x = moment * extremum;
                if x > low && x < high {
                    let along = (x - from.x) * inverse * run.y;
                    let point = DVec2::new(x, from.y + along);
                    let offset = face.offsets[0] + (along + self.skew * (x - from.x));
                    bounds.narrow(point, offset, sin, cos);
                }
            }
        }
    }

    /// Narrows bounds to those that viewpoints between the ends allow: where a circle touches the line of the cell the
    /// limit is linear along the face (equation 10), so that the ends of that part of the face are enough.
    #[inline(always)]
    fn narrow_by_tangents(&self, face: &Face, [from, to]: [DVec2; 2], bounds: &mut Bounds) {
        // Split where the face crosses the axis (appendix B).
        let rise = to.y - from.y;
        let below = from.y < 0.0;
        let parts = if below == (to.y < 0.0) {
            [Some((0.0, 1.0, below)), None]
        } else {
            let at = (from.y / (from.y - to.y)).clamp(0.0, 1.0);
            [Some((0.0, at, below)), Some((at, 1.0, !below))]
        };
        let [first, last] = self.cell.ends();
        let run = face.offsets[1] - face.offsets[0];
        for (low, high, below) in parts.into_iter().flatten() {
            let side = if below { -1.0 } else { 1.0 };
            for (direction, sign) in [(0, 1.0), (1, -1.0)] {
                let tangents = self.tangents[usize::from(below)][direction];
                for Tangent { offset, length } in tangents.into_iter().flatten() {
                    // The viewpoint of the point at parameter t is at start + t slope.
                    let start = from.x + side * offset * from.y;
                    let slope = to.x - from.x + side * offset * rise;
                    let (at_low, at_high) = (start + low * slope, start + high * slope);
                    if at_low.max(at_high) < first || at_low.min(at_high) > last {
                        continue;
                    }
                    let part = |t: f64, x: f64| {
                        if x < first {
                            ((first - start) / slope).clamp(low, high)
                        } else if x > last {
                            ((last - start) / slope).clamp(low, high)
                        } else {
                            t
                        }
                    };
                    for t in [part(low, at_low), part(high, at_high)] {
                        let height = (from.y + t * rise) * side;
                        let limit = face.offsets[0] + t * run + sign * length * height.max(0.0);
                        if sign > 0.0 {
                            bounds.0.max = bounds.0.max.min(limit);
                        } else {
                            bounds.0.min = bounds.0.min.max(limit);
                        }
                    }
                }
            }
        }
    }
}

/// The ends of a face by their coordinates across and along the direction, and their offsets.
#[derive(Clone, Copy, Debug)]
struct Face {
    from: DVec2,
    to: DVec2,
    offsets: [f64; 2],
}
