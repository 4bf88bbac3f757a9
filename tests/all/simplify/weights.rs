//! Weights: what weighs 1 stays whatever gives way, what weighs less is dearer by the law that is written down.

use std::collections::BTreeSet;

use glam::DVec3;
use lodmark::{
    Error,
    collapse::{
        Concession, EdgeStar, Engine, LiveMesh, Method, MethodScratch, Observer, Patch, Price,
        Proposal, Refusal, Replay, Rules, Schedule, Site, Topology,
    },
    mesh::{Mesh, canonical, generate},
    simplify::{
        Options, Outcome, Target,
        image::{ImageOptions, Preset, Size},
        simplify,
        visibility::VisibilityOptions,
    },
};

use crate::support::{Random, collapse, live, meshes, on_threads};

fn run(mesh: &Mesh, options: &Options) -> Outcome {
    simplify(mesh, options).expect("valid")
}

/// Weights of which about one in `n` is 1.
fn some_locked(mesh: &Mesh, n: usize, seed: u64) -> Vec<f32> {
    let mut random = Random(seed);
    let weight = |_: &DVec3| f32::from(u8::from(random.below(n) == 0));
    mesh.positions().iter().map(weight).collect()
}

/// True where every vertex of weight 1 has its very place in the result.
fn all_left(before: &Mesh, after: &Mesh, weights: &[f32]) -> bool {
    let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
    let left: BTreeSet<_> = after.positions().iter().map(bits).collect();
    let pairs = before.positions().iter().zip(weights);
    let mut locked = pairs.filter(|&(_, &weight)| weight >= 1.0);
    locked.all(|(p, _)| left.contains(&bits(p)))
}

/// Pictures of few pixels, and all that follows them.
fn small_pictures(target: Target) -> Options {
    let own = ImageOptions {
        size: Size::Pixels(16),
        ..ImageOptions::default()
    };
    Options::new(own, target)
}

#[test]
fn no_concession_and_no_polishing_moves_or_removes_a_vertex_of_weight_1() {
    let all = Target::Triangles(1);
    for (kind, mesh) in [
        meshes::cube(4, true, true),
        meshes::textured_torus(10, 6, 5, false),
        meshes::fins(6, 8),
        meshes::soup(30, 60, 3),
    ]
    .iter()
    .enumerate()
    {
        let mesh = canonical(mesh).mesh;
        let weights = some_locked(&mesh, 9, kind as u64);
        let locked = weights.iter().filter(|&&w| w >= 1.0).count();
        assert!(locked > 1, "{kind}");
        for (options, topology) in [
            (Options::memoryless(all), Topology::Auto),
            (Options::memoryless(all), Topology::Free),
            (Options::quadric(all), Topology::Free),
            (small_pictures(all), Topology::Auto),
        ] {
            for drop_pieces in [false, true] {
                // Several pieces are a reason to measure, at length, which of them is seen.
                let is_long = kind > 1 && topology == Topology::Auto;
                if is_long || drop_pieces && topology == Topology::Auto {
                    continue;
                }
                let mut options = options.clone().topology(topology);
                options = options.weights(weights.clone());
                options.rules.drop_pieces = drop_pieces;
                let outcome = run(&mesh, &options);
                let report = outcome.weights.expect("weights were given");
                assert!(all_left(&mesh, &outcome.mesh, &weights), "{kind}");
                assert_eq!((report.locked, report.held), (locked, locked));
                assert_eq!(outcome.locked_vertices, locked);
                assert!(outcome.mesh.triangles().len() < mesh.triangles().len());
            }
        }
    }
}

#[test]
fn a_piece_that_nobody_sees_stays_where_a_vertex_of_it_weighs_1() {
    let mut parts = generate::icosphere(2).into_parts();
    let outside = parts.positions.len();
    let tetrahedron = generate::tetrahedron();
    for k in 0..4 {
        let at = DVec3::new(0.2, 0.0, 0.0) * f64::from(k) - DVec3::X * 0.3;
        let first = parts.positions.len() as u32;
        let places = tetrahedron.positions().iter();
        parts.positions.extend(places.map(|&p| p * 0.05 + at));
        let faces = tetrahedron.triangles().iter();
        parts.triangles.extend(faces.map(|t| t.map(|v| v + first)));
    }
    let mesh = Mesh::new(parts).expect("valid");
    let mut weights = vec![0.0; mesh.positions().len()];
    for k in [0, 2] {
        weights[outside + 4 * k] = 1.0;
    }
    let seen: Vec<bool> = mesh
        .triangles()
        .iter()
        .map(|t| t[0] < outside as u32)
        .collect();
    let rules = Rules {
        concession: Concession::UnseenPieces,
        ..Rules::default()
    };
    for (weights, pieces) in [(&weights, 3), (&vec![0.0; weights.len()], 1)] {
        let mut live = live(&mesh);
        live.weigh(weights);
        assert_eq!(live.expend_unseen(&seen), [5, 4]);
        let mut engine = Engine::new(live, rules, Schedule::Lazy);
        collapse(&mut engine, &mut Priced(2), 1);
        let left = engine.live().to_mesh().expect("valid");
        assert!(all_left(&mesh, &left, weights));
        assert_eq!(engine.live().pieces(), pieces);
    }
}

#[test]
fn repaired_folds_and_both_results_that_pictures_choose_from_leave_locked_vertices_alone() {
    let mesh = canonical(&generate::torus(1.0, 0.4, 24, 12)).mesh;
    let weights = some_locked(&mesh, 12, 6);
    for (options, falls_back) in [
        (Options::memoryless(Target::Triangles(40)), None),
        (small_pictures(Target::Triangles(60)), Some(false)),
        (
            Options::image(Target::Triangles(400)).size(8).samples(1),
            Some(true),
        ),
    ] {
        let outcome = run(&mesh, &options.weights(weights.clone()));
        assert!(all_left(&mesh, &outcome.mesh, &weights));
        let fell_back = outcome.comparison().map(|c| c.fell_back);
        if falls_back == Some(true) {
            assert_eq!(fell_back, falls_back);
        }
        let report = outcome.weights.expect("weights were given");
        assert_eq!(report.held, report.locked);
    }
}

#[test]
fn weights_of_0_change_no_bit_and_neither_does_the_number_of_threads() {
    let mesh = canonical(&meshes::textured_torus(10, 6, 2, false)).mesh;
    for options in [
        Options::memoryless(Target::Ratio(0.3)),
        Options::image(Target::Ratio(0.3))
            .preset(Preset::Fast)
            .size(16),
    ] {
        let plain = run(&mesh, &options);
        let zero = vec![0.0; mesh.positions().len()];
        let zero = run(&mesh, &options.clone().weights(zero));
        assert_eq!(plain.mesh, zero.mesh);
        let report = zero.weights.expect("weights were given");
        assert_eq!((report.mean_kept, report.mean_removed), (0.0, 0.0));
        let mut random = Random(4);
        let weights = mesh.positions().iter().map(|_| random.unit() as f32);
        let options = options.weights(weights.collect());
        let [one, three] = [1, 3].map(|n| on_threads(n, || run(&mesh, &options).mesh));
        assert!(one == three && one != plain.mesh);
    }
}

#[test]
fn a_region_keeps_more_triangles_the_more_it_weighs_by_every_method() {
    let mesh = canonical(&meshes::torus(16, 10, 9)).mesh;
    let right = |p: &DVec3| p.x > 0.0;
    let mut seen = VisibilityOptions::default();
    (seen.measure.octahedron, seen.measure.size) = (1, 64);
    for options in [
        Options::memoryless(Target::Ratio(0.3)),
        Options::quadric(Target::Ratio(0.3)),
        Options::new(seen, Target::Ratio(0.3)),
        Options::image(Target::Ratio(0.3))
            .preset(Preset::Fast)
            .size(16),
    ] {
        let mut counts = Vec::new();
        for weight in [0.0_f32, 0.7, 0.97] {
            let weights = mesh.positions().iter().map(|p| match right(p) {
                true => weight,
                false => 0.0,
            });
            let outcome = run(&mesh, &options.clone().weights(weights.collect()));
            let report = outcome.weights.expect("weights were given");
            assert!(weight == 0.0 || report.mean_kept > report.mean_removed);
            counts.push(outcome.mesh.positions().iter().filter(|p| right(p)).count());
        }
        assert!(
            counts[0] < counts[1] && counts[1] <= counts[2],
            "{counts:?}"
        );
    }
}

/// Prices edges by their ends, at random; places new vertices in the middle.
struct Priced(u64);

impl Priced {
    fn price(&self, [u, w]: [u32; 2]) -> i64 {
        let mut random = Random(self.0 ^ u64::from(u) << 32 ^ u64::from(w));
        (random.next() % 2_000_001) as i64 - 1_000_000
    }
}

impl Method for Priced {
    fn propose(&self, site: &Site<'_>, _: &mut MethodScratch) -> Result<Proposal, Refusal> {
        let [p, q] = site.star.points;
        Ok(Proposal {
            position: site.admit(site.fixed().unwrap_or((p + q) * 0.5))?,
            primary: self.price(site.star.ends),
            secondary: 0.0,
        })
    }

    fn committed(&mut self, _: &LiveMesh, _: &Patch) {}
}

/// The ends of the first collapse.
#[derive(Default)]
struct First(Option<[u32; 2]>);

impl Observer for First {
    fn committed(&mut self, _: &LiveMesh, patch: &Patch) {
        let kept = patch.moved.expect("a collapse moves a vertex").vertex;
        let gone = patch.gone.expect("a collapse removes a vertex");
        self.0.get_or_insert([kept, gone]);
    }
}

#[test]
fn every_collapse_is_the_cheapest_by_the_law_and_the_heavier_of_two_vertices_leaves_its_weight() {
    for seed in 0..3 {
        let mesh = meshes::torus(7, 5, seed);
        let mut random = Random(seed);
        let choices = [0.0, 0.0, 0.25, 0.5, 0.875, 0.999, 1.0];
        let mut weights: Vec<f32> = vec![0.0; mesh.positions().len()];
        weights.fill_with(|| choices[random.below(choices.len())]);
        let mut weighed = live(&mesh);
        weighed.weigh(&weights);
        // Folds depend on faces beyond the star, whose edges no queue watches.
        let rules = Rules {
            fold_cosine: -1.0,
            ..Rules::default()
        };
        let mut engine = Engine::new(weighed, rules, Schedule::Eager);
        let (prices, mut method) = (Priced(seed), Priced(seed));
        let mut collapses = 0;
        loop {
            let live = engine.live();
            // The law once more, in floating point.
            let dear = |ends: [u32; 2]| {
                let movable = ends.iter().map(|&v| weights[v as usize]);
                let w = movable.filter(|&w| w < 1.0).fold(0.0, f32::max);
                let (price, rest) = (prices.price(ends) as f64, 1.0 - f64::from(w));
                if price > 0.0 {
                    price / rest
                } else {
                    price * rest
                }
            };
            let is_legal = |&e: &u32| {
                let mut star = EdgeStar::default();
                star.gather(live, e);
                let site = Site::new(live, &star, rules);
                let found = site.map(|s| prices.propose(&s, &mut MethodScratch::default()));
                matches!(found, Ok(Ok(_)))
            };
            let edges = (0..live.edge_ids()).filter(|&e| live.edge(e).is_some());
            let legal: Vec<u32> = edges.filter(is_legal).collect();
            let costs = legal.iter().filter_map(|&e| live.edge(e)).map(dear);
            let least = costs.fold(f64::INFINITY, f64::min);
            let target = live.triangle_count() - 1;
            let mut first = First::default();
            let stop = engine.run(&mut method, target, &mut first, &lodmark::Silent);
            stop.expect("nobody interrupts");
            let Some([kept, gone]) = first.0 else {
                assert_eq!(legal, [0_u32; 0]);
                break;
            };
            // Whole numbers, and weights in 1/65536.
            let cost = dear([kept, gone]);
            let off = 2.0 + least.abs() * 0.01;
            assert!((cost - least).abs() <= off, "{cost}, not {least}");
            let [a, b] = [kept, gone].map(|v| v as usize);
            weights[a] = weights[a].max(weights[b]);
            assert!(weights[a].total_cmp(&engine.live().weight(kept)).is_eq());
            collapses += 1;
        }
        assert!(collapses > 5, "{collapses}");
    }
}

#[test]
fn a_price_keeps_signs_and_the_order_of_what_costs_something() {
    let mut random = Random(5);
    for _ in 0..2_000 {
        let price = Price::of_weight(random.unit() as f32);
        let mut costs = [0; 2].map(|_: i64| (random.next() as i64) >> (16 + random.below(47)));
        costs.sort_unstable();
        let [a, b] = costs.map(|cost| price.of_count(cost));
        assert!(a <= b && a.signum() == costs[0].signum());
        assert!(costs[0] == costs[1] || costs[0] <= 0 || a < b, "{costs:?}");
    }
    for cost in [i64::MIN, -1, 0, 1, i64::MAX] {
        assert_eq!(Price::of_weight(0.0).of_count(cost), cost);
        assert_eq!(Price::of_weight(1.0).of_count(cost).signum(), cost.signum());
    }
    let half = Price::of_weight(0.5);
    assert_eq!([3, -3].map(|c| half.of_count(c)), [6, -2]);
    assert_eq!((half.of(3.0), half.of(-3.0)), (6.0, -1.5));
    assert!(half.of(f64::NAN).is_nan());
}

#[test]
fn replay_needs_no_weights_and_the_record_names_them_by_their_hash() {
    let mesh = canonical(&meshes::torus(14, 8, 3)).mesh;
    let weights: Vec<f32> = (0..mesh.positions().len())
        .map(|i| (i % 3) as f32 / 2.0)
        .collect();
    let options = Options::memoryless(Target::Triangles(60)).weights(weights);
    let outcome = run(&mesh, &options);
    let mut replay = Replay::new(&mesh, &outcome.history).expect("its mesh");
    replay.seek(60).expect("replays");
    assert_eq!(replay.live().to_mesh().expect("a mesh"), outcome.mesh);
    let json: serde_json::Value =
        serde_json::from_str(&outcome.history.header().options).expect("JSON");
    let recorded = &json["weights"];
    assert_eq!(recorded["vertices"], mesh.positions().len());
    assert_eq!(recorded["sha256"].as_str().map(str::len), Some(64));
    assert_eq!(recorded.as_object().map(serde_json::Map::len), Some(2));
    // The record alone cannot be run, and says so.
    let again: Options = serde_json::from_value(json).expect("options");
    let refused = simplify(&mesh, &again).expect_err("the numbers are missing");
    assert!(matches!(&refused, Error::Usage(told) if told.contains("hash")));
}

#[test]
fn weights_that_are_none_are_refused_with_what_was_expected() {
    let mesh = generate::icosphere(1);
    let count = mesh.positions().len();
    let options = Options::memoryless(Target::Triangles(20));
    for wrong in [-0.1, 1.1, f32::NAN, f32::INFINITY] {
        let mut weights = vec![0.5; count];
        weights[7] = wrong;
        let refused = simplify(&mesh, &options.clone().weights(weights)).expect_err("refused");
        assert!(matches!(&refused, Error::Usage(told) if told.contains("vertex 7")));
    }
    for wrong in [0, count - 1, count + 1] {
        let weights = options.clone().weights(vec![0.5; wrong]);
        let refused = simplify(&mesh, &weights).expect_err("refused").to_string();
        let both = [wrong, count].map(|n| refused.contains(&n.to_string()));
        assert_eq!(both, [true; 2], "{refused}");
    }
}

#[test]
fn a_mesh_of_weight_1_is_left_as_it_is() {
    let mesh = canonical(&meshes::torus(8, 6, 1)).mesh;
    let weights = vec![1.0; mesh.positions().len()];
    let outcome = run(
        &mesh,
        &Options::memoryless(Target::Triangles(9)).weights(weights.clone()),
    );
    assert_eq!(outcome.mesh, mesh);
    let mut engine = Engine::new(live(&mesh), Rules::default(), Schedule::Lazy);
    collapse(&mut engine, &mut Priced(1), 20);
    assert!(!all_left(
        &mesh,
        &engine.live().to_mesh().expect("valid"),
        &weights
    ));
}
