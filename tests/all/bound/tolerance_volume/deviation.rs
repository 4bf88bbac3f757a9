//! How far new faces are from the old ones: the measure is never too small.

use glam::DVec3;

use super::{cases, coordinates, drawn, inner, is_outer, neighborhood, outer, ring, ring_of};
use crate::support::{Random, at, distance_by_descent, distance_to_all, lattice};

#[test]
fn no_point_of_the_new_faces_is_farther_than_the_measured_deviation() {
    let mut random = Random(0xde71);
    let mut tight = 0;
    for _ in 0..cases() / 4 {
        let (_, faces) = ring(&mut random, 0.5);
        let around = neighborhood(&faces).expect("no needles");
        let v = random.vector(0.3);
        let claimed = around.deviation(v);
        assert!(around.keeps(v, claimed) && !around.keeps(v, claimed * 0.999));
        let mut most: f64 = 0.0;
        for _ in 0..24 {
            let [_, b, c] = faces[random.below(faces.len() - 2)].points;
            let p = drawn([v, b, c], &mut random);
            let distances = faces.iter().map(|f| distance_by_descent(p, f.points));
            let nearest = distances.fold(f64::INFINITY, f64::min);
            assert!(nearest <= claimed + 1e-3, "{p}: {nearest} above {claimed}");
            most = most.max(nearest);
        }
        tight += u64::from(most > 0.3 * claimed);
    }
    assert!(tight > cases() / 40, "{tight}");
}

/// Above a peak the new vertex is over no old face: in the gaps between the columns, where heights say nothing.
#[test]
fn no_point_above_a_peak_is_farther_than_the_measured_deviation() {
    let mut random = Random(0x6a9);
    let mut between = 0;
    for _ in 0..cases() / 4 {
        let slope = 0.2 + random.unit();
        let (_, faces) = ring_of(&mut random, 0.1, 0.4, slope);
        let around = neighborhood(&faces).expect("no needles");
        let v = DVec3::Z * (0.05 + 0.3 * random.unit()) + random.vector(0.05);
        let claimed = around.deviation(v);
        let corners: Vec<[DVec3; 3]> = faces.iter().map(|f| f.points).collect();
        let mut most: f64 = 0.0;
        for face in faces.iter().filter(is_outer) {
            for p in lattice([v, face.points[1], face.points[2]], 8) {
                most = most.max(distance_to_all(p, &corners));
            }
        }
        let limit = claimed * (1.0 + 1e-12);
        assert!(most <= limit, "{v}: {most} above {claimed}");
        let over = |f: &[DVec3; 3]| coordinates(*f, v).0.iter().all(|&w| w >= 0.0);
        between += u64::from(!corners.iter().any(over));
    }
    assert!(between > cases() / 20, "{between}");
}

#[test]
fn a_new_vertex_above_a_ridge_is_in_no_column_and_counts_all_the_same() {
    let [u, w] = [at(-0.5, 0.0, 0.0), at(0.5, 0.0, 0.0)];
    let [east, west] = [at(2.0, 0.0, -2.0), at(-2.0, 0.0, -2.0)];
    let [north, south] = [at(0.0, 1.0, -2.0), at(0.0, -1.0, -2.0)];
    let faces = [
        outer([w, south, east]),
        outer([w, east, north]),
        outer([u, north, west]),
        outer([u, west, south]),
        inner([w, north, u]),
        inner([u, south, w]),
    ];
    let around = neighborhood(&faces).expect("no needles");
    let claimed = around.deviation(at(0.0, 0.0, 0.3));
    assert!(claimed >= 0.3, "{claimed}");
}
