//! Quadrics against the vectors and against sums of distances.

use glam::DVec3;
use lodmark::{
    collapse::LiveMesh,
    simplify::{
        Options, Stop, Target,
        quadric::{Quadric, QuadricMethod, QuadricOptions, Uncertainty, Weighting},
        simplify,
    },
};
use proptest::prelude::*;

use crate::{
    simplify::memoryless::{U, W, interior},
    support::{Random, faces, meshes},
};

fn options(weighting: Weighting) -> QuadricOptions {
    QuadricOptions {
        weighting,
        // The ring's outer edges are boundaries of the test's mesh, not of the vector's.
        boundary_weight: 0.0,
        ..QuadricOptions::default()
    }
}

fn edge(live: &LiveMesh, options: &QuadricOptions) -> Quadric {
    let method = QuadricMethod::new(live, options);
    method.quadric(0).plus(method.quadric(1))
}

#[test]
fn unit_and_area_weights_give_the_vertices_and_errors_of_the_vectors() {
    let vectors = [
        (
            Weighting::Unit,
            [
                -0.026_137_273_713_825_21,
                0.013_314_889_780_954_322,
                0.251_220_690_836_399_3,
            ],
            0.054_011_934_252_198_86,
        ),
        (
            Weighting::Area,
            [
                -0.021_197_793_723_243_524,
                0.005_808_587_552_024_54,
                0.254_937_581_408_395_5,
            ],
            0.023_718_322_814_530_676,
        ),
    ];
    for (weighting, v, error) in vectors {
        let sum = edge(&interior(false), &options(weighting));
        let found = sum.minimum().expect("well conditioned");
        for (found, expected) in found.to_array().into_iter().zip(v) {
            assert!((found - expected).abs() < 1e-11, "{found}, not {expected}");
        }
        let found = sum.error(found);
        assert!((found - error).abs() < 1e-12, "{found}, not {error}");
    }
}

#[test]
fn a_flat_ring_has_no_minimum_and_every_point_of_the_edge_is_as_good() {
    let live = interior(true);
    let sum = edge(&live, &options(Weighting::Area));
    assert_eq!(sum.minimum(), None);
    let ends = [live.position(0), live.position(1)];
    assert_eq!(sum.minimum_on(ends), None);
    assert_eq!(sum.place(ends), (ends[0] + ends[1]) * 0.5);
}

proptest! {
    #![proptest_config(crate::support::cases(256))]

    #[test]
    fn a_sum_of_planes_is_the_sum_of_squared_distances(seed: u64, count in 1_usize..9) {
        let mut random = Random(seed);
        let mut vector = || random.vector(0.5);
        let v = vector();
        let (mut sum, mut expected) = (Quadric::default(), 0.0);
        for i in 0..count {
            let (point, normal) = (vector(), vector().normalize());
            let weight = 0.5 + i as f64;
            sum = sum.plus(&Quadric::plane(point, normal, weight));
            expected += weight * (v - point).dot(normal) * (v - point).dot(normal);
        }
        prop_assert!((sum.error(v) - expected).abs() < 1e-12);
        if let Some(best) = sum.minimum() {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                for step in [1e-2, -1e-2] {
                    prop_assert!(sum.error(best + axis * step) >= sum.error(best) - 1e-9);
                }
            }
        }
        let on = sum.place([U, W]);
        prop_assert!(sum.error(on) <= sum.error((U + W) * 0.5) + 1e-9);
    }

    #[test]
    fn an_uncertain_plane_costs_what_random_planes_cost_on_average(seed: u64) {
        // Deviations of +-sigma along each axis have the same first and second moments as Gaussian ones.
        let mut random = Random(seed);
        let mut vector = || random.vector(0.5);
        let (point, normal, v) = (vector(), vector().normalize(), vector());
        let (sn, sp) = (0.1, 0.05);
        let found = Quadric::uncertain_plane(point, normal, 1.0, sn, sp).error(v);
        let (mut sum, mut count) = (0.0, 0.0);
        let sign = |bits: usize, bit: usize| if bits >> bit & 1 == 1 { 1.0 } else { -1.0 };
        for bits in 0..64 {
            let n = normal + DVec3::new(sign(bits, 0), sign(bits, 1), sign(bits, 2)) * sn;
            let p = point + DVec3::new(sign(bits, 3), sign(bits, 4), sign(bits, 5)) * sp;
            let d = (v - p).dot(n);
            sum += d * d;
            count += 1.0;
        }
        prop_assert!((found - sum / count).abs() < 1e-12, "{found} {}", sum / count);
    }
}

#[test]
fn every_option_simplifies_open_and_closed_meshes() {
    for weighting in [Weighting::Unit, Weighting::Area] {
        let uncertain = Uncertainty {
            normal: 0.02,
            position: 0.05,
        };
        for uncertainty in [None, Some(uncertain)] {
            for mesh in [meshes::grid(12, 2), meshes::torus(14, 9, 2)] {
                let own = QuadricOptions {
                    weighting,
                    uncertainty,
                    ..QuadricOptions::default()
                };
                let outcome = simplify(&mesh, &Options::new(own, Target::ratio(0.25)));
                assert_eq!(outcome.expect("valid").stop, Stop::TargetReached);
            }
        }
    }
}

#[test]
fn the_outline_of_a_flat_sheet_survives() {
    let mut parts = meshes::grid(10, 0).into_parts();
    parts.positions.iter_mut().for_each(|p| p.z = 0.0);
    let mesh = lodmark::mesh::Mesh::new(parts).expect("valid");
    let outcome = simplify(&mesh, &Options::quadric(Target::Triangles(2)));
    let left = outcome.expect("valid").mesh;
    let area = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length() * 0.5;
    let area: f64 = faces(&left).into_iter().map(area).sum();
    assert!((area - 100.0).abs() < 1.0, "{area} of 100 in {left:?}");
}
