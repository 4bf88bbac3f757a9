//! The map from an original surface to a simplified one: through single collapses, and through whole runs.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property, and `LODMARK_SEED` what they are drawn from.

mod judged;

use glam::{DVec2, DVec3};
use lodmark::{
    bound::{
        correspondence::{Collapse, Correspondence, Face, Layout, PieceScratch},
        view_cell::ViewCell,
    },
    mesh::{Mesh, canonical},
    simplify::{Options, Target, Topology, simplify, view_bounded::ViewBoundedOptions},
};
use proptest::prelude::*;

use crate::support::{Random, bounded, meshes};

/// What lies around a collapsed edge.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Class {
    Inside,
    /// One end on the boundary.
    Touching,
    /// The edge itself on the boundary.
    Border,
}

/// A bumpy fan around the edge from vertex 0 to vertex 1, and where the new vertex goes; faces turn upwards.
fn ring(class: Class, random: &mut Random) -> (Vec<Face>, Vec<Face>, DVec3) {
    let half = 3 + random.below(3);
    let bump = if random.below(4) == 0 { 0.0 } else { 0.4 };
    let mut height = |x: f64, y: f64| DVec3::new(x, y, (random.unit() - 0.5) * bump);
    let (u, w) = (height(-0.5, 0.0), height(0.5, 0.0));
    let mut points = vec![u, w];
    // The link, counter-clockwise from below u (inside), or an arc above the edge.
    let (count, whole, turns, start) = match class {
        Class::Inside => (2 * half, 2 * half, 2.0, -0.5),
        _ => (half + 1, half, 1.0, 0.0),
    };
    for i in 0..count {
        let a = (i as f64 / whole as f64 * turns + start) * std::f64::consts::PI;
        points.push(height(1.6 * libm::cos(a), 1.3 * libm::sin(a)));
    }
    let link = |i: usize| 2 + (i % count) as u32;
    let side = |end: u32, i: usize| [end, link(i), link(i + 1)];
    let around = |end: u32, range: std::ops::Range<usize>| range.map(move |i| side(end, i));
    let mut triangles: Vec<[u32; 3]> = match class {
        // Right half around w, then left half around u; the two faces beside the edge in between.
        Class::Inside => {
            let beside = [[0, 1, link(half)], [1, 0, link(0)]];
            around(1, 0..half)
                .chain(around(0, half..count))
                .chain(beside)
                .collect()
        }
        Class::Border => {
            let top = 1 + random_index(&points) % (count - 2);
            let beside = [[0, 1, link(top)]];
            around(1, 0..top)
                .chain(around(0, top..count - 1))
                .chain(beside)
                .collect()
        }
        // w is inside, u in the middle of the boundary below it.
        Class::Touching => {
            points[0] = DVec3::new(0.0, 0.0, u.z);
            points[1] = DVec3::new(0.0, 0.6, w.z);
            let last = count - 2;
            let beside = [side(0, last), [0, link(1), 1], [0, 1, link(last)]];
            around(0, 0..1)
                .chain(around(1, 1..last))
                .chain(beside)
                .collect()
        }
    };
    let mut at = |size: f64| size * (2.0 * random.unit() - 1.0);
    let [x, y, z] = match class {
        Class::Inside => [0.5, 0.2, 0.2],
        Class::Border => [0.7, 0.1, 0.2],
        Class::Touching => [0.1, 0.1, 0.2],
    };
    let to = DVec3::new(at(x), at(y), at(z));
    // Any corner may be the first.
    for (id, corners) in triangles.iter_mut().enumerate() {
        corners.rotate_left(id % 3);
    }
    let (removed, added) = collapsed(&triangles, &points, to);
    (removed, added, to)
}

/// The faces of a fan before and after the edge from vertex 0 to vertex 1 collapses into vertex 0 at `to`.
fn collapsed(triangles: &[[u32; 3]], points: &[DVec3], to: DVec3) -> (Vec<Face>, Vec<Face>) {
    let (mut removed, mut added) = (Vec::new(), Vec::new());
    for (id, &corners) in (0_u32..).zip(triangles) {
        let before = corners.map(|v| points[v as usize]);
        removed.push(Face {
            id,
            corners,
            points: before,
        });
        if !(corners.contains(&0) && corners.contains(&1)) {
            added.push(Face {
                id,
                corners: corners.map(|v| if v == 1 { 0 } else { v }),
                points: corners.map(|v| if v < 2 { to } else { points[v as usize] }),
            });
        }
    }
    (removed, added)
}

fn layout(removed: &[Face], added: &[Face], to: DVec3) -> Option<Layout> {
    Layout::new(&Collapse {
        removed,
        added,
        keep: 0,
        gone: 1,
        to,
    })
}

fn random_index(points: &[DVec3]) -> usize {
    (points[0].z.abs() * 1e6) as usize
}

fn at(t: [DVec3; 3], [u, v]: [f64; 2]) -> DVec3 {
    t[0] * (1.0 - u - v) + t[1] * u + t[2] * v
}

/// The images of a point of an original triangle: one for every piece that has it, by the triangles from its first corner.
fn images(
    map: &Correspondence,
    face_points: &dyn Fn(u32) -> [DVec3; 3],
    triangle: u32,
    [u, v]: [f64; 2],
) -> Vec<DVec3> {
    let mut found = Vec::new();
    for face in 0..map.face_count() as u32 {
        for piece in map.pieces(face).filter(|p| p.triangle == triangle) {
            let c = piece.corners;
            for i in 2..c.len() {
                let three = [c[0], c[i - 1], c[i]];
                let [a, b, d] = three.map(|c| DVec2::from_array(c.source.get()));
                let area = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
                let (place, whole) = (DVec2::new(u, v), area(a, b, d));
                let w = [area(place, b, d), area(a, place, d), area(a, b, place)];
                let w = w.map(|x| x / whole);
                if whole > 1e-12 && w.iter().all(|&x| x >= -1e-7) {
                    let image = three.map(|c| at(face_points(face), c.target.get()));
                    found.push(image[0] * w[0] + image[1] * w[1] + image[2] * w[2]);
                }
            }
        }
    }
    found
}

/// Sum of the areas of the pieces of an original triangle, as a share of it.
fn covered(map: &Correspondence, triangle: u32) -> f64 {
    let mut sum = 0.0;
    for face in 0..map.face_count() as u32 {
        for piece in map.pieces(face).filter(|p| p.triangle == triangle) {
            for (i, corner) in piece.corners.iter().enumerate() {
                let next = &piece.corners[(i + 1) % piece.corners.len()];
                let (p, q) = (corner.source.get(), next.source.get());
                sum += p[0] * q[1] - p[1] * q[0];
            }
        }
    }
    sum
}

proptest! {
    #![proptest_config(bounded(if cfg!(debug_assertions) { 3_000 } else { 300_000 }))]

    #[test]
    fn a_collapse_maps_every_point_of_the_fan_once_and_along_one_direction(kind in 0_u8..3, seed: u64) {
        let class = [Class::Inside, Class::Touching, Class::Border][usize::from(kind)];
        let mut random = Random(seed);
        let (removed, added, to) = ring(class, &mut random);
        let Some(fan) = layout(&removed, &added, to) else {
            // A new vertex outside of what its link sees has no map; rare for these fans.
            return Ok(());
        };
        let originals: Vec<[DVec3; 3]> = removed.iter().map(|f| f.points).collect();
        let mut map = Correspondence::new(originals.clone(), |_| true);
        assert!(map.apply(&fan, &mut PieceScratch::default()));
        let after = |face: u32| added.iter().find(|f| f.id == face).map_or([DVec3::NAN; 3], |f| f.points);
        let normal: DVec3 = originals.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a)).sum();
        let normal = normal.normalize();
        for t in 0..originals.len() as u32 {
            prop_assert!((covered(&map, t) - 1.0).abs() < 1e-7, "{class:?}: {} of triangle {t}", covered(&map, t));
            let (u, v) = (random.unit(), random.unit());
            let place = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
            let found = images(&map, &after, t, place);
            prop_assert!(!found.is_empty());
            let point = at(originals[t as usize], place);
            for image in &found {
                prop_assert!((*image - found[0]).length() < 1e-6, "torn: {found:?}");
                let moved = *image - point;
                if class == Class::Inside {
                    prop_assert!((moved - normal * moved.dot(normal)).length() < 1e-6, "sideways: {moved}");
                }
                let most = (0..map.face_count() as u32).map(|f| map.displacement(f)).fold(0.0, f64::max);
                prop_assert!(moved.length() <= most + 1e-7, "{moved} beyond {most}");
            }
        }
        // Triangles beside each other agree on what they share.
        for (i, one) in removed.iter().enumerate() {
            for other in &removed[..i] {
                let shared: Vec<u32> = one.corners.into_iter().filter(|v| other.corners.contains(v)).collect();
                let &[p, q] = shared.as_slice() else { continue };
                let s = random.unit();
                let weight = |v: u32| if v == p { 1.0 - s } else if v == q { s } else { 0.0 };
                let found: Vec<DVec3> = [one, other].iter()
                    .flat_map(|f| images(&map, &after, f.id, [weight(f.corners[1]), weight(f.corners[2])])).collect();
                for image in &found {
                    prop_assert!((*image - found[0]).length() < 1e-6, "{class:?}: torn along a side: {found:?}");
                }
            }
        }
    }
}

#[test]
fn most_fans_of_every_class_have_a_map() {
    for class in [Class::Inside, Class::Touching, Class::Border] {
        let is_mapped = |&seed: &u64| {
            let (removed, added, to) = ring(class, &mut Random(seed));
            layout(&removed, &added, to).is_some()
        };
        let count = (0..200).filter(is_mapped).count();
        assert!(count >= 150, "{class:?}: only {count} of 200");
    }
}

#[test]
fn a_flat_fan_moves_no_point() {
    for seed in 0..50 {
        let (mut removed, mut added, mut to) = ring(Class::Inside, &mut Random(seed));
        to.z = 0.0;
        for face in removed.iter_mut().chain(&mut added) {
            for p in &mut face.points {
                p.z = 0.0;
            }
        }
        let fan = layout(&removed, &added, to).expect("flat and convex");
        let originals = removed.iter().map(|f| f.points).collect();
        let mut map = Correspondence::new(originals, |_| true);
        assert!(map.apply(&fan, &mut PieceScratch::default()));
        for face in &added {
            let moved = map.displacement(face.id);
            assert!(moved < 1e-8, "{moved}");
        }
    }
}

#[test]
fn folded_torn_and_turned_fans_have_no_map() {
    let (removed, added, to) = ring(Class::Inside, &mut Random(3));
    assert!(layout(&removed, &added, to).is_some());
    let mut turned = removed.clone();
    turned[0].corners.swap(0, 1);
    turned[0].points.swap(0, 1);
    let far = DVec3::new(9.0, 0.0, 0.0);
    let mut outside = added.clone();
    for face in &mut outside {
        for k in 0..3 {
            if face.corners[k] == 0 {
                face.points[k] = far;
            }
        }
    }
    let twice = [&removed[..], &removed].concat();
    for (removed, added, to, told) in [
        (&[][..], &[][..], to, "nothing"),
        (&removed[1..], &added[1..], to, "a face is missing"),
        (&removed, &added[1..], to, "a face vanishes"),
        (&turned, &added, to, "a face is turned over"),
        (&removed, &outside, far, "the new vertex lies outside"),
        (&twice, &added, to, "every face is there twice"),
    ] {
        assert!(layout(removed, added, to).is_none(), "{told}");
    }
}

/// A map through as many collapses as move no point farther than `most`, and the mesh it leads to.
fn run(mesh: &Mesh, triangles: u64, most: f64) -> (Correspondence, Mesh) {
    let cell = ViewCell::half_space(DVec3::new(0.0, 0.0, 1e4), DVec3::NEG_Z).expect("a half-space");
    let own = ViewBoundedOptions::new(cell, (most / 1e4).to_degrees());
    let options = Options::view_bounded(own, Target::Triangles(triangles));
    let options = options.topology(Topology::Preserve);
    let outcome = simplify(mesh, &options).expect("valid");
    let map = outcome.correspondence().expect("this method keeps account");
    (map.clone(), outcome.mesh)
}

proptest! {
    #![proptest_config(bounded(40))]

    #[test]
    fn after_many_collapses_the_map_still_covers_everything_once_without_a_tear(
        kind in 0_usize..8, seed: u64, share in 1_u64..9, most in prop::sample::select(vec![0.05, 0.3, 1e3]),
    ) {
        // In canonical order no triangle repeats a vertex: such a one has no points to keep account of.
        let mesh = canonical(&meshes::any(kind, seed)).mesh;
        let (map, low) = run(&mesh, (mesh.triangles().len() as u64 * share / 10).max(1), most);
        prop_assert_eq!(map.face_count(), low.triangles().len());
        prop_assert_eq!(map.triangle_count(), mesh.triangles().len());
        let face_points = |face: u32| low.corners(face as usize);
        let size = { let (a, b) = mesh.bounds().expect("not empty"); (b - a).length() };
        let mut random = Random(seed);
        for t in 0..mesh.triangles().len() as u32 {
            prop_assert!((covered(&map, t) - 1.0).abs() < 1e-12, "{} of {t}", covered(&map, t));
        }
        for piece in (0..map.face_count() as u32).flat_map(|face| map.pieces(face)) {
            let corners: Vec<[f64; 2]> = piece.corners.iter().map(|c| c.source.get()).collect();
            for pair in corners[1..].windows(2) {
                let [[a, b], [c, d]] = [pair[0], pair[1]].map(|p| [p[0] - corners[0][0], p[1] - corners[0][1]]);
                prop_assert!(a * d - b * c > -1e-6, "turned over: {corners:?}");
            }
        }
        if most > 1.0 {
            // Pushed together beyond recognition, neighbours need not agree along their common side.
            return Ok(());
        }
        let edges = lodmark::mesh::Edges::of(&mesh);
        for (edge, triangles) in edges.iter() {
            if random.below(4) > 0 {
                continue;
            }
            let s = random.unit();
            let mut all = Vec::new();
            for &t in triangles {
                let weight = |v: u32| if v == edge[0] { 1.0 - s } else if v == edge[1] { s } else { 0.0 };
                let corners = mesh.triangles()[t as usize];
                all.extend(images(&map, &face_points, t, [weight(corners[1]), weight(corners[2])]));
            }
            for image in &all {
                prop_assert!((*image - all[0]).length() < 1e-6 * size, "torn at {edge:?}: {all:?}");
            }
        }
    }
}
