//! Quadrics of texture coordinates and colours: vectors, seams, and what they are worth.

use std::collections::BTreeSet;

use glam::DVec3;
use lodmark::{
    collapse::{EdgeStar, Method, MethodScratch, Replay, Rules, Site},
    mesh::{Attributes, ChannelKind, Mesh, MeshParts, canonical, content_sha256, generate, weld},
    num::math,
    simplify::{
        Options, Stop, Target, Topology,
        quadric::{AttributeQuadric, Quadric, QuadricMethod, QuadricOptions, Values},
        simplify,
    },
};
use proptest::prelude::*;

use crate::support::{Random, live, meshes, same_on_all_threads};

const FIRST: [DVec3; 3] = [
    DVec3::new(0.1, 0.2, -0.3),
    DVec3::new(0.9, 0.1, 0.2),
    DVec3::new(0.3, 0.8, 0.1),
];
const SECOND: [DVec3; 3] = [
    DVec3::new(0.5, -0.4, 0.3),
    DVec3::new(-0.2, 0.6, 0.4),
    DVec3::new(0.7, 0.5, -0.6),
];
const AT: DVec3 = DVec3::new(0.4, -0.1, 0.25);

fn st(s: f64, t: f64) -> Values {
    [s, t, 0.0, 0.0]
}

fn first_texture(steep: f64) -> [Values; 3] {
    [st(0.2, 0.1), st(1.1, 0.3), st(0.4, 1.2)].map(|v| v.map(|x| x * steep))
}

fn second_texture() -> [Values; 3] {
    [st(0.9, 0.2), st(0.3, 1.4), st(1.3, -0.5)]
}

/// A face weighted by its area: its plane in space, and what its values add.
fn face(points: [DVec3; 3], values: [Values; 3], scale: f64) -> (Quadric, AttributeQuadric) {
    let n = (points[1] - points[0]).cross(points[2] - points[0]);
    let area = n.length() * 0.5;
    let plane = Quadric::plane(points[0], n.normalize(), area);
    let more = AttributeQuadric::face(points, values, scale, area);
    (plane, more.expect("not degenerate"))
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found}, not {expected}"
    );
}

// The vectors: numpy 2.4, double precision. Corners (x, y, z, k s, k t, ...) are p, q, r; e1 = (q - p) / |q - p|,
// e2 = (r - p) - e1 (e1 . (r - p)), made unit; A = I - e1 e1^T - e2 e2^T, b = (p . e1) e1 + (p . e2) e2 - p,
// c = p . p - (p . e1)^2 - (p . e2)^2, times the area in space; E = v^T A v + 2 b . v + c (Garland & Heckbert 1998).

#[test]
fn a_face_with_values_costs_what_the_vectors_say() {
    for (scale, steep, values, error) in [
        (0.75, 1.0, st(0.7, -0.2), 0.049_264_090_503_137_51),
        // Slopes of 100,000: E is that of the plane in space and of the directions that the slopes leave open.
        (1.0, 1e5, st(7e4, -2e4), 0.053_554_247_802_984_29),
    ] {
        let (plane, more) = face(FIRST, first_texture(steep), scale);
        assert_near(
            plane.error(AT) + more.error(AT, values),
            error,
            1e-6 * steep.min(10.0),
        );
    }
    let colors = [
        [0.1, 0.9, 0.3, 1.0],
        [0.8, 0.2, 0.5, 0.6],
        [0.4, 0.4, 0.9, 0.2],
    ];
    let (plane, more) = face(FIRST, colors, 1.3);
    let error = plane.error(AT) + more.error(AT, [0.3, 0.6, 0.2, 0.5]);
    assert_near(error, 0.136_212_729_077_463_96, 1e-14);
}

#[test]
fn two_faces_cost_least_where_five_unknowns_have_no_gradient() {
    // The vectors: numpy.linalg.solve(A, -b) of the sum, and of its last two rows for the position given.
    let (plane, mut more) = face(FIRST, first_texture(1.0), 0.75);
    let (second_plane, second) = face(SECOND, second_texture(), 0.75);
    more.add(&second);
    let plane = plane.plus(&second_plane);
    let left = plane.plus(&more.without_values(2).expect("determined"));
    let best = left.minimum().expect("well conditioned");
    let expected = [
        0.982_267_005_215_794_4,
        -0.620_931_803_256_751_1,
        -0.063_847_553_227_895_56,
    ];
    for (found, expected) in best.to_array().into_iter().zip(expected) {
        assert_near(found, expected, 1e-11);
    }
    assert_near(left.error(best), 0.004_443_534_130_554_649, 1e-13);
    for (at, values, error) in [
        (
            best,
            [1.344_540_037_098_4, -0.751_339_382_875_543_1],
            0.004_443_534_130_554_649,
        ),
        (
            AT,
            [0.823_325_946_172_359_2, 0.281_020_580_683_634_45],
            0.051_769_073_148_794_365,
        ),
    ] {
        let found = more.values_at(at, 2).expect("determined");
        assert_near(found[0], values[0], 1e-11);
        assert_near(found[1], values[1], 1e-11);
        assert_near(plane.error(at) + more.error(at, found), error, 1e-13);
        assert_near(left.error(at), error, 1e-13);
    }
}

proptest! {
    #![proptest_config(crate::support::cases(128))]

    #[test]
    fn a_face_costs_the_distance_to_its_lifted_plane(seed: u64, width in 2_usize..5, corner in 0_usize..3) {
        let mut random = Random(seed);
        let points = [0; 3].map(|_| random.vector(0.5));
        let values: [Values; 3] = [0; 3].map(|_| {
            let mut values = [0.0; 4];
            values[..width].fill_with(|| random.between(-2.0, 2.0));
            values
        });
        let (at, mut own) = (random.vector(0.5), [0.0; 4]);
        own[..width].fill_with(|| random.between(-2.0, 2.0));
        let scale = random.between(0.1, 3.0);
        // The distance by taking away what lies along the edges, in seven dimensions.
        let lifted = |p: DVec3, s: Values| -> [f64; 7] {
            [p.x, p.y, p.z, scale * s[0], scale * s[1], scale * s[2], scale * s[3]]
        };
        let dot = |a: [f64; 7], b: [f64; 7]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let less = |mut a: [f64; 7], b: [f64; 7], times: f64| {
            a.iter_mut().zip(b).for_each(|(x, y)| *x -= times * y);
            a
        };
        let base = lifted(points[0], values[0]);
        let edge = |k: usize| less(lifted(points[k], values[k]), base, 1.0);
        let first = edge(1);
        let second = less(edge(2), first, dot(edge(2), first) / dot(first, first));
        let mut left = less(lifted(at, own), base, 1.0);
        for direction in [first, second] {
            left = less(left, direction, dot(left, direction) / dot(direction, direction));
        }
        let turned = |k: usize| (k + corner) % 3;
        let (plane, more) = face([0, 1, 2].map(|k| points[turned(k)]), [0, 1, 2].map(|k| values[turned(k)]), scale);
        let area = (points[1] - points[0]).cross(points[2] - points[0]).length() * 0.5;
        let found = plane.error(at) + more.error(at, own);
        prop_assert!((found - area * dot(left, left)).abs() < 1e-9, "{found} {}", area * dot(left, left));
    }
}

/// The proposal for every edge of a mesh that may be collapsed, and the values of each.
fn proposals(mesh: &Mesh, attributes: bool) -> Vec<(DVec3, f64, Vec<f64>)> {
    let live = live(mesh);
    let own = QuadricOptions {
        attributes,
        ..QuadricOptions::default()
    };
    let method = QuadricMethod::new(&live, &own);
    let mut star = EdgeStar::default();
    let mut all = Vec::new();
    for edge in 0..live.edge_ids() {
        star.gather(&live, edge);
        let Ok(site) = Site::new(&live, &star, Rules::default()) else {
            continue;
        };
        let site = Site {
            values: method.wedge_values(),
            ..site
        };
        let Ok(proposal) = method.propose(&site, &mut MethodScratch::default()) else {
            continue;
        };
        let mut values = Vec::new();
        site.each_value(proposal.position, |_, own| values.extend_from_slice(own));
        all.push((
            live.frame().leave(proposal.position.position()),
            proposal.secondary,
            values,
        ));
    }
    all
}

/// A mesh with channels whose values every corner gets from its position and the centroid of its triangle.
fn painted(mesh: Mesh, kinds: &[ChannelKind], paint: impl Fn(DVec3, DVec3) -> Vec<f64>) -> Mesh {
    let mut parts = mesh.into_parts();
    let mut values = Vec::new();
    for triangle in &parts.triangles {
        let points = triangle.map(|v| parts.positions[v as usize]);
        let centroid = (points[0] + points[1] + points[2]) / 3.0;
        values.extend(points.into_iter().flat_map(|p| paint(p, centroid)));
    }
    let corners = (0..parts.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    parts.attributes = Attributes::new(kinds, values, corners.collect()).expect("fits");
    canonical(&weld(Mesh::new(parts).expect("valid")).mesh).mesh
}

const TEXTURE: &[ChannelKind] = &[ChannelKind::TexCoord(0)];

fn flat(side: u32) -> Mesh {
    generate::grid(side, side, generate::Height::Flat)
}

/// The corners of every triangle with their values.
fn corners(mesh: &Mesh) -> Vec<[(DVec3, Vec<f64>); 3]> {
    let corner = |v: u32, w: u32| {
        let row = mesh.attributes().row(w);
        (mesh.positions()[v as usize], row.to_vec())
    };
    let triangles = mesh.triangles().iter().zip(mesh.attributes().corners());
    triangles
        .map(|(v, w)| [0, 1, 2].map(|k| corner(v[k], w[k])))
        .collect()
}

fn by_attributes(triangles: u64) -> Options {
    Options::quadric(Target::Triangles(triangles)).attributes()
}

fn run(mesh: &Mesh, options: &Options) -> Mesh {
    simplify(mesh, options).expect("valid").mesh
}

#[test]
fn an_affine_texture_on_a_bent_sheet_is_reproduced_and_costs_nothing() {
    // Bent along x alone, and a texture that does not change along x: linear on the surface, whatever the bend.
    let mut parts = flat(10).into_parts();
    for p in &mut parts.positions {
        p.z = 0.4 * p.x * p.x;
    }
    let bent = Mesh::new(parts).expect("valid");
    let map = |y: f64| [0.7 * y + 3.0, 0.2 - 0.3 * y];
    let mesh = painted(bent, TEXTURE, |p, _| map(p.y).to_vec());
    let (plain, own) = (proposals(&mesh, false), proposals(&mesh, true));
    assert!(plain.len() > 200 && plain.len() == own.len());
    for ((_, cost, _), (place, own_cost, values)) in plain.iter().zip(&own) {
        assert_near(*own_cost, *cost, 1e-9);
        let [s, t] = map(place.y);
        assert_near(values[0], s, 1e-6);
        assert_near(values[1], t, 1e-6);
    }
    // Flat, and affine in both directions.
    let map = |p: DVec3| [0.3 * p.x - 0.1 * p.y + 2.0, 0.2 * p.x + 0.4 * p.y];
    let mesh = painted(flat(24), TEXTURE, |p, _| map(p).to_vec());
    for (p, values) in corners(&run(&mesh, &by_attributes(40)))
        .into_iter()
        .flatten()
    {
        let [s, t] = map(p);
        assert_near(values[0], s, 1e-6);
        assert_near(values[1], t, 1e-6);
    }
}

#[test]
fn constant_values_change_no_bit() {
    let kinds = [
        ChannelKind::TexCoord(0),
        ChannelKind::TexCoord(1),
        ChannelKind::Color,
    ];
    for mesh in [meshes::torus(16, 10, 3), meshes::grid(12, 5)] {
        let values = [0.3_f32, 0.7, -5.0, 0.1, 0.25, 0.5, 1.0].map(f64::from);
        let mesh = painted(mesh, &kinds, |_, _| values.to_vec());
        let [plain, own] = [Options::quadric(Target::Triangles(60)), by_attributes(60)]
            .map(|options| simplify(&mesh, &options).expect("valid"));
        assert_eq!(plain.history.len(), own.history.len());
        assert!(plain.mesh == own.mesh);
    }
}

#[test]
fn a_mesh_without_channels_that_take_part_is_simplified_as_without_the_option() {
    let bare = meshes::torus(16, 10, 3);
    let normals = meshes::with_normals(&bare, |_, p, _| Some(p.normalize()));
    for mesh in [bare, normals] {
        let plain = run(&mesh, &Options::quadric(Target::Triangles(60)));
        assert!(plain == run(&mesh, &by_attributes(60)));
    }
}

#[test]
fn the_sides_of_a_seam_keep_their_own_values_and_collapse_together() {
    let maps = [
        |p: DVec3| vec![0.2 * p.x, 0.3 * p.y],
        |p: DVec3| vec![5.0 - 0.4 * p.y, 7.0 + 0.1 * p.x + 0.2 * p.y],
    ];
    let side = |centroid: DVec3| usize::from(centroid.x > 0.0);
    let mesh = painted(flat(16), TEXTURE, |p, c| maps[side(c)](p));
    let options = by_attributes(30).topology(Topology::Preserve);
    let outcome = simplify(&mesh, &options).expect("valid");
    assert_eq!(outcome.stop, Stop::TargetReached);
    let mut on_seam = [BTreeSet::new(), BTreeSet::new()];
    for face in corners(&outcome.mesh) {
        let centroid = (face[0].0 + face[1].0 + face[2].0) / 3.0;
        for (p, values) in face {
            let expected = maps[side(centroid)](p);
            assert_near(values[0], expected[0], 2e-6);
            assert_near(values[1], expected[1], 2e-6);
            if p.x == 0.0 {
                on_seam[side(centroid)].insert(p.y.to_bits());
            }
        }
    }
    assert!(
        on_seam[0] == on_seam[1] && on_seam[0].len() < 16,
        "{on_seam:?}"
    );
}

#[test]
fn threads_and_first_corners_change_no_bit_and_a_history_has_the_values() {
    let kinds = [ChannelKind::TexCoord(0), ChannelKind::ColorAlpha];
    let paint = |p: DVec3, _: DVec3| {
        vec![
            p.x * p.y,
            p.y - p.z * p.z,
            0.5 + 0.3 * p.x,
            0.5,
            0.5 - 0.2 * p.z * p.y,
            1.0,
        ]
    };
    let colored = painted(meshes::torus(18, 12, 5), &kinds, paint);
    for mesh in [
        colored,
        canonical(&meshes::textured_torus(18, 12, 2, true)).mesh,
    ] {
        let expected = same_on_all_threads(|| content_sha256(&run(&mesh, &by_attributes(120))));
        let parts = mesh.clone().into_parts();
        let rotated = |t: &[u32; 3]| [t[1], t[2], t[0]];
        let turned = Mesh::new(MeshParts {
            triangles: parts.triangles.iter().map(rotated).collect(),
            attributes: {
                let a = &parts.attributes;
                let kinds: Vec<_> = a.channels().iter().map(|c| c.kind).collect();
                let corners = a.corners().iter().map(rotated).collect();
                Attributes::new(&kinds, a.values().to_vec(), corners).expect("valid")
            },
            ..parts
        });
        let turned = canonical(&turned.expect("valid")).mesh;
        assert_eq!(content_sha256(&run(&turned, &by_attributes(120))), expected);
        let options = by_attributes(120)
            .keep_folds()
            .normals(lodmark::simplify::Normals::Carry);
        let outcome = simplify(&mesh, &options).expect("valid");
        let mut replay = Replay::new(&mesh, &outcome.history).expect("its input");
        replay.seek(120).expect("fits");
        assert!(replay.live().to_mesh().expect("valid") == outcome.mesh);
        let finer = run(&mesh, &options.target(Target::Triangles(200)));
        replay.seek(200).expect("fits");
        assert!(replay.live().to_mesh().expect("valid") == finer);
    }
}

#[test]
fn absent_values_steep_slopes_and_flat_triangles_are_survived() {
    let mut random = Random(7);
    let kinds = [
        ChannelKind::TexCoord(0),
        ChannelKind::TexCoord(1),
        ChannelKind::Color,
    ];
    for case in 0..4 {
        let mut parts = meshes::grid(8, case).into_parts();
        for v in (0..parts.positions.len()).step_by(5) {
            // Needles, and triangles of no area.
            parts.positions[v] = parts.positions[(v + 1) % 9];
        }
        let mut values = Vec::new();
        for t in 0..3 * parts.triangles.len() {
            for k in 0..7 {
                values.push(match (t + k) % 11 {
                    0 if case % 2 == 0 => f64::NAN,
                    1 => 1e30 * random.unit(),
                    2 => 0.0,
                    _ => random.unit(),
                });
            }
        }
        let wedges = (0..parts.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        parts.attributes = Attributes::new(&kinds, values, wedges.collect()).expect("valid");
        let mesh = Mesh::new(parts).expect("valid");
        for topology in [Topology::Auto, Topology::Preserve, Topology::Free] {
            let options = by_attributes(10).topology(topology);
            let left = run(&mesh, &options);
            assert!(left.triangles().len() <= mesh.triangles().len());
            assert!(left.attributes().values().iter().all(|x| !x.is_infinite()));
        }
    }
}

/// The root mean square of the distance in the texture between what a flat mesh shows at a point and what `map` wants.
fn displacement(mesh: &Mesh, map: impl Fn(DVec3) -> [f64; 2]) -> f64 {
    let faces = corners(mesh);
    let (mut sum, mut count) = (0.0, 0.0);
    for i in 0..10_000 {
        let at = DVec3::new(f64::from(i % 100), f64::from(i / 100), 0.0) * 0.0198
            - DVec3::new(0.985, 0.985, 0.0);
        let shown = faces.iter().find_map(|[(a, s), (b, t), (c, u)]| {
            let area = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).z;
            let whole = area(*a, *b, *c);
            let shares = [area(at, *b, *c), area(*a, at, *c), area(*a, *b, at)].map(|x| x / whole);
            let inside = shares.iter().all(|&x| x >= -1e-9);
            let mix = |k: usize| shares[0] * s[k] + shares[1] * t[k] + shares[2] * u[k];
            inside.then(|| [mix(0), mix(1)])
        });
        if let Some(shown) = shown {
            let wanted = map(at);
            let (x, y) = (shown[0] - wanted[0], shown[1] - wanted[1]);
            sum += x * x + y * y;
            count += 1.0;
        }
    }
    assert!(count > 9_900.0);
    math::sqrt(sum / count)
}

#[test]
fn a_texture_that_bends_on_a_flat_sheet_is_kept_better_than_by_planes() {
    // Squares of a checker that are bent to waves where x is small, and straight elsewhere.
    let map = |p: DVec3| {
        let wave = if p.x < 0.0 {
            0.1 * libm::sin(9.0 * p.x) * libm::sin(7.0 * p.y)
        } else {
            0.0
        };
        [p.x + wave, p.y - 0.5 * wave]
    };
    let mesh = painted(flat(32), TEXTURE, |p, _| map(p).to_vec());
    let error = |options: Options| displacement(&run(&mesh, &options), map);
    for triangles in [400, 150] {
        let [plain, own] = [
            Options::quadric(Target::Triangles(triangles)),
            by_attributes(triangles),
        ]
        .map(error);
        assert!(
            own < 0.5 * plain,
            "{triangles} triangles: {own}, and {plain} by planes"
        );
    }
}
