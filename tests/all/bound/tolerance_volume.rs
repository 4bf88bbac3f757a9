//! Tolerance volumes against the notes' vectors and brute force with code of its own.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property; 1,000 unless given.

mod deviation;

use glam::DVec3;
use lodmark::{
    bound::tolerance::{
        HalfSpace, Neighborhood, OldFace, Polyhedron, Prism, Quadratic, Source, Volume, shadows,
    },
    geometry::Sym3,
};

use crate::support::{Random, at, rows};

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
        let (x, y) = (libm::cos(angle), libm::sin(angle));
        link.push(at(1.4 * radius * x, radius * y, height));
    }
    let mut end = |x: f64| DVec3::X * x + random.vector(0.25 * bump);
    let (u, w) = (end(-0.35), end(0.35));
    // The vertices of the link near the top and the bottom see both ends.
    let (top, bottom) = (n / 4, 3 * n / 4);
    let outer = |k: usize| {
        let at_u = k >= top && k < bottom;
        outer([if at_u { u } else { w }, link[k], link[(k + 1) % n]])
    };
    let inner = [[w, link[top], u], [u, link[bottom], w]].map(inner);
    ([u, w], (0..n).map(outer).chain(inner).collect())
}

/// A face at one end of the edge, its first corner.
fn outer(points: [DVec3; 3]) -> OldFace {
    let ends = [true, false, false];
    OldFace { points, ends }
}

/// A face at both ends, its first corner and its last.
fn inner(points: [DVec3; 3]) -> OldFace {
    let ends = [true, false, true];
    OldFace { points, ends }
}

fn is_outer(face: &&OldFace) -> bool {
    face.ends == [true, false, false]
}

fn neighborhood(faces: &[OldFace]) -> Option<Neighborhood> {
    Neighborhood::new(DVec3::ZERO, faces.iter().copied())
}

/// Barycentric coordinates of the projection of `v`, and its height.
fn coordinates([a, b, c]: [DVec3; 3], v: DVec3) -> ([f64; 3], f64) {
    let n = (b - a).cross(c - a);
    let area = |p: DVec3, q: DVec3| (p - v).cross(q - v).dot(n) / n.dot(n);
    let height = (v - a).dot(n) / n.length();
    ([area(b, c), area(c, a), area(a, b)], height)
}

fn height_limit(v: [f64; 3], bound: f64) -> f64 {
    bound * 1_f64.max(1.0 - v[0]).max(1.0 - v[1]).max(1.0 - v[0] - v[1])
}

fn in_shadow(v: DVec3, shadow: &[HalfSpace], margin: f64) -> bool {
    shadow.iter().all(|h| h.excess(v) <= margin)
}

#[test]
fn the_height_limit_of_a_boundary_triangle_is_that_of_the_vectors() {
    let base = [DVec3::ZERO, at(1.0, 0.1, 0.0), at(0.4, 0.9, 0.0)];
    let prism = Prism::new(base).expect("no needle");
    let bound = 0.1;
    // A position, its limit, and the largest height: legal, and not, for every limit.
    for [x, y, z, limit, highest] in rows(
        " 0.45 0.4 0.09  0.1                  0.09
          0.45 0.4 0.11  0.1                  0.11
          0.4  1.5 0.15  0.1697674418604651   0.08835616438356164
          0.4  1.5 0.2   0.1697674418604651   0.11780821917808221
          2    0.6 0.15  0.22790697674418606  0.06581632653061224
          2    0.6 0.3   0.22790697674418606  0.13163265306122449
         -0.8  0.7 0.15  0.2162790697674419   0.06935483870967742
         -0.8  0.7 0.25  0.2162790697674419   0.11559139784946236",
    ) {
        let v = at(x, y, z);
        let (barycentric, height) = coordinates(base, v);
        let off = (height_limit(barycentric, bound) - limit).abs();
        assert!(off < 1e-12, "{v}");
        let found = prism.largest_height([v, base[0], base[1]]);
        assert!((found - highest).abs() < 1e-12, "{v}: {found}");
        let shadow = shadows(prism.cap(bound), prism.normal, [base[0], base[1]], 1e-12);
        assert_eq!(shadow.len(), 1);
        assert_eq!(in_shadow(v, &shadow[0], 0.0), height > limit, "{v}");
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
        let rise = prism.normal * (4.0 * bound * (random.unit() - 0.3));
        let v = inner + rise + (q - p) * random.unit();
        let (barycentric, height) = coordinates(base, v);
        let limit = height_limit(barycentric, bound);
        if barycentric[2] < 1e-3 || (height - limit).abs() < 1e-6 * limit.max(1.0) {
            continue;
        }
        let shadow = shadows(prism.cap(bound), prism.normal, [p, q], 1e-12);
        let dark = in_shadow(v, &shadow[0], 0.0);
        assert_eq!(dark, height > limit, "{base:?} {v}");
        illegal += u64::from(dark);
        legal += u64::from(!dark);
    }
    assert_both(legal, illegal, 10);
}

/// Holds both outcomes to a part of the cases at least.
fn assert_both(one: u64, other: u64, part: u64) {
    let enough = one.min(other) > cases() / part;
    assert!(enough, "{one} {other}");
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
        let is_dark = |margin| all.iter().any(|s| in_shadow(v, s, margin));
        if depth > 1e-6 {
            assert!(is_dark(1e-9), "{cap:?} {source:?} {v}");
            dark += 1;
        } else if depth < -1e-3 {
            assert!(!is_dark(-1e-3), "{cap:?} {source:?} {v}");
            light += 1;
        }
    }
    assert_both(dark, light, 10);
}

/// What a volume promises of a position: in the kernel, in a prism, and no face pierces a cap deeper than `depth`.
fn allowed(faces: &[OldFace], bound: f64, v: DVec3, margin: f64, depth: f64) -> bool {
    let behind = |p: DVec3, q: DVec3, n: DVec3| (v - p).dot(n.cross(q - p).normalize()) >= -margin;
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize();
    let outer: Vec<[DVec3; 3]> = faces.iter().filter(is_outer).map(|f| f.points).collect();
    let in_kernel = { outer.iter() }.all(|&[a, b, c]| behind(b, c, normal([a, b, c])));
    let in_prism = |f: &OldFace| {
        let n = normal(f.points);
        (v - f.points[0]).dot(n).abs() <= bound + margin
            && (0..3).all(|k| behind(f.points[k], f.points[(k + 1) % 3], n))
    };
    let caps = faces.iter().flat_map(|f| {
        let n = normal(f.points);
        [bound, -bound].map(|h| f.points.map(|p| p + n * h))
    });
    let mut shallow =
        caps.map(|cap| { outer.iter() }.all(|&[_, p, q]| deepest(cap, [p, q], v) <= depth));
    in_kernel && faces.iter().any(in_prism) && shallow.all(|all| all)
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
            let on = drawn(faces[random.below(faces.len())].points, &mut random);
            let v = on + random.vector(bound);
            let allowed = |margin, depth| allowed(&faces, bound, v, margin, depth);
            if volume.contains(v) {
                assert!(allowed(1e-7, 1e-6), "{bump} {bound} {v}");
                inside += 1;
            } else {
                assert!(!allowed(-1e-4, -1e-3), "{bump} {bound} {v}");
                outside += 1;
            }
        }
    }
    assert_both(inside, outside, 20);
}

/// A point of a triangle.
fn drawn([a, b, c]: [DVec3; 3], random: &mut Random) -> DVec3 {
    let (s, t) = (random.unit(), random.unit());
    a * (1.0 - s) + (b * t + c * (1.0 - t)) * s
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
        let outer: Vec<[DVec3; 3]> = faces.iter().filter(is_outer).map(|f| f.points).collect();
        for _ in 0..20 {
            let v = drawn(faces[random.below(faces.len())].points, &mut random);
            // Seen from a side that is turned, `v` and the end of the edge lie across from each other.
            let depth = |[end, p, q]: [DVec3; 3]| {
                let wall = (end - p) - (q - p) * ((end - p).dot(q - p) / (q - p).length_squared());
                (v - p).dot(wall.normalize())
            };
            let depths = outer.iter().map(|&f| depth(f));
            let least = depths.fold(f64::INFINITY, f64::min);
            if least < -1e-6 {
                assert!(!volume.contains(v), "{v} lies {least} beyond a side");
                beyond += 1;
            } else if volume.contains(v) {
                inside += 1;
            }
        }
    }
    let enough = beyond > cases() / 4 && inside > cases() / 10;
    assert!(enough, "{beyond} {inside}");
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
        let mut squares = Vec::new();
        for _ in 0..1 + random.below(3) {
            let (n, d) = (random.vector(1.0), random.unit());
            of.matrix.add(&Sym3::outer(n));
            of.linear -= n * d;
            squares.push((n, d));
        }
        // Without its constant: half the squares of the distances from the planes.
        let value = |v: DVec3| {
            let squares = squares
                .iter()
                .map(|(n, d)| 0.5 * n.dot(v) * n.dot(v) - d * n.dot(v));
            squares.sum::<f64>()
        };
        let Some(best) = volume.minimum(&of) else {
            continue;
        };
        assert!(volume.polyhedra().iter().any(|c| c.contains(best, 1e-6)));
        for _ in 0..60 {
            let v = match random.below(2) {
                0 => random.vector(0.6),
                _ => best + random.vector(1e-3),
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
            let volume = cell.volume();
            assert!((volume - expected).abs() < 1e-9, "{volume} {expected}");
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
    // Every other face of the fan lies on its neighbour.
    let folded = faces.iter().map(|f| {
        let points = f.points.map(|p| DVec3::new(p.x, p.y.abs(), p.z));
        OldFace { points, ..*f }
    });
    let around = neighborhood(&folded.collect::<Vec<_>>());
    let volume = around.map(|a| Volume::new(&a, 0.05, Source::Edges, 1e-9));
    let empty = volume.is_none_or(|volume| volume.polyhedra().is_empty());
    assert!(empty, "a folded ring has an empty kernel");
    faces[0].points[2] = faces[0].points[1] + (faces[0].points[0] - faces[0].points[1]) * 0.5;
    assert!(neighborhood(&faces).is_none());
}
