//! The classifier against a rasterizer with planted bugs, and against claims that are wrong in a known way.

use glam::DVec3;
use lodmark::{
    Error, Silent,
    mesh::{Mesh, generate},
    num::fixed::SubpixelBits,
    raster::{self, Grid, SampleKey},
    validate::rays::{Class, RayCaster, TOLERANCE, cap},
    view::{Cull, Projection, View, ViewSet},
};

use crate::{
    support::scene_of,
    validate::rays::{framed, grid_set, layer, of_doubles, soup_of, tally, two_layers},
};

/// Squares of `step` pixels whose corners are pixel centres, every fourth triangle a second time.
fn tiles(step: usize) -> Mesh {
    let at = |i: usize| (i * step) as f64 - 12.5;
    let (side, mut triangles) = (24 / step + 1, Vec::new());
    let corner = |k| DVec3::new(at(k % side), at(k / side), ((k * 7) % 5) as f64 / 8.0);
    let positions = (0..side * side).map(corner).collect();
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
fn draw(mesh: &Mesh, view: &View, set: &ViewSet, bug: Bug) -> Grid<SampleKey> {
    let (width, height) = (f64::from(set.width), f64::from(set.height));
    let bits = set.subpixel.bits();
    // Left out is one that shows: that of the pixel in the middle of those which show any.
    let left_out = (bug == Bug::TriangleLeftOut).then(|| {
        let shown = draw(mesh, view, set, Bug::None);
        let seen = shown.values().iter().filter(|k| !k.is_background());
        let ids: Vec<u32> = seen.map(|k| k.id()).collect();
        ids[ids.len() / 2] as usize
    });
    let mut keys = Grid::filled(set.width, set.height, u64::MAX);
    let place = |p: &DVec3| {
        let row = |m: [f64; 4]| ((m[0] * p.x + m[1] * p.y) + m[2] * p.z) + m[3];
        let [x, y, z, w] = view.matrix.map(row);
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
    };
    let screen: Vec<[i128; 3]> = mesh.positions().iter().map(place).collect();
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
            let mut edges = [[b, c], [c, a], [a, b]].into_iter().zip(weights);
            let covers = edges.all(|([u, v], e)| {
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
    keys.map(SampleKey::from_bits)
}

#[test]
fn the_rasterizer_for_planted_bugs_has_none_of_its_own() {
    let sixteen = SubpixelBits::Sixteen;
    let torus = generate::torus(1.0, 0.4, 24, 12);
    let (torus, views) = framed(&torus, 2, 64, sixteen, Projection::Perspective);
    for (mesh, set) in [
        (torus, views),
        (tiles(3), grid_set(sixteen, Cull::None)),
        (tiles(4), grid_set(SubpixelBits::Eight, Cull::None)),
    ] {
        let scene = scene_of(&mesh);
        for view in &set.views {
            let drawn = raster::keys(&scene, view, &set).keys;
            assert_eq!(draw(&mesh, view, &set, Bug::None), drawn);
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
            let flagged = found.unexplained() > 0 && !found.passes(1.0);
            assert_eq!(flagged, visible, "{bug:?}: {:?}", found.counts);
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
            let flagged = found.unexplained() > 0 && !found.passes(1.0);
            assert!(flagged, "{bits:?} {bug:?}: {:?}", found.counts);
        }
    }
}

#[test]
fn a_difference_is_named_after_what_is_wrong() {
    let (mesh, set) = two_layers();
    let caster = RayCaster::new(&mesh);
    let rays = caster.keys(&set.views[0], &set, &Silent).expect("goes on");
    // The pixel in the middle, far from every edge: the triangle in front has number 1.
    let at = 16 * 32 + 16;
    let near = rays.values()[at];
    assert_eq!(near, SampleKey::new(0x4000_0000, 1));
    for (shown, class) in [
        (SampleKey::BACKGROUND, Class::Hole),
        (SampleKey::new(0x8000_0000, 0), Class::Occluded),
        (SampleKey::new(0x4000_0000, 2), Class::Range),
        (SampleKey::new(0x4000_0009, 1), Class::Depth),
        (SampleKey::new(0x4000_0002, 1), Class::Equal),
    ] {
        let mut planted = rays.clone();
        planted.values_mut()[at] = shown;
        let found = caster.classify(&set, 0, [&planted, &rays], &Silent);
        let found = found.expect("one size");
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
    let reversed = classes([&rays, &planted]);
    assert_eq!(reversed, Class::Rays, "the other way round");
    let small = Grid::filled(31, 32, SampleKey::BACKGROUND);
    let refused = caster.classify(&set, 0, [&small, &rays], &Silent);
    assert!(matches!(refused, Err(Error::Usage(_))));
}

/// The class of the pixel (16, 16) of a scene on the grid where the rasterizer shows `shown` and the rays something else.
fn class_of(corners: impl IntoIterator<Item = DVec3>, shown: SampleKey) -> Class {
    let mesh = soup_of(corners.into_iter().collect());
    let set = grid_set(SubpixelBits::Sixteen, Cull::None);
    class_at(&mesh, &set, [16, 16], shown)
}

/// The class of one pixel where the rasterizer shows `shown` and the rays something else.
fn class_at(mesh: &Mesh, set: &ViewSet, [x, y]: [u32; 2], shown: SampleKey) -> Class {
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
        // At distance 0 the ray, moved right by a hair, misses.
        let shown = match distance > 0.0 {
            true => SampleKey::BACKGROUND,
            false => SampleKey::new(0x1999_9999, 0),
        };
        assert_eq!(class_of(corners, shown), class, "{distance}");
    }
    // Two parallel triangles of no slope, so many quanta apart.
    for (quanta, class) in [
        (1, Class::DepthTie),
        (2, Class::DepthTie),
        (3, Class::Occluded),
    ] {
        let depths = [1_000 + quanta, 1_000].map(|z| f64::from(z) / 4_294_967_296.0);
        let corners = depths.into_iter().flat_map(|z| layer(|_| z));
        let shown = SampleKey::new(1_000 + quanta, 0);
        assert_eq!(class_of(corners, shown), class, "{quanta}");
    }
    // The same on a slope of a million quanta per pixel: 3,906 of them within the tolerance, for each triangle.
    for (quanta, class) in [(7_000.0, Class::DepthTie), (8_500.0, Class::Occluded)] {
        let sloped = |above: f64| layer(|x| (1e9 + 1e6 * x + above) / 4_294_967_296.0);
        let corners = [quanta, 0.0].into_iter().flat_map(sloped);
        let shown = SampleKey::new(1_000_000, 0);
        assert_eq!(class_of(corners, shown), class, "{quanta}");
    }
}

#[test]
fn what_the_near_plane_cuts_off_and_what_is_culled_is_not_there() {
    // Depth grows to the right and is 0 this far from the centre of pixel (16, 16).
    for (distance, class) in [
        (0.9 * TOLERANCE, Class::Edge),
        (1.1 * TOLERANCE, Class::Stray),
        (9.0, Class::Stray),
    ] {
        let corners = layer(|x| (x - 0.5 - distance) / 32.0);
        let found = class_of(corners, SampleKey::new(0, 0));
        assert_eq!(found, class, "{distance}");
    }
    for (cull, class) in [
        (Cull::None, Class::Equal),
        (Cull::Back, Class::Equal),
        (Cull::Front, Class::Stray),
    ] {
        let z = 1_000.0 / 4_294_967_296.0 + 1e-12;
        let mesh = soup_of(layer(|_| z).to_vec());
        let mut set = grid_set(SubpixelBits::Sixteen, cull);
        let shown = SampleKey::new(1_000, 0);
        let found = class_at(&mesh, &set, [16, 16], shown);
        assert_eq!(found, class, "{cull:?}");
        // Seen from the other side it is the other way round.
        let mirrored = match cull {
            Cull::Back => Class::Stray,
            _ => Class::Equal,
        };
        set.views[0].matrix[0][0] = -0.0625;
        let found = class_at(&mesh, &set, [15, 16], shown);
        assert_eq!(found, mirrored, "{cull:?}");
    }
}
