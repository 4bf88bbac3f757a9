//! The max viewpoint on a straight line or segment in space, for an extent and for a given pair of points.
//!
//! Deviation: the paper leaves edges to "numerical methods"; the stationary points are roots of a polynomial of degree
//! 6. Here a fractional program is solved instead (Dinkelbach 1967): both quantities are ratios over the line, and
//! whether a ratio is reached anywhere is decided by the maximum of `gain * h(s) + slope * s - weight * s^2`, where
//! `h` is the distance to the axis, the line along which the point moves. `h` is a hyperbola: its second derivative is
//! largest at one place and falls off on both sides, so the sum is concave, convex, concave, and each of the two
//! concave parts has one maximum, found by a bracketed Newton iteration. No maximum can be missed, and none is between
//! samples. The outer iteration climbs monotonically and quadratically, in 3 to 6 steps to the last bits.

use glam::DVec3;

use super::{Aperture, viewpoint};
use crate::num::math::{cbrt, length, sqrt};

/// Steps of the outer iteration; far more than it takes.
const STEPS: u32 = 60;
/// Steps of a root search, which halves its bracket at least.
const HALVINGS: u32 = 80;

/// Viewpoints `origin + s * direction` for `s` in [low, high], either of which may be infinite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    origin: DVec3,
    /// Unit vector.
    direction: DVec3,
    low: f64,
    high: f64,
}

impl Edge {
    /// From one point to another one.
    pub(super) fn between(from: DVec3, to: DVec3) -> Option<Self> {
        let along = to - from;
        let high = length(along);
        Some(Self {
            origin: from,
            direction: crate::num::math::unit(along)?,
            low: 0.0,
            high,
        })
    }

    /// A whole line.
    pub(super) fn line(origin: DVec3, direction: DVec3) -> Self {
        Self {
            origin,
            direction,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        }
    }

    fn at(&self, s: f64) -> DVec3 {
        self.origin + self.direction * s
    }

    /// The same viewpoints with the one closest to `p` at 0.
    fn centred_at_foot_of(&self, p: DVec3) -> Self {
        let foot = (p - self.origin).dot(self.direction);
        Self {
            origin: self.at(foot),
            low: self.low - foot,
            high: self.high - foot,
            ..*self
        }
    }

    /// The viewpoint that limits the extent of `point` along the unit vector `axis` most; `None` where none limits it.
    /// The aperture is above 0, and the point does not lie on the edge.
    pub(super) fn max_viewpoint(
        &self,
        point: DVec3,
        axis: DVec3,
        aperture: Aperture,
    ) -> Option<DVec3> {
        let edge = self.centred_at_foot_of(point);
        let ridge = Ridge::new(&edge, point, axis);
        let (sine, cosine) = (aperture.sin(), aperture.cos());
        let limit = |s: f64| 1.0 / viewpoint::extent_from(edge.at(s), point, axis, aperture);
        // Where it is limited at all it is at an end: the denominator of the extent is convex along the line.
        // A line without an end is: far out its angle with the axis exceeds the aperture on one side at least.
        let far = length(point - edge.origin) * (4.0 / (sine * cosine)).min(1e12);
        let start = best_of(edge.ends(far), (0.0, f64::NAN), &limit);
        if start.0 <= 0.0 {
            return None;
        }
        let (slope, range) = (sine * edge.direction.dot(axis), [edge.low, edge.high]);
        let maxima = |best: f64| ridge.maxima(cosine, slope, best * sine, range);
        Some(edge.at(climb(start, &limit, maxima)))
    }

    /// The viewpoint that sees the two points farthest apart; `None` where none tells them apart. The edge does not
    /// meet the segment between them.
    pub(super) fn worst_viewpoint(&self, point: DVec3, moved: DVec3) -> Option<DVec3> {
        let (half, middle) = (0.5 * (moved - point), 0.5 * (point + moved));
        let radius = length(half);
        let axis = crate::num::math::unit(half)?;
        let edge = self.centred_at_foot_of(middle);
        let ridge = Ridge::new(&edge, point, axis);
        // Minus the cotangent of the angle, a ratio whose denominator is not negative: the largest is wanted.
        let seen = |s: f64| {
            let v = edge.at(s);
            let (a, b) = (point - v, moved - v);
            -(a.dot(b) / length(a.cross(moved - point)))
        };
        let nearest = 0.0_f64.max(edge.low).min(edge.high);
        let far = 4.0 * (radius + length(middle - edge.origin));
        let [first, last] = edge.ends(far);
        let start = best_of([first, last, nearest], (f64::NEG_INFINITY, f64::NAN), &seen);
        if !start.0.is_finite() {
            return None;
        }
        let range = [edge.low, edge.high];
        let maxima = |best: f64| ridge.maxima(-2.0 * radius * best, 0.0, 1.0, range);
        Some(edge.at(climb(start, &seen, maxima)))
    }

    /// Both ends, a place so far out for an end at infinity.
    fn ends(&self, far: f64) -> [f64; 2] {
        let (low, high) = (self.low, self.high);
        let end = |end: f64, place: f64| if end.is_finite() { end } else { place };
        [end(low, high.min(0.0) - far), end(high, low.max(0.0) + far)]
    }
}

/// The place with the largest value, if that is above the value of the one that is known.
fn best_of<const N: usize>(
    places: [f64; N],
    known: (f64, f64),
    value: &impl Fn(f64) -> f64,
) -> (f64, f64) {
    let found = places.into_iter().map(|s| (value(s), s));
    found.fold(
        known,
        |best, next| if next.0 > best.0 { next } else { best },
    )
}

/// The place with the largest value: from the best one so far to the best of the maxima for its value, while that rises.
fn climb(
    mut best: (f64, f64),
    value: &impl Fn(f64) -> f64,
    maxima: impl Fn(f64) -> [f64; 2],
) -> f64 {
    for _ in 0..STEPS {
        let next = best_of(maxima(best.0), best, value);
        if next.0 <= best.0 {
            break;
        }
        best = next;
    }
    best.1
}

/// The distance of the viewpoints of an edge to the axis: `h(s) = sqrt(squared + spread (s - centre)^2)`.
struct Ridge {
    centre: f64,
    /// Squared distance between the two lines.
    squared: f64,
    /// Squared sine of the angle between them.
    spread: f64,
}

impl Ridge {
    fn new(edge: &Edge, point: DVec3, axis: DVec3) -> Self {
        let still = (point - edge.origin).cross(axis);
        let moving = edge.direction.cross(axis);
        let spread = moving.dot(moving);
        // Parallel but for rounding: then the distance does not change along the edge.
        let (spread, centre) = if spread > 1e-28 {
            (spread, still.dot(moving) / spread)
        } else {
            (0.0, 0.0)
        };
        let least = still - moving * centre;
        Self {
            centre,
            squared: least.dot(least),
            spread,
        }
    }

    /// Every local maximum of `gain * h(s) + slope * s - weight * s^2` in [low, high], and maybe more places; `weight`
    /// is above 0.
    fn maxima(&self, gain: f64, slope: f64, weight: f64, [low, high]: [f64; 2]) -> [f64; 2] {
        // |h'| <= sqrt(spread): no stationary point lies farther out.
        let reach = (gain.abs() * sqrt(self.spread) + slope.abs()) / (2.0 * weight);
        let reach = 1.000_001 * reach;
        let (low, high) = (low.max(-reach).min(high), high.min(reach).max(low));
        // Within this distance of the centre the sum is convex.
        let curved = 0.5 * gain * self.spread * self.squared / weight;
        let root = if curved > 0.0 { cbrt(curved) } else { 0.0 };
        let above = root * root - self.squared;
        let is_convex = gain > 0.0 && self.spread > 0.0 && above > 0.0;
        let convex = if is_convex {
            sqrt(above / self.spread)
        } else {
            0.0
        };
        let left = (self.centre - convex).min(high).max(low);
        let right = (self.centre + convex).min(high).max(low);
        let search = |side: f64| Search {
            ridge: self,
            gain,
            slope,
            weight,
            side,
        };
        if gain <= 0.0 {
            let only = search(1.0).peak(low, high);
            return [only, only];
        }
        [search(-1.0).peak(low, left), search(1.0).peak(right, high)]
    }
}

struct Search<'a> {
    ridge: &'a Ridge,
    gain: f64,
    slope: f64,
    weight: f64,
    /// The side of the centre that is searched, -1 or 1: where the lines meet, `h` has two derivatives there.
    side: f64,
}

impl Search<'_> {
    /// The first two derivatives at `s`.
    fn derivatives(&self, s: f64) -> [f64; 2] {
        let ridge = self.ridge;
        let x = s - ridge.centre;
        let h = sqrt(ridge.squared + ridge.spread * x * x);
        let (first, second) = if h > 0.0 {
            let first = ridge.spread * x / h;
            (first, (ridge.spread - first * first) / h)
        } else {
            (self.side * sqrt(ridge.spread), 0.0)
        };
        [
            self.gain * first + self.slope - 2.0 * self.weight * s,
            self.gain * second - 2.0 * self.weight,
        ]
    }

    /// The place of the maximum between `low` and `high`, where the sum is concave.
    fn peak(&self, mut low: f64, mut high: f64) -> f64 {
        if low >= high || self.derivatives(low)[0] <= 0.0 {
            return low;
        }
        if self.derivatives(high)[0] >= 0.0 {
            return high;
        }
        let mut s = 0.5 * (low + high);
        for _ in 0..HALVINGS {
            let [first, second] = self.derivatives(s);
            if first > 0.0 {
                low = s;
            } else if first < 0.0 {
                high = s;
            } else {
                return s;
            }
            let newton = s - first / second;
            let inside = newton > low && newton < high;
            let next = if inside { newton } else { 0.5 * (low + high) };
            if (next - s).abs() <= 1e-15 * s.abs() {
                return next;
            }
            s = next;
        }
        s
    }
}
