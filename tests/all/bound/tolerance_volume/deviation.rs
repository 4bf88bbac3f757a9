//! How far new faces are from the old ones: the measure is never too small.

use glam::DVec3;
use lodmark::bound::tolerance::OldFace;

use super::{cases, coordinates, neighborhood, ring, ring_of};
use crate::support::{Random, distance, distance_by_descent, lattice};

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
            let face = &faces[random.below(faces.len() - 2)];
            let (s, t) = (random.unit(), random.unit());
            let p = v * (1.0 - s) + (face.points[1] * t + face.points[2] * (1.0 - t)) * s;
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
        for face in faces.iter().filter(|f| f.ends == [true, false, false]) {
            for p in lattice([v, face.points[1], face.points[2]], 8) {
                let distances = corners.iter().map(|&f| distance(p, f));
                most = most.max(distances.fold(f64::INFINITY, f64::min));
            }
        }
        assert!(
            most <= claimed * (1.0 + 1e-12),
            "{v}: {most} above {claimed}"
        );
        let over = |f: &[DVec3; 3]| coordinates(*f, v).0.iter().all(|&w| w >= 0.0);
        between += u64::from(!corners.iter().any(over));
    }
    assert!(between > cases() / 20, "{between}");
}

#[test]
fn a_new_vertex_above_a_ridge_is_in_no_column_and_counts_all_the_same() {
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let [u, w] = [at(-0.5, 0.0, 0.0), at(0.5, 0.0, 0.0)];
    let [east, north, west, south] = [
        at(2.0, 0.0, -2.0),
        at(0.0, 1.0, -2.0),
        at(-2.0, 0.0, -2.0),
        at(0.0, -1.0, -2.0),
    ];
    let outer = |points| OldFace {
        points,
        ends: [true, false, false],
    };
    let inner = |points| OldFace {
        points,
        ends: [true, false, true],
    };
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
