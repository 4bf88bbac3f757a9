//! A face, viewers, and a projection: drawn so that every special case occurs, and judged by sampling viewers against
//! points of the face.

use std::f64::consts::TAU;

use glam::DVec2;
use lodmark::bound::planar::{Disc, Interval, Projection, ViewerSegment};

use super::seen::{angle, cases, largest, largest_of_two};
use crate::support::{Random, aperture};

/// The special cases of section 5 and of appendices A to C. In the frame of one viewpoint at the origin with the
/// direction along y, a face lies on the line y = m + x tan(g).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// Anything.
    Generic,
    /// cos(theta + g) = 0, m not 0: the limit is a parabola (equation 12).
    Parabola,
    /// sin(theta + g) = 0, m not 0: a hyperbola of monotone branches.
    Hyperbola,
    /// m = 0: linear.
    ThroughViewpoint,
    /// m = 0 and cos(theta + g) = 0: the side of the cone is parallel to the direction.
    ThroughViewpointAlongCone,
    /// m = 0 and sin(theta + g) = 0: the limit is the x-axis.
    ThroughViewpointFlat,
    /// The face is seen edge-on along the direction.
    EdgeOn,
    /// And its line holds the viewpoint.
    EdgeOnThroughViewpoint,
    /// w1 + c w2 = 0 and the common max viewpoint is in the cell: linear all over.
    OneTangentInside,
    /// w1 + c w2 = 0 and the common max viewpoint is outside.
    OneTangentOutside,
    /// The face crosses the line of the cell beside it (appendix B).
    Crossing,
    /// The face touches the cell.
    Touching,
    /// The face lies in the line of the cell, beside it.
    InLine,
    /// The face is a point.
    Point,
    /// The direction is within the aperture of the cell's line (appendix A).
    AlongCell,
    /// The viewpoint is an end of the face.
    ViewpointOnEnd,
}

pub(super) const CLASSES: [Class; 16] = [
    Class::Generic,
    Class::Parabola,
    Class::Hyperbola,
    Class::ThroughViewpoint,
    Class::ThroughViewpointAlongCone,
    Class::ThroughViewpointFlat,
    Class::EdgeOn,
    Class::EdgeOnThroughViewpoint,
    Class::OneTangentInside,
    Class::OneTangentOutside,
    Class::Crossing,
    Class::Touching,
    Class::InLine,
    Class::Point,
    Class::AlongCell,
    Class::ViewpointOnEnd,
];

#[derive(Debug)]
pub(super) struct Case {
    /// Ends of the cell; equal for one viewpoint.
    pub(super) cell: [DVec2; 2],
    /// The cell lies on the x-axis and goes on for ever beyond its second end.
    pub(super) endless: bool,
    pub(super) face: [DVec2; 2],
    pub(super) direction: DVec2,
    /// Of the lines that are projected on.
    pub(super) normal: DVec2,
    pub(super) theta: f64,
}

pub(super) fn turned(p: DVec2, turn: f64) -> DVec2 {
    DVec2::from_angle(turn).rotate(p)
}

/// A case of a class, on lines across the direction.
pub(super) fn draw(class: Class, random: &mut Random) -> Case {
    let theta = match random.next() % 3 {
        0 => random.between(0.002, 0.03),
        1 => random.between(0.03, 0.3),
        _ => random.between(0.3, 1.4),
    };
    let side = random.sign();
    let away = |random: &mut Random, low: f64, high: f64| {
        let radius = random.between(low, high);
        turned(DVec2::new(radius, 0.0), random.between(0.0, TAU))
    };
    let far = |random: &mut Random| away(random, 1.0, 10.0);
    let (mut a, mut b) = (far(random), far(random));
    let (mut from, mut to) = (DVec2::ZERO, DVec2::ZERO);
    let mut up = DVec2::Y;
    if random.next().is_multiple_of(2) {
        to = away(random, 0.2, 5.0);
    }
    // A face along `w`, at m over the viewpoint.
    let along = |random: &mut Random, w: DVec2, m: f64| {
        let (s, t) = (random.between(-8.0, 8.0), random.between(-8.0, 8.0));
        [DVec2::new(0.0, m) + w * s, DVec2::new(0.0, m) + w * t]
    };
    let m = side * random.between(0.5, 6.0);
    let (sin, cos) = theta.sin_cos();
    let (steep, flat) = (DVec2::new(side * sin, cos), DVec2::new(cos, -side * sin));
    if matches!(class, Class::Crossing | Class::Touching | Class::InLine) {
        (from, to) = (DVec2::ZERO, DVec2::new(3.0, 0.0));
        up = turned(up, random.between(0.0, TAU));
    }
    match class {
        Class::Generic => up = turned(up, random.between(0.0, TAU)),
        Class::Parabola => [a, b] = along(random, steep, m),
        Class::Hyperbola => [a, b] = along(random, flat, m),
        Class::ThroughViewpoint => {
            let g = random.between(-1.5, 1.5);
            [a, b] = along(random, DVec2::from_angle(g), 0.0);
        }
        Class::ThroughViewpointAlongCone => [a, b] = along(random, steep, 0.0),
        Class::ThroughViewpointFlat => [a, b] = along(random, flat, 0.0),
        Class::EdgeOn => b.x = a.x,
        Class::EdgeOnThroughViewpoint => (a.x, b.x) = (0.0, 0.0),
        Class::OneTangentInside | Class::OneTangentOutside => {
            // A cell on the x-axis; by the inscribed angle the circle of `up` touches it at the half-angle.
            let gamma = random.between(0.0, TAU);
            up = DVec2::from_angle(gamma);
            let c = ((theta + gamma) / 2.0).tan();
            let (low, high) = (random.between(0.5, 3.0), random.between(3.5, 9.0));
            let v = random.between(-1.0, 1.0);
            a = DVec2::new(v - c * low, low);
            b = DVec2::new(v - c * high, high);
            let middle = f64::from(u8::from(class == Class::OneTangentOutside)) * 7.0;
            (from, to) = (DVec2::X * (middle - 2.0), DVec2::X * (middle + 2.0));
        }
        Class::Crossing => {
            a = DVec2::new(random.between(4.0, 8.0), random.between(0.5, 4.0));
            b = DVec2::new(random.between(4.0, 8.0), -random.between(0.5, 4.0));
        }
        Class::Touching => {
            let contact = DVec2::new(random.between(0.1, 2.9), 0.0);
            a = contact + DVec2::new(random.between(-3.0, 3.0), random.between(0.5, 4.0));
            b = contact + (contact - a) * random.between(0.1, 1.0);
        }
        Class::InLine => {
            a = DVec2::new(random.between(3.5, 9.0), 0.0);
            b = DVec2::new(random.between(3.5, 9.0), 0.0);
        }
        Class::Point => {
            up = turned(up, random.between(0.0, TAU));
            b = a;
        }
        Class::AlongCell => {
            let axis = turned(DVec2::X, random.between(0.0, TAU));
            (from, to) = (DVec2::ZERO, axis * 4.0);
            up = turned(-axis * side, random.between(-theta, theta));
        }
        Class::ViewpointOnEnd => {
            up = turned(up, random.between(0.0, TAU));
            a = DVec2::ZERO;
        }
    }
    // The same scene somewhere else; a quarter stay where the coordinates are exact.
    let (turn, by) = match random.next() % 4 {
        0 => (0.0, DVec2::ZERO),
        _ => (random.between(0.0, TAU), far(random) * 3.0),
    };
    let place = |p: DVec2| if turn == 0.0 { p } else { turned(p, turn) + by };
    Case {
        cell: [place(from), place(to)],
        endless: false,
        face: [place(a), place(b)],
        direction: turned(up, turn),
        normal: turned(up, turn),
        theta,
    }
}

pub(super) const SCALE: f64 = 10.0;

/// Projections along a direction on the lines across it, or on those with another normal.
pub(super) fn projection(
    cell: &ViewerSegment,
    direction: DVec2,
    normal: DVec2,
    theta: f64,
) -> Projection {
    if normal == direction {
        return Projection::new(cell, direction, aperture(theta));
    }
    Projection::oblique(cell, direction, normal, aperture(theta)).expect("not parallel")
}

impl Case {
    pub(super) fn interval(&self) -> Interval {
        let [a, b] = self.cell;
        let cell = if self.endless {
            ViewerSegment::on_x_axis(a.x, (b.x - a.x) * f64::INFINITY)
        } else {
            ViewerSegment::between(a, b).expect("finite ends")
        };
        let projection = projection(&cell, self.direction, self.normal, self.theta);
        projection.interval(self.face[0], self.face[1])
    }

    /// Offset along the normal per way along the direction.
    pub(super) fn scale(&self) -> f64 {
        if self.normal == self.direction {
            1.0
        } else {
            self.direction.dot(self.normal)
        }
    }

    fn viewpoint(&self, s: f64) -> DVec2 {
        let far = if self.endless { 0.999_999 } else { 0.0 };
        let way = s / (1.0 - s * far);
        self.cell[0] + (self.cell[1] - self.cell[0]) * way
    }

    pub(super) fn point(&self, t: f64) -> DVec2 {
        self.face[0] + (self.face[1] - self.face[0]) * t
    }

    /// The distance between face and cell.
    fn gap(&self) -> f64 {
        let ([a, b], [c, d]) = (self.face, self.cell);
        let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p) > 0.0;
        if side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b) {
            return 0.0;
        }
        let to = |p: DVec2, q: DVec2, r: DVec2| {
            let along = r - q;
            let t = (p - q).dot(along) / along.length_squared().max(1e-300);
            p.distance(q + along * t.clamp(0.0, 1.0))
        };
        let sides = [to(a, c, d), to(b, c, d), to(c, a, b), to(d, a, b)];
        sides.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The angle by which the viewer at `s` of the cell sees the point at `t` of the face move to offset `rho`, 0 where
    /// that is not in the sense of `sign`.
    fn angle(&self, [s, t]: [f64; 2], rho: f64, sign: f64) -> f64 {
        let (v, p, scale) = (self.viewpoint(s), self.point(t), self.scale());
        let way = rho - p.dot(self.normal);
        if way * sign < 1e-12 * SCALE * scale.abs() {
            return 0.0;
        }
        if p.distance(v) < 1e-12 * SCALE {
            // A point at a viewpoint must not move at all.
            return std::f64::consts::PI;
        }
        angle(v, p, p + self.direction * (way / scale))
    }

    /// The largest such angle of a sampled viewer and a sampled point, and the parameters of both; `finer` samples more
    /// densely.
    fn seen(&self, rho: f64, sign: f64, finer: u32) -> (f64, [f64; 2]) {
        largest_of_two(
            |s, t| self.angle([s, t], rho, sign),
            match (self.cell[0] == self.cell[1], self.gap() < 0.2) {
                (true, _) => [0, 300 * finer],
                (false, false) => [16 * finer, 24 * finer],
                (false, true) => [32 * finer, 48 * finer],
            },
            4 * finer as usize,
        )
    }

    /// As [`Case::seen`], slowly: the best viewer for every point, for ridges too narrow to be followed.
    fn seen_point_by_point(&self, rho: f64, sign: f64) -> f64 {
        let worst = |t: f64| largest(|s| self.angle([s, t], rho, sign), 200).0;
        largest(worst, 100).0
    }

    /// Panics where sampling contradicts the claim that `rho` is the last valid offset in the sense of `sign`; gives the
    /// parameter of the face point that limits it.
    pub(super) fn judge(&self, name: &str, number: u32, rho: f64, sign: f64) -> f64 {
        let size = SCALE * self.scale().abs();
        let what = || format!("{name} {number}: rho {rho} toward {sign}, {self:?}");
        let most = self.theta * (1.0 + 1e-9);
        // Where a side of the cone is parallel to the direction but for rounding, the limit is as far.
        if rho.abs() > 1e9 * size {
            assert!(rho * sign > 0.0, "{}", what());
            for far in [1.0, 30.0, 1e4, 1e6] {
                let start = self.point(0.0).dot(self.normal);
                let (seen, _) = self.seen(start + sign * far * size, sign, 1);
                assert!(seen <= most + 1e-9, "{}: {seen} at {far}", what());
            }
            return 0.0;
        }
        let inside = rho - sign * 1e-9 * size;
        let (seen, [_, t]) = self.seen(inside, sign, 1);
        assert!(seen <= most + 1e-12, "{}: {seen}", what());
        // Near a contact the angle jumps: only viewers and points within about the step of it see anything.
        let floor = if self.gap() < 0.2 { 1e-2 } else { 1e-8 };
        let found = [1, 2, 8, 40].into_iter().any(|finer| {
            let (_, [_, t]) = self.seen(inside, sign, finer);
            let extent = (rho - self.point(t).dot(self.normal)).abs();
            let step = 1e-4 * extent + floor * size;
            let beyond = rho + sign * step;
            self.seen(beyond, sign, finer).0 > self.theta
                || finer == 40 && self.seen_point_by_point(beyond, sign) > self.theta
        });
        assert!(found, "{}: nobody sees too much beyond the claim", what());
        t
    }

    /// Judges both ends of the interval, and gives it; true if a point inside the face limits its upper end.
    pub(super) fn judge_interval(&self, name: &str, number: u32) -> (Interval, bool) {
        let interval = self.interval();
        let Interval { min, max } = interval;
        assert!(!min.is_nan() && !max.is_nan(), "{name} {number}");
        let t = self.judge(name, number, max, 1.0);
        self.judge(name, number, min, -1.0);
        (interval, t > 1e-3 && t < 1.0 - 1e-3)
    }

    /// Panics where a quick look at a point of the face, or at a disc around it, refuses an offset that the face may
    /// have; gives how many offsets well beyond those of a point alone were looked at, and how many of them refused.
    pub(super) fn look(&self, told: &str, random: &mut Random) -> [u32; 2] {
        let [a, b] = self.cell;
        let mut cells = vec![ViewerSegment::between(a, b).expect("finite ends")];
        if a != b {
            cells.push(ViewerSegment::line(a, b - a).expect("two points"));
        }
        let (mut beyond, mut refused, size) = (0, 0, SCALE * self.scale().abs());
        for cell in cells {
            let projection = projection(&cell, self.direction, self.normal, self.theta);
            let valid = projection.interval(self.face[0], self.face[1]);
            let may = |p: DVec2, from: f64, to: f64| {
                projection.may_reach(p, Interval::new(from.min(to), from.max(to)))
            };
            let t = random.unit();
            for p in [self.face[0], self.face[1], self.point(t)] {
                for rho in [valid.min, valid.max, valid.min / 2.0 + valid.max / 2.0] {
                    if !rho.is_finite() || !valid.contains(rho) {
                        continue;
                    }
                    let (s, radius) = (random.unit(), random.between(0.0, 2.0));
                    let centre = p + turned(DVec2::X * radius, random.between(0.0, TAU));
                    let radius = radius * 1.000_001;
                    let disc = Disc { centre, radius };
                    let near = may(p, rho, rho) && may(p, rho, rho - s) && may(p, rho, rho + s);
                    let all = near && projection.may_reach_any(disc, Interval::new(rho - s, rho));
                    assert!(all, "{told}: {rho} of {valid:?}, {self:?}");
                }
                // The point alone, by its own interval: what lies well beyond is refused.
                let (own, alone) = (p.dot(self.normal), projection.interval(p, p));
                for (end, sense) in [(alone.max, 1.0), (alone.min, -1.0)] {
                    let far = own + (end - own) * 1.5 + sense * 0.01 * size;
                    if far.is_finite() && far.abs() < 1e3 * size {
                        beyond += 1;
                        refused += u32::from(!may(p, far, far + sense * size / SCALE));
                    }
                }
            }
        }
        [beyond, refused]
    }
}

/// Holds quick looks to refuse most of what lies well beyond, over all cases.
pub(super) fn refuses_most(counts: impl Iterator<Item = [u32; 2]>) {
    let [beyond, refused] = counts.fold([0, 0], |[a, b], [c, d]| [a + c, b + d]);
    println!("{refused} of {beyond} offsets beyond are refused at a look");
    assert!(refused > beyond / 2, "{refused} of {beyond}");
}

/// Panics where the own line of a face is not allowed to a direction at most `slant` off its normal.
pub(super) fn allows_own_lines(stream: u64, slant: f64) {
    let (count, mut random) = cases(stream);
    for number in 0..count {
        let mut at = || DVec2::new(random.between(-9.0, 9.0), random.between(-9.0, 9.0));
        let (a, b, e, f) = (at(), at(), at(), at());
        let normal = (b - a).perp().normalize();
        let direction = turned(normal, random.between(-slant, slant));
        let cell = ViewerSegment::between(e, f).expect("finite ends");
        for theta in [0.0, 1e-4, 0.1, 1.5] {
            let found = projection(&cell, direction, normal, theta).interval(a, b);
            let (rho, slack) = (a.dot(normal), 1e-12 * 20.0);
            let allowed = found.min <= rho + slack && rho <= found.max + slack;
            assert!(allowed, "case {number}, {theta}: {found:?} without {rho}");
        }
    }
}

/// Panics where a line of viewers does not limit a face at its ends only, on lines at most `slant` off those across.
pub(super) fn limits_at_ends_only(stream: u64, slant: f64) {
    let (count, mut random) = cases(stream);
    let line = ViewerSegment::on_x_axis(f64::NEG_INFINITY, f64::INFINITY);
    for number in 0..count {
        let mut at = || DVec2::new(random.between(-9.0, 9.0), random.between(0.1, 9.0));
        let (a, b) = (at(), at());
        let d = DVec2::from_angle(random.between(0.0, TAU));
        let n = turned(d, random.between(-slant, slant));
        let theta = random.between(0.001, 1.2);
        let found = projection(&line, d, n, theta).interval(a, b);
        // The law of sines with the tangent half-angle, by hand: t = 2 y sin / (1 +- cos); moved by t a point has t d.n
        // more offset.
        let moved = |p: DVec2, d: DVec2| {
            let gamma = d.y.atan2(d.x);
            let (plus, minus) = (1.0 + (theta + gamma).cos(), 1.0 - (theta - gamma).cos());
            (p + d * (2.0 * p.y * theta.sin() / plus.max(minus))).dot(n)
        };
        let min = moved(a, -d).max(moved(b, -d));
        let max = moved(a, d).min(moved(b, d));
        let off = (found.min - min).abs().max((found.max - max).abs());
        assert!(
            off < 1e-11 * 20.0,
            "case {number}: {found:?}, not {min} to {max}"
        );
    }
}
