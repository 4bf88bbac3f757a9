//! No point of a face projected inside its interval is seen to move by more than the aperture, and beyond it one is.
//! Every special case of the paper's appendices is built on purpose and counted.

use std::f64::consts::TAU;

use glam::DVec2;
use lodmark::bound::planar::{Aperture, Interval, Projection, SegmentCell};
use lodmark::mesh::generate::Pcg32;

use super::seen::{angle, between, cases, largest_of_two};

/// The special cases of section 5 and of appendices A to C. In the frame of one viewpoint at the origin with the
/// direction along y, a face lies on the line y = m + x tan(g).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Class {
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

const CLASSES: [Class; 16] = [
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
struct Case {
    /// Ends of the cell; equal for one viewpoint.
    cell: [DVec2; 2],
    face: [DVec2; 2],
    direction: DVec2,
    theta: f64,
}

fn turned(p: DVec2, turn: f64) -> DVec2 {
    DVec2::from_angle(turn).rotate(p)
}

fn draw(class: Class, random: &mut Pcg32) -> Case {
    let theta = match random.bits() % 3 {
        0 => between(random, 0.002, 0.03),
        1 => between(random, 0.03, 0.3),
        _ => between(random, 0.3, 1.4),
    };
    let side = if random.bits().is_multiple_of(2) {
        1.0
    } else {
        -1.0
    };
    let far = |random: &mut Pcg32| {
        let radius = between(random, 1.0, 10.0);
        turned(DVec2::new(radius, 0.0), between(random, 0.0, TAU))
    };
    let (mut a, mut b) = (far(random), far(random));
    let (mut from, mut to) = (DVec2::ZERO, DVec2::ZERO);
    let mut up = DVec2::Y;
    if random.bits().is_multiple_of(2) {
        to = turned(
            DVec2::new(between(random, 0.2, 5.0), 0.0),
            between(random, 0.0, TAU),
        );
    }
    // A face along `w`, at m over the viewpoint.
    let along = |random: &mut Pcg32, w: DVec2, m: f64| {
        let (s, t) = (between(random, -8.0, 8.0), between(random, -8.0, 8.0));
        [DVec2::new(0.0, m) + w * s, DVec2::new(0.0, m) + w * t]
    };
    let m = side * between(random, 0.5, 6.0);
    let (sin, cos) = theta.sin_cos();
    match class {
        Class::Generic => {
            up = turned(up, between(random, 0.0, TAU));
        }
        Class::Parabola => [a, b] = along(random, DVec2::new(side * sin, cos), m),
        Class::Hyperbola => [a, b] = along(random, DVec2::new(cos, -side * sin), m),
        Class::ThroughViewpoint => {
            let g = between(random, -1.5, 1.5);
            [a, b] = along(random, DVec2::from_angle(g), 0.0);
        }
        Class::ThroughViewpointAlongCone => {
            [a, b] = along(random, DVec2::new(side * sin, cos), 0.0)
        }
        Class::ThroughViewpointFlat => [a, b] = along(random, DVec2::new(cos, -side * sin), 0.0),
        Class::EdgeOn => b.x = a.x,
        Class::EdgeOnThroughViewpoint => (a.x, b.x) = (0.0, 0.0),
        Class::OneTangentInside | Class::OneTangentOutside => {
            // A cell on the x-axis; by the inscribed angle the circle of `up` touches it at the half-angle.
            let gamma = between(random, 0.0, TAU);
            up = DVec2::from_angle(gamma);
            let c = ((theta + gamma) / 2.0).tan();
            let (low, high) = (between(random, 0.5, 3.0), between(random, 3.5, 9.0));
            let v = between(random, -1.0, 1.0);
            a = DVec2::new(v - c * low, low);
            b = DVec2::new(v - c * high, high);
            let shift = if class == Class::OneTangentInside {
                0.0
            } else {
                7.0
            };
            from = DVec2::new(shift - 2.0, 0.0);
            to = DVec2::new(shift + 2.0, 0.0);
        }
        Class::Crossing => {
            up = turned(up, between(random, 0.0, TAU));
            (from, to) = (DVec2::ZERO, DVec2::new(3.0, 0.0));
            a = DVec2::new(between(random, 4.0, 8.0), between(random, 0.5, 4.0));
            b = DVec2::new(between(random, 4.0, 8.0), -between(random, 0.5, 4.0));
        }
        Class::Touching => {
            up = turned(up, between(random, 0.0, TAU));
            (from, to) = (DVec2::ZERO, DVec2::new(3.0, 0.0));
            let contact = DVec2::new(between(random, 0.1, 2.9), 0.0);
            a = contact + DVec2::new(between(random, -3.0, 3.0), between(random, 0.5, 4.0));
            b = contact + (contact - a) * between(random, 0.1, 1.0);
        }
        Class::InLine => {
            up = turned(up, between(random, 0.0, TAU));
            (from, to) = (DVec2::ZERO, DVec2::new(3.0, 0.0));
            a = DVec2::new(between(random, 3.5, 9.0), 0.0);
            b = DVec2::new(between(random, 3.5, 9.0), 0.0);
        }
        Class::Point => {
            up = turned(up, between(random, 0.0, TAU));
            b = a;
        }
        Class::AlongCell => {
            let axis = turned(DVec2::X, between(random, 0.0, TAU));
            (from, to) = (DVec2::ZERO, axis * 4.0);
            up = turned(-axis * side, between(random, -theta, theta));
        }
        Class::ViewpointOnEnd => {
            up = turned(up, between(random, 0.0, TAU));
            a = DVec2::ZERO;
        }
    }
    // The same scene somewhere else; a quarter stay where the coordinates are exact.
    let (turn, by) = match random.bits() % 4 {
        0 => (0.0, DVec2::ZERO),
        _ => (between(random, 0.0, TAU), far(random) * 3.0),
    };
    let place = |p: DVec2| if turn == 0.0 { p } else { turned(p, turn) + by };
    Case {
        cell: [place(from), place(to)],
        face: [place(a), place(b)],
        direction: turned(up, turn),
        theta,
    }
}

const SCALE: f64 = 10.0;

impl Case {
    fn interval(&self) -> Interval {
        let cell = SegmentCell::between(self.cell[0], self.cell[1]).expect("finite ends");
        let aperture = Aperture::radians(self.theta).expect("drawn below a right angle");
        let projection = Projection::new(&cell, self.direction, aperture);
        projection.interval(self.face[0], self.face[1])
    }

    fn point(&self, t: f64) -> DVec2 {
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
        to(a, c, d)
            .min(to(b, c, d))
            .min(to(c, a, b))
            .min(to(d, a, b))
    }

    /// The largest angle by which a sampled viewer sees a sampled point move that goes to offset `rho` in the sense of
    /// `sign`, and the parameters of both; `finer` samples more densely.
    fn seen(&self, rho: f64, sign: f64, finer: u32) -> (f64, [f64; 2]) {
        let d = self.direction;
        largest_of_two(
            |s, t| {
                let v = self.cell[0] + (self.cell[1] - self.cell[0]) * s;
                let p = self.point(t);
                let way = rho - p.dot(d);
                if way * sign < 1e-12 * SCALE {
                    return 0.0;
                }
                if p.distance(v) < 1e-12 * SCALE {
                    // A point at a viewpoint must not move at all.
                    return std::f64::consts::PI;
                }
                angle(v, p, p + d * way)
            },
            match (self.cell[0] == self.cell[1], self.gap() < 0.2) {
                (true, _) => [0, 300 * finer],
                (false, false) => [16 * finer, 24 * finer],
                (false, true) => [32 * finer, 48 * finer],
            },
            4 * finer as usize,
        )
    }

    /// Panics where sampling contradicts the claim that `rho` is the last valid offset in the sense of `sign`; gives the
    /// parameter of the face point that limits it.
    fn judge(&self, class: Class, number: u32, rho: f64, sign: f64) -> f64 {
        let what = || format!("{class:?} {number}: rho {rho} toward {sign}, {self:?}");
        // Where a side of the cone is parallel to the direction but for rounding, the limit is as far.
        if rho.abs() > 1e9 * SCALE {
            assert!(rho * sign > 0.0, "{}", what());
            for far in [1.0, 30.0, 1e4, 1e6] {
                let start = self.point(0.0).dot(self.direction);
                let (seen, _) = self.seen(start + sign * far * SCALE, sign, 1);
                assert!(
                    seen <= self.theta * (1.0 + 1e-9) + 1e-9,
                    "{}: {seen} at {far}",
                    what()
                );
            }
            return 0.0;
        }
        let inside = rho - sign * 1e-9 * SCALE;
        let (seen, [_, t]) = self.seen(inside, sign, 1);
        assert!(
            seen <= self.theta * (1.0 + 1e-9) + 1e-12,
            "{}: {seen}",
            what()
        );
        // Near a contact the angle jumps: only viewers and points within about the step of it see anything.
        let floor = if self.gap() < 0.2 { 1e-2 } else { 1e-8 };
        let found = [1, 2, 8, 40].into_iter().any(|finer| {
            let (_, [_, t]) = self.seen(inside, sign, finer);
            let extent = (rho - self.point(t).dot(self.direction)).abs();
            let step = 1e-4 * extent + floor * SCALE;
            self.seen(rho + sign * step, sign, finer).0 > self.theta
        });
        assert!(found, "{}: nobody sees too much beyond the claim", what());
        t
    }
}

#[test]
fn a_point_of_a_face_is_seen_to_move_more_than_its_interval_claims() {
    let mut counted = Vec::new();
    let (count, _) = cases(0);
    for class in CLASSES {
        let (_, mut random) = cases(100 + class as u64);
        let (mut empty, mut unbounded, mut on_face) = (0, 0, 0);
        // Each class is as many cases again.
        for number in 0..count {
            let case = draw(class, &mut random);
            let interval = case.interval();
            assert!(
                !interval.min.is_nan() && !interval.max.is_nan(),
                "{class:?} {number}"
            );
            empty += u32::from(interval.is_empty());
            unbounded += u32::from(interval.max.max(-interval.min) > 1e9 * SCALE);
            let t = case.judge(class, number, interval.max, 1.0);
            case.judge(class, number, interval.min, -1.0);
            on_face += u32::from(t > 1e-3 && t < 1.0 - 1e-3);
        }
        counted.push((class, count, empty, unbounded, on_face));
    }
    println!("class, cases, empty, unbounded, limited inside the face: {counted:?}");
    for class in [Class::Generic, Class::Parabola] {
        let (.., on_face) = counted[class as usize];
        assert!(
            on_face > count / 50,
            "{class:?}: an extremum on the face in {on_face} cases only"
        );
    }
}

#[test]
fn without_tolerance_a_face_has_a_line_other_than_its_own() {
    let none = Aperture::radians(0.0).expect("zero is an angle");
    let cell = SegmentCell::on_x_axis(-1.0, 1.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(5.0, 3.0));
    let own = Projection::new(&cell, DVec2::Y, none).interval(a, b);
    assert_eq!(own, Interval { min: 3.0, max: 3.0 });
    let slanted = Projection::new(&cell, DVec2::from_angle(1.5), none).interval(a, b);
    assert!(slanted.is_empty());
    // One viewpoint that sees the face from its end sees nothing of how far its points are.
    let viewpoint = SegmentCell::on_x_axis(2.0, 2.0);
    let (a, b) = (DVec2::new(2.0, 3.0), DVec2::new(2.0, 5.0));
    let behind = Projection::new(&viewpoint, DVec2::Y, none).interval(a, b);
    assert_eq!(
        behind,
        Interval {
            min: 0.0,
            max: f64::INFINITY
        }
    );
    let around = Projection::new(&viewpoint, DVec2::Y, none).interval(-a, b);
    assert!(around.is_empty());
}

#[test]
fn the_own_line_of_a_face_is_refused() {
    let (count, mut random) = cases(200);
    for number in 0..count {
        let mut at = || {
            DVec2::new(
                between(&mut random, -9.0, 9.0),
                between(&mut random, -9.0, 9.0),
            )
        };
        let (a, b, e, f) = (at(), at(), at(), at());
        let along = b - a;
        let normal = along.perp() / along.length();
        let cell = SegmentCell::between(e, f).expect("finite ends");
        for theta in [0.0, 1e-4, 0.1, 1.5] {
            let aperture = Aperture::radians(theta).expect("below a right angle");
            let interval = Projection::new(&cell, normal, aperture).interval(a, b);
            let rho = a.dot(normal);
            let slack = 1e-12 * 20.0;
            assert!(
                interval.min <= rho + slack && rho <= interval.max + slack,
                "case {number}, theta {theta}: {interval:?} without {rho}"
            );
        }
    }
}

#[test]
fn a_line_cell_limits_a_face_elsewhere_than_at_its_ends() {
    let (count, mut random) = cases(201);
    let line = SegmentCell::on_x_axis(f64::NEG_INFINITY, f64::INFINITY);
    for number in 0..count {
        let mut at = || {
            DVec2::new(
                between(&mut random, -9.0, 9.0),
                between(&mut random, 0.1, 9.0),
            )
        };
        let (a, b) = (at(), at());
        let d = DVec2::from_angle(between(&mut random, 0.0, TAU));
        let theta = between(&mut random, 0.001, 1.2);
        let aperture = Aperture::radians(theta).expect("below a right angle");
        let interval = Projection::new(&line, d, aperture).interval(a, b);
        // The law of sines with the tangent half-angle, by hand: t = 2 y sin / (1 +- cos).
        let reach = |p: DVec2, d: DVec2| {
            let gamma = d.y.atan2(d.x);
            let (plus, minus) = (1.0 + (theta + gamma).cos(), 1.0 - (theta - gamma).cos());
            2.0 * p.y * theta.sin() / plus.max(minus)
        };
        let expected = Interval {
            min: [a, b]
                .iter()
                .map(|&p| p.dot(d) - reach(p, -d))
                .fold(f64::NEG_INFINITY, f64::max),
            max: [a, b]
                .iter()
                .map(|&p| p.dot(d) + reach(p, d))
                .fold(f64::INFINITY, f64::min),
        };
        let off = (interval.min - expected.min)
            .abs()
            .max((interval.max - expected.max).abs());
        assert!(
            off < 1e-11 * 20.0,
            "case {number}: {interval:?} and not {expected:?}"
        );
    }
}

#[test]
fn a_viewpoint_a_rounding_error_beside_a_face_lets_it_go() {
    // Case 93379 of 10^5 faces through a viewpoint along the side of its cone.
    let case = Case {
        cell: [
            DVec2::new(-19.704_283_887_876_15, -1.189_390_026_670_972_5),
            DVec2::new(-20.905_475_581_530_172, -2.793_957_439_535_063),
        ],
        face: [
            DVec2::new(-19.431_069_141_748_946, -4.687_402_356_827_183),
            DVec2::new(-19.859_274_439_878_135, 0.794_978_934_542_536_2),
        ],
        direction: DVec2::new(0.959_549_201_314_995_4, 0.281_540_992_141_027_85),
        theta: 1.363_344_104_331_917_9,
    };
    let through = case.cell[0].dot(case.direction);
    let interval = case.interval();
    assert!(interval.max <= through + 1e-12, "{interval:?}, {through}");
}

#[test]
fn a_quick_look_at_a_point_refuses_an_offset_that_its_face_may_have() {
    let (mut refused, mut beyond) = (0, 0);
    for class in CLASSES {
        let (count, mut random) = cases(500 + class as u64);
        for number in 0..count {
            let case = draw(class, &mut random);
            let aperture = Aperture::radians(case.theta).expect("drawn below a right angle");
            let [a, b] = case.cell;
            let mut cells = vec![SegmentCell::between(a, b).expect("finite ends")];
            if a != b {
                cells.push(SegmentCell::line(a, b - a).expect("two points"));
            }
            for cell in cells {
                let projection = Projection::new(&cell, case.direction, aperture);
                let valid = projection.interval(case.face[0], case.face[1]);
                let may = |p: DVec2, low: f64, high: f64| {
                    projection.may_reach(
                        p,
                        Interval {
                            min: low,
                            max: high,
                        },
                    )
                };
                let t = random.unit();
                for p in [case.face[0], case.face[1], case.point(t)] {
                    let own = p.dot(case.direction);
                    for rho in [valid.min, valid.max, valid.min / 2.0 + valid.max / 2.0] {
                        if rho.is_finite() && valid.contains(rho) {
                            let s = random.unit();
                            assert!(
                                may(p, rho, rho) && may(p, rho - s, rho) && may(p, rho, rho + s),
                                "{class:?} {number}: {rho} of {valid:?}, {case:?}"
                            );
                        }
                    }
                    // The point alone, by its own interval: what lies well beyond is refused.
                    let alone = projection.interval(p, p);
                    for (end, sense) in [(alone.max, 1.0), (alone.min, -1.0)] {
                        let far = own + (end - own) * 1.5 + sense * 0.01 * SCALE;
                        if far.is_finite() && far.abs() < 1e3 * SCALE {
                            beyond += 1;
                            refused +=
                                u32::from(!may(p, far.min(far + sense), far.max(far + sense)));
                        }
                    }
                }
            }
        }
    }
    println!("{refused} of {beyond} offsets beyond are refused at a look");
    assert!(refused > beyond / 2, "{refused} of {beyond}");
}
