//! Image-driven simplification against whole pictures drawn from scratch, on every kind of mesh and view.

use glam::DVec3;
use lodmark::{
    Silent,
    collapse::{
        Changes, EdgeStar, Engine, LiveMesh, Observer, Patch, Proposal, Rules, Schedule, Site,
        Topology,
    },
    mesh::{Mesh, canonical, generate, weld},
    num::{fixed::SubpixelBits, math},
    raster,
    simplify::{
        self, MethodOptions, Options, Stop, Target,
        image::{EngineName, ImageDriven, Pictures, Preset, ReferenceImages, Size, Start},
        memoryless::{self, MemorylessOptions},
    },
    view::{
        Cull, Interpolation, Projection, Shading, Specular, Sphere, View, ViewSet,
        sets::dodecahedron,
    },
};

use crate::support::{collapse, framed, meshes, same_on_all_threads, scene_of, snapshot};

fn method(original: &Mesh, live: &LiveMesh, set: &ViewSet, price: f64) -> ImageDriven {
    let pictures = Pictures::new(&reference(original, set), live, EngineName::Buckets);
    ImageDriven::new(pictures, MemorylessOptions::default(), None).with_swept_price(price)
}

/// The pictures of `original`, in units of the frame of `set`.
pub(crate) fn reference(original: &Mesh, set: &ViewSet) -> ReferenceImages {
    ReferenceImages::draw(&scene_of(original), set.clone(), &Silent).expect("not interrupted")
}

/// Sum of squared luma differences, by drawing everything.
pub(crate) fn error(original: &Mesh, current: &Mesh, set: &ViewSet) -> i64 {
    let (a, b) = (scene_of(original), scene_of(current));
    let view = |view: &View| -> i64 {
        let [x, y] = [&a, &b].map(|scene| raster::luma_sums(scene, view, set));
        let pairs = x.values().iter().zip(y.values());
        pairs
            .map(|(&x, &y)| (i64::from(x) - i64::from(y)).pow(2))
            .sum()
    };
    set.views.iter().map(view).sum()
}

/// Meshes with everything that makes surgery hard.
pub(crate) fn meshes() -> Vec<(&'static str, Mesh)> {
    let mesh = |positions: &[[f64; 3]], triangles: Vec<[u32; 3]>| {
        let positions = positions.iter().map(|&p| DVec3::from_array(p)).collect();
        Mesh::from_triangles(positions, triangles).expect("valid")
    };
    // Three sheets of squares at one common edge.
    let (mut book, mut pages) = (Vec::new(), Vec::new());
    for page in 0..3_u32 {
        let (x, z) = [(1.0, 0.1), (-0.7, 0.6), (-0.3, -0.9)][page as usize];
        for i in 0..4_u32 {
            for j in 0..3_u32 {
                let (s, t) = (f64::from(i) / 3.0, f64::from(j) * 0.5);
                book.push([x * s, t, z * s + 0.05 * s * t]);
            }
        }
        for (i, j) in (0..3_u32).flat_map(|i| (0..2_u32).map(move |j| (i, j))) {
            let v = |i, j| page * 12 + i * 3 + j;
            pages.extend([
                [v(i, j), v(i + 1, j), v(i + 1, j + 1)],
                [v(i, j), v(i + 1, j + 1), v(i, j + 1)],
            ]);
        }
    }
    // A fan with every face twice, the second time turned over.
    let rim = [
        [0.0, 0.0, 0.4],
        [1.0, 0.0, 0.0],
        [0.4, 0.9, 0.1],
        [-0.6, 0.8, 0.0],
        [-1.0, -0.1, 0.2],
        [0.1, -1.0, 0.0],
    ];
    let fan = (1..6).flat_map(|i| {
        let next = i % 5 + 1;
        [[0, i, next], [0, next, i]]
    });
    let book = canonical(&weld(mesh(&book, pages)).mesh).mesh;
    vec![
        ("closed", generate::icosphere(1)),
        ("hidden", generate::by_name("probe").expect("a generator")),
        ("open", generate::grid(6, 5, generate::Height::Polynomial)),
        ("non-manifold", book),
        ("duplicate faces", mesh(&rim, fan.collect())),
        ("seams", canonical(&generate::textured_torus(10, 6)).mesh),
        (
            "hard normals",
            canonical(&meshes::textured_torus(7, 5, 3, true)).mesh,
        ),
    ]
}

pub(crate) fn view_sets(sphere: &Sphere) -> Vec<(&'static str, ViewSet)> {
    let around = |projection| {
        let directions: Vec<DVec3> = dodecahedron().into_iter().step_by(5).collect();
        ViewSet::around(sphere, &directions, 40, 32, projection).expect("views")
    };
    let outside = around(Projection::Perspective);
    let gouraud = Shading {
        interpolation: Interpolation::Gouraud,
        ..Shading::default()
    };
    let lit = Shading {
        interpolation: Interpolation::Lit,
        ..Shading::default()
    };
    let specular = Some(Specular {
        strength: 0.5,
        exponent: 12,
    });
    let ahead = sphere.center + DVec3::new(0.3, 0.2, 1.0);
    let range = [0.1 * sphere.radius, 4.0 * sphere.radius];
    let inside = View::perspective([sphere.center, ahead, DVec3::Y], range, [40, 32]);
    let inside = ViewSet {
        views: vec![inside.expect("a view")],
        ..outside.clone()
    };
    let one_sided = Shading {
        two_sided: false,
        ..Shading::default()
    };
    let shiny = Shading {
        specular,
        ..gouraud
    };
    let all = || outside.clone();
    let interior = all().with_interior_views(2).expect("enough views");
    let culled = all().with_shading(one_sided).with_cull(Cull::Back);
    vec![
        ("flat", all()),
        ("Gouraud", all().with_shading(gouraud)),
        ("specular Gouraud", all().with_shading(shiny)),
        ("one-sided, backs culled", culled),
        ("interior", interior),
        ("orthographic", around(Projection::Orthographic)),
        ("16 bits", all().with_subpixel(SubpixelBits::Sixteen)),
        ("2 x 2 samples", all().with_samples(2).expect("small")),
        ("lit", all().with_shading(lit)),
        ("inside, near-clipped", inside),
    ]
}

/// Nothing may collapse in a fan of duplicates unless the topology is free.
fn rules(mesh_name: &str) -> Rules {
    let topology = match mesh_name {
        "duplicate faces" | "non-manifold" => Topology::Free,
        _ => Topology::Preserve,
    };
    Rules {
        topology,
        ..Rules::default()
    }
}

#[test]
fn maintained_pictures_and_error_never_drift_from_those_drawn_from_scratch() {
    for (mesh_name, mesh) in meshes() {
        let (frame, original, sphere) = framed(&mesh);
        for (view_name, set) in view_sets(&sphere) {
            let name = format!("{mesh_name}, {view_name}");
            let live = LiveMesh::new(&mesh, frame);
            let mut method = method(&original, &live, &set, 0.0);
            let mut engine = Engine::new(live, rules(mesh_name), Schedule::Lazy);
            let mut steps = 0;
            while engine.live().triangle_count() > 4 && steps < 24 {
                let before = engine.live().triangle_count();
                collapse(&mut engine, &mut method, before - 1);
                if engine.live().triangle_count() == before {
                    break;
                }
                steps += 1;
                let now = snapshot(engine.live());
                let (scene, pictures) = (scene_of(&now), method.pictures());
                for (i, view) in set.views.iter().enumerate() {
                    let fresh = raster::luma(&scene, view, &set);
                    assert!(fresh.tones == pictures.engine().luma(i), "{name}");
                }
                let expected = error(&original, &now, &set);
                assert_eq!(pictures.sum() as i64, expected, "{name}");
            }
            assert!(steps > 0, "{name}: nothing collapsed, nothing tested");
        }
    }
}

/// What orders collapses: images and what is charged, geometry, squared length, ends.
type Key = (i64, f64, f64, [u32; 2]);

#[test]
fn a_fresh_choice_is_the_cheapest_of_all_pictures_and_costs_what_it_says() {
    for (mesh_name, mesh) in meshes() {
        let (frame, original, sphere) = framed(&mesh);
        for (view_name, set) in view_sets(&sphere).into_iter().step_by(3) {
            let name = format!("{mesh_name}, {view_name}");
            let mut live = LiveMesh::new(&mesh, frame);
            // The published cost, and twice with swept volume charged for.
            for price in [0.0, 0.0, 3e3, 1e6] {
                let before = error(&original, &snapshot(&live), &set);
                // (1) Every legal collapse, judged by drawing the whole result.
                let mut cheapest: Option<(Key, i64)> = None;
                for edge in (0..live.edge_ids()).filter(|&e| live.edge(e).is_some()) {
                    let mut star = EdgeStar::default();
                    star.gather(&live, edge);
                    let Ok(site) = Site::new(&live, &star, rules(mesh_name)) else {
                        continue;
                    };
                    let options = MemorylessOptions::default();
                    let Ok(proposal) = memoryless::propose(&site, &options) else {
                        continue;
                    };
                    let mut patch = Patch::default();
                    site.patch(proposal.position, &mut patch);
                    let mut after = live.clone();
                    after.apply(&patch, &mut Changes::default());
                    let cost = error(&original, &snapshot(&after), &set) - before;
                    let ends = live.edge(edge).expect("in use");
                    let d = live.position(ends[1]) - live.position(ends[0]);
                    let charged = cost + (price * math::sqrt(proposal.secondary)) as i64;
                    let key: Key = (charged, proposal.secondary, d.dot(d), ends);
                    if cheapest.is_none_or(|(least, _)| key < least) {
                        cheapest = Some((key, cost));
                    }
                }
                let Some((cheapest, cost)) = cheapest else {
                    break;
                };
                // (2) What the engine takes first.
                let triangles = live.triangle_count();
                let mut method = method(&original, &live, &set, price);
                let mut engine = Engine::new(live.clone(), rules(mesh_name), Schedule::Eager);
                let mut taken = Taken::default();
                let stop = engine.run(&mut method, triangles - 1, &mut taken, &Silent);
                stop.expect("not interrupted");
                assert_eq!(taken.price, cheapest.0, "{name}");
                assert_eq!(taken.edge, Some(cheapest.3), "{name}");
                let sum = method.pictures().sum() as i64;
                assert_eq!(sum - before, cost, "{name}");
                live = engine.into_parts().0;
            }
        }
    }
}

/// The edge of the first collapse, and the price of the last.
#[derive(Default)]
struct Taken {
    edge: Option<[u32; 2]>,
    price: i64,
}

impl Observer for Taken {
    fn chosen(&mut self, proposal: &Proposal) {
        self.price = proposal.primary;
    }

    fn committed(&mut self, _: &LiveMesh, patch: &Patch) {
        let kept = patch.moved.expect("a collapse moves").vertex;
        let gone = patch.gone.expect("a collapse removes");
        self.edge.get_or_insert([kept, gone]);
    }
}

fn options(triangles: u64) -> Options {
    published(64, Start::Auto, triangles)
}

/// The published method but for the schedule, which notices costs that fall.
fn published(size: u32, start: Start, triangles: u64) -> Options {
    Options::image(Target::triangles(triangles))
        .preset(Preset::Paper)
        .schedule(Schedule::Semi)
        .size(size)
        .start(start)
}

#[test]
fn no_number_of_threads_changes_the_result() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    same_on_all_threads(|| {
        let outcome = simplify::simplify(&mesh, &options(200)).expect("simplified");
        (outcome.mesh, outcome.history.to_bytes(), outcome.phases)
    });
}

#[test]
fn an_error_limit_is_never_exceeded_and_nearly_used_up() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    let limited = options(1).target(Target::ErrorOnly).error_rms(3.0);
    let outcome = simplify::simplify(&mesh, &limited).expect("simplified");
    assert_eq!(outcome.stop, Stop::ErrorLimit);
    let rms = outcome.error_rms().expect("driven by images");
    assert!(rms <= 3.0 && rms > 2.5, "{rms}");
}

#[test]
fn a_target_above_the_start_of_the_pictures_is_not_overshot() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    let started = |triangles, start| {
        let options = published(32, Start::Triangles(start), triangles);
        simplify::simplify(&mesh, &options).expect("simplified")
    };
    let (direct, far) = (started(600, 300), started(100, 300));
    assert!((599..=600).contains(&direct.mesh.triangles().len()));
    let mut replay = simplify::Replay::new(&mesh, &far.history).expect("its own history");
    replay.seek(600).expect("a level");
    assert_eq!(replay.live().to_mesh().expect("valid"), direct.mesh);
}

#[test]
fn a_method_without_images_refuses_an_error_measured_on_them() {
    let options = Options::memoryless(Target::triangles(10)).error_rms(1.0);
    let refused = simplify::simplify(&generate::tetrahedron(), &options).expect_err("refused");
    assert_eq!(refused.exit_code(), 2);
}

#[test]
fn a_recipe_has_no_more_samples_along_a_side_than_it_says() {
    let size = |most_samples| Size::PerTriangle {
        per_triangle: 4,
        most_samples,
    };
    for target in [1, 1_000, 3_000, 4_000, 20_000, 1_000_000] {
        let side = size(256).pixels(Some(target));
        let [own, samples] = size(256).sampled(Some(target), 2);
        assert!(
            own * samples <= 256 && own >= side,
            "{target}: {own}, {samples}"
        );
        assert_eq!(samples == 2, side <= 128, "{target}");
        assert_eq!(size(512).sampled(Some(target), 2), [side, 2]);
    }
    assert_eq!(Size::Pixels(300).sampled(Some(9), 2), [300, 2]);
    assert_eq!(size(256).sampled(None, 2), [Size::MOST, 2], "no target");
}

#[test]
fn one_triangle_is_a_target_like_any_other() {
    let of = |target| {
        let size = Size::PerTriangle {
            per_triangle: 9,
            most_samples: 512,
        };
        (size.pixels(target), Start::Times(2.2).triangles(target))
    };
    assert_eq!(of(Some(1)), (Size::LEAST, 2));
    assert_eq!(of(None), (Size::MOST, 65_536), "only an error limits it");
    assert_eq!(Start::Auto.triangles(Some(1)), 10);
    assert_eq!(Start::Times(2.2).triangles(Some(30_000)), 50_000);
    let mesh = canonical(&generate::icosphere(1)).mesh;
    let used = |options: Options| {
        let outcome = simplify::simplify(&mesh, &options).expect("simplified");
        let MethodOptions::Image(own) = outcome.options.method else {
            panic!("{:?}", outcome.options);
        };
        (own.size, own.start)
    };
    let fast = |target| Options::image(target).preset(Preset::Fast).polish(0);
    let [one, few] = [Target::triangles(1), Target::ratio(1e-9)].map(|t| used(fast(t)));
    assert_eq!(one, (Size::Pixels(Size::LEAST), Start::Triangles(1)));
    assert_eq!(few, one);
    let limited = used(fast(Target::ErrorOnly).error_rms(0.5));
    let most = (Size::Pixels(Size::MOST), Start::Triangles(65_536));
    assert_eq!(limited, most);
}

#[test]
fn pre_simplification_leaves_as_many_triangles_as_the_paper_had() {
    // Table 1: bunny 14,535 -> 1,333 is about tenfold, dragon 32,768 -> 8,191 fourfold.
    let starts = [100, 1_333, 8_191, 16_384].map(|target| Start::Auto.triangles(Some(target)));
    assert_eq!(starts, [1_000, 13_330, 32_768, 65_536]);
}
