//! Vertices of very many faces: what is sorted there instead of looked through is the same, and what is looked at again
//! after every collapse is bounded. No test measures time: they count evaluations and the faces they see.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::atomic::{AtomicUsize, Ordering},
};

use glam::DVec3;
use lodmark::{
    bound::view_cell::ViewCell,
    collapse::{
        EdgeStar, Engine, LiveMesh, Method, MethodScratch, Patch, Plan, Proposal, Refusal, Rules,
        Schedule, Site, StarFace, fold_amount,
    },
    mesh::{Materials, Mesh, MeshParts, canonical},
    simplify::{
        Options, Target, simplify,
        tolerance::{Distance, ToleranceOptions},
        view_bounded::ViewBoundedOptions,
    },
};

use crate::{
    collapse::engine::{Dice, assert_consistent, groups},
    support::{Random, collapse, live},
};

/// `count` faces around a vertex in a plane.
fn disc(count: u32) -> Mesh {
    let turn = std::f64::consts::TAU / f64::from(count);
    let rim = (0..count).map(|i| {
        let angle = turn * f64::from(i);
        DVec3::new(libm::cos(angle), libm::sin(angle), 0.0)
    });
    let positions = std::iter::once(DVec3::ZERO).chain(rim).collect();
    let triangles = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count]);
    let mesh = Mesh::from_triangles(positions, triangles.collect()).expect("valid");
    canonical(&mesh).mesh
}

/// Two hubs with a common edge, and faces of all kinds around them: sheets that touch in a point, edges with three
/// faces, faces that are there twice, faces that coincide after a collapse, borders of materials.
fn tangle(seed: u64) -> Mesh {
    let mut random = Random(seed);
    let count = 40 + random.below(60) as u32;
    let mut triangles = vec![[0, 1, 2]];
    if random.below(3) > 0 {
        triangles.push([1, 0, 3]);
    }
    for hub in [0, 1] {
        for i in 2..count {
            if random.below(12) > 0 {
                triangles.push([hub, i, 2 + (i - 1) % (count - 2)]);
            }
        }
    }
    for _ in 0..random.below(12) {
        let [a, b] = [2 + random.below(9) as u32, 2 + random.below(40) as u32];
        triangles.push([random.below(2) as u32, a, b]);
    }
    for _ in 0..random.below(3) {
        triangles.push([0, 1, 4 + random.below(30) as u32]);
    }
    for _ in 0..random.below(6) {
        let [a, b, c] = triangles[random.below(triangles.len())];
        triangles.push([b, c, a]);
    }
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    let mut point = || DVec3::new(random.unit(), random.unit(), random.unit());
    let positions = (0..count).map(|_| point()).collect();
    let of_triangle = (0..triangles.len()).map(|_| u32::from(random.below(20) == 0));
    let materials = Materials {
        names: vec!["a".into(), "b".into()],
        of_triangle: of_triangle.collect(),
        libraries: Vec::new(),
        asset: None,
    };
    Mesh::new(MeshParts {
        positions,
        triangles,
        materials,
        ..MeshParts::default()
    })
    .expect("valid")
}

fn sorted(f: &StarFace) -> [u32; 3] {
    let mut corners = f.corners;
    corners.sort_unstable();
    corners
}

#[test]
fn nothing_is_missed_or_met_twice_around_two_hubs() {
    let mut seen = [0; 6];
    for seed in 0..300 {
        let mesh = tangle(seed);
        let live = live(&mesh);
        let mut star = EdgeStar::default();
        assert!(star.gather(&live, live.find_edge(0, 1).expect("an edge")));
        assert!(star.faces.len() > 48, "{}", star.faces.len());
        // Every set of corners once.
        let mut different: BTreeMap<[u32; 3], &StarFace> = BTreeMap::new();
        for face in &star.faces {
            different.entry(sorted(face)).or_insert(face);
        }
        let both = |c: &&[u32; 3]| c.contains(&0) && c.contains(&1);
        let edge_faces = different.keys().filter(both).count();
        assert_eq!(star.edge_faces as usize, edge_faces);
        let mut degree = [u32::from(star.edge_feature); 2];
        let vertices: BTreeSet<u32> = different.keys().flatten().copied().collect();
        let others = vertices.into_iter().filter(|&v| v > 1);
        assert!(others.eq(star.spokes.iter().map(|s| s.vertex)));
        for spoke in &star.spokes {
            assert_eq!(spoke.point, live.position(spoke.vertex));
            for (end, degree) in degree.iter_mut().enumerate() {
                let side = [end as u32, spoke.vertex];
                let at = |c: &&[u32; 3]| side.iter().all(|v| c.contains(v));
                let faces = different.keys().filter(at).count() as u32;
                assert_eq!(spoke.faces[end], faces, "faces at {side:?}, seed {seed}");
                let all = star.faces.iter().filter(|f| at(&&f.corners));
                let materials: BTreeSet<u32> = all.map(|f| live.material(f.id)).collect();
                let feature = faces > 2 || (faces == 2 && materials.len() > 1);
                assert_eq!(spoke.feature[end], feature, "feature {side:?}, seed {seed}");
                *degree += u32::from(feature);
            }
            let beside = |c: &[u32; 3]| [0, 1, spoke.vertex].iter().all(|v| c.contains(v));
            assert_eq!(spoke.beside, different.keys().any(beside));
        }
        assert_eq!(star.feature_degree, degree);
        for (i, face) in star.faces.iter().enumerate() {
            let rest = |f: &StarFace| sorted(f).map(|v| if v > 1 { v } else { 0 });
            let earlier = |f: &&StarFace| {
                f.survives && (f.at[0] < 3) != (face.at[0] < 3) && rest(f) == rest(face)
            };
            let doubled = star.faces[..i].iter().any(|f| earlier(&f));
            assert_eq!(face.survives, !face.has_both() && !doubled, "face {i}");
            seen[0] += usize::from(doubled);
        }
        for end in 0..2 {
            let at: Vec<&StarFace> = star.faces.iter().filter(|f| f.at[end] < 3).collect();
            let linked = |i: usize, j: usize| {
                let mut corners = at[i].corners.iter();
                corners.any(|v| *v != end as u32 && at[j].corners.contains(v))
            };
            let pinched = groups(at.len(), linked) > 1;
            assert_eq!(star.is_pinched(end), pinched, "end {end}, seed {seed}");
            seen[1 + usize::from(pinched)] += 1;
        }
        seen[3] += star.faces.len() - different.len();
        seen[4] += star.feature_degree[0] as usize;
        seen[5] += usize::from(edge_faces > 2);
    }
    assert!(seen.iter().all(|&n| n > 5), "{seen:?}");
}

/// The sum of [`fold_amount`] after a collapse, from all faces of the mesh: over sides of exactly two changed faces, and
/// of one changed and one other.
fn folded_after(live: &LiveMesh, patch: &Patch, cosine: f64) -> f64 {
    let mut faces: Vec<([u32; 3], DVec3, bool)> = Vec::new();
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    for t in 0..live.triangle_ids() {
        let changed = patch.removed.iter().any(|f| f.id == t);
        if let (Some(corners), Some(points), false) = (live.triangle(t), live.points(t), changed) {
            faces.push((corners, normal(points), false));
        }
    }
    for f in &patch.added {
        faces.push((f.corners, normal(patch.after(live, f)), true));
    }
    let mut at: BTreeMap<[u32; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (i, (corners, ..)) in faces.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let side = at.entry([a.min(b), a.max(b)]).or_default();
            side.push((i, a < b));
        }
    }
    let mut sum = 0.0;
    for side in at.values() {
        // Unchanged faces come first.
        let changed = side.iter().filter(|s| faces[s.0].2).count();
        if changed == 2 || (changed == 1 && side.len() == 2) {
            let [(i, f), (j, g)] = [side[side.len() - 2], side[side.len() - 1]];
            let sign = if f == g { -1.0 } else { 1.0 };
            let (a, b) = (faces[i].1, faces[j].1);
            let c = sign * a.dot(b) / (a.length() * b.length());
            let c = if c < 0.0 { c } else { 1.0 };
            sum += (cosine - c).max(0.0);
        }
    }
    sum
}

#[test]
fn no_fold_around_a_hub_is_missed_or_counted_twice() {
    let mut folds = 0;
    for seed in 0..60 {
        let mesh = tangle(seed);
        let live = live(&mesh);
        let (mut star, mut patch) = (EdgeStar::default(), Patch::default());
        let hubs = live.find_edge(0, 1).expect("an edge");
        // A side of its star may end at a hub that is not in it.
        let spoke = live.find_edge(0, 7).or(live.find_edge(1, 7));
        for edge in [Some(hubs), spoke].into_iter().flatten() {
            assert!(star.gather(&live, edge));
            star.patch(&live, star.midpoint(), &mut patch);
            let [_, after] = fold_amount(&live, &patch, -0.2);
            let expected = folded_after(&live, &patch, -0.2);
            let same = (after - expected).abs() < 1e-9;
            assert!(same, "{after}, not {expected}, edge {edge}, seed {seed}");
            folds += usize::from(expected > 0.0);
        }
    }
    assert!(folds > 40, "{folds}");
}

#[test]
fn a_hub_of_thousands_loses_its_faces_without_losing_track() {
    let mesh = disc(1_100);
    let live = live(&mesh);
    let mut engine = Engine::new(live, Rules::default(), Schedule::Lazy);
    for triangles in [1_060, 1_000, 480] {
        collapse(&mut engine, &mut Dice(1), triangles);
        assert!(engine.live().triangle_count() <= triangles);
        assert_consistent(engine.live());
    }
}

/// [`Dice`] that looks at few faces, and the most that it saw.
struct Modest(AtomicUsize);

impl Method for Modest {
    fn plan(&self) -> Plan {
        Plan {
            star_limit: 40,
            ..Plan::default()
        }
    }

    fn propose(&self, site: &Site<'_>, scratch: &mut MethodScratch) -> Result<Proposal, Refusal> {
        self.0.fetch_max(site.star.faces.len(), Ordering::Relaxed);
        Dice(3).propose(site, scratch)
    }

    fn committed(&mut self, _: &LiveMesh, _: &Patch) {}
}

#[test]
fn no_method_is_asked_about_more_faces_than_it_looks_at() {
    let mesh = disc(300);
    let live = live(&mesh);
    let mut method = Modest(AtomicUsize::new(0));
    let mut engine = Engine::new(live, Rules::default(), Schedule::Eager);
    collapse(&mut engine, &mut method, 10);
    let (live, counters) = engine.into_parts();
    let most = method.0.into_inner();
    assert!((30..=40).contains(&most), "{most}");
    assert!(counters.refusals.count(Refusal::Valence) > 200);
    // It is looked at again once it is small enough.
    assert!(live.triangle_count() <= 10, "{}", live.triangle_count());
}

/// Edges of a disc that are evaluated or estimated down to a number of triangles, but for those refused for their number of
/// faces.
fn looks(faces: u32, options: &Options, triangles: usize) -> u64 {
    let outcome = simplify(&disc(faces), options).expect("valid");
    assert!(outcome.mesh.triangles().len() <= triangles);
    let counters = outcome.phases.iter().map(|phase| &phase.counters);
    let looks = counters.map(|c| c.evaluations + c.estimates - c.refusals.count(Refusal::Valence));
    looks.sum()
}

#[test]
fn a_hub_is_not_looked_at_once_for_every_face_and_collapse() {
    let cell = ViewCell::point(DVec3::new(0.0, 0.0, 5.0)).expect("a point");
    let own = ToleranceOptions::new(Distance::OfDiagonal(0.005));
    let tolerance = Options::tolerance(own, Target::Triangles(100));
    let view_bounded = Options::view_bounded(ViewBoundedOptions::new(cell, 0.1), Target::ErrorOnly);
    // Where a hub has few enough faces all of it is looked at: only what more faces add is bounded, and a few collapses of
    // such a hub are enough.
    let target = Target::Triangles(480);
    for (few, many, most, triangles, options) in [
        (0, 2_000, 12.0, 100, tolerance),
        (0, 400, 12.0, 100, view_bounded),
        (600, 2_000, 16.0, 480, Options::memoryless(target)),
        (600, 2_000, 16.0, 480, Options::quadric(target)),
    ] {
        let looks = |faces| looks(faces, &options, triangles);
        let before = if few > 0 { looks(few) } else { 0 };
        let more = (looks(many) - before) as f64 / f64::from(many - few);
        let name = options.method.name();
        assert!(more < most, "{name}: {more} looks for each face");
    }
}

#[test]
fn a_vertex_that_is_not_there_has_no_edge_to_a_hub() {
    let mesh = disc(100);
    let live = live(&mesh);
    let unknown = live.vertex_ids();
    for hub in 0..unknown {
        assert_eq!(live.find_edge(hub, unknown), None);
        assert_eq!(live.find_edge(unknown, hub), None);
    }
}
