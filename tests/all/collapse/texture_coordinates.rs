//! Texture coordinates of new vertices: affine maps, orientation, mirrored charts, and charts that are not left.

use glam::DVec3;
use lodmark::{
    mesh::{Attributes, ChannelKind, Mesh, canonical, generate, weld},
    simplify::{Options, Target, Topology, simplify},
};

use crate::support::Random;

/// A sheet over the unit square, bent but for its rim, with a texture that `map` gives for every corner of a triangle with
/// this centroid.
fn sheet(side: u32, map: impl Fn(DVec3, DVec3) -> [f64; 2]) -> Mesh {
    let mut parts = generate::grid(side, side, generate::Height::Polynomial).into_parts();
    let mut random = Random::new(11, 1);
    for p in &mut parts.positions {
        let inside = |x: f64| x.abs() < 0.999;
        let shift = |random: &mut Random| (random.next() % 1000) as f64 * 1e-4 / f64::from(side);
        if inside(p.x) && inside(p.y) {
            *p += DVec3::new(shift(&mut random), shift(&mut random), 0.0);
        }
    }
    textured(Mesh::new(parts).expect("valid"), map)
}

/// A mesh with texture coordinates for every corner, from its position and the centroid of its triangle.
fn textured(mesh: Mesh, map: impl Fn(DVec3, DVec3) -> [f64; 2]) -> Mesh {
    let mut parts = mesh.into_parts();
    let (mut values, mut corners) = (Vec::new(), Vec::new());
    for triangle in &parts.triangles {
        let points = triangle.map(|v| parts.positions[v as usize]);
        let centroid = (points[0] + points[1] + points[2]) / 3.0;
        let first = (values.len() / 2) as u32;
        values.extend(points.iter().flat_map(|&p| map(p, centroid)));
        corners.push([first, first + 1, first + 2]);
    }
    parts.attributes = Attributes::new(&[ChannelKind::TexCoord(0)], values, corners).expect("fits");
    canonical(&weld(Mesh::new(parts).expect("valid")).mesh).mesh
}

/// The corners of every triangle with their texture coordinates.
fn faces(mesh: &Mesh) -> Vec<[(DVec3, [f64; 2]); 3]> {
    let attributes = mesh.attributes();
    let channel = attributes.channel(ChannelKind::TexCoord(0)).expect("set");
    let corner = |v: u32, w: u32| {
        let value = attributes.value(channel, w);
        (mesh.positions()[v as usize], [value[0], value[1]])
    };
    let triangles = mesh.triangles().iter().zip(attributes.corners());
    triangles
        .map(|(v, w)| [0, 1, 2].map(|k| corner(v[k], w[k])))
        .collect()
}

fn texture_area(face: &[(DVec3, [f64; 2]); 3]) -> f64 {
    let [a, b, c] = face.map(|(_, st)| st);
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn simplified(mesh: &Mesh, triangles: u64, topology: Topology) -> Mesh {
    let options = Options::memoryless(Target::Triangles(triangles)).topology(topology);
    simplify(mesh, &options).expect("valid").mesh
}

#[test]
fn an_affine_texture_is_reproduced_where_the_volume_is_kept() {
    let map = |p: DVec3| {
        [
            0.3 * p.x - 0.1 * p.y + 0.05 * p.z + 2.0,
            0.2 * p.x + 0.4 * p.y - 1.0,
        ]
    };
    let error = |(p, st): (DVec3, [f64; 2])| {
        let expected = map(p);
        (st[0] - expected[0]).abs().max((st[1] - expected[1]).abs())
    };
    let flat = textured(generate::grid(24, 24, generate::Height::Flat), |p, _| {
        map(p)
    });
    let after = simplified(&flat, 60, Topology::Preserve);
    let worst = faces(&after).into_iter().flatten().map(error);
    assert!(worst.fold(0.0, f64::max) < 3e-7);
    // A rim that moves would keep its area rather than the volume.
    let options = Options::memoryless(Target::Triangles(260)).lock_border();
    let after = simplify(&sheet(24, |p, _| map(p)), &options)
        .expect("valid")
        .mesh;
    let errors: Vec<f64> = faces(&after).into_iter().flatten().map(error).collect();
    // The rest lies at a midpoint, which the volume forbids, and has the value below it.
    let exact = errors.iter().filter(|&&e| e < 1e-6).count();
    assert!(
        errors.len() > 200 && exact * 10 > errors.len() * 8,
        "{exact} of {}",
        errors.len()
    );
    assert!(errors.iter().all(|&e| e < 1e-3));
}

#[test]
fn no_triangle_turns_over_in_the_texture() {
    // A texture that is stretched unevenly and so bends along the surface.
    let map = |p: DVec3| [p.x + 0.3 * p.x * p.y, p.y + 0.4 * p.x * p.x * p.y];
    let mesh = sheet(20, |p, _| map(p));
    assert!(faces(&mesh).iter().all(|f| texture_area(f) > 0.0));
    for triangles in [300, 90, 30, 12] {
        let after = simplified(&mesh, triangles, Topology::Auto);
        let turned = faces(&after)
            .iter()
            .filter(|f| texture_area(f) < 0.0)
            .count();
        assert_eq!(turned, 0, "of {triangles}");
    }
}

#[test]
fn the_two_sides_of_a_mirrored_texture_keep_their_own_maps() {
    // Whichever side the first faces show.
    for sign in [1.0, -1.0] {
        let flat = generate::grid(24, 24, generate::Height::Flat);
        let mesh = textured(flat, |p, _| [sign * p.x.abs(), p.y]);
        let after = simplified(&mesh, 140, Topology::Preserve);
        let mut sides = [0, 0];
        for face in faces(&after) {
            // The sign says which side a triangle shows.
            let area = sign * texture_area(&face);
            if area == 0.0 {
                continue;
            }
            sides[usize::from(area < 0.0)] += 1;
            for (p, st) in face {
                // Beyond the line a vertex has the nearest value of its own side, which bends the map of its faces.
                let own = sign * (p.x * area.signum()).max(0.0);
                assert!((st[0] - own).abs() < 0.05, "{st:?} at {p}");
            }
        }
        assert!(sides.iter().all(|&count| count > 30), "{sides:?}");
    }
}

#[test]
fn no_coordinate_leaves_its_chart_where_seams_break() {
    // Charts of one square each, far from each other in the texture.
    let cell = |x: f64| ((x + 1.0) * 4.0).floor().clamp(0.0, 7.0);
    let chart = |c: DVec3| cell(c.x) * 100.0 + cell(c.y) * 10_000.0;
    let mesh = sheet(32, |p, c| [p.x + chart(c), p.y]);
    let kept = simplified(&mesh, 1, Topology::Preserve).triangles().len();
    let after = simplified(&mesh, kept as u64 / 3, Topology::Auto);
    assert!(after.triangles().len() <= kept / 3);
    for face in faces(&after) {
        let chart = (face[0].1[0] / 100.0).round();
        for (_, [s, _]) in face {
            assert!((s - 100.0 * chart).abs() <= 1.001, "{s} is in no chart");
            let same = ((s / 100.0).round() - chart).abs() < 0.5;
            assert!(same, "{face:?} spans charts");
        }
    }
}
