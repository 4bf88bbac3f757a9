//! The certificate against brute force: a yes is never wrong, a no only near the bound.

use glam::DVec3;
use lodmark::bound::envelope::{
    Coverage, Facet, OriginalSurface, PieceQueue, Reach, Trial, WitnessChange,
};

use crate::{
    bound::tolerance_volume::cases,
    support::{Random, at, distance, distance_to_all, faces, lattice, meshes},
};

fn triangle(random: &mut Random, size: f64) -> [DVec3; 3] {
    let middle = random.vector(1.0);
    [0; 3].map(|_| middle + random.vector(size))
}

/// The largest sampled distance of a triangle from others.
fn farthest(of: [DVec3; 3], from: &[[DVec3; 3]]) -> f64 {
    let distances = lattice(of, 12).map(|p| distance_to_all(p, from));
    distances.fold(0.0, f64::max)
}

#[test]
fn the_distance_to_a_triangle_is_that_to_its_nearest_point_and_never_shorter() {
    let mut random = Random(0xfa);
    for case in 0..20 * cases() {
        let mut corners = triangle(&mut random, 1.0);
        match case % 5 {
            // A needle, a segment, a point.
            0 => corners[2] = corners[0] + (corners[1] - corners[0]) * 0.3 + random.vector(1e-9),
            1 => corners[2] = corners[1],
            2 if case % 2 == 0 => corners = [corners[0]; 3],
            _ => {}
        }
        let p = random.vector(2.0);
        let found = lodmark::num::math::sqrt(Facet::new(corners).distance2(p));
        let off = (found - distance(p, corners)).abs();
        assert!(off <= 1e-8, "{p} {corners:?}: {found} is {off} off");
    }
}

#[test]
fn a_triangle_that_is_held_is_within_reach_and_one_well_within_reach_is_held() {
    let mut random = Random(0xe1);
    let (mut held, mut refused) = (0, 0);
    for _ in 0..cases() {
        // A wavy sheet, so that neighbours share edges, and strays.
        let original = faces(&meshes::grid(3, random.next()));
        let surface = OriginalSurface::new(original.iter().copied());
        let mut unit = || random.unit();
        let new = [0; 3].map(|_| at(3.0 * unit(), 3.0 * unit(), 0.6 * unit()));
        let most = farthest(new, &original);
        let share = 0.5 + random.unit();
        let reach = Reach::new(most * share, 3.0).expect("large enough");
        let yes = surface.holds([new].into_iter(), reach, &mut PieceQueue::default());
        if share < 1.0 {
            assert!(!yes, "a point is at {most}, and {share} of it certified");
            refused += 1;
        } else if share > 1.15 {
            assert!(yes, "all samples are within {most}, of the bound {share}");
            held += 1;
        }
    }
    assert!(held > cases() / 10 && refused > cases() / 10);
}

#[test]
fn coverage_after_changes_is_true_of_every_point_and_refuses_only_near_the_bound() {
    let mut random = Random(0xc0e);
    let (mut yes, mut no) = (0, 0);
    for _ in 0..cases() / 4 {
        let mesh = meshes::grid(3, random.next());
        let original = faces(&mesh);
        let mut live: Vec<Option<[DVec3; 3]>> = original.iter().map(|&t| Some(t)).collect();
        let mut coverage = Coverage::new(mesh.positions(), mesh.triangles());
        let reach = Reach::new(0.1 + 0.5 * random.unit(), 3.0).expect("large enough");
        let (mut trial, mut change) = (Trial::default(), WitnessChange::default());
        for _ in 0..12 {
            // Some neighbours go; all but one of them come back, bent.
            let first = random.below(live.len());
            let four = first..(first + 4).min(live.len());
            let ids = four.filter(|&t| live[t].is_some()).map(|t| t as u32);
            let ids: Vec<u32> = ids.collect();
            if ids.len() < 2 {
                continue;
            }
            let size = 0.6 * reach.length * random.unit();
            let kept = &ids[usize::from(random.below(3) == 0)..];
            let corners = kept.iter().filter_map(|&t| live[t as usize]);
            let bent = corners.map(|corners| corners.map(|p| p + random.vector(size)));
            let fan: Vec<[DVec3; 3]> = bent.collect();
            coverage.gather(&ids, |t| live[t as usize], reach, &mut trial);
            let covers = trial.covers(fan.iter().copied(), reach);
            let assigned = trial.assign(&ids, kept, fan.iter().copied(), reach, &mut change);
            assert_eq!(covers, assigned);
            let mut after = live.clone();
            for &t in &ids {
                after[t as usize] = None;
            }
            for (&t, &corners) in kept.iter().zip(&fan) {
                after[t as usize] = Some(corners);
            }
            let all: Vec<[DVec3; 3]> = after.iter().flatten().copied().collect();
            let most = original.iter().map(|&t| farthest(t, &all));
            let most = most.fold(0.0, f64::max);
            if covers {
                assert!(most <= reach.length * (1.0 + 1e-9), "{most}, {reach:?}");
                coverage.apply(&change);
                live = after;
                yes += 1;
            } else {
                // Only faces next to the change are asked: it may be one of the others that is near.
                no += 1;
            }
            for t in 0..original.len() as u32 {
                let alive = |&w: &u32| live[w as usize].expect("a witness is alive");
                let witnesses: Vec<_> = coverage.witnesses(t).iter().map(alive).collect();
                let most = farthest(original[t as usize], &witnesses);
                assert!(most <= reach.length * (1.0 + 1e-9), "triangle {t}: {most}");
            }
        }
    }
    assert!(yes > cases() / 4 && no > cases() / 10, "{yes} {no}");
}

#[test]
fn a_bound_that_rounding_would_swallow_is_no_bound() {
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-15] {
        assert_eq!(Reach::new(length, 1.0), None);
    }
    assert_eq!(Reach::new(1e-9, 1e9), None);
    let reach = Reach::new(1e-9, 1.0).expect("large enough");
    assert!(reach.length < 1e-9 && reach.length > 0.99e-9);
}
