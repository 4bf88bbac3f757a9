//! The rasterizer against exact rays, and the classifier against a rasterizer with planted bugs.

use glam::DVec3;
use lodmark::{
    Error, Silent,
    mesh::{Mesh, MeshParts, generate},
    num::{Precision, fixed::SubpixelBits},
    raster::{self, Grid, SampleKey},
    validate::rays::{Class, RayCaster, Tally},
    view::{Cull, Eye, Light, Projection, Shading, Sphere, View, ViewSet, frame_of, sets},
};
use proptest::prelude::*;

use crate::support::{
    Impatient, bytes, code, expect, folder, json, lodmark, meshes, model, put, refused, scene_of,
    stderr, stdout,
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
    let chosen = &sets::dodecahedron()[..count];
    let set = ViewSet::around(&sphere, chosen, size, size, projection).expect("views");
    let set = set.with_subpixel(bits).enter_frame(frame);
    (mesh.enter_frame(frame).in_frame_units().clone(), set)
}

/// Every view of `draw` against rays.
pub(crate) fn tally(mesh: &Mesh, set: &ViewSet, draw: impl Fn(&View) -> Grid<SampleKey>) -> Tally {
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
    let scene = scene_of(mesh);
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

pub(crate) fn grid_set(bits: SubpixelBits, cull: Cull) -> ViewSet {
    ViewSet {
        width: 32,
        height: 32,
        samples: 1,
        subpixel: bits,
        background: 128,
        views: vec![grid_view(cull)],
    }
}

pub(crate) fn of_doubles(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(MeshParts {
        positions,
        triangles,
        precision: Precision::F64,
        ..MeshParts::default()
    })
    .expect("valid")
}

pub(crate) fn soup_of(corners: Vec<DVec3>) -> Mesh {
    let triangles = (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    of_doubles(corners, triangles.collect())
}

/// One large triangle in front of another.
pub(crate) fn two_layers() -> (Mesh, ViewSet) {
    let corners = [0.5, 0.25].into_iter().flat_map(|z| layer(|_| z));
    let set = grid_set(SubpixelBits::Sixteen, Cull::None);
    (soup_of(corners.collect()), set)
}

/// A large triangle with a depth at every column.
pub(crate) fn layer(depth: impl Fn(f64) -> f64) -> [DVec3; 3] {
    [(-12.3, -11.7), (13.1, -9.9), (0.3, 12.9)].map(|(x, y)| DVec3::new(x, y, depth(x)))
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
        let corners = soup.prop_map(|soup| soup.into_iter().flatten().collect());
        (Just(bits), corners)
    })
}

fn any_cull() -> impl Strategy<Value = Cull> {
    proptest::sample::select(vec![Cull::None, Cull::Back, Cull::Front])
}

proptest! {
    #![proptest_config(crate::support::cases(200))]

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
        let mesh = meshes::any(kind, seed);
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
    let Some(mesh) = model("bunny.ply") else {
        return;
    };
    let bits = SubpixelBits::Sixteen;
    let (mesh, set) = framed(&mesh, 2, 128, bits, Projection::Perspective);
    let found = check(&mesh, &set);
    assert!(found.passes(1e-4), "{:?}", found.worst);
    assert!(found.of(Class::Equal) > 8_000);
}

#[test]
fn casting_and_classifying_can_be_interrupted() {
    let (mesh, set) = two_layers();
    let caster = RayCaster::new(&mesh);
    let view = &set.views[0];
    let stopped = caster.keys(view, &set, &Impatient);
    assert!(matches!(stopped, Err(Error::Interrupted)));
    let rays = caster.keys(view, &set, &Silent).expect("goes on");
    let stopped = caster.classify(&set, 0, [&rays, &rays], &Impatient);
    assert!(matches!(stopped, Err(Error::Interrupted)));
}

#[test]
fn the_command_answers_with_classes_a_picture_and_its_exit_code() {
    let dir = folder();
    put(&dir, "in.ply", &generate::probe());
    let words = "check-rays in.ply --size 96 --subpixel-bits 8 --json r.json";
    expect(&dir, 0, &format!("{words} --picture p.png"));
    let report = json(&dir, "r.json");
    assert_eq!(report["tally"]["pixels"], 20 * 96 * 96);
    assert_eq!(report["unexplained"], 0);
    assert_eq!(report["options"]["subpixel_bits"], 8);
    let edges = report["tally"]["counts"]["edge"].as_u64().expect("a count");
    assert!(edges > 0 && report["explained"].as_u64() >= Some(edges));
    assert!(report["tally"]["worst"][0]["raster"]["depth"].is_u64());
    let picture = lodmark::encode::png::read(&dir.path().join("p.png")).expect("a picture");
    let picture = picture.into_rgb();
    assert!(picture.values().contains(&Class::Edge.color()));
    assert!(picture.width() > 5 * 96 && picture.height() > 4 * 96);
    // The same differences are too many where none may be.
    let none = lodmark(&dir, &format!("{words} --cap 0"));
    assert_eq!(code(&none), 1, "{}", stderr(&none));
    assert!(stdout(&none).contains("NOT what rays hit"));
    for (words, said) in [
        ("--cap 2", "--cap"),
        ("--subpixel-bits 9", "8 or 16"),
        ("--size 0", "0"),
    ] {
        refused(&dir, 2, &format!("check-rays in.ply {words}"), said);
    }
}

#[test]
fn no_number_of_threads_changes_what_check_rays_reports() {
    let dir = folder();
    put(&dir, "in.ply", &generate::probe());
    let reports = ["1", "2", "3"].map(|threads| {
        let words =
            "check-rays in.ply --size 70 --subpixel-bits 8 --views octahedron:0 --json r.json";
        expect(&dir, 0, &format!("{words} --threads {threads}"));
        bytes(&dir, "r.json")
    });
    assert!(reports.iter().all(|r| *r == reports[0]));
}
