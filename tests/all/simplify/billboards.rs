//! Billboard clouds: no viewer sees a point displaced by more than the angle, nothing is lost, nothing depends on
//! threads, and what cannot be done is said.

#![allow(
    clippy::disallowed_methods,
    clippy::float_cmp,
    clippy::print_stdout,
    reason = "what is held against the crate's math must not use it; exact results are exact; cases are counted aloud"
)]

mod borders;
mod command;
mod measured;

use glam::{DVec2, DVec3};
use lodmark::{
    Silent,
    bound::{planar::Aperture, view_cell::ViewCell},
    mesh::{Mesh, generate},
    simplify::billboards::{BillboardOptions, Cloud, Limit, Quad, Up, billboards},
};

use crate::support::{Random, at, mesh_of, same_on_all_threads, square};

fn within(degrees: f64) -> BillboardOptions {
    let aperture = Aperture::degrees(degrees).expect("below 90");
    BillboardOptions {
        directions: 60,
        texels: 128,
        ..BillboardOptions::within(Limit::Angle(aperture))
    }
}

fn before_the_city() -> ViewCell {
    ViewCell::half_space(at(0.0, -6.0, 0.0), DVec3::Y).expect("a normal")
}

fn in_the_forest() -> ViewCell {
    segment(at(-10.0, 0.0, 0.0), at(10.0, 0.0, 0.0))
}

fn segment(from: DVec3, to: DVec3) -> ViewCell {
    ViewCell::segment([from, to]).expect("two points")
}

fn cuboid(low: DVec3, high: DVec3) -> ViewCell {
    ViewCell::cuboid(low, high).expect("a box")
}

/// As [`within`], by a distance.
fn within_distance(distance: f64) -> BillboardOptions {
    let limit = Limit::Distance(distance);
    BillboardOptions {
        limit,
        ..within(1.0)
    }
}

fn cloud(mesh: &Mesh, cell: &ViewCell, options: &BillboardOptions) -> Cloud {
    billboards(mesh, cell, options, &Silent).expect("a cloud")
}

/// So many buildings of the city.
fn blocks(count: usize) -> Mesh {
    let city = generate::city();
    let corners: Vec<DVec3> = (0..10 * count).flat_map(|t| city.corners(t)).collect();
    let triangles = (0..10 * count as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    mesh_of(corners, triangles.collect::<Vec<_>>())
}

/// The angle across the horizon.
fn angle(v: DVec2, a: DVec3, b: DVec3) -> f64 {
    let (a, b) = (a.truncate() - v, b.truncate() - v);
    (a.x * b.y - a.y * b.x).abs().atan2(a.x * b.x + a.y * b.y)
}

/// Plan viewpoints: the border of a cell, finely.
fn viewers(cell: &str) -> Vec<DVec2> {
    let side = |a: DVec2, b: DVec2| (0..=60).map(move |i| a + (b - a) * (f64::from(i) / 60.0));
    match cell {
        "half-space" => {
            let turn = |i: i32| f64::from(i) / 402.0 * std::f64::consts::FRAC_PI_2;
            let place = |i| DVec2::new(25.0 + 30.0 * turn(i).tan(), -6.0);
            (-400..=400).map(place).collect()
        }
        "segment" => side(DVec2::new(-10.0, 0.0), DVec2::new(10.0, 0.0)).collect(),
        _ => {
            let c = [[-9.0, -12.0], [9.0, -12.0], [9.0, -4.0], [-9.0, -4.0]].map(DVec2::from_array);
            (0..4).flat_map(|i| side(c[i], c[(i + 1) % 4])).collect()
        }
    }
}

fn sampled(mesh: &Mesh, t: u32, random: &mut Random, count: usize) -> Vec<DVec3> {
    let [a, b, c] = mesh.corners(t as usize);
    let mut points = vec![a, b, c];
    for _ in 0..count {
        let [s, t] = [random.unit(), random.unit()];
        let [s, t] = [s, t].map(|x| if s + t > 1.0 { 1.0 - x } else { x });
        points.push(a + (b - a) * s + (c - a) * t);
    }
    points
}

#[test]
fn no_viewer_sees_a_point_displaced_by_more_than_the_angle() {
    let mut random = Random::new(2007, 400);
    let around = cuboid(at(-9.0, -12.0, 0.0), at(9.0, -4.0, 3.0));
    let scenes = [
        ("half-space", before_the_city(), blocks(60), 0.3),
        ("segment", in_the_forest(), generate::trees(400, 120.0), 0.5),
        ("box", around, blocks(60), 1.0),
    ];
    for (name, cell, mesh, degrees) in scenes {
        let cloud = cloud(&mesh, &cell, &within(degrees));
        let theta = degrees.to_radians();
        let (mut worst, mut shared, mut slanted) = (0.0_f64, 0, 0);
        for quad in cloud.quads.iter().filter(|q| !q.horizontal) {
            shared += usize::from(quad.replaces.len() > 2);
            slanted += usize::from(quad.replaces.len() > 2 && quad.along != quad.axes[2]);
            // Everything that is drawn, not only what is replaced.
            for &t in &quad.drawn {
                for p in sampled(&mesh, t, &mut random, 2) {
                    let s = quad.project(p);
                    for &v in &viewers(name) {
                        worst = worst.max(angle(v, p, s));
                    }
                }
            }
        }
        let range = theta * 0.4..=theta * (1.0 + 1e-9);
        assert!(range.contains(&worst), "{name}: {worst} of {theta}");
        assert!(shared > 3, "{name}: {shared} shared planes");
        assert!(slanted > 3 || name != "segment", "{slanted} slanted planes");
        let claimed = cloud.displacement.horizontal;
        assert!(range.contains(&claimed), "{name}: {claimed} of {theta}");
    }
}

#[test]
fn every_texel_shows_a_point_that_belongs_there() {
    let cell = in_the_forest();
    let mesh = generate::trees(300, 100.0);
    let cloud = cloud(&mesh, &cell, &within(0.5));
    let theta = 0.5_f64.to_radians();
    let (mut opaque, mut empty, mut slanted) = (0, 0, 0);
    for quad in cloud.quads.iter().filter(|q| q.drawn.len() > 2).take(12) {
        slanted += usize::from(quad.along.dot(quad.axes[2]) < 0.97);
        let texture = quad.texture(&mesh);
        assert_eq!([texture.width(), texture.height()], quad.texels);
        for y in (0..texture.height()).step_by(3) {
            for x in (0..texture.width()).step_by(3) {
                let at = |u: f64, v: f64| place(quad, f64::from(x) + u, f64::from(y) + v);
                let shown = |at: DVec3| -> Vec<DVec3> {
                    let behind = |&t: &u32| behind(mesh.corners(t as usize), at, quad.along);
                    quad.drawn.iter().filter_map(behind).collect()
                };
                if texture.at(x, y)[3] == 0 {
                    empty += 1;
                    // A triangle may miss the centre of a texel by the grid of the rasterizer only.
                    let mut near = [(0.4, 0.4), (0.6, 0.4), (0.4, 0.6), (0.6, 0.6)].into_iter();
                    let inner = near.all(|(u, v)| !shown(at(u, v)).is_empty());
                    assert!(!inner, "a covered texel at {x}, {y} is transparent");
                    continue;
                }
                opaque += 1;
                let at = at(0.5, 0.5);
                for p in shown(at) {
                    for &v in viewers("segment").iter().step_by(6) {
                        let seen = angle(v, p, at);
                        assert!(seen <= theta * (1.0 + 1e-9), "{seen} > {theta} at {x}, {y}");
                    }
                }
            }
        }
    }
    assert!(opaque > 300 && empty > 300, "{opaque} {empty}");
    assert!(slanted > 2, "{slanted} slanted quads");
}

/// A point of a quad by column and row, in texels.
fn place(quad: &Quad, x: f64, y: f64) -> DVec3 {
    let [right, up, _] = quad.axes;
    let [width, height] = quad.texels.map(f64::from);
    let (u, v) = (x / width, 1.0 - y / height);
    quad.corner + right * (u * quad.size[0]) + up * (v * quad.size[1])
}

/// Where the line through `at` along `axis` meets a triangle.
fn behind([a, b, c]: [DVec3; 3], at: DVec3, axis: DVec3) -> Option<DVec3> {
    let normal = (b - a).cross(c - a);
    let steep = normal.dot(axis);
    if steep.abs() < 1e-9 * normal.length() {
        return None;
    }
    let p = at + axis * ((a - at).dot(normal) / steep);
    let inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|&(e, f)| (f - e).cross(p - e).dot(normal) >= 0.0);
    inside.then_some(p)
}

#[test]
fn every_triangle_is_shown_by_one_quad_for_its_own() {
    let around = cuboid(at(1.0, 1.0, 0.0), at(3.0, 9.0, 3.0));
    let sphere = generate::icosphere(2);
    let [near, inside] = [4.0, 0.1].map(|x| ViewCell::point(DVec3::X * x).expect("a point"));
    for (mesh, cell) in [
        (blocks(45), before_the_city()),
        (blocks(45), around),
        (generate::trees(200, 60.0), in_the_forest()),
        (sphere.clone(), near),
        (sphere, inside),
    ] {
        let cloud = cloud(&mesh, &cell, &within(0.5));
        let mut count = vec![0; mesh.triangles().len()];
        let replaced = cloud.quads.iter().flat_map(|q| &q.replaces);
        for &t in replaced.chain(&cloud.kept) {
            count[t as usize] += 1;
        }
        assert!(count.iter().all(|&n| n == 1), "{count:?}");
        for quad in &cloud.quads {
            assert!(quad.replaces.iter().all(|t| quad.drawn.contains(t)));
            let [right, up, back] = quad.axes;
            assert!((right.cross(up) - back).length() < 1e-12);
            assert!((quad.along.length() - 1.0).abs() < 1e-12 && quad.along.dot(back) > 0.1);
            for &t in &quad.replaces {
                for p in mesh.corners(t as usize) {
                    let on = quad.project(p) - quad.corner;
                    let (x, y) = (on.dot(right), on.dot(up));
                    let inside = |x: f64, side: f64| (-1e-9..=side + 1e-9).contains(&x);
                    assert!(inside(x, quad.size[0]) && inside(y, quad.size[1]));
                }
            }
        }
    }
}

#[test]
fn the_city_needs_no_more_quads_than_the_published_one() {
    let aperture = Aperture::degrees(0.1).expect("below 90");
    let mut options = BillboardOptions::within(Limit::Angle(aperture));
    let city = generate::city();
    assert_eq!(city.triangles().len(), 4200);
    let cloud = cloud(&city, &before_the_city(), &options);
    let vertical = cloud.quads.iter().filter(|q| !q.horizontal).count();
    assert!(vertical <= 100, "{vertical} quads for facades");
    options.any_height = true;
    let flattened = self::cloud(&city, &before_the_city(), &options);
    let count = flattened.quads.len();
    assert!(count <= 115, "{count} quads");
    assert!(flattened.kept.is_empty() && cloud.kept.is_empty());
    let [exact, flat] = [&cloud, &flattened].map(|c| c.displacement.vertical);
    assert!(exact < 0.3_f64.to_radians() && flat > 0.1, "{exact} {flat}");
}

#[test]
fn without_tolerance_nothing_is_displaced() {
    let mesh = blocks(30);
    let cloud = cloud(&mesh, &before_the_city(), &within(0.0));
    for quad in &cloud.quads {
        for &t in &quad.replaces {
            for p in mesh.corners(t as usize) {
                assert!((quad.project(p) - p).length() < 1e-12, "{p} moves");
            }
        }
    }
    let count = cloud.quads.len();
    assert!(cloud.kept.is_empty() && count < 150, "{count}");
    assert!(cloud.displacement.horizontal < 1e-9);
}

#[test]
fn a_wider_angle_needs_no_more_quads() {
    let mesh = blocks(30);
    let count = |degrees| {
        cloud(&mesh, &before_the_city(), &within(degrees))
            .quads
            .len()
    };
    let counts = [0.1, 1.0, 10.0, 89.0].map(count);
    assert!(counts.is_sorted_by(|a, b| a >= b), "{counts:?}");
    assert!(counts[3] <= 4, "{counts:?}");
}

#[test]
fn what_viewers_stand_in_is_not_moved() {
    let mesh = blocks(10);
    let cell = cuboid(at(-1.0, 0.5, 0.0), at(0.8, 0.9, 2.0));
    let cloud = cloud(&mesh, &cell, &within(1.0));
    // The wall at x = 0 and the roof of the first building.
    assert!(cloud.kept.len() >= 2, "{:?}", cloud.kept);
    for &t in &cloud.kept {
        assert!(t < 10, "triangle {t} of another building is kept");
    }
    // Viewers right on a wall: it stays in its plane.
    let on_wall = segment(at(0.2, 0.0, 1.0), at(0.6, 0.0, 1.0));
    let moved = self::cloud(&mesh, &on_wall, &within(1.0))
        .displacement
        .horizontal;
    assert!(moved <= 1.0_f64.to_radians() * (1.0 + 1e-9), "{moved}");
}

#[test]
fn a_slope_over_viewers_without_a_width_is_not_moved_through_them() {
    let plate = |z: [f64; 4]| {
        let corners = [0, 1, 2, 3].map(|i| square()[i] + DVec3::Z * z[i]);
        mesh_of(corners, [[0, 1, 2], [0, 2, 3]])
    };
    let cells = [
        segment(at(-0.3, 0.1, 0.0), at(0.4, 0.2, 0.0)),
        ViewCell::line(at(0.0, 0.3, 0.0), DVec3::X).expect("a direction"),
        ViewCell::point(at(0.2, 0.1, 0.0)).expect("finite"),
        ViewCell::point(at(1.0, 0.5, 0.0)).expect("finite"),
    ];
    for cell in &cells {
        for z in [[1.0, 1.0, 2.0, 2.0], [1.0, 1.5, 1.25, 3.0]] {
            for degrees in [1.0, 89.9999] {
                let cloud = cloud(&plate(z), cell, &within(degrees));
                let moved = cloud.displacement.horizontal;
                let most = f64::to_radians(degrees) * (1.0 + 1e-9);
                assert!(moved <= most, "{cell:?}, {degrees}: {moved}");
                assert!(!cloud.kept.is_empty(), "{cell:?}, {degrees}");
            }
        }
    }
}

#[test]
fn a_cell_that_covers_the_ground_is_refused() {
    let mesh = blocks(2);
    let refused = |cell: &ViewCell, options: &BillboardOptions| {
        let error = billboards(&mesh, cell, options, &Silent).expect_err("out of range");
        assert_eq!(error.exit_code(), 2);
        error.to_string()
    };
    let above = ViewCell::half_space(at(0.0, 0.0, 20.0), DVec3::NEG_Z).expect("a normal");
    let slanted = ViewCell::plane(DVec3::ZERO, at(0.0, 1.0, 0.2)).expect("a normal");
    for cell in [above, slanted] {
        let said = refused(&cell, &within(1.0));
        assert!(said.contains("covers the ground"), "{said}");
    }
    for (directions, texels) in [(0, 10), (5000, 10), (10, 0), (10, 5000)] {
        let options = BillboardOptions {
            directions,
            texels,
            ..within(1.0)
        };
        refused(&before_the_city(), &options);
    }
    refused(&before_the_city(), &within_distance(f64::NAN));
}

#[test]
fn a_face_without_area_does_not_end_the_run() {
    let positions = [
        [0.0, 5.0, 0.0],
        [0.0, 5.0, 1.0],
        [0.0, 5.0, 2.0],
        [1.0, 5.0, 0.0],
        [2.0, 5.0, 0.0],
        [2.0, 6.0, 0.0],
    ];
    let mesh = Mesh::from_triangles(
        positions.map(DVec3::from_array).to_vec(),
        // A vertical needle, a point, a line on the ground, a real one.
        vec![[0, 1, 2], [0, 0, 0], [0, 3, 4], [3, 4, 5], [0, 1, 3]],
    )
    .expect("indices");
    for degrees in [0.0, 0.1, 5.0] {
        let cloud = cloud(&mesh, &before_the_city(), &within(degrees));
        let replaced: usize = cloud.quads.iter().map(|q| q.replaces.len()).sum();
        assert_eq!(replaced + cloud.kept.len(), 5);
        assert!(
            cloud
                .quads
                .iter()
                .all(|q| q.size[0] > 0.0 && q.size[1] > 0.0)
        );
        for quad in &cloud.quads {
            let _ = quad.texture(&mesh);
        }
    }
    let empty = cloud(&Mesh::default(), &before_the_city(), &within(0.1));
    assert!(empty.quads.is_empty() && empty.kept.is_empty());
}

#[test]
fn no_number_of_threads_changes_a_cloud() {
    let mesh = generate::trees(500, 150.0);
    let one = same_on_all_threads(|| cloud(&mesh, &in_the_forest(), &within(0.2)));
    assert!(one.quads.iter().any(|q| q.replaces.len() > 6));
}

#[test]
fn another_axis_up_gives_the_same_cloud() {
    let mesh = blocks(20);
    let turned = |turn: fn(DVec3) -> DVec3| {
        let positions: Vec<DVec3> = mesh.positions().iter().map(|&p| turn(p)).collect();
        mesh_of(positions, mesh.triangles())
    };
    let z = cloud(&mesh, &before_the_city(), &within(0.3));
    for (up, turn) in [
        (Up::X, (|p| at(p.z, p.x, p.y)) as fn(DVec3) -> DVec3),
        (Up::Y, |p| at(p.y, p.z, p.x)),
    ] {
        let cell = ViewCell::half_space(turn(at(0.0, -6.0, 0.0)), turn(DVec3::Y));
        let cell = cell.expect("a normal");
        let options = BillboardOptions { up, ..within(0.3) };
        let other = cloud(&turned(turn), &cell, &options);
        assert_eq!(other.quads.len(), z.quads.len());
        for (a, b) in z.quads.iter().zip(&other.quads) {
            assert_eq!((turn(a.corner), a.size), (b.corner, b.size));
            assert_eq!((&a.replaces, &a.drawn), (&b.replaces, &b.drawn));
        }
    }
}

#[test]
fn no_point_is_displaced_by_more_than_a_distance() {
    let mesh = blocks(60);
    let cloud = cloud(&mesh, &before_the_city(), &within_distance(0.02));
    for quad in &cloud.quads {
        for &t in &quad.replaces {
            for p in mesh.corners(t as usize) {
                assert!((quad.project(p) - p).length() <= 0.02 + 1e-12);
            }
        }
    }
    assert!(cloud.quads.iter().any(|q| q.replaces.len() > 2));
}

#[test]
fn three_walls_at_one_edge_are_not_taken_for_a_surface() {
    // A non-manifold edge, a wall that stands twice in the mesh, and one turned the other way.
    let edge = [at(0.0, 5.0, 0.0), at(0.0, 5.0, 2.0)];
    let feet = [at(2.0, 5.0, 0.0), at(-2.0, 5.0, 0.0), at(0.0, 7.0, 0.0)];
    let positions = [&edge[..], &feet, &[at(0.5, 5.0, 2.0)]].concat();
    let walls = [[0, 2, 1], [0, 1, 3], [0, 4, 1]];
    let mesh = mesh_of(
        positions,
        [walls, [[0, 2, 1], [0, 1, 2], [1, 2, 5]]].concat(),
    );
    for degrees in [0.0, 0.2, 30.0] {
        let cloud = cloud(&mesh, &before_the_city(), &within(degrees));
        let mut shown: Vec<u32> = cloud
            .quads
            .iter()
            .flat_map(|q| q.replaces.clone())
            .collect();
        shown.extend(&cloud.kept);
        shown.sort_unstable();
        assert_eq!(shown, [0, 1, 2, 3, 4, 5], "{degrees}");
        // The walls along the street are in one plane, the third stands across.
        assert!(cloud.kept.is_empty() && cloud.quads.len() <= 2, "{degrees}");
        let claimed = cloud.displacement.horizontal.to_degrees();
        assert!(claimed <= degrees + 1e-9, "{claimed} of {degrees}");
    }
}
