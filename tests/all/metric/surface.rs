//! Distances between surfaces.
#![expect(
    clippy::float_cmp,
    clippy::disallowed_methods,
    reason = "closed forms are met exactly, and are computed without the crate's own functions"
)]

use glam::DVec3;
use lodmark::{
    Error, Result, Silent,
    geometry::closest_point,
    mesh::{Mesh, MeshParts},
    metric::surface::{Distances, SurfaceDistance, surface_distance},
    num::Precision,
};
use proptest::prelude::*;

use crate::support::{Impatient, same_on_all_threads};

fn mesh(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(MeshParts {
        positions,
        triangles,
        precision: Precision::F64,
        ..MeshParts::default()
    })
    .expect("a valid mesh")
}

fn soup(corners: &[[DVec3; 3]]) -> Mesh {
    let triangles = (0..corners.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    mesh(corners.concat(), triangles.collect())
}

pub(crate) fn moved(m: &Mesh, f: impl Fn(DVec3) -> DVec3) -> Mesh {
    let positions = m.positions().iter().map(|&p| f(p)).collect();
    mesh(positions, m.triangles().to_vec())
}

fn square() -> Mesh {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    mesh(positions, vec![[0, 1, 2], [0, 2, 3]])
}

pub(crate) fn cube() -> Mesh {
    let corner = |i: u32| DVec3::from_array([0, 1, 2].map(|axis| f64::from(i >> axis & 1)));
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let halves = quads
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    mesh((0..8).map(corner).collect(), halves.collect())
}

/// An octahedron with every triangle divided into four `levels` times, on the unit sphere.
fn sphere(levels: u32) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for x in [DVec3::X, -DVec3::X] {
        for y in [DVec3::Y, -DVec3::Y] {
            for z in [DVec3::Z, -DVec3::Z] {
                triangles.push([x, y, z]);
            }
        }
    }
    let four = |[a, b, c]: [DVec3; 3]| {
        let [ab, bc, ca] = [(a + b), (b + c), (c + a)].map(DVec3::normalize);
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    for _ in 0..levels {
        triangles = triangles.into_iter().flat_map(four).collect();
    }
    triangles
}

fn distance(reference: &Mesh, candidate: &Mesh, samples: u32) -> SurfaceDistance {
    surface_distance(reference, candidate, samples, &Silent).expect("both have triangles")
}

#[test]
fn parallel_squares_are_everywhere_as_far_apart_as_their_planes() {
    let above = moved(&square(), |p| p + DVec3::new(0.0, 0.0, 0.25));
    let found = distance(&square(), &above, 1000);
    for side in [found.to_candidate, found.to_reference] {
        let Distances { mean, rms, max } = side.absolute;
        assert_eq!([mean, rms, max], [0.25; 3]);
    }
    assert!((found.diagonal - 2_f64.sqrt()).abs() < 1e-15);
    let relative = found.relative().expect("a square has a size");
    assert!((relative.mean - 0.25 / 2_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn a_cube_beside_a_cube_has_the_distances_of_the_integral() {
    let beside = moved(&cube(), |p| p + DVec3::new(3.0, 0.0, 0.0));
    let found = distance(&cube(), &beside, 10_000);
    // Distance 3 - x: 3 and 2 on two faces, 2.5 in the mean on four; its square 9, 4 and 19/3.
    let side = found.to_candidate;
    assert!((side.absolute.mean - 2.5).abs() < 1e-12, "{side:?}");
    assert!((side.absolute.rms - (38.333_333_333_333_336_f64 / 6.0).sqrt()).abs() < 1e-4);
    assert_eq!(side.absolute.max, 3.0);
    assert_eq!(side.farthest[0], 0.0);
    assert_eq!(found.to_reference.farthest[0], 4.0);
}

#[test]
fn concentric_spheres_are_as_far_apart_as_their_radii() {
    let inner = soup(&sphere(6));
    let outer = moved(&inner, |p| p * 1.5);
    let found = distance(&inner, &outer, 50_000);
    for side in [found.to_candidate, found.to_reference] {
        assert!((side.absolute.mean - 0.5).abs() < 1e-3, "{side:?}");
        assert!((side.absolute.rms - 0.5).abs() < 1e-3, "{side:?}");
        assert!((side.absolute.max - 0.5).abs() < 1e-3, "{side:?}");
    }
}

#[test]
fn a_missing_part_shows_only_from_the_side_that_has_it() {
    let far = moved(&square(), |p| p + DVec3::new(0.0, 0.0, 7.0));
    let positions = [square().positions(), far.positions()].concat();
    let both = mesh(positions, vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]);
    let found = distance(&both, &square(), 1000);
    // Centroids are rounded off their plane.
    assert!(found.to_reference.absolute.max < 1e-14);
    assert_eq!(found.to_candidate.absolute.max, 7.0);
    assert!((found.to_candidate.absolute.mean - 3.5).abs() < 1e-12);
    assert_eq!(found.absolute().max, 7.0);
}

#[test]
fn a_spike_of_one_vertex_is_never_missed() {
    let mut positions = square().positions().to_vec();
    positions.push(DVec3::new(0.5, 0.5, 9.0));
    // A needle with next to no area.
    positions.push(DVec3::new(0.5, 0.500_000_001, 0.0));
    positions.push(DVec3::new(0.5, 0.5, 0.0));
    let spiked = mesh(positions, vec![[0, 1, 2], [0, 2, 3], [6, 5, 4]]);
    let found = distance(&square(), &spiked, 10);
    assert_eq!(found.to_reference.absolute.max, 9.0);
    assert_eq!(found.to_reference.farthest, [0.5, 0.5, 9.0]);
}

#[test]
fn an_unused_vertex_is_no_part_of_a_surface() {
    let mut positions = square().positions().to_vec();
    positions.push(DVec3::splat(100.0));
    let same = mesh(positions, square().triangles().to_vec());
    let found = distance(&square(), &same, 10);
    assert!(found.absolute().max < 1e-14);
}

#[test]
fn surfaces_without_area_are_measured_at_their_vertices() {
    let point = soup(&[[DVec3::new(0.0, 0.0, 2.0); 3]]);
    let segment = soup(&[[DVec3::ZERO, DVec3::X * 2.0, DVec3::X]]);
    let found = distance(&segment, &point, 10);
    let expected = (2.0 + 8_f64.sqrt() + 5_f64.sqrt()) / 3.0;
    assert!((found.to_candidate.absolute.mean - expected).abs() < 1e-15);
    assert_eq!(found.to_reference.absolute.max, 2.0);
    let back = distance(&point, &segment, 10);
    let size = (back.relative(), back.diagonal);
    assert_eq!(size, (None, 0.0), "a point has no diagonal");
    assert_eq!(back.to_candidate.absolute.mean, 2.0);
}

#[test]
fn sizes_near_the_ends_of_f64_give_the_same_relative_distances() {
    let a = cube();
    let b = moved(&a, |p| p * 1.25 + DVec3::new(0.125, 0.5, -0.25));
    let expected = distance(&a, &b, 500);
    for exponent in [-900, -100, 100, 1000] {
        let scale = 2_f64.powi(exponent);
        let found = distance(&moved(&a, |p| p * scale), &moved(&b, |p| p * scale), 500);
        assert_eq!(found.relative(), expected.relative(), "2^{exponent}");
        let max = expected.absolute().max * scale;
        assert_eq!(found.absolute().max, max, "2^{exponent}");
    }
}

#[test]
fn what_cannot_be_measured_is_an_error() {
    let empty = mesh(vec![DVec3::ZERO], Vec::new());
    for (a, b) in [(&empty, &square()), (&square(), &empty)] {
        let error = surface_distance(a, b, 10, &Silent).expect_err("empty");
        assert_eq!(error.exit_code(), 3, "{error}");
    }
    let tiny = moved(&square(), |p| p * 1e-300);
    let error = surface_distance(&tiny, &square(), 10, &Silent).expect_err("out of reach");
    assert_eq!(error.exit_code(), 4, "{error}");
    assert!(surface_distance(&square(), &square(), 0, &Silent).is_err());
}

#[test]
fn an_interruption_ends_the_measurement() {
    let result: Result<SurfaceDistance> = surface_distance(&square(), &cube(), 10, &Impatient);
    assert!(matches!(result, Err(Error::Interrupted)));
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let reference = soup(&sphere(4));
    let candidate = moved(&soup(&sphere(2)), |p| p * 1.01);
    same_on_all_threads(|| distance(&reference, &candidate, 30_000));
}

#[test]
fn every_region_of_a_triangle_has_its_closest_point() {
    let t = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
    for (p, q) in [
        ([1.0, 1.0, 3.0], [1.0, 1.0, 0.0]),
        ([-1.0, -2.0, 1.0], [0.0, 0.0, 0.0]),
        ([6.0, -1.0, 0.0], [4.0, 0.0, 0.0]),
        ([-1.0, 6.0, -2.0], [0.0, 4.0, 0.0]),
        ([2.0, -3.0, 1.0], [2.0, 0.0, 0.0]),
        ([-3.0, 2.0, 1.0], [0.0, 2.0, 0.0]),
        ([3.0, 3.0, 5.0], [2.0, 2.0, 0.0]),
    ] {
        let (p, q) = (DVec3::from_array(p), DVec3::from_array(q));
        assert_eq!(closest_point(p, t), (q, p.distance_squared(q)), "{p}");
    }
    // Segment and point.
    let segment = [DVec3::ZERO, DVec3::X, DVec3::X * 4.0];
    let found = closest_point(DVec3::new(3.0, 2.0, 0.0), segment);
    assert_eq!(found, (DVec3::X * 3.0, 4.0));
    let found = closest_point(DVec3::Y, [DVec3::ZERO; 3]);
    assert_eq!(found, (DVec3::ZERO, 1.0));
}

/// Corners on a coarse grid (ties, degenerate triangles) or nearly collinear.
fn triangle() -> impl Strategy<Value = [DVec3; 3]> {
    let coordinate =
        (-4_i32..=4, 0_u32..4).prop_map(|(x, s)| f64::from(x) / f64::from(1 << (7 * s)));
    prop::array::uniform3(prop::array::uniform3(coordinate).prop_map(DVec3::from_array))
}

proptest! {
    #![proptest_config(crate::support::cases(2000))]

    #[test]
    fn the_closest_point_meets_the_conditions_of_the_minimum(
        t in triangle(),
        p in prop::array::uniform3(-5.0..5.0_f64).prop_map(DVec3::from_array),
        order in 0_usize..6,
    ) {
        let (q, squared) = closest_point(p, t);
        prop_assert!((squared - p.distance_squared(q)).abs() < 1e-13);
        // No corner lies on p's side of the plane through q across p - q: necessary and sufficient for a convex set.
        for v in t {
            prop_assert!((p - q).dot(v - q) <= 1e-12, "{q} is not closest to {p} in {t:?}");
        }
        // q is in the triangle: no direction tells it apart from the corners.
        let n = (t[1] - t[0]).cross(t[2] - t[0]);
        let edges = [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
        let directions = [n, p - q, DVec3::X, DVec3::Y, DVec3::Z].into_iter()
            .chain(edges).chain(edges.map(|e| e.cross(n)));
        for d in directions.flat_map(|d| [d, -d]) {
            let d = d.normalize_or_zero();
            let reach = t.iter().map(|v| v.dot(d)).fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(q.dot(d) <= reach + 1e-13, "{q} is outside {t:?}");
        }
        let turned = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]][order].map(|i| t[i]);
        prop_assert_eq!(closest_point(p, turned), (q, squared));
    }
}

proptest! {
    #![proptest_config(crate::support::cases(64))]

    #[test]
    fn large_and_small_triangles_count_by_their_area(
        x in 0.01..0.99_f64,
        y in 0.01..0.99_f64,
        samples in 1_u32..3000,
    ) {
        let mut positions = square().positions().to_vec();
        positions.push(DVec3::new(x, y, 0.0));
        let fan = mesh(positions, vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);
        let beside = moved(&square(), |p| p + DVec3::new(3.0, 0.0, 0.0));
        // The distance is 3 - x everywhere, whatever the triangles are.
        let found = distance(&fan, &beside, samples);
        prop_assert!((found.to_candidate.absolute.mean - 2.5).abs() < 1e-12);
    }

    #[test]
    fn the_largest_vertex_distance_is_that_of_trying_all_triangles(
        a in prop::collection::vec(triangle(), 1..30),
        b in prop::collection::vec(triangle(), 1..30),
        order in 0_usize..6,
    ) {
        let found = distance(&soup(&a), &soup(&b), 1);
        let all = a.iter().flatten()
            .map(|&p| b.iter().map(|&t| closest_point(p, t).1).fold(f64::INFINITY, f64::min))
            .fold(0.0, f64::max);
        prop_assert!(found.to_candidate.absolute.max >= all.sqrt() - 1e-12);
        let at = DVec3::from_array(found.to_candidate.farthest);
        let there = b.iter().map(|&t| closest_point(at, t).1).fold(f64::INFINITY, f64::min);
        prop_assert!((there.sqrt() - found.to_candidate.absolute.max).abs() < 1e-12);
        prop_assert!(found.to_candidate.absolute.mean <= found.to_candidate.absolute.rms * (1.0 + 1e-12));
        prop_assert!(found.to_candidate.absolute.rms <= found.to_candidate.absolute.max * (1.0 + 1e-12));
        let turned: Vec<[DVec3; 3]> = a.iter()
            .map(|t| [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]][order].map(|i| t[i]))
            .collect();
        let again = distance(&soup(&turned), &soup(&b), 1);
        prop_assert_eq!(again.to_candidate.relative.map(|d| d.mean.to_bits()), found.to_candidate.relative.map(|d| d.mean.to_bits()));
    }
}
