//! Polishing in which the surface has a say: what a change costs in pictures it must bring back in distance.

use std::collections::VecDeque;

use glam::DVec3;
use lodmark::{
    Error,
    collapse::{LiveMesh, Observer, Patch},
    geometry::{TriangleTree, closest_point},
    mesh::{Mesh, generate},
    num::math,
    simplify::{
        MethodOptions, Options, Target,
        image::{DistancePenalty, EngineName, Limits, Pictures, Polish},
        simplify,
    },
    view::ViewSet,
};

use crate::{
    simplify::{
        image::{error, reference, view_sets},
        polish::{THREE, polish_with, pushed},
    },
    support::{faces, framed, snapshot},
};

/// Vertices searched against the same pictures: a change is weighed by the error of one of so many moments before.
const BATCH: usize = 16;

/// Area times mean distance of centroid and midpoints from the nearest of all faces.
fn deviation(original: &[[DVec3; 3]], mesh: &Mesh) -> f64 {
    let distance = |p: DVec3| {
        let squared = original.iter().map(|f| closest_point(p, *f).1);
        math::sqrt(squared.fold(f64::INFINITY, f64::min))
    };
    let of = |[a, b, c]: [DVec3; 3]| {
        let area = (b - a).cross(c - a).length() / 2.0;
        let sides = [a + b, b + c, c + a].map(|sum| sum / 2.0);
        let points = [(a + b + c) / 3.0, sides[0], sides[1], sides[2]];
        area * points.map(distance).iter().sum::<f64>() / 4.0
    };
    faces(mesh).into_iter().map(of).sum()
}

/// Judges every change by drawing everything and measuring every distance.
struct Judge<'a> {
    original: &'a Mesh,
    faces: &'a [[DVec3; 3]],
    set: &'a ViewSet,
    weight: f64,
    falling: bool,
    total: f64,
    last: f64,
    sums: VecDeque<i64>,
    for_the_surface: usize,
}

impl Observer for Judge<'_> {
    fn committed(&mut self, live: &LiveMesh, _: &Patch) {
        let now = snapshot(live);
        let sum = error(self.original, &now, self.set);
        let deviation = deviation(self.faces, &now);
        let cost = sum - self.sums.back().expect("one");
        let added = deviation - self.last;
        assert!(cost <= 0 || !self.falling, "{cost} under a limit");
        if cost >= 0 {
            let largest = *self.sums.iter().max().expect("one") as f64;
            let balance = cost as f64 * self.total + self.weight * largest * added;
            assert!(added < 0.0 && balance < 0.0, "{cost} for {added}");
            self.for_the_surface += 1;
        }
        self.last = deviation;
        self.sums.push_back(sum);
        if self.sums.len() > BATCH {
            self.sums.pop_front();
        }
    }
}

#[test]
fn a_change_that_makes_pictures_worse_brings_the_surface_nearer_by_as_much() {
    let mut for_the_surface = 0;
    for mesh in [generate::torus(1.0, 0.4, 10, 6), generate::icosphere(1)] {
        let (frame, original, sphere) = framed(&mesh);
        let all = faces(&original);
        let surface = TriangleTree::new(all.clone()).expect("triangles");
        let set = &view_sets(&sphere)[0].1;
        let worse = pushed(&mesh, 0.06, 11);
        let mut distances = Vec::new();
        for (weight, falling) in [(0.0, false), (1.0, false), (20.0, false), (20.0, true)] {
            let mut live = LiveMesh::new(&worse, frame);
            let pictures = Pictures::new(&reference(&original, set), &live, EngineName::Layers);
            let bound = DistancePenalty::new(&surface, &live, weight);
            let total = deviation(&all, &snapshot(&live));
            let mut judge = Judge {
                original: &original,
                faces: &all,
                set,
                weight,
                falling,
                total,
                last: total,
                sums: VecDeque::from([pictures.sum() as i64]),
                for_the_surface: 0,
            };
            let options = Polish { sweeps: 2, ..THREE };
            let limits = Limits {
                deviation: bound.as_ref(),
                falling,
                ..Limits::default()
            };
            let (pictures, _) = polish_with(&mut live, pictures, options, limits, &mut judge);
            let result = snapshot(&live);
            assert_eq!(pictures.sum() as i64, error(&original, &result, set));
            for_the_surface += judge.for_the_surface;
            distances.push(deviation(&all, &result));
        }
        let nearer = distances[1].max(distances[2]) < distances[0];
        assert!(nearer, "{distances:?}");
    }
    assert!(for_the_surface > 20, "{for_the_surface}");
}

#[test]
fn weights_that_are_no_weights_are_refused_by_name() {
    let mesh = generate::icosphere(2);
    for (name, weight) in [("swept-weight", f64::NAN), ("deviation-weight", -0.5)] {
        let mut options = Options::image(Target::Triangles(100));
        let MethodOptions::Image(own) = &mut options.method else {
            unreachable!("image-driven");
        };
        match name {
            "swept-weight" => own.swept_weight = weight,
            _ => own.polish.deviation_weight = weight,
        }
        let refused = simplify(&mesh, &options);
        let named = matches!(&refused, Err(Error::Usage(what)) if what.contains(name));
        assert!(named, "{refused:?}");
    }
}
