//! The rasterizer against exact rays, and the classifier against a rasterizer with planted bugs.

use glam::DVec3;
use lodmark::{
    Error, Progress, Silent, io,
    mesh::{Mesh, MeshParts, generate},
    num::{Precision, fixed::SubpixelBits},
    raster::{self, Plane, Scene},
    view::{Cull, Eye, Light, Projection, Shading, Sphere, View, ViewSet, directions, frame_of},
    visibility::rays::{Class, RayCaster, TOLERANCE, Tally, cap},
};
use proptest::prelude::*;

use crate::{
    cli::{code, expect, folder, lodmark, put, stderr, stdout},
    shapes,
};

/// The views of a mesh from some of the dodecahedron's directions, and the mesh in their frame.
pub(crate) fn framed(
    mesh: &Mesh,
    count: usize,
    size: u32,
    bits: SubpixelBits,
    projection: Projection,
) -> (Mesh, ViewSet) {
    let frame = frame_of(mesh);
    let sphere = Sphere::of_mesh(mesh).expect("triangles");
    let chosen = &directions::dodecahedron()[..count];
    let set = ViewSet::around(&sphere, chosen, size, size, projection)
        .expect("views")
        .with_subpixel(bits)
        .enter_frame(frame);
    (mesh.enter_frame(frame), set)
}

/// Every view of `draw` against rays.
fn tally(mesh: &Mesh, set: &ViewSet, draw: impl Fn(&View) -> Plane<u64>) -> Tally {
    let caster = RayCaster::new(mesh);
    let mut tally = Tally::default();
    for (i, view) in set.views.iter().enumerate() {
        let rays = caster.keys(view, set, &Silent).expect("goes on");
        let found = caster.classify(set, i, [&draw(view), &rays], &Silent);
        tally.add(&found.expect("one size"));
    }
    tally
}

/// The rasterizer against rays.
fn check(mesh: &Mesh, set: &ViewSet) -> Tally {
    let scene = Scene::of(mesh);
    tally(mesh, set, |view| raster::keys(&scene, view, set).keys)
}

/// A view of the square from -16 to 16 onto 32 x 32 pixels, a pixel per unit; z is the depth.
fn grid_view(cull: Cull) -> View {
    View {
        matrix: [
            [0.0625, 0.0, 0.0, 0.0],
            [0.0, 0.0625, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ],
        eye: Eye::Axis(DVec3::NEG_Z),
        near: 1.0,
        far: 3.0,
        cull,
        shading: Shading::default(),
        light: Light::Headlight,
    }
}

fn grid_set(bits: SubpixelBits, cull: Cull) -> ViewSet {
    ViewSet {
        width: 32,
        height: 32,
        samples: 1,
        subpixel: bits,
        background: 128,
        views: vec![grid_view(cull)],
    }
}

fn of_doubles(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(MeshParts {
        positions,
        triangles,
        precision: Precision::F64,
        ..MeshParts::default()
    })
    .expect("valid")
}

fn soup_of(corners: Vec<DVec3>) -> Mesh {
    let triangles = (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    of_doubles(corners, triangles.collect())
}

/// Squares of `step` pixels whose corners are pixel centres, every fourth triangle a second time.
fn tiles(step: usize) -> Mesh {
    let at = |i: usize| (i * step) as f64 - 12.5;
    let (side, mut triangles) = (24 / step + 1, Vec::new());
    let positions = (0..side * side)
        .map(|k| DVec3::new(at(k % side), at(k / side), ((k * 7) % 5) as f64 / 8.0))
        .collect();
    for y in 1..side {
        for x in 1..side {
            let v = |dx: usize, dy: usize| ((y - dy) * side + x - dx) as u32;
            triangles.push([v(1, 1), v(0, 1), v(0, 0)]);
            triangles.push([v(1, 1), v(0, 0), v(1, 0)]);
        }
    }
    let again: Vec<[u32; 3]> = triangles.iter().step_by(4).copied().collect();
    triangles.extend(again);
    of_doubles(positions, triangles)
}

/// Corners on pixel centres, on pixel corners, or anywhere on the sub-pixel grid; far outside the image, too.
fn grid_corner(bits: SubpixelBits) -> impl Strategy<Value = DVec3> {
    let scale = f64::from(bits.scale());
    let coordinate = move || {
        prop_oneof![
            3 => (-40..41_i32).prop_map(|i| f64::from(i) * 0.5),
            1 => (-(20 << 8)..20 << 8_i32).prop_map(move |i| f64::from(i) / scale),
            1 => (-4_000..4_000_i32).prop_map(f64::from),
        ]
    };
    let depth = prop_oneof![
        (0..8_i32).prop_map(|i| f64::from(i) / 8.0),
        any::<u32>().prop_map(|i| f64::from(i >> 1) / 4_294_967_296.0),
    ];
    (coordinate(), coordinate(), depth).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn grid_soup() -> impl Strategy<Value = (SubpixelBits, Vec<DVec3>)> {
    let bits = prop_oneof![Just(SubpixelBits::Eight), Just(SubpixelBits::Sixteen)];
    bits.prop_flat_map(|bits| {
        let triangle = [grid_corner(bits), grid_corner(bits), grid_corner(bits)];
        let soup = proptest::collection::vec(triangle, 1..30);
        (
            Just(bits),
            soup.prop_map(|soup| soup.into_iter().flatten().collect()),
        )
    })
}

fn any_cull() -> impl Strategy<Value = Cull> {
    proptest::sample::select(vec![Cull::None, Cull::Back, Cull::Front])
}

proptest! {
    #![proptest_config(crate::cases(200))]

    #[test]
    fn on_the_grid_rays_and_raster_agree_in_every_bit((bits, corners) in grid_soup(), cull in any_cull()) {
        let (mesh, set) = (soup_of(corners), grid_set(bits, cull));
        let found = check(&mesh, &set);
        prop_assert_eq!(found.grid_exact_views, 1);
        prop_assert_eq!(found.explained() + found.unexplained(), 0, "{:?}", found.worst);
    }

    #[test]
    fn on_the_grid_of_a_perspective_view_they_agree_too((bits, corners) in grid_soup(), cull in any_cull()) {
        // w is 1, 2 or 4 and depth 1/2 - 1/2w: the division is exact.
        let corners = corners.into_iter().map(|p| {
            let w = [1.0, 2.0, 4.0][(p.z * 8.0) as usize % 3];
            DVec3::new(p.x * w, p.y * w, w)
        });
        let mesh = soup_of(corners.collect());
        let mut set = grid_set(bits, cull);
        let view = &mut set.views[0];
        view.eye = Eye::Point(DVec3::ZERO);
        view.matrix[2] = [0.0, 0.0, 0.5, -0.5];
        view.matrix[3] = [0.0, 0.0, 1.0, 0.0];
        let found = check(&mesh, &set);
        prop_assert_eq!(found.grid_exact_views, 1);
        prop_assert_eq!(found.explained() + found.unexplained(), 0, "{:?}", found.worst);
    }

    #[test]
    fn nothing_stays_unexplained_from_anywhere_near_or_inside_a_mesh(
        (kind, seed) in (0..8_usize, any::<u64>()),
        eye in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
        near in prop_oneof![Just(1e-3), 0.01..1.0_f64],
        eight in any::<bool>(),
        cull in any_cull(),
        distance in prop_oneof![Just(0.5), Just(2.0), 0.1..6.0_f64],
    ) {
        let mesh = shapes::any(kind, seed);
        let sphere = Sphere::of_mesh(&mesh).expect("triangles");
        let eye = sphere.center + DVec3::from_array(eye) * sphere.radius * distance;
        let range = [near * sphere.radius, 20.0 * sphere.radius];
        let view = View::perspective([eye, sphere.center, DVec3::new(0.1, 1.0, 0.2)], range, [40, 28]);
        prop_assume!(view.is_some());
        let set = ViewSet {
            width: 40,
            height: 28,
            views: vec![View { cull, ..view.expect("checked") }],
            ..grid_set(if eight { SubpixelBits::Eight } else { SubpixelBits::Sixteen }, cull)
        };
        let found = check(&mesh, &set);
        prop_assert_eq!(found.unexplained(), 0, "{:?}", found.worst);
    }
}

/// What a rasterizer can do wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Bug {
    None,
    HalfPixelShift,
    DroppedFillRule,
    LessOrEqualDepth,
    OffByOneIds,
    MirroredY,
    FourBitSnapping,
    TriangleLeftOut,
    BackToFront,
}

const BUGS: [Bug; 8] = [
    Bug::HalfPixelShift,
    Bug::DroppedFillRule,
    Bug::LessOrEqualDepth,
    Bug::OffByOneIds,
    Bug::MirroredY,
    Bug::FourBitSnapping,
    Bug::TriangleLeftOut,
    Bug::BackToFront,
];

/// A rasterizer of its own: every pixel against every triangle in `i128`, with a bug. For meshes in front of the near
/// plane and inside the guard band, without culling.
fn draw(mesh: &Mesh, view: &View, set: &ViewSet, bug: Bug) -> Plane<u64> {
    let (width, height) = (f64::from(set.width), f64::from(set.height));
    let bits = set.subpixel.bits();
    // Left out is one that shows: that of the pixel in the middle of those which show any.
    let left_out = (bug == Bug::TriangleLeftOut).then(|| {
        let shown = draw(mesh, view, set, Bug::None);
        let ids: Vec<u64> = shown
            .values()
            .iter()
            .copied()
            .filter(|&k| k != u64::MAX)
            .collect();
        ids[ids.len() / 2] as u32 as usize
    });
    let mut keys = Plane::filled(set.width, set.height, u64::MAX);
    let screen: Vec<[i128; 3]> = mesh
        .positions()
        .iter()
        .map(|p| {
            let [x, y, z, w] = view
                .matrix
                .map(|m| ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3]);
            let mut column = (x / w * 0.5 + 0.5) * width;
            let mut row = (0.5 - y / w * 0.5) * height;
            match bug {
                Bug::HalfPixelShift => column += 0.5,
                Bug::MirroredY => row = height - row,
                _ => {}
            }
            let [fine, coarse] = match bug {
                Bug::FourBitSnapping => [4, bits - 4],
                _ => [bits, 0],
            };
            let snap = |v: f64| ((v * f64::from(1 << fine)).round_ties_even() as i128) << coarse;
            let depth = (z / w * 4_294_967_296.0).floor();
            [snap(column), snap(row), depth as i128]
        })
        .collect();
    for (t, corners) in mesh.triangles().iter().enumerate() {
        if left_out == Some(t) {
            continue;
        }
        let mut corners = corners.map(|v| screen[v as usize]);
        let cross = |a: [i128; 3], b: [i128; 3], c: [i128; 3]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        if cross(corners[0], corners[1], corners[2]) < 0 {
            corners.swap(1, 2);
        }
        let [a, b, c] = corners;
        let area = cross(a, b, c);
        if area == 0 {
            continue;
        }
        let id = match bug {
            Bug::OffByOneIds => t as u64 + 1,
            _ => t as u64,
        };
        for (at, key) in keys.values_mut().iter_mut().enumerate() {
            let (x, y) = (at % set.width as usize, at / set.width as usize);
            let p = [x, y, 0].map(|v| (2 * v as i128 + 1) << (bits - 1));
            let beside = |i: usize| {
                corners.iter().all(|v| v[i] < p[i]) || corners.iter().all(|v| v[i] > p[i])
            };
            if beside(0) || beside(1) {
                continue;
            }
            let weights = [cross(p, b, c), cross(a, p, c), cross(a, b, p)];
            let covers = [[b, c], [c, a], [a, b]]
                .iter()
                .zip(weights)
                .all(|([u, v], e)| {
                    let (dx, dy) = (v[0] - u[0], v[1] - u[1]);
                    let owned = dy < 0 || (dy == 0 && dx > 0) || bug == Bug::DroppedFillRule;
                    e > 0 || (e == 0 && owned)
                });
            if !covers {
                continue;
            }
            let sum: i128 = weights.iter().zip(corners).map(|(e, v)| e * v[2]).sum();
            let depth = sum.div_euclid(area) as u64;
            let nearer = match bug {
                Bug::LessOrEqualDepth => depth <= *key >> 32,
                Bug::BackToFront => *key == u64::MAX || depth > *key >> 32,
                _ => depth << 32 | id < *key,
            };
            if nearer {
                *key = depth << 32 | id;
            }
        }
    }
    keys
}

#[test]
fn the_rasterizer_for_planted_bugs_has_none_of_its_own() {
    let sixteen = SubpixelBits::Sixteen;
    let (torus, views) = framed(
        &generate::torus(1.0, 0.4, 24, 12),
        2,
        64,
        sixteen,
        Projection::Perspective,
    );
    for (mesh, set) in [
        (torus, views),
        (tiles(3), grid_set(sixteen, Cull::None)),
        (tiles(4), grid_set(SubpixelBits::Eight, Cull::None)),
    ] {
        let scene = Scene::of(&mesh);
        for view in &set.views {
            assert_eq!(
                draw(&mesh, view, &set, Bug::None),
                raster::keys(&scene, view, &set).keys
            );
        }
    }
}

#[test]
fn every_planted_bug_is_flagged_on_a_grid_exact_scene() {
    for bits in [SubpixelBits::Eight, SubpixelBits::Sixteen] {
        let (mesh, set) = (tiles(3), grid_set(bits, Cull::None));
        assert!(tally(&mesh, &set, |view| draw(&mesh, view, &set, Bug::None)).passes(0.0));
        for bug in BUGS {
            // 4 bits hold every corner, and one layer has no back: nothing to see.
            let visible = ![Bug::FourBitSnapping, Bug::BackToFront].contains(&bug);
            let found = tally(&mesh, &set, |view| draw(&mesh, view, &set, bug));
            assert_eq!(
                found.unexplained() > 0 && !found.passes(1.0),
                visible,
                "{bug:?}: {:?}",
                found.counts
            );
            assert_eq!(found.unexplained(), found.of(Class::GridExact));
        }
    }
}

#[test]
fn planted_bugs_are_flagged_on_an_ordinary_scene_where_they_show_at_all() {
    for (bits, projection) in [
        (SubpixelBits::Sixteen, Projection::Perspective),
        (SubpixelBits::Eight, Projection::Orthographic),
    ] {
        let torus = generate::torus(1.0, 0.4, 24, 12);
        let (mesh, set) = framed(&torus, 2, 64, bits, projection);
        assert!(tally(&mesh, &set, |view| draw(&mesh, view, &set, Bug::None)).passes(cap(bits)));
        for bug in BUGS {
            if [Bug::DroppedFillRule, Bug::LessOrEqualDepth].contains(&bug) {
                // No centre lies on an edge and no two depths are equal: only a grid-exact scene can show these.
                continue;
            }
            let found = tally(&mesh, &set, |view| draw(&mesh, view, &set, bug));
            assert!(
                found.unexplained() > 0 && !found.passes(1.0),
                "{bits:?} {bug:?}: {:?}",
                found.counts
            );
        }
    }
}

/// One large triangle in front of another.
fn two_layers() -> (Mesh, ViewSet) {
    let layer =
        |z: f64| [(-12.3, -11.7), (13.1, -9.9), (0.3, 12.9)].map(|(x, y)| DVec3::new(x, y, z));
    let corners = [layer(0.5), layer(0.25)].into_iter().flatten();
    (
        soup_of(corners.collect()),
        grid_set(SubpixelBits::Sixteen, Cull::None),
    )
}

#[test]
fn a_difference_is_named_after_what_is_wrong() {
    let (mesh, set) = two_layers();
    let caster = RayCaster::new(&mesh);
    let rays = caster.keys(&set.views[0], &set, &Silent).expect("goes on");
    // The pixel in the middle, far from every edge: the triangle in front has number 1.
    let at = 16 * 32 + 16;
    let near = rays.values()[at];
    assert_eq!(near, 0x4000_0000 << 32 | 1);
    for (shown, class) in [
        (u64::MAX, Class::Hole),
        (0x8000_0000 << 32, Class::Occluded),
        (0x4000_0000 << 32 | 2, Class::Range),
        (0x4000_0009 << 32 | 1, Class::Depth),
        (0x4000_0002 << 32 | 1, Class::Equal),
    ] {
        let mut planted = rays.clone();
        planted.values_mut()[at] = shown;
        let found = caster
            .classify(&set, 0, [&planted, &rays], &Silent)
            .expect("one size");
        assert_eq!(found.classes.values()[at], class);
        assert_eq!(found.witnesses.len(), usize::from(class != Class::Equal));
    }
    // In the corner there is nothing.
    let mut planted = rays.clone();
    planted.values_mut()[0] = near;
    let classes = |pictures| {
        let found = caster.classify(&set, 0, pictures, &Silent);
        found.expect("one size").classes.values()[0]
    };
    assert_eq!(classes([&planted, &rays]), Class::Stray);
    assert_eq!(
        classes([&rays, &planted]),
        Class::Rays,
        "the other way round"
    );
    let small = Plane::filled(31, 32, u64::MAX);
    assert!(matches!(
        caster.classify(&set, 0, [&small, &rays], &Silent),
        Err(Error::Usage(_))
    ));
}

/// The class of one pixel where the rasterizer shows `shown` and the rays something else.
fn class_of(mesh: &Mesh, set: &ViewSet, [x, y]: [u32; 2], shown: u64) -> Class {
    let caster = RayCaster::new(mesh);
    let rays = caster.keys(&set.views[0], set, &Silent).expect("goes on");
    let mut planted = rays.clone();
    planted.values_mut()[(y * set.width + x) as usize] = shown;
    let found = caster.classify(set, 0, [&planted, &rays], &Silent);
    found.expect("one size").classes.at(x, y)
}

#[test]
fn the_tolerance_ends_where_it_says() {
    // A vertical edge this far to the right of the centre of pixel (16, 16); the triangle lies on its left.
    for (distance, class) in [
        (0.0, Class::Edge),
        (0.9 * TOLERANCE, Class::Edge),
        (1.1 * TOLERANCE, Class::Hole),
        (0.3, Class::Hole),
    ] {
        let x = 0.5 + distance;
        let corners = [(x, -9.0), (x, 9.0), (x - 14.0, 0.3)].map(|(x, y)| DVec3::new(x, y, 0.1));
        let mesh = soup_of(corners.to_vec());
        let set = grid_set(SubpixelBits::Sixteen, Cull::None);
        // At distance 0 the ray, moved right by a hair, misses.
        let shown = if distance > 0.0 {
            u64::MAX
        } else {
            0x1999_9999 << 32
        };
        assert_eq!(class_of(&mesh, &set, [16, 16], shown), class, "{distance}");
    }
    // Two parallel triangles of no slope, so many quanta apart.
    for (quanta, class) in [
        (1, Class::DepthTie),
        (2, Class::DepthTie),
        (3, Class::Occluded),
    ] {
        let layer = |z: u32| {
            let z = f64::from(z) / 4_294_967_296.0;
            [(-12.3, -11.7), (13.1, -9.9), (0.3, 12.9)].map(|(x, y)| DVec3::new(x, y, z))
        };
        let corners = [layer(1_000 + quanta), layer(1_000)].into_iter().flatten();
        let mesh = soup_of(corners.collect());
        let set = grid_set(SubpixelBits::Sixteen, Cull::None);
        let shown = u64::from(1_000 + quanta) << 32;
        assert_eq!(class_of(&mesh, &set, [16, 16], shown), class, "{quanta}");
    }
}

#[test]
fn a_coarser_grid_moves_more_pixels_and_all_for_a_reason() {
    for mesh in [
        generate::probe(),
        generate::interlocking_tori(32, 16),
        generate::engine(1),
        generate::textured_torus(24, 12),
        generate::shells(2, 2),
    ] {
        let explained = [SubpixelBits::Eight, SubpixelBits::Sixteen].map(|bits| {
            [Projection::Perspective, Projection::Orthographic].map(|projection| {
                let (mesh, set) = framed(&mesh, 3, 96, bits, projection);
                let found = check(&mesh, &set);
                assert_eq!(found.unexplained(), 0, "{:?}", found.worst);
                assert_eq!(found.counts.iter().sum::<u64>(), 3 * 96 * 96);
                found.explained()
            })
        });
        assert!(explained[0].iter().sum::<u64>() > explained[1].iter().sum());
    }
}

#[test]
fn real_models_are_shown_as_rays_hit_them() {
    let folder = std::env::var("LODMARK_MODELS").unwrap_or("../shared/models".into());
    let bunny = std::path::Path::new(&folder).join("bunny.ply");
    if !bunny.exists() {
        println!("skipped: {} is not there", bunny.display());
        return;
    }
    let mesh = io::read(&bunny).expect("reads").mesh;
    let (mesh, set) = framed(
        &mesh,
        2,
        128,
        SubpixelBits::Sixteen,
        Projection::Perspective,
    );
    let found = check(&mesh, &set);
    assert!(found.passes(1e-4), "{:?}", found.worst);
    assert!(found.of(Class::Equal) > 8_000);
}

struct Impatient;

impl Progress for Impatient {
    fn report(&self, _: &str, _: u64, _: u64) {}

    fn interrupted(&self) -> bool {
        true
    }
}

#[test]
fn casting_and_classifying_can_be_interrupted() {
    let (mesh, set) = two_layers();
    let caster = RayCaster::new(&mesh);
    let view = &set.views[0];
    assert!(matches!(
        caster.keys(view, &set, &Impatient),
        Err(Error::Interrupted)
    ));
    let rays = caster.keys(view, &set, &Silent).expect("goes on");
    assert!(matches!(
        caster.classify(&set, 0, [&rays, &rays], &Impatient),
        Err(Error::Interrupted)
    ));
}

#[test]
fn the_command_answers_with_classes_a_picture_and_its_exit_code() {
    let dir = folder();
    put(&dir, "in.ply", &generate::probe());
    let words = ["check-rays", "in.ply", "--size", "96", "--json", "r.json"];
    let more = ["--picture", "p.png", "--subpixel-bits", "8"];
    expect(&dir, 0, &[&words[..], &more].concat());
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(dir.path().join("r.json")).expect("written"))
            .expect("JSON");
    assert_eq!(report["tally"]["pixels"], 20 * 96 * 96);
    assert_eq!(report["unexplained"], 0);
    assert_eq!(report["options"]["subpixel_bits"], 8);
    let edges = report["tally"]["counts"]["edge"].as_u64().expect("a count");
    assert!(edges > 0 && report["explained"].as_u64() >= Some(edges));
    assert!(report["tally"]["worst"][0]["raster"]["depth"].is_u64());
    let picture = lodmark::output::png::read(&dir.path().join("p.png")).expect("a picture");
    let picture = picture.into_rgb();
    assert!(picture.values().contains(&Class::Edge.color()));
    assert!(picture.width() > 5 * 96 && picture.height() > 4 * 96);
    // The same differences are too many where none may be.
    let none = lodmark(
        &dir,
        &[&words[..], &["--subpixel-bits", "8", "--cap", "0"]].concat(),
    );
    assert_eq!(code(&none), 1, "{}", stderr(&none));
    assert!(stdout(&none).contains("NOT what rays hit"));
    for (words, said) in [
        (&["check-rays", "in.ply", "--cap", "2"][..], "--cap"),
        (&["check-rays", "in.ply", "--subpixel-bits", "9"], "8 or 16"),
        (&["check-rays", "in.ply", "--size", "0"], "0"),
    ] {
        let message = expect(&dir, 2, words);
        assert!(message.contains(said), "{message}");
    }
}

#[test]
fn no_number_of_threads_changes_what_check_rays_reports() {
    let dir = folder();
    put(&dir, "in.ply", &generate::probe());
    let reports = ["1", "2", "3"].map(|threads| {
        let words = [
            "check-rays",
            "in.ply",
            "--size",
            "70",
            "--subpixel-bits",
            "8",
            "--views",
            "octahedron:0",
            "--json",
            "r.json",
            "--threads",
            threads,
        ];
        expect(&dir, 0, &words);
        std::fs::read(dir.path().join("r.json")).expect("written")
    });
    assert!(reports.iter().all(|r| *r == reports[0]));
}
