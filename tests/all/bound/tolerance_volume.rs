//! Tolerance volumes against the notes' vectors and brute force with code of its own.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property; 1,000 unless given.

mod deviation;

use glam::DVec3;
use lodmark::bound::tolerance::{
    HalfSpace, Neighborhood, OldFace, Polyhedron, Prism, Quadratic, Source, Volume, shadows,
};

use crate::support::Random;

pub(crate) fn cases() -> u64 {
    crate::support::bound_cases(1_000)
}

/// `[u, w]` with links around it: 4 to 6 boundary triangles at each end and two internal ones, bumpy.
pub(crate) fn ring(random: &mut Random, bump: f64) -> ([DVec3; 2], Vec<OldFace>) {
    ring_of(random, bump, 0.4, 0.0)
}

/// The same with distances of 1 to `1 + spread` to the link, which lies lower by `slope` times that.
fn ring_of(random: &mut Random, bump: f64, spread: f64, slope: f64) -> ([DVec3; 2], Vec<OldFace>) {
    let n = 6 + random.below(4);
    let mut link = Vec::new();
    for k in 0..n {
        let angle = (k as f64 + 0.5 * random.unit()) / n as f64 * std::f64::consts::TAU;
        let radius = 1.0 + spread * random.unit();
        let height = (random.unit() - 0.5) * bump - slope * radius;
        link.push(DVec3::new(
            1.4 * radius * libm::cos(angle),
            radius * libm::sin(angle),
            height,
        ));
    }
    let mut end = |x: f64| DVec3::new(x, 0.0, 0.0) + random.vector(0.25 * bump);
    let (u, w) = (end(-0.35), end(0.35));
    let mut faces = Vec::new();
    // The vertices of the link near the top and the bottom see both ends.
    let top = n / 4;
    let bottom = 3 * n / 4;
    for k in 0..n {
        let (p, q) = (link[k], link[(k + 1) % n]);
        let at_u = k >= top && k < bottom;
        faces.push(OldFace {
            points: [if at_u { u } else { w }, p, q],
            ends: [true, false, false],
        });
    }
    faces.push(OldFace {
        points: [w, link[top], u],
        ends: [true, false, true],
    });
    faces.push(OldFace {
        points: [u, link[bottom], w],
        ends: [true, false, true],
    });
    ([u, w], faces)
}

fn neighborhood(faces: &[OldFace]) -> Option<Neighborhood> {
    Neighborhood::new(DVec3::ZERO, faces.iter().copied())
}

/// Barycentric coordinates of the projection of `v`, and its height.
fn coordinates([a, b, c]: [DVec3; 3], v: DVec3) -> ([f64; 3], f64) {
    let n = (b - a).cross(c - a);
    let area = |p: DVec3, q: DVec3| (p - v).cross(q - v).dot(n) / n.dot(n);
    (
        [area(b, c), area(c, a), area(a, b)],
        (v - a).dot(n) / n.length(),
    )
}

fn height_limit(v: [f64; 3], bound: f64) -> f64 {
    bound * 1_f64.max(1.0 - v[0]).max(1.0 - v[1]).max(1.0 - v[0] - v[1])
}

fn in_shadow(v: DVec3, shadow: &[HalfSpace], margin: f64) -> bool {
    shadow.iter().all(|h| h.excess(v) <= margin)
}

#[test]
fn the_height_limit_of_a_boundary_triangle_is_that_of_the_vectors() {
    let base = [
        DVec3::ZERO,
        DVec3::new(1.0, 0.1, 0.0),
        DVec3::new(0.4, 0.9, 0.0),
    ];
    let prism = Prism::new(base).expect("no needle");
    let bound = 0.1;
    for (v, limit, highest, legal) in [
        ([0.45, 0.4, 0.09], 0.1, 0.09, true),
        ([0.45, 0.4, 0.11], 0.1, 0.11, false),
        (
            [0.4, 1.5, 0.15],
            0.169_767_441_860_465_1,
            0.088_356_164_383_561_64,
            true,
        ),
        (
            [0.4, 1.5, 0.2],
            0.169_767_441_860_465_1,
            0.117_808_219_178_082_21,
            false,
        ),
        (
            [2.0, 0.6, 0.15],
            0.227_906_976_744_186_06,
            0.065_816_326_530_612_24,
            true,
        ),
        (
            [2.0, 0.6, 0.3],
            0.227_906_976_744_186_06,
            0.131_632_653_061_224_49,
            false,
        ),
        (
            [-0.8, 0.7, 0.15],
            0.216_279_069_767_441_9,
            0.069_354_838_709_677_42,
            true,
        ),
        (
            [-0.8, 0.7, 0.25],
            0.216_279_069_767_441_9,
            0.115_591_397_849_462_36,
            false,
        ),
    ] {
        let v = DVec3::from_array(v);
        let (barycentric, _) = coordinates(base, v);
        assert!(
            (height_limit(barycentric, bound) - limit).abs() < 1e-12,
            "{v}"
        );
        let found = prism.largest_height([v, base[0], base[1]]);
        assert!((found - highest).abs() < 1e-12, "{v}: {found}");
        let shadow = shadows(prism.cap(bound), prism.normal, [base[0], base[1]], 1e-12);
        assert_eq!(shadow.len(), 1);
        assert_eq!(in_shadow(v, &shadow[0], 0.0), !legal, "{v}");
    }
}

#[test]
fn the_shadow_of_a_cap_from_its_own_edge_is_what_the_height_limit_says() {
    let mut random = Random(0x5ead0);
    let (mut legal, mut illegal) = (0, 0);
    for _ in 0..cases() {
        let base = [0; 3].map(|_| random.vector(1.0));
        let bound = 0.05 + random.unit();
        let Some(prism) = Prism::new(base) else {
            continue;
        };
        let [p, q, c] = base;
        let inner = p + (q - p) * random.unit() + (c - p) * (3.0 * random.unit());
        let v =
            inner + prism.normal * (4.0 * bound * (random.unit() - 0.3)) + (q - p) * random.unit();
        let (barycentric, height) = coordinates(base, v);
        let limit = height_limit(barycentric, bound);
        if barycentric[2] < 1e-3 || (height - limit).abs() < 1e-6 * limit.max(1.0) {
            continue;
        }
        let shadow = shadows(prism.cap(bound), prism.normal, [p, q], 1e-12);
        assert_eq!(
            in_shadow(v, &shadow[0], 0.0),
            height > limit,
            "{base:?} {v}"
        );
        *(if height > limit {
            &mut illegal
        } else {
            &mut legal
        }) += 1;
    }
    assert!(
        legal > cases() / 10 && illegal > cases() / 10,
        "{legal} {illegal}"
    );
}

/// How far the segment from `a` to `v` passes inside the cap where it pierces it: the least barycentric coordinate;
/// negative outside; `None` where it does not reach the plane.
fn pierces(cap: [DVec3; 3], a: DVec3, v: DVec3) -> Option<f64> {
    let (_, from) = coordinates(cap, a);
    let (_, to) = coordinates(cap, v);
    if from * to >= 0.0 {
        return None;
    }
    let (inside, _) = coordinates(cap, a + (v - a) * (from / (from - to)));
    Some(inside[0].min(inside[1]).min(inside[2]))
}

/// The best of [`pierces`] over a segment: sampled, then refined around the best sample. Depths have one peak along a
/// segment, because the places that pierce by some depth are convex; with a needle for a cap it is as narrow as 10^-5.
fn deepest(cap: [DVec3; 3], [p, q]: [DVec3; 2], v: DVec3) -> f64 {
    let at = |t: f64| pierces(cap, p + (q - p) * t, v).unwrap_or(f64::NEG_INFINITY);
    let (mut best, mut where_) = (f64::NEG_INFINITY, 0.0);
    let (mut low, mut high) = (0.0, 1.0);
    for round in 0..16 {
        let steps = if round == 0 { 40 } else { 10 };
        for i in 0..=steps {
            let t = low + (high - low) * f64::from(i) / f64::from(steps);
            if at(t) > best {
                (best, where_) = (at(t), t);
            }
        }
        let step = (high - low) / f64::from(steps);
        (low, high) = ((where_ - step).max(0.0), (where_ + step).min(1.0));
    }
    best
}

#[test]
fn a_position_is_in_the_shadow_of_a_cap_where_a_face_would_pierce_it() {
    let mut random = Random(0xca9);
    let (mut dark, mut light) = (0, 0);
    for _ in 0..cases() {
        let cap = [0; 3].map(|_| random.vector(1.0));
        let Some(prism) = Prism::new(cap) else {
            continue;
        };
        let source = [0; 2].map(|_| random.vector(1.5));
        let through = (cap[0] + cap[1] + cap[2]) / 3.0 + random.vector(0.6);
        let from = source[0] + (source[1] - source[0]) * random.unit();
        let v = from + (through - from) * (2.0 * random.unit());
        let depth = deepest(cap, source, v);
        let all = shadows(cap, prism.normal, source, 1e-12);
        if depth > 1e-6 {
            assert!(
                all.iter().any(|s| in_shadow(v, s, 1e-9)),
                "{cap:?} {source:?} {v}"
            );
            dark += 1;
        } else if depth < -1e-3 {
            assert!(
                !all.iter().any(|s| in_shadow(v, s, -1e-3)),
                "{cap:?} {source:?} {v}"
            );
            light += 1;
        }
    }
    assert!(
        dark > cases() / 10 && light > cases() / 10,
        "{dark} {light}"
    );
}

/// What a volume promises of a position: in the kernel, in a prism, and no face pierces a cap deeper than `depth`.
fn allowed(faces: &[OldFace], bound: f64, v: DVec3, margin: f64, depth: f64) -> bool {
    let behind = |p: DVec3, q: DVec3, n: DVec3| (v - p).dot(n.cross(q - p).normalize()) >= -margin;
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize();
    let links: Vec<[DVec3; 2]> = faces
        .iter()
        .filter(|f| f.ends == [true, false, false])
        .map(|f| [f.points[1], f.points[2]])
        .collect();
    let kernel = faces.iter().filter(|f| f.ends == [true, false, false]);
    let in_kernel = { kernel }.all(|f| behind(f.points[1], f.points[2], normal(f.points)));
    let in_prism = |f: &OldFace| {
        let n = normal(f.points);
        (v - f.points[0]).dot(n).abs() <= bound + margin
            && (0..3).all(|k| behind(f.points[k], f.points[(k + 1) % 3], n))
    };
    let caps = faces.iter().flat_map(|f| {
        let n = normal(f.points);
        [bound, -bound].map(|h| f.points.map(|p| p + n * h))
    });
    in_kernel && faces.iter().any(in_prism) && { caps }
        .all(|cap| links.iter().all(|&link| deepest(cap, link, v) <= depth))
}

#[test]
fn a_volume_holds_the_positions_that_are_allowed_and_no_others() {
    let mut random = Random(0x7011);
    let (mut inside, mut outside) = (0_u64, 0_u64);
    for _ in 0..cases() / 10 {
        let bump = 0.1 + 0.4 * random.unit();
        let (_, faces) = ring(&mut random, bump);
        let bound = 0.05 + 0.3 * random.unit();
        let around = neighborhood(&faces).expect("no needles");
        let volume = Volume::new(&around, bound, Source::Edges, 1e-9);
        if volume.polyhedra().is_empty() {
            continue;
        }
        for _ in 0..10 {
            let face = &faces[random.below(faces.len())];
            let (s, t) = (random.unit(), random.unit());
            let on =
                face.points[0] * (1.0 - s) + (face.points[1] * t + face.points[2] * (1.0 - t)) * s;
            let v = on + random.vector(bound);
            let holds = volume.contains(v);
            if holds {
                assert!(allowed(&faces, bound, v, 1e-7, 1e-6), "{bump} {bound} {v}");
                inside += 1;
            } else {
                assert!(
                    !allowed(&faces, bound, v, -1e-4, -1e-3),
                    "{bump} {bound} {v}"
                );
                outside += 1;
            }
        }
    }
    assert!(
        inside > cases() / 20 && outside > cases() / 20,
        "{inside} {outside}"
    );
}

/// In the plane the kernel of a star is far from all of it, and no shadow falls: only the kernel forbids its tips.
#[test]
fn a_position_beyond_a_side_of_the_link_is_in_no_volume() {
    let mut random = Random(0x57a2);
    let (mut beyond, mut inside) = (0, 0);
    for _ in 0..cases() / 4 {
        let (_, faces) = ring_of(&mut random, 0.02, 2.5, 0.0);
        let upright = |f: &OldFace| {
            let [a, b, c] = f.points;
            (b - a).cross(c - a).z > 0.0
        };
        if !faces.iter().all(upright) {
            continue;
        }
        let bound = 0.1;
        let around = neighborhood(&faces).expect("no needles");
        let volume = Volume::new(&around, bound, Source::Edges, 1e-9);
        let outer: Vec<[DVec3; 3]> = { faces.iter() }
            .filter(|f| f.ends == [true, false, false])
            .map(|f| f.points)
            .collect();
        for _ in 0..20 {
            let [a, b, c] = faces[random.below(faces.len())].points;
            let (s, t) = (random.unit(), random.unit());
            let v = a * (1.0 - s) + (b * t + c * (1.0 - t)) * s;
            // Seen from a side that is turned, `v` and the end of the edge lie across from each other.
            let depth = |[end, p, q]: [DVec3; 3]| {
                let wall = (end - p) - (q - p) * ((end - p).dot(q - p) / (q - p).length_squared());
                (v - p).dot(wall.normalize())
            };
            let least = outer
                .iter()
                .map(|&f| depth(f))
                .fold(f64::INFINITY, f64::min);
            if least < -1e-6 {
                assert!(!volume.contains(v), "{v} lies {least} beyond a side");
                beyond += 1;
            } else if volume.contains(v) {
                inside += 1;
            }
        }
    }
    assert!(
        beyond > cases() / 4 && inside > cases() / 10,
        "{beyond} {inside}"
    );
}

#[test]
fn the_published_sets_allow_at_least_what_the_rigorous_ones_do() {
    let mut random = Random(0x9a9e);
    let (mut both, mut only) = (0, 0);
    for _ in 0..cases() / 20 {
        let (_, faces) = ring(&mut random, 0.6);
        let around = neighborhood(&faces).expect("no needles");
        let [strict, loose] = [Source::Edges, Source::Vertices]
            .map(|source| Volume::new(&around, 0.15, source, 1e-9));
        for _ in 0..20 {
            let v = random.vector(0.4);
            if strict.contains(v) && !loose.polyhedra().is_empty() {
                assert!(loose.contains(v), "{v}");
                both += 1;
            } else if loose.contains(v) {
                only += 1;
            }
        }
    }
    assert!(both > 0 && only > 0, "{both} {only}");
}

#[test]
fn no_place_in_a_volume_is_cheaper_than_its_minimum() {
    let mut random = Random(0x317);
    let mut compared = 0;
    for _ in 0..cases() / 10 {
        let (_, faces) = ring(&mut random, 0.4);
        let around = neighborhood(&faces).expect("no needles");
        let volume = Volume::new(&around, 0.1 + 0.2 * random.unit(), Source::Edges, 1e-9);
        let mut of = Quadratic::default();
        let rank = 1 + random.below(3);
        for _ in 0..rank {
            let (n, d) = (random.vector(1.0), random.unit());
            let m = [
                n.x * n.x,
                n.x * n.y,
                n.x * n.z,
                n.y * n.y,
                n.y * n.z,
                n.z * n.z,
            ];
            of.matrix.0.iter_mut().zip(m).for_each(|(x, y)| *x += y);
            of.linear -= n * d;
        }
        let value = |v: DVec3| {
            let [a, b, c, d, e, f] = of.matrix.0;
            let h = DVec3::new(
                a * v.x + b * v.y + c * v.z,
                b * v.x + d * v.y + e * v.z,
                c * v.x + e * v.y + f * v.z,
            );
            v.dot(h) / 2.0 + of.linear.dot(v)
        };
        let Some(best) = volume.minimum(&of) else {
            continue;
        };
        assert!(volume.polyhedra().iter().any(|c| c.contains(best, 1e-6)));
        for _ in 0..60 {
            let v = if random.below(2) == 0 {
                random.vector(0.6)
            } else {
                best + random.vector(1e-3)
            };
            if volume.polyhedra().iter().any(|c| c.contains(v, 0.0)) {
                assert!(value(v) >= value(best) - 1e-9, "{v} beats {best}");
                compared += 1;
            }
        }
    }
    assert!(compared > cases() / 10, "{compared}");
}

#[test]
fn cuts_of_a_cell_add_up_to_its_volume() {
    let mut random = Random(0xce11);
    for _ in 0..cases() / 4 {
        let mut cell = Polyhedron::cuboid(DVec3::splat(-1.0), DVec3::ONE);
        let mut expected = 8.0;
        for _ in 0..6 {
            assert!(
                (cell.volume() - expected).abs() < 1e-9,
                "{} {expected}",
                cell.volume()
            );
            let by = HalfSpace::behind(random.vector(0.7), random.vector(1.0));
            let by = by.expect("a direction");
            let parts = [by, by.complement()].map(|h| cell.cut(h, 1e-12));
            let [Some(a), Some(b)] = parts else { break };
            assert!((a.volume() + b.volume() - cell.volume()).abs() < 1e-9);
            expected = a.volume();
            cell = a;
        }
    }
}

#[test]
fn a_needle_or_a_folded_ring_has_no_volume() {
    let mut random = Random(4);
    let (_, mut faces) = ring(&mut random, 0.2);
    let folded: Vec<OldFace> = faces
        .iter()
        .map(|f| {
            // Every other face of the fan lies on its neighbour.
            let points = f.points.map(|p| DVec3::new(p.x, p.y.abs(), p.z));
            OldFace { points, ..*f }
        })
        .collect();
    let around = neighborhood(&folded);
    let empty = around.is_none_or(|a| {
        Volume::new(&a, 0.05, Source::Edges, 1e-9)
            .polyhedra()
            .is_empty()
    });
    assert!(empty, "a folded ring has an empty kernel");
    faces[0].points[2] = faces[0].points[1] + (faces[0].points[0] - faces[0].points[1]) * 0.5;
    assert!(neighborhood(&faces).is_none());
}
