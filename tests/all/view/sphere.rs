//! The minimum bounding sphere and the frame it gives.

use super::*;
use crate::support::read_model;

/// Half the mirror images and every cyclic permutation of a few points, zeros with either sign: distances from the middle
/// tie in bits, but the spheres through different ones of them are rounded differently.
fn symmetric() -> impl Strategy<Value = Vec<DVec3>> {
    let coordinate = prop_oneof![Just(0.0), 0.1..1.0];
    let point = [coordinate.clone(), coordinate.clone(), coordinate];
    (prop::collection::vec(point, 1..4), 0.1..9.0).prop_map(|(base, size)| {
        let mut points = Vec::new();
        for [a, b, c] in base.into_iter().map(|p| p.map(|x| x * size)) {
            for p in [[a, b, c], [b, c, a], [c, a, b]] {
                // An even number of signs: without opposite points, whose middle would be exact.
                points.extend([0, 3, 5, 6].map(|signs: u32| {
                    let sign = |axis: u32| if signs >> axis & 1 == 1 { -1.0 } else { 1.0 };
                    DVec3::new(p[0] * sign(0), p[1] * sign(1), p[2] * sign(2))
                }));
            }
        }
        points
    })
}

proptest! {
    #![proptest_config(crate::support::cases(256))]

    #[test]
    fn the_sphere_is_the_smallest_that_contains_every_point(
        points in prop_oneof![coarse(1..9), fine(1..9)],
    ) {
        let s = sphere(&points);
        for &p in &points {
            prop_assert!(contains(s, p), "{p} outside {s:?}");
        }
        let expected = brute_force(&points);
        prop_assert!((s.radius - expected).abs() <= 1e-12 * expected.max(1e-3), "{} for {expected}", s.radius);
    }

    #[test]
    fn the_sphere_has_the_same_bits_for_every_order_and_for_repeated_points(
        (points, shuffled) in prop_oneof![coarse(1..40), fine(1..200), symmetric()]
            .prop_flat_map(|p| (Just(p.clone()), Just(p).prop_shuffle())),
        extra in any::<prop::sample::Index>(),
    ) {
        let mut again = shuffled;
        again.push(points[extra.index(points.len())]);
        for p in &mut again {
            *p += DVec3::ZERO; // -0 becomes 0
        }
        prop_assert_eq!(bits(sphere(&points)), bits(sphere(&again)));
    }

    #[test]
    fn the_sphere_scales_exactly_with_powers_of_two(points in fine(1..50), exponent in -400_i32..400) {
        let frame = Frame { exponent };
        let scaled: Vec<DVec3> = points.iter().map(|&p| frame.leave(p)).collect();
        prop_assert_eq!(bits(sphere(&points).leave_frame(frame)), bits(sphere(&scaled)));
    }
}

fn bits(s: Sphere) -> [u64; 4] {
    [s.center.x, s.center.y, s.center.z, s.radius].map(f64::to_bits)
}

fn contains(s: Sphere, p: DVec3) -> bool {
    let d = p - s.center;
    d.x * d.x + d.y * d.y + d.z * d.z <= s.radius * s.radius
}

fn sphere(points: &[DVec3]) -> Sphere {
    Sphere::of_points(points).expect("there are points")
}

/// Solves `rows . x = right` by elimination with pivots; the circumcentre conditions in the span of the edges.
fn eliminate(mut m: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = m.len();
    for i in 0..n {
        let pivot = (i..n).max_by(|&a, &b| m[a][i].abs().total_cmp(&m[b][i].abs()))?;
        m.swap(i, pivot);
        if m[i][i].abs() < 1e-13 {
            return None;
        }
        for r in 0..n {
            if r != i {
                let f = m[r][i] / m[i][i];
                let source = m[i].clone();
                for (x, s) in m[r].iter_mut().zip(source) {
                    *x -= f * s;
                }
            }
        }
    }
    Some((0..n).map(|i| m[i][n] / m[i][i]).collect())
}

/// The smallest sphere by trying every subset of one to four points: the definition.
fn brute_force(points: &[DVec3]) -> f64 {
    let mut best = f64::INFINITY;
    for subset in 1_u32..1 << points.len() {
        if subset.count_ones() > 4 {
            continue;
        }
        let chosen: Vec<DVec3> = (0..points.len())
            .filter(|i| subset >> i & 1 == 1)
            .map(|i| points[i])
            .collect();
        let edges: Vec<DVec3> = chosen[1..].iter().map(|&p| p - chosen[0]).collect();
        let rows = edges.iter().map(|a| {
            let mut row: Vec<f64> = edges.iter().map(|b| a.dot(*b)).collect();
            row.push(0.5 * a.length_squared());
            row
        });
        let Some(weights) = eliminate(rows.collect()) else {
            continue;
        };
        let center = chosen[0]
            + edges
                .iter()
                .zip(weights)
                .map(|(&e, w)| e * w)
                .sum::<DVec3>();
        let radius = points
            .iter()
            .map(|p| p.distance(center))
            .fold(0.0, f64::max);
        best = best.min(radius);
    }
    best
}

/// Points on a coarse grid, so that duplicates, lines, planes and common spheres are frequent.
fn coarse(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<DVec3>> {
    prop::collection::vec([-3_i32..4, -3..4, -3..4], count).prop_map(|v| {
        v.into_iter()
            .map(|p| DVec3::from_array(p.map(f64::from)))
            .collect()
    })
}

#[test]
fn spheres_of_no_one_and_two_points() {
    assert_eq!(Sphere::of_points(&[]), None);
    let p = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(
        sphere(&[p, p]),
        Sphere {
            center: p,
            radius: 0.0
        }
    );
    let s = sphere(&[DVec3::ZERO, DVec3::new(0.0, 6.0, 0.0)]);
    assert_eq!(
        s,
        Sphere {
            center: DVec3::new(0.0, 3.0, 0.0),
            radius: 3.0
        }
    );
}

#[test]
fn points_on_a_line_a_circle_and_a_sphere_have_the_sphere_of_their_extremes() {
    let line: Vec<DVec3> = (0..=10)
        .map(|i| DVec3::new(f64::from(i), 0.0, 0.0))
        .collect();
    assert_eq!(sphere(&line).radius.to_bits(), 5.0_f64.to_bits());
    let mut cube = Vec::new();
    for i in 0..8 {
        cube.push(DVec3::new(
            f64::from(i & 1),
            f64::from(i >> 1 & 1),
            f64::from(i >> 2),
        ));
    }
    let s = sphere(&cube);
    assert_eq!(s.center, DVec3::splat(0.5));
    assert!((s.radius - sqrt(0.75)).abs() < 1e-15);
    let (round, _) = named_sets::octahedron_faces(4);
    let s = sphere(&round);
    assert!(
        s.center.length() < 1e-15 && (s.radius - 1.0).abs() < 1e-15,
        "{s:?}"
    );
}

#[test]
fn negative_zero_is_the_same_point_as_zero() {
    let a = [
        DVec3::new(-0.0, 0.0, -0.0),
        DVec3::X,
        DVec3::new(0.0, -0.0, 0.0),
        DVec3::Y,
    ];
    let b = [DVec3::ZERO, DVec3::Y, DVec3::X];
    assert_eq!(bits(sphere(&a)), bits(sphere(&b)));
}

#[test]
fn vertices_that_no_triangle_uses_do_not_count() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::splat(100.0)];
    let mesh = Mesh::from_triangles(positions, vec![[0, 1, 2]]).expect("valid");
    let s = Sphere::of_mesh(&mesh).expect("a triangle");
    assert!((s.radius - sqrt(0.5)).abs() < 1e-15);
    let empty = Mesh::from_triangles(vec![DVec3::X], vec![]).expect("valid");
    assert_eq!(Sphere::of_mesh(&empty), None);
    assert_eq!(frame_of(&empty), Frame::default());
}

#[test]
fn the_frame_of_huge_and_tiny_meshes_brings_the_radius_into_half_to_one() {
    for (size, precision) in [
        (1e30, Precision::F32),
        (1e-30, Precision::F32),
        (3e38, Precision::F32),
        (1e200, Precision::F64),
        (1.7e308, Precision::F64),
        (1e-300, Precision::F64),
        (0.7, Precision::F32),
    ] {
        let positions = [DVec3::NEG_X, DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_Z];
        let mesh = Mesh::new(MeshParts {
            positions: positions.map(|p| p * size).to_vec(),
            triangles: vec![[0, 1, 2], [2, 3, 4]],
            precision,
            ..MeshParts::default()
        })
        .expect("finite");
        let frame = frame_of(&mesh);
        let s = Sphere::of_mesh(mesh.enter_frame(frame).in_frame_units()).expect("triangles");
        assert!((0.5..1.0).contains(&s.radius), "{size}: {s:?} in {frame:?}");
        assert_eq!(
            frame_of(mesh.enter_frame(frame).in_frame_units()),
            Frame::default()
        );
        assert!(ViewSet::costs(&s).is_ok());
    }
}

#[test]
fn real_scans_fit_their_sphere_which_touches_them() {
    for (name, radius) in [
        ("bunny.ply", 0.100_146_663_823_659_72),
        ("dragon.ply", 0.106_654_167_496_236_14),
    ] {
        let Some(loaded) = read_model(name) else {
            continue;
        };
        let mesh = loaded.mesh;
        let s = Sphere::of_mesh(&mesh).expect("triangles");
        assert_eq!(
            s.radius.to_bits(),
            f64::to_bits(radius),
            "{name}: {}",
            s.radius
        );
        // The bunny has 1,113 vertices that no triangle uses, some of them outside.
        let used = mesh.triangles().iter().flatten();
        let mut used: Vec<u32> = used.copied().collect();
        used.sort_unstable();
        used.dedup();
        let distances = used
            .iter()
            .map(|&v| mesh.positions()[v as usize].distance(s.center));
        assert!(distances.clone().all(|d| d <= s.radius * (1.0 + 1e-15)));
        let touching = distances.filter(|&d| d > s.radius * (1.0 - 1e-12)).count();
        assert!((2..=6).contains(&touching), "{touching} points touch");
        let mut parts = mesh.into_parts();
        parts.positions.reverse();
        let last = parts.positions.len() as u32 - 1;
        for corner in parts.triangles.iter_mut().flatten() {
            *corner = last - *corner;
        }
        let reversed = Mesh::new(parts).expect("valid");
        assert_eq!(Sphere::of_mesh(&reversed).map(bits), Some(bits(s)));
    }
}
