//! What decides about a collapse: that nothing is left out of what is judged, and that no judge allows too much.

use std::cell::RefCell;

use glam::DVec3;
use lodmark::bound::{
    correspondence::{Allowance, AngleLimit, Answer, Correspondence, Layout, PieceScratch},
    view_cell::ViewCell,
};
use proptest::prelude::*;

use super::{Class, at, collapsed, layout, ring};
use crate::support::{Random, angle_between, bounded, lattice, mixture};

/// What was asked about: triangle, corners, and what stands for these.
type Heard = Vec<(u32, Vec<DVec3>, Vec<DVec3>)>;

/// Denies the piece that comes as number `wrong`, and writes down all.
struct Judge {
    wrong: usize,
    heard: RefCell<Heard>,
}

impl Allowance for Judge {
    fn allows(&self, triangle: u32, from: &[DVec3], to: &[DVec3]) -> bool {
        let mut heard = self.heard.borrow_mut();
        heard.push((triangle, from.to_vec(), to.to_vec()));
        heard.len() - 1 != self.wrong
    }

    fn radius(&self, _: u32) -> f64 {
        0.0
    }
}

fn judge(map: &Correspondence, fan: &Layout, wrong: usize) -> (Answer, Heard) {
    let judge = Judge {
        wrong,
        heard: RefCell::default(),
    };
    let answer = map.allows(fan, &judge, &mut PieceScratch::default());
    (answer, judge.heard.into_inner())
}

/// The largest factor up to `most` that is allowed.
fn farthest(most: f64, allows: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..50 {
        let k = 0.5 * (low + high);
        *(if allows(k) { &mut low } else { &mut high }) = k;
    }
    low
}

proptest! {
    #![proptest_config(bounded(600))]

    #[test]
    fn a_single_piece_that_is_denied_denies_the_collapse_and_none_is_kept_that_was_not_judged(kind in 0_u8..3, seed: u64) {
        let class = [Class::Inside, Class::Touching, Class::Border][usize::from(kind)];
        let mut random = Random(seed);
        let (removed, added, to) = ring(class, &mut random);
        let Some(fan) = layout(&removed, &added, to) else { return Ok(()) };
        let originals: Vec<[DVec3; 3]> = removed.iter().map(|f| f.points).collect();
        let mut map = Correspondence::new(originals.clone(), |_| true);
        let (answer, all) = judge(&map, &fan, usize::MAX);
        prop_assert_eq!(answer, Answer::Allowed);
        for wrong in 0..all.len() {
            let (answer, heard) = judge(&map, &fan, wrong);
            prop_assert_eq!(answer, Answer::Denied, "{:?}: piece {} of {}", class, wrong, all.len());
            prop_assert_eq!(&heard[..], &all[..=wrong]);
        }
        prop_assert!(map.apply(&fan, &mut PieceScratch::default()));
        let mut rest = all;
        for face in 0..map.face_count() as u32 {
            for piece in map.pieces(face) {
                let target = added.iter().find(|f| f.id == face).expect("a live face").points;
                let near = |p: DVec3, q: DVec3| (p - q).length() < 1e-12;
                let is_this = |(t, from, to): &(u32, Vec<DVec3>, Vec<DVec3>)| {
                    *t == piece.triangle && from.len() == piece.corners.len() && to.len() == from.len()
                        && piece.corners.iter().zip(from.iter().zip(to)).all(|(c, (&p, &s))| {
                            near(at(originals[*t as usize], c.source.get()), p) && near(at(target, c.target.get()), s)
                        })
                };
                let found = rest.iter().position(is_this);
                prop_assert!(found.is_some(), "{class:?}: {piece:?} was not judged");
                rest.remove(found.unwrap_or(0));
            }
        }
        prop_assert!(rest.is_empty());
    }

    #[test]
    fn no_displacement_that_is_allowed_is_seen_under_more_than_the_angle(
        kind in 0_u8..6, seed: u64, size in prop::sample::select(vec![1e-3, 0.1, 1.0]),
        degrees in prop::sample::select(vec![0.05, 1.0, 20.0]),
    ) {
        let mut random = Random(seed);
        let mut vector = |size: f64| random.vector(size);
        // A cell somewhere around the triangle, with a way out to it.
        let out = vector(1.0).normalize_or(DVec3::X);
        let [across, other] = [out.any_orthonormal_vector(), out.cross(out.any_orthonormal_vector())];
        let centre = out * 4.0 + vector(0.5);
        let place = |x: f64, y: f64, z: f64| centre + across * x + other * y + out * z;
        let cell = match kind {
            0 => ViewCell::point(centre),
            1 => ViewCell::segment([place(-1.0, 0.2, 0.0), place(1.5, 0.0, 0.4)]),
            2 => ViewCell::polygon(&[place(-1.0, -1.0, 0.0), place(1.0, -1.0, 0.0), place(1.5, 1.0, 0.0), place(-1.0, 1.0, 0.0)]),
            3 => ViewCell::polyhedron(&[
                place(-1.0, -1.0, 0.0), place(1.0, -1.0, 0.3), place(1.0, 1.0, 0.0), place(-1.0, 1.0, 0.0), place(0.0, 0.0, 2.0),
            ]),
            4 => ViewCell::half_space(centre, -out),
            _ => ViewCell::line(centre, across),
        };
        let cell = cell.expect("a cell");
        let triangle = [0, 1, 2].map(|_| vector(size));
        let common = vector(1.0);
        let own = [0, 1, 2].map(|_| vector(if seed % 3 == 0 { 1.0 } else { 0.05 }));
        let moved = |k: f64| [0, 1, 2].map(|i| triangle[i] + (common + own[i]) * k);
        let limit = AngleLimit::new(&[triangle], &cell, f64::to_radians(degrees));
        let farthest = farthest(8.0, |k| limit.allows(0, &triangle, &moved(k)));
        let low_corners = moved(farthest);
        prop_assert!(farthest > 0.0);
        let mut eyes: Vec<DVec3> = cell.corners().unwrap_or_default().to_vec();
        let corners = eyes.clone();
        for _ in 0..60 {
            let weights: Vec<f64> = corners.iter().map(|_| -libm::log(random.unit().max(1e-9))).collect();
            if !corners.is_empty() {
                eyes.push(mixture(&corners, &weights));
            }
        }
        for i in 0..60 {
            let far = libm::pow(10.0, random.unit() * 3.0 - 2.0);
            let mut step = || (random.unit() * 2.0 - 1.0) * far;
            // Around the nearest point.
            let foot = triangle[i % 3];
            match kind {
                4 => eyes.push(foot - out * (foot - centre).dot(out) + across * step() + other * step()),
                5 => eyes.push(centre + across * ((foot - centre).dot(across) + step())),
                _ => {}
            }
        }
        for _ in 0..12 {
            let (u, v) = (random.unit(), random.unit());
            let place = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
            for place in [place, [0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0 / 3.0, 1.0 / 3.0]] {
                let (p, s) = (at(triangle, place), at(low_corners, place));
                for &eye in &eyes {
                    let seen = angle_between(eye, p, s).to_degrees();
                    prop_assert!(seen <= degrees * (1.0 + 1e-9), "{seen} from {eye}");
                }
            }
        }
    }

    /// A piece that is large for its distance: inside it the angle may be larger than at every corner.
    #[test]
    fn a_viewer_close_to_a_large_face_sees_no_point_inside_it_beyond_the_angle(
        kind in 0_u8..3, seed: u64, near in 0.1..1.5_f64, degrees in prop::sample::select(vec![0.5, 5.0, 30.0]),
    ) {
        let mut random = Random(seed);
        let mut vector = |size: f64| random.vector(size);
        // Viewers above the middle of a triangle, which moves towards them or away, and a little to the side.
        let triangle = [(1.8, 0.0), (-0.9, 1.6), (-0.9, -1.6)].map(|(x, y)| DVec3::new(x, y, 0.0) + vector(0.2));
        let eye = DVec3::Z * near + vector(0.2 * near);
        let corners: Vec<DVec3> = (0..=kind).map(|_| eye + vector(0.3 * near)).collect();
        let cell = match corners[..] {
            [a] => ViewCell::point(a),
            [a, b] => ViewCell::segment([a, b]),
            _ => ViewCell::polygon(&corners),
        }.expect("a cell");
        let way = DVec3::Z * if seed.is_multiple_of(2) { -1.0 } else { 0.4 } + vector(0.02);
        let own = [0, 1, 2].map(|_| vector(0.02));
        let moved = |k: f64| [0, 1, 2].map(|i| triangle[i] + (way + own[i]) * k);
        let limit = AngleLimit::new(&[triangle], &cell, f64::to_radians(degrees));
        let allowed = moved(farthest(2.0 * near, |k| limit.allows(0, &triangle, &moved(k))));
        for _ in 0..10 {
            let weights: Vec<f64> = corners.iter().map(|_| random.unit() + 1e-9).collect();
            let eye = mixture(&corners, &weights);
            for (p, s) in lattice(triangle, 20).zip(lattice(allowed, 20)) {
                let seen = angle_between(eye, p, s).to_degrees();
                prop_assert!(seen <= degrees * (1.0 + 1e-9), "{seen} of {degrees} from {eye} at {p}");
            }
        }
    }
}

/// A surface that goes around its vertices twice, like a spiral staircase.
#[test]
fn a_fan_that_goes_around_twice_has_no_map() {
    let lay_out = |turns: f64| {
        let (u, w) = (DVec3::new(-0.05, 0.0, 0.0), DVec3::new(0.05, 0.0, 0.0));
        let mut points = vec![u, w];
        // Around w from below it, then around u from above it.
        let (first, second) = (8 * turns as usize, 4);
        let count = first + second;
        for k in 0..count {
            let turn = match k.checked_sub(first + 1) {
                None => -0.25 + (k as f64 / first as f64) * (turns - 0.5),
                Some(more) => 0.25 + (more + 1) as f64 / second as f64 * 0.5,
            };
            let (angle, height) = (turn * std::f64::consts::TAU, 0.02 * k as f64);
            points.push(DVec3::new(libm::cos(angle), libm::sin(angle), height));
        }
        let link = |k: usize| 2 + (k % count) as u32;
        let side = |k| [u32::from(k < first), link(k), link(k + 1)];
        let mut triangles: Vec<[u32; 3]> = (0..count).map(side).collect();
        triangles.extend([[0, 1, link(first)], [1, 0, link(0)]]);
        let to = DVec3::Z * 0.1;
        let (removed, added) = collapsed(&triangles, &points, to);
        layout(&removed, &added, to).is_some()
    };
    assert!(lay_out(1.0));
    assert!(!lay_out(2.0));
}
