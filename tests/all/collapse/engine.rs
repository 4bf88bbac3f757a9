//! The engine and what it stands on: live mesh, stars, rules, queue.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use lodmark::{
    Silent,
    collapse::{
        Changes, EdgeStar, Engine, Evaluation, Heap, Key, LiveMesh, Method, MethodScratch, NONE,
        Observer, Patch, Plan, Proposal, Refusal, Rules, Schedule, Site, Topology,
    },
    mesh::Mesh,
    num::Frame,
    simplify::{Options, Stop, Target, memoryless::Memoryless, simplify},
};
use proptest::prelude::*;

use crate::support::{Random, collapse, live, meshes, same_on_all_threads};

/// Places at random on the edge and prices at random: reaches states that a sensible method never would.
pub(crate) struct Dice(pub(crate) u64);

impl Method for Dice {
    fn propose(&self, site: &Site<'_>, _: &mut MethodScratch) -> Result<Proposal, Refusal> {
        let [u, w] = site.star.ends;
        let mut random = Random(self.0 ^ u64::from(u) << 32 ^ u64::from(w));
        let [p, q] = site.star.points;
        let wanted = site.fixed().unwrap_or_else(|| p + (q - p) * random.unit());
        Ok(Proposal {
            position: site.admit(wanted)?,
            primary: (random.next() % 7) as i64 - 3,
            secondary: random.unit(),
        })
    }

    fn committed(&mut self, _: &LiveMesh, _: &Patch) {}
}

/// Prices as [`Dice`] does, and roughly with an error from a range.
#[derive(Clone)]
struct Rough {
    seed: u64,
    off: std::ops::Range<i64>,
}

impl Rough {
    fn price(&self, [u, w]: [u32; 2]) -> [i64; 2] {
        let mut random = Random(self.seed ^ u64::from(u) << 32 ^ u64::from(w));
        random.unit();
        let price = (random.next() % 7) as i64 - 3;
        let length = (self.off.end - self.off.start) as u64;
        [price, self.off.start + (random.next() % length) as i64]
    }
}

impl Method for Rough {
    fn plan(&self) -> Plan {
        Plan {
            rough_first: true,
            ..Plan::default()
        }
    }

    fn propose(&self, site: &Site<'_>, scratch: &mut MethodScratch) -> Result<Proposal, Refusal> {
        let [price, off] = self.price(site.star.ends);
        let proposal = Dice(self.seed).propose(site, scratch)?;
        Ok(Proposal {
            primary: match site.accuracy {
                Evaluation::Exact => price,
                Evaluation::Rough => price + off,
            },
            ..proposal
        })
    }

    fn committed(&mut self, _: &LiveMesh, _: &Patch) {}
}

/// Holds the price of every collapse against the dice's.
struct Exact(Rough, i64);

impl Observer for Exact {
    fn chosen(&mut self, proposal: &Proposal) {
        self.1 = proposal.primary;
    }

    fn committed(&mut self, _: &LiveMesh, patch: &Patch) {
        let kept = patch.moved.expect("a collapse moves a vertex").vertex;
        let gone = patch.gone.expect("a collapse removes a vertex");
        assert_eq!(self.1, self.0.price([kept, gone])[0]);
    }
}

type EdgeCounts = BTreeMap<[u32; 2], u32>;

fn live_triangles(live: &LiveMesh) -> Vec<(u32, [u32; 3])> {
    (0..live.triangle_ids())
        .filter_map(|t| Some((t, live.triangle(t)?)))
        .collect()
}

fn edge_counts(triangles: impl Iterator<Item = [u32; 3]>) -> EdgeCounts {
    let mut counts = EdgeCounts::new();
    for [a, b, c] in triangles {
        for [x, y] in [[a, b], [b, c], [c, a]] {
            *counts.entry([x.min(y), x.max(y)]).or_default() += 1;
        }
    }
    counts
}

/// Everything the live mesh says about adjacency, against a rebuild from its triangles.
pub(crate) fn assert_consistent(live: &LiveMesh) {
    let triangles = live_triangles(live);
    assert_eq!(triangles.len(), live.triangle_count());
    let mut at: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &(t, corners) in &triangles {
        for v in corners {
            at.entry(v).or_default().push(t);
        }
    }
    let counts = edge_counts(triangles.iter().map(|&(_, c)| c));
    for v in 0..live.vertex_ids() {
        let mut found: Vec<u32> = live.triangles_at(v).collect();
        found.sort_unstable();
        assert_eq!(found, at.get(&v).cloned().unwrap_or_default(), "vertex {v}");
        let edges = live
            .edges_at(v)
            .map(|e| live.edge(e).expect("a listed edge is in use"));
        let edges: BTreeSet<[u32; 2]> = edges.collect();
        let count = live.edges_at(v).count();
        assert_eq!(edges.len(), count, "an edge twice at {v}");
        let expected: BTreeSet<[u32; 2]> =
            counts.keys().copied().filter(|e| e.contains(&v)).collect();
        assert_eq!(edges, expected, "edges at {v}");
    }
    let mut found = EdgeCounts::new();
    for e in 0..live.edge_ids() {
        if let Some(ends) = live.edge(e) {
            assert!(found.insert(ends, live.faces_at_edge(e)).is_none());
            assert_eq!(live.find_edge(ends[1], ends[0]), Some(e));
        }
    }
    assert_eq!(found, counts);
}

/// Of the complex: faces with the same vertices are one.
fn euler(triangles: &[[u32; 3]]) -> i64 {
    let faces = triangles.len() - duplicates(triangles);
    let vertices: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let edges = edge_counts(triangles.iter().copied()).len();
    vertices.len() as i64 - edges as i64 + faces as i64
}

/// Connected groups of `items`, where `linked` items belong together.
pub(crate) fn groups(count: usize, linked: impl Fn(usize, usize) -> bool) -> usize {
    let mut seen = vec![false; count];
    let mut groups = 0;
    for start in 0..count {
        if seen[start] {
            continue;
        }
        groups += 1;
        let mut stack = vec![start];
        seen[start] = true;
        while let Some(i) = stack.pop() {
            for (j, seen) in seen.iter_mut().enumerate() {
                if !*seen && linked(i, j) {
                    *seen = true;
                    stack.push(j);
                }
            }
        }
    }
    groups
}

fn boundary_loops(triangles: &[[u32; 3]]) -> usize {
    let edges = edge_counts(triangles.iter().copied()).into_iter();
    let edges: Vec<[u32; 2]> = edges.filter_map(|(e, n)| (n == 1).then_some(e)).collect();
    groups(edges.len(), |i, j| {
        edges[i].iter().any(|v| edges[j].contains(v))
    })
}

fn duplicates(triangles: &[[u32; 3]]) -> usize {
    let mut sets = triangles.to_vec();
    sets.iter_mut().for_each(|t| t.sort_unstable());
    triangles.len() - sets.into_iter().collect::<BTreeSet<_>>().len()
}

fn plain(live: &LiveMesh) -> Vec<[u32; 3]> {
    live_triangles(live).into_iter().map(|(_, c)| c).collect()
}

fn unit_normal([a, b, c]: [DVec3; 3]) -> Option<DVec3> {
    (b - a).cross(c - a).try_normalize()
}

/// Tests every commit.
struct Witness {
    normals: bool,
}

impl Observer for Witness {
    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        assert_consistent(live);
        let moved = patch.moved.expect("a collapse moves its vertex");
        assert_eq!(live.position(moved.vertex), moved.to);
        assert_eq!(live.round(moved.to), Some(moved.to), "not rounded");
        assert!(Some(moved.vertex) < patch.gone, "the smaller id survives");
        for new in &patch.added {
            let old = patch.removed.iter().find(|f| f.id == new.id);
            let old = old.expect("a collapse makes no new id");
            assert_eq!(live.triangle(new.id), Some(new.corners));
            assert_eq!(live.wedges(new.id), new.wedges);
            if self.normals {
                let before = unit_normal(patch.before(live, old)).expect("had an area");
                let after = unit_normal(patch.after(live, new)).expect("has an area");
                assert!(before.dot(after) > 0.1999, "face {} turned", new.id);
            }
        }
    }
}

fn run(mesh: &Mesh, seed: u64, topology: Topology, triangles: usize) -> (LiveMesh, Stop) {
    let live = live(mesh);
    let rules = Rules {
        topology,
        ..Rules::default()
    };
    let mut engine = Engine::new(live, rules, Schedule::Lazy);
    let normals = plain(engine.live())
        .iter()
        .all(|t| unit_normal(t.map(|v| engine.live().position(v))).is_some());
    let mut witness = Witness { normals };
    let stop = engine.run(&mut Dice(seed), triangles, &mut witness, &Silent);
    (engine.into_parts().0, stop.expect("nobody interrupts"))
}

proptest! {
    #![proptest_config(crate::support::cases(48))]

    #[test]
    fn after_every_collapse_adjacency_is_what_a_rebuild_finds(
        kind in 0_usize..8, seed: u64, free: bool,
    ) {
        let topology = if free { Topology::Free } else { Topology::Preserve };
        run(&meshes::any(kind, seed), seed, topology, 1);
    }

    #[test]
    fn preserved_topology_keeps_euler_characteristic_and_boundary_loops(
        kind in 0_usize..8, seed: u64,
    ) {
        let mesh = meshes::any(kind, seed);
        let before = LiveMesh::new(&mesh, Frame::default());
        let (after, _) = run(&mesh, seed, Topology::Preserve, 1);
        prop_assert_eq!(euler(&plain(&before)), euler(&plain(&after)));
        if !matches!(kind, 2 | 3 | 7) {
            prop_assert_eq!(boundary_loops(&plain(&before)), boundary_loops(&plain(&after)));
            prop_assert!(edge_counts(plain(&after).into_iter()).values().all(|&c| c <= 2));
        }
        prop_assert!(after.triangle_count() > 0);
    }

    #[test]
    fn no_collapse_makes_duplicate_or_degenerate_faces(
        kind in 0_usize..8, seed: u64, free: bool,
    ) {
        let mesh = meshes::any(kind, seed);
        let topology = if free { Topology::Free } else { Topology::Preserve };
        let before = LiveMesh::new(&mesh, Frame::default());
        let (after, _) = run(&mesh, seed, topology, 1);
        prop_assert!(duplicates(&plain(&after)) <= duplicates(&plain(&before)));
        prop_assert!(plain(&after).iter().all(|[a, b, c]| a != b && b != c && c != a));
        prop_assert!(after.triangle_count() > 0, "nothing is left");
    }

    #[test]
    fn the_order_of_lists_decides_nothing(kind in 0_usize..8, seed: u64, steps in 1_usize..12) {
        let mesh = meshes::any(kind, seed);
        // Collapses taken back leave the same mesh with its lists in another order.
        let mut shuffled = live(&mesh);
        let fresh = shuffled.clone();
        let (mut star, mut patch, mut changes) = (EdgeStar::default(), Patch::default(), Changes::default());
        let mut random = Random(seed);
        let mut done: Vec<Patch> = Vec::new();
        for _ in 0..steps {
            let edge = random.below(shuffled.edge_ids().max(1) as usize) as u32;
            if edge < shuffled.edge_ids() && star.gather(&shuffled, edge) {
                let middle = shuffled.round(star.midpoint()).expect("finite");
                star.patch(&shuffled, middle, &mut patch);
                shuffled.apply(&patch, &mut changes);
                done.push(patch.clone());
            }
        }
        while let Some(p) = done.pop() {
            shuffled.revert(&p.removed, p.moved, p.rows.len(), &mut changes);
            assert_consistent(&shuffled);
        }
        prop_assert_eq!(shuffled.to_mesh().expect("a mesh"), fresh.to_mesh().expect("a mesh"));
        let finish = |live: LiveMesh| {
            let mut engine = Engine::new(live, Rules::default(), Schedule::Lazy);
            collapse(&mut engine, &mut Dice(seed), 8);
            engine.into_parts().0.to_mesh().expect("a mesh")
        };
        prop_assert_eq!(finish(shuffled), finish(fresh));
    }

    #[test]
    fn the_heap_gives_what_sorting_gives(
        operations in prop::collection::vec((0_u8..4, 0_u32..24, -2_i64..3, 0_u8..3), 0..200),
        start in 0_u32..24,
    ) {
        let key = |id: u32, primary: i64, g: u8| Key {
            primary,
            secondary: [-0.0, 0.0, f64::INFINITY][g as usize],
            length2: 1.0,
            edge: [id, id + 1],
        };
        let mut model: Vec<(Key, u32)> = (0..start).map(|id| (key(id, i64::from(id % 3), 1), id)).collect();
        let mut heap = Heap::of(model.clone());
        for (operation, id, image, g) in operations {
            let at = model.iter().position(|&(_, i)| i == id);
            match operation {
                0 | 1 => {
                    let key = key(id, image, g);
                    match at {
                        Some(at) => model[at].0 = key,
                        None => model.push((key, id)),
                    }
                    heap.set(id, key);
                }
                2 => {
                    let expected = at.map(|at| model.swap_remove(at).0);
                    prop_assert_eq!(heap.remove(id), expected);
                }
                _ => {
                    model.sort_unstable();
                    let expected = (!model.is_empty()).then(|| model.remove(0));
                    prop_assert_eq!(heap.pop(), expected);
                }
            }
            prop_assert_eq!(heap.peek(), model.iter().min().copied());
            prop_assert_eq!(heap.key(id), model.iter().find(|(_, i)| *i == id).map(|e| e.0));
        }
        model.sort_unstable();
        for expected in model.into_iter().map(Some).chain([None]) {
            prop_assert_eq!(heap.pop(), expected);
        }
    }
}

#[test]
fn thread_counts_give_equal_meshes_and_counters() {
    let mesh = meshes::torus(40, 24, 5);
    for schedule in [Schedule::Lazy, Schedule::Semi, Schedule::Eager] {
        let options = Options::memoryless(Target::triangles(300)).schedule(schedule);
        same_on_all_threads(|| {
            let outcome = simplify(&mesh, &options).expect("valid");
            (outcome.mesh, outcome.history.to_bytes(), outcome.phases)
        });
    }
}

#[test]
fn an_eager_queue_takes_the_cheapest_edge_every_time() {
    let mesh = meshes::torus(16, 10, 3);
    let live = live(&mesh);
    let mut method = Memoryless::default();
    let mut engine = Engine::new(live, Rules::default(), Schedule::Eager).with_rank_measured(1);
    collapse(&mut engine, &mut method, 60);
    let counters = engine.counters();
    let ranks = &counters.ranks;
    assert_eq!(ranks.len() as u64, counters.collapses);
    assert!(ranks.iter().all(|&rank| rank == 0.0), "{ranks:?}");
    assert_eq!(counters.evaluations, counters.evaluations_if_eager);
}

#[test]
fn no_edge_is_collapsed_at_a_rough_price_and_cheap_rough_prices_change_no_order() {
    let mesh = meshes::torus(16, 10, 3);
    // Folds look beyond the star, so when an edge is evaluated would matter.
    let rules = Rules {
        fold_cosine: -1.0,
        ..Rules::default()
    };
    for seed in 0..20 {
        let run = |off: std::ops::Range<i64>, schedule| {
            let live = live(&mesh);
            let mut method = Rough { seed, off };
            let mut exact = Exact(method.clone(), 0);
            let mut engine = Engine::new(live, rules, schedule).with_rank_measured(1);
            let stop = engine.run(&mut method, 60, &mut exact, &Silent);
            stop.expect("nobody interrupts");
            let (live, counters) = engine.into_parts();
            (live.to_mesh().expect("a mesh"), counters)
        };
        let live = live(&mesh);
        let mut engine = Engine::new(live, rules, Schedule::Eager).with_rank_measured(1);
        collapse(&mut engine, &mut Dice(seed), 60);
        let (exact, expected) = engine.into_parts();
        let exact = exact.to_mesh().expect("a mesh");
        let (cheap, counters) = run(-4..1, Schedule::Eager);
        assert_eq!(cheap, exact);
        // A rough price below the exact one is no reason to overlook an edge.
        assert_eq!(counters.ranks, expected.ranks);
        assert_eq!(counters.estimates, counters.evaluations_if_eager);
        assert!(counters.evaluations < counters.estimates / 2);
        // Any rough price will do for the rest, and any schedule.
        for schedule in [Schedule::Lazy, Schedule::Semi, Schedule::Eager] {
            run(-4..5, schedule);
        }
    }
}

#[test]
fn a_lazy_queue_evaluates_less_and_ranks_near_the_front() {
    let mesh = meshes::torus(24, 16, 3);
    let live = live(&mesh);
    let mut method = Memoryless::default();
    let mut engine = Engine::new(live, Rules::default(), Schedule::Lazy).with_rank_measured(5);
    collapse(&mut engine, &mut method, 100);
    let counters = engine.counters();
    assert!(counters.evaluations < counters.evaluations_if_eager / 2);
    let mean = counters.ranks.iter().sum::<f64>() / counters.ranks.len() as f64;
    assert!(mean < 0.1, "mean rank {mean}");
}

#[test]
fn a_locked_vertex_stays_where_it_is() {
    let mesh = meshes::grid(8, 1);
    let mut live = live(&mesh);
    let locked = [0_u32, 8, 40, 72, 80];
    for v in locked {
        live.set_locked(v, true);
    }
    let places = locked.map(|v| live.position(v));
    let mut engine = Engine::new(live, Rules::default(), Schedule::Lazy);
    collapse(&mut engine, &mut Dice(1), 2);
    let left = engine.live().to_mesh().expect("valid");
    let frame = engine.live().frame();
    for p in places {
        assert!(left.positions().contains(&frame.leave(p)), "{p} is gone");
    }
}

#[test]
fn a_tetrahedron_and_a_lone_triangle_are_left_alone() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let closed = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    for triangles in [closed, vec![[0, 1, 2]]] {
        let mesh = Mesh::from_triangles(positions.clone(), triangles.clone()).expect("valid");
        let (live, stop) = run(&mesh, 0, Topology::Preserve, 0);
        assert_eq!(plain(&live), triangles);
        let Stop::NoLegalCollapse { refusals: blocked } = stop else {
            panic!("{stop:?}");
        };
        let rules = [Refusal::LastTriangle, Refusal::Duplicate];
        let rule = rules[usize::from(triangles.len() == 4)];
        assert_eq!(blocked.count(rule), blocked.total());
    }
}

#[test]
fn an_edge_between_two_boundaries_does_not_pinch_the_surface() {
    // A strip two triangles wide, open everywhere: its inner edges join boundary vertices.
    let positions = (0..8)
        .map(|i| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0))
        .collect();
    let triangles = (0..3).flat_map(|i| {
        let a = 2 * i;
        [[a, a + 2, a + 1], [a + 1, a + 2, a + 3]]
    });
    let mesh = Mesh::from_triangles(positions, triangles.collect()).expect("valid");
    let live = LiveMesh::new(&mesh, Frame::default());
    let mut star = EdgeStar::default();
    assert!(star.gather(&live, live.find_edge(2, 3).expect("an edge")));
    let refused = Site::new(&live, &star, Rules::default()).err();
    assert_eq!(refused, Some(Refusal::Pinch));
    assert!(star.gather(&live, live.find_edge(2, 4).expect("an edge")));
    assert!(Site::new(&live, &star, Rules::default()).is_ok());
}

#[test]
fn a_handle_is_not_closed_and_free_topology_may_close_it() {
    let mesh = meshes::torus(3, 8, 2);
    let live = LiveMesh::new(&mesh, Frame::default());
    // Vertices 0, 8, 16 form a cycle of three edges around the torus and no face.
    let mut star = EdgeStar::default();
    assert!(star.gather(&live, live.find_edge(0, 8).expect("an edge")));
    let refused = Site::new(&live, &star, Rules::default()).err();
    assert_eq!(refused, Some(Refusal::Link));
    let free = Rules {
        topology: Topology::Free,
        ..Rules::default()
    };
    assert!(Site::new(&live, &star, free).is_ok());
}

#[test]
fn a_sheet_with_two_sides_is_simplified_as_one() {
    let mut parts = meshes::grid(10, 3).into_parts();
    let back: Vec<[u32; 3]> = parts.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    parts.triangles.extend(back);
    let mesh = Mesh::new(parts).expect("valid");
    let outcome = simplify(&mesh, &Options::memoryless(Target::Triangles(80)));
    let outcome = outcome.expect("valid");
    assert_eq!(outcome.stop, Stop::TargetReached);
    let triangles = outcome.mesh.triangles();
    assert_eq!(duplicates(triangles), triangles.len() / 2);
}

#[test]
fn dead_ids_and_meshes_without_attributes_have_no_wedges() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mesh = Mesh::from_triangles(positions, vec![[0, 0, 1], [0, 1, 2]]);
    let live = LiveMesh::new(&mesh.expect("valid"), Frame::default());
    assert_eq!(live.triangle(0), None);
    assert_eq!(live.wedges(1), [NONE; 3]);
    assert_eq!(live.triangle_count(), 1);
}
