//! Polishing: what it promises about errors, topology, attributes, histories and threads.

use glam::DVec3;
use lodmark::{
    Error, Silent,
    collapse::{
        Changes, Freedom, History, LiveMesh, Observer, Patch, Replay, Rules, Star, check_folds,
        flip,
    },
    mesh::{Attributes, ChannelKind, Edges, Mesh, MeshParts, canonical, generate},
    raster,
    simplify::{
        MethodOptions, Options, Outcome, Target,
        image::{
            DrivingShading, EngineName, ImageOptions, Limits, Pictures, Polish, PolishCounters,
            Preset, Start, polish,
        },
        simplify, simplify_with,
    },
    view::{Interpolation, ViewSet, ViewsName, frame_of},
};
use proptest::prelude::*;
use sha2::{Digest, Sha256};

use crate::{
    collapse::history::{read_damaged, seek},
    simplify::{
        image::{error, meshes, reference, view_sets},
        options::SHADINGS,
    },
    support::{StopsAfter, faults, framed, live, meshes, same_on_all_threads, scene_of, snapshot},
};

pub(crate) const THREE: Polish = Polish {
    sweeps: 3,
    flips_every: 1,
    cameras_every: 0,
    deviation_weight: 0.0,
    least_share: 0.0,
};

/// Polishes with cameras that stay; nobody interrupts.
pub(crate) fn polish_with(
    live: &mut LiveMesh,
    pictures: Pictures,
    options: Polish,
    limits: Limits<'_>,
    observer: &mut dyn Observer,
) -> (Pictures, PolishCounters) {
    let mut stay = |_: &LiveMesh, _| Ok(None);
    let polished = polish(
        live, pictures, options, limits, &mut stay, observer, &Silent,
    );
    polished.expect("not interrupted")
}

/// Polishes a copy of `mesh` that was made worse, so that there is something to do.
fn polished(
    engine: EngineName,
    mesh: &Mesh,
    worse: &Mesh,
    set: &ViewSet,
    options: Polish,
    observer: &mut dyn Observer,
) -> (LiveMesh, u64, Pictures, PolishCounters) {
    let (frame, original, _) = framed(mesh);
    let mut live = LiveMesh::new(worse, frame);
    let pictures = Pictures::new(&reference(&original, set), &live, engine);
    let before = pictures.sum();
    let limits = Limits::default();
    let (pictures, counters) = polish_with(&mut live, pictures, options, limits, observer);
    (live, before, pictures, counters)
}

/// The mesh with every vertex pushed aside by up to `amount`.
pub(crate) fn pushed(mesh: &Mesh, amount: f64, seed: u64) -> Mesh {
    let mut random = crate::support::Random(seed);
    let mut parts = mesh.clone().into_parts();
    for p in &mut parts.positions {
        let mut axis = || (random.unit() - 0.5) * 2.0 * amount;
        let to = *p + DVec3::new(axis(), axis(), axis());
        *p = DVec3::from_array(to.to_array().map(|x| f64::from(x as f32)));
    }
    Mesh::new(parts).expect("valid")
}

/// Checks after every change that the error fell, by drawing everything.
struct Falling<'a> {
    original: &'a Mesh,
    set: &'a ViewSet,
    last: i64,
    changes: usize,
}

impl Observer for Falling<'_> {
    fn committed(&mut self, live: &LiveMesh, _: &Patch) {
        let error = error(self.original, &snapshot(live), self.set);
        assert!(error < self.last, "{error} after {}", self.last);
        self.last = error;
        self.changes += 1;
    }
}

/// The error of every triangle by pictures drawn from scratch: a pixel's squared difference for each of its samples that
/// shows the triangle, or the background beside it.
fn errors_from_scratch(original: &Mesh, live: &LiveMesh, set: &ViewSet) -> Vec<u64> {
    let (first, now) = (scene_of(original), scene_of(&snapshot(live)));
    let s = set.samples as i64;
    let mut errors = vec![0_u64; live.triangle_ids() as usize];
    // Triangles are numbered without gaps in the order of their ids.
    let ids: Vec<usize> = (0..live.triangle_ids())
        .filter(|&t| live.triangle(t).is_some())
        .map(|t| t as usize)
        .collect();
    for view in &set.views {
        let [a, b] = [&first, &now].map(|scene| raster::luma_sums(scene, view, set));
        let shown = raster::ids(&raster::keys(&now, view, set));
        let at = |x: i64, y: i64| {
            let inside = x >= 0 && y >= 0 && x < shown.width() as i64 && y < shown.height() as i64;
            if inside {
                shown.at(x as u32, y as u32)
            } else {
                0
            }
        };
        for y in 0..shown.height() as i64 {
            for x in 0..shown.width() as i64 {
                let pixel = ((x / s) as u32, (y / s) as u32);
                let [a, b] = [&a, &b].map(|sums| i64::from(sums.at(pixel.0, pixel.1)));
                let square = ((a - b) * (a - b)) as u64;
                let beside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
                let counted = match at(x, y) {
                    0 => beside.map(|(x, y)| at(x, y)),
                    id => [id, 0, 0, 0],
                };
                for id in counted.into_iter().filter(|&id| id > 0) {
                    errors[ids[id as usize - 1]] += square;
                }
            }
        }
    }
    errors
}

#[test]
fn the_error_of_a_triangle_is_that_of_the_samples_that_show_it() {
    for (name, mesh) in meshes() {
        let (frame, original, sphere) = framed(&mesh);
        let worse = pushed(&mesh, 0.06, 3);
        for (views, set) in view_sets(&sphere) {
            let live = LiveMesh::new(&worse, frame);
            let pictures = Pictures::new(&reference(&original, &set), &live, EngineName::Layers);
            let found = pictures.errors(&live);
            let expected = errors_from_scratch(&original, &live, &set);
            assert_eq!(found, expected, "{name}, {views}");
        }
    }
}

#[test]
fn only_stars_that_hold_their_share_of_the_error_are_tried() {
    let mesh = canonical(&generate::torus(1.0, 0.4, 20, 12)).mesh;
    let (_, _, sphere) = framed(&mesh);
    let worse = pushed(&mesh, 0.06, 5);
    let (_, set) = view_sets(&sphere).into_iter().next().expect("a set");
    let with = |least_share| {
        let options = Polish {
            least_share,
            ..THREE
        };
        let (live, before, pictures, counters) =
            polished(EngineName::Layers, &mesh, &worse, &set, options, &mut ());
        assert!(pictures.sum() <= before);
        (live.to_mesh().expect("a mesh"), counters)
    };
    let (all, few, none) = (with(0.0), with(0.02), with(2.0));
    assert!(0 < few.1.evaluations && few.1.evaluations < all.1.evaluations / 2);
    assert_eq!((none.0, none.1.evaluations), (worse, 0));
}

#[test]
fn every_change_that_is_kept_lowers_the_error_drawn_from_scratch() {
    let mut changes = 0;
    for (name, mesh) in meshes() {
        let (_, original, sphere) = framed(&mesh);
        let worse = pushed(&mesh, 0.06, 7);
        for (views, set) in view_sets(&sphere) {
            let mut falling = Falling {
                original: &original,
                set: &set,
                last: i64::MAX,
                changes: 0,
            };
            let options = Polish { sweeps: 1, ..THREE };
            let layers = EngineName::Layers;
            let (_, before, pictures, counters) =
                polished(layers, &mesh, &worse, &set, options, &mut falling);
            assert!(pictures.sum() <= before, "{name}, {views}");
            if falling.changes > 0 {
                assert_eq!(pictures.sum() as i64, falling.last, "{name}, {views}");
            }
            let counted = counters.moves + counters.flips;
            assert_eq!(falling.changes as u64, counted, "{name}, {views}");
            changes += falling.changes;
        }
    }
    assert!(changes > 500, "{changes}");
}

#[test]
fn both_engines_polish_alike() {
    for (name, mesh) in meshes() {
        let (_, _, sphere) = framed(&mesh);
        let worse = pushed(&mesh, 0.05, 3);
        for (views, set) in view_sets(&sphere).into_iter().take(3) {
            let [layers, buckets] = [EngineName::Layers, EngineName::Buckets].map(|engine| {
                let (live, _, _, counters) = polished(engine, &mesh, &worse, &set, THREE, &mut ());
                (live.to_mesh().expect("a mesh"), counters)
            });
            assert_eq!(layers, buckets, "{name}, {views}");
        }
    }
}

/// A run with everything: pre-simplification, collapses, moves, flips, turned cameras.
fn options(triangles: u64, shading: DrivingShading) -> Options {
    let own = ImageOptions {
        views: ViewsName::Spiral(5),
        size: 32.into(),
        samples: 1,
        shading,
        start: Start::Times(3.0),
        polish: Polish {
            sweeps: 4,
            flips_every: 2,
            cameras_every: 2,
            deviation_weight: 0.2,
            least_share: 0.0,
        },
        // Polishing is looked at, whatever becomes of its result.
        fall_back: false,
        ..Preset::Default.options()
    };
    Options::new(own, Target::triangles(triangles))
}

fn run(mesh: &Mesh, triangles: u64, shading: DrivingShading) -> Outcome {
    simplify(mesh, &options(triangles, shading)).expect("simplified")
}

fn shading(kind: usize) -> DrivingShading {
    SHADINGS[kind % SHADINGS.len()]
}

proptest! {
    #![proptest_config(crate::support::cases(16))]

    #[test]
    fn a_replay_ends_with_the_polished_mesh_and_passes_by_the_collapsed_ones(
        kind in 0_usize..8, seed: u64, triangles in 1_u64..60, levels in prop::collection::vec(1_usize..140, 1..6),
    ) {
        let mesh = meshes::any(kind, seed);
        let outcome = run(&mesh, triangles, shading(seed as usize));
        let last = outcome.mesh.triangles().len();
        let bytes = outcome.history.to_bytes();
        let history = History::from_bytes(&bytes, "run.lodh").expect("just written");
        prop_assert_eq!(&history, &outcome.history);
        let mut walk = Replay::new(&mesh, &history).expect("the same mesh");
        for level in levels.into_iter().chain([last, 140, last]) {
            seek(&mut walk, &mesh, &history, level);
        }
        prop_assert_eq!(walk.applied(), history.len());
        if mesh.triangles().len() as u64 > triangles {
            prop_assert_eq!(history.level(&mesh, last).expect("fits"), outcome.mesh);
        } else {
            prop_assert!(outcome.polish().is_none() && history.is_empty(), "a copy");
        }
        while walk.back() {}
        prop_assert_eq!(walk.live().to_mesh().expect("a mesh"), LiveMesh::new(&mesh, history.header().frame).to_mesh().expect("a mesh"));
    }

    #[test]
    fn damaged_histories_of_polished_runs_are_refused_without_a_panic(
        kind in 0_usize..8, at: prop::sample::Index, bit in 0_u8..8, cut: bool,
    ) {
        let mesh = meshes::any(kind, 5);
        let history = run(&mesh, 30, DrivingShading::Flat).history;
        let bytes = history.to_bytes();
        // Somewhere in the records, which follow the options; the checksum is repaired.
        let text = history.header().options.as_bytes();
        let options = bytes.windows(text.len()).position(|w| w == text).expect("JSON") + text.len();
        let at = options + at.index(bytes.len() - 32 - options);
        let mut damaged = bytes[..bytes.len() - 32].to_vec();
        if cut {
            damaged.truncate(at);
        } else {
            damaged[at] ^= 1 << bit;
        }
        let sum = Sha256::digest(&damaged);
        damaged.extend(sum);
        read_damaged(&mesh, &damaged);
    }

    #[test]
    fn polishing_changes_no_topology(kind in 0_usize..8, seed: u64) {
        let mesh = canonical(&meshes::any(kind, seed)).mesh;
        let (_, _, sphere) = framed(&mesh);
        let set = view_sets(&sphere).swap_remove(seed as usize % 2).1;
        let worse = pushed(&mesh, 0.1, seed);
        let (live, ..) = polished(EngineName::Layers, &mesh, &worse, &set, THREE, &mut ());
        let now = live.to_mesh().expect("valid");
        let (before, after) = (Edges::of(&worse), Edges::of(&now));
        prop_assert_eq!(before.boundary_count(), after.boundary_count());
        prop_assert_eq!(worse.triangles().len(), now.triangles().len());
        prop_assert_eq!(faces_at_edges(&worse), faces_at_edges(&now));
        let materials = |mesh: &Mesh| mesh.materials().of_triangle.clone();
        prop_assert_eq!(materials(&worse), materials(&now));
    }
}

/// How many edges have 1, 2, ... faces.
fn faces_at_edges(mesh: &Mesh) -> Vec<usize> {
    let mut sides: Vec<[u32; 2]> = mesh
        .triangles()
        .iter()
        .flat_map(|t| [0, 1, 2].map(|k| [t[k], t[(k + 1) % 3]]))
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    sides.sort_unstable();
    let mut counts = vec![0; 40];
    for run in sides.chunk_by(|a, b| a == b) {
        counts[run.len()] += 1;
    }
    counts
}

#[test]
fn no_number_of_threads_changes_what_polishing_does() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    for kind in 0..SHADINGS.len() {
        same_on_all_threads(|| {
            let outcome = run(&mesh, 150, shading(kind));
            assert!(outcome.polish().is_some_and(|p| p.moves > 20));
            let polish = outcome.polish().cloned();
            (outcome.mesh, outcome.history.to_bytes(), polish)
        });
    }
}

#[test]
fn a_locked_vertex_stays_where_it_is() {
    let mesh = generate::icosphere(1);
    let worse = pushed(&mesh, 0.1, 1);
    let (frame, original, sphere) = framed(&mesh);
    let (_, set) = view_sets(&sphere).swap_remove(0);
    let mut live = LiveMesh::new(&worse, frame);
    for v in (0..live.vertex_ids()).step_by(2) {
        live.set_locked(v, true);
    }
    let before = live.positions().to_vec();
    let pictures = Pictures::new(&reference(&original, &set), &live, EngineName::Layers);
    let (_, counters) = polish_with(&mut live, pictures, THREE, Limits::default(), &mut ());
    assert!(counters.moves > 0);
    for (v, (a, b)) in before.iter().zip(live.positions()).enumerate() {
        assert!(v % 2 == 1 || a == b, "vertex {v}");
    }
}

#[test]
fn polishing_can_be_interrupted() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    let options = options(150, DrivingShading::Flat);
    let stopped = simplify_with(&mesh, &options, &StopsAfter::new("polish", 4));
    assert!(matches!(stopped, Err(Error::Interrupted)));
}

#[test]
fn under_an_error_limit_the_cameras_stay_and_the_limit_holds() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    let limited = options(1, DrivingShading::Flat)
        .target(Target::ErrorOnly)
        .error_rms(6.0);
    let outcome = simplify(&mesh, &limited).expect("simplified");
    assert!(outcome.error_rms().is_some_and(|rms| rms <= 6.0));
    assert_eq!(outcome.polish().expect("polished").cameras.len(), 1);
}

#[test]
fn cameras_are_turned_as_often_as_asked_and_never_make_a_set_of_pictures_worse() {
    let mesh = canonical(&generate::icosphere(3)).mesh;
    let outcome = run(&mesh, 150, DrivingShading::Flat);
    let counters = outcome.polish().expect("polished");
    assert_eq!(counters.cameras.len(), 2, "4 sweeps, turned after 2");
    for [before, after] in &counters.cameras {
        assert!(after <= before, "{before} to {after}");
    }
}

/// A flat grid with texture coordinates that are an affine map of the plane, and one of normals per corner.
fn textured_grid() -> Mesh {
    let parts = generate::grid(4, 4, generate::Height::Polynomial).into_parts();
    let positions: Vec<DVec3> = parts.positions.iter().map(|p| p.with_z(0.0)).collect();
    let values = positions.iter().flat_map(|&p| affine(p)).collect();
    let attributes = Attributes::new(&[ChannelKind::TexCoord(0)], values, parts.triangles.clone());
    Mesh::new(MeshParts {
        positions,
        triangles: parts.triangles,
        attributes: attributes.expect("valid"),
        ..MeshParts::default()
    })
    .expect("valid")
}

fn affine(p: DVec3) -> [f64; 2] {
    [0.25 * p.x + 0.5 * p.y + 0.125, p.x - 0.75 * p.y]
}

#[test]
fn a_texture_does_not_slide_with_the_vertices() {
    let mesh = textured_grid();
    let mut live = live(&mesh);
    let mut tested = 0;
    for v in 0..live.vertex_ids() {
        let mut star = Star::default();
        star.gather(&live, v);
        if star.neighbors.iter().any(|&(_, faces)| faces == 1) {
            continue;
        }
        let step = 0.3 * star.mean_edge(&live);
        let to = star.point + DVec3::new(0.6, -0.5, 0.0) * step;
        let to = star.admit(&live, to, Rules::default());
        let to = to.expect("a small move");
        let mut patch = Patch::default();
        star.patch(&live, to, &mut patch);
        live.apply(&patch, &mut Changes::default());
        tested += 1;
    }
    assert!(tested >= 9, "{tested}");
    let moved = live.to_mesh().expect("valid");
    let channel = moved.attributes().channel(ChannelKind::TexCoord(0));
    let channel = channel.expect("kept");
    for (corners, wedges) in moved.triangles().iter().zip(moved.attributes().corners()) {
        for (&v, &w) in corners.iter().zip(wedges) {
            let expected = affine(moved.positions()[v as usize]);
            let found = moved.attributes().value(channel, w);
            let mut both = expected.iter().zip(found);
            let alike = both.all(|(e, f)| (e - f).abs() < 1e-6);
            assert!(alike, "vertex {v}: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn a_vertex_on_a_seam_moves_along_the_normal_only() {
    let freedoms = |mesh: &Mesh| -> Vec<Freedom> {
        let live = live(mesh);
        let each = (0..live.vertex_ids()).map(|v| {
            let mut star = Star::default();
            star.gather(&live, v);
            star.freedom
        });
        each.collect()
    };
    let count = |all: &[Freedom], f: Freedom| all.iter().filter(|&&x| x == f).count();
    // A cube of 4 x 4 squares a side: 98 vertices, 9 inside every side.
    let seams = freedoms(&meshes::cube(4, true, false));
    assert_eq!(count(&seams, Freedom::Free), 54);
    assert_eq!(count(&seams, Freedom::Normal), 44);
    let plain = freedoms(&meshes::cube(4, false, false));
    assert_eq!(count(&plain, Freedom::Free), 98);
    // The common edge of three sheets has three vertices.
    let (_, book) = meshes().swap_remove(3);
    assert_eq!(count(&freedoms(&book), Freedom::Fixed), 3);
}

#[test]
fn a_flip_crosses_no_seam_no_border_and_no_fold() {
    let flips = |mesh: &Mesh| {
        let live = live(mesh);
        let ends = (0..live.edge_ids()).map(|e| live.edge(e).expect("in use"));
        let legal =
            |&ends: &[u32; 2]| flip(&live, ends, Rules::default(), &mut Patch::default()).is_ok();
        ends.filter(legal).collect::<Vec<_>>()
    };
    // Two coplanar triangles, then the same with a material border, then a boundary.
    let quad = |materials: Vec<u32>| {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let mut parts = MeshParts {
            positions,
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..MeshParts::default()
        };
        parts.materials.names = vec!["a".into(), "b".into()];
        parts.materials.of_triangle = materials;
        Mesh::new(parts).expect("valid")
    };
    assert_eq!(flips(&quad(vec![0, 0])), [[0, 2]]);
    assert_eq!(flips(&quad(vec![0, 1])), [[0; 2]; 0]);
    // Every edge of a tetrahedron has its flip there already.
    assert_eq!(flips(&generate::tetrahedron()), [[0; 2]; 0]);
    // Normals that differ on both sides forbid every flip, equal ones do not.
    assert_eq!(flips(&meshes::textured_torus(8, 6, 1, true)), [[0; 2]; 0]);
    assert!(flips(&meshes::textured_torus(8, 6, 1, false)).len() > 20);
}

#[test]
fn a_flip_and_its_flip_leave_the_surface_as_it_was() {
    let mesh = meshes::torus(8, 6, 4);
    let mut live = live(&mesh);
    let before = live.to_mesh().expect("valid");
    let mut patch = Patch::default();
    let edge = (0..live.edge_ids())
        .filter_map(|e| live.edge(e))
        .find(|&ends| flip(&live, ends, Rules::default(), &mut patch).is_ok())
        .expect("some edge may be flipped");
    assert_eq!(patch.flipped(), Some(edge));
    live.apply(&patch, &mut Changes::default());
    let middle = live.to_mesh().expect("valid");
    assert_ne!(middle, before);
    assert_eq!(live.find_edge(edge[0], edge[1]), None);
    let back = patch.reversed();
    assert!(check_folds(&live, &back, Rules::default()).is_ok());
    live.apply(&back, &mut Changes::default());
    assert_eq!(live.to_mesh().expect("valid"), before);
    assert!(live.find_edge(edge[0], edge[1]).is_some());
}

#[test]
fn half_of_mixed_views_are_flat() {
    let mesh = generate::icosphere(1);
    let frame = frame_of(&mesh);
    let original = mesh.enter_frame(frame);
    let of = |shading| {
        let options = ImageOptions {
            shading,
            ..Preset::Default.options()
        };
        let set = options.views(&original, frame, 0).expect("views");
        let gouraud = |v: &&lodmark::view::View| v.shading.interpolation == Interpolation::Gouraud;
        [set.views.iter().filter(gouraud).count(), set.views.len()]
    };
    assert_eq!(SHADINGS.map(of), [[0, 42], [42, 42], [21, 42], [0, 42]]);
}

#[test]
fn polishing_turns_no_face_over_though_pictures_would_gain_by_it() {
    let mut moved = 0;
    for name in ["terrain", "tori", "shells"] {
        let mesh = canonical(&generate::by_name(name).expect("a name of the list")).mesh;
        for triangles in [60, 150] {
            let mut options = options(triangles, DrivingShading::Gouraud);
            let polished = simplify(&mesh, &options).expect("simplified");
            let MethodOptions::Image(own) = &mut options.method else {
                unreachable!("image-driven");
            };
            own.polish.sweeps = 0;
            let plain = simplify(&mesh, &options).expect("simplified");
            let [before, after] = [plain, polished.clone()].map(|o| faults(&mesh, &o.mesh)[1]);
            assert!(after <= before, "{name}, {triangles}: {before}, {after}");
            moved += polished.polish().expect("polished").moves;
        }
    }
    assert!(moved > 500, "{moved}");
}
