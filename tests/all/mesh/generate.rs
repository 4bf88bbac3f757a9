//! Generated meshes keep what their documentation says.

use glam::DVec3;
use lodmark::{
    mesh::{
        ChannelKind, Edges, Mesh,
        generate::{self, Height, Pcg32},
    },
    num::math,
};
use proptest::prelude::*;

fn doubled_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

fn area(mesh: &Mesh, triangles: std::ops::Range<usize>) -> f64 {
    let area = |t| 0.5 * math::length(doubled_normal(mesh.corners(t)));
    triangles.map(area).sum()
}

fn volume(mesh: &Mesh) -> f64 {
    let corners = (0..mesh.triangles().len()).map(|t| mesh.corners(t));
    corners.map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
}

/// Every side of a triangle is the side of one other, in the opposite direction.
fn closed(mesh: &Mesh) -> bool {
    let triangles = mesh.triangles().iter();
    let sides = triangles.flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut sides: Vec<[u32; 2]> = sides.collect();
    sides.sort_unstable();
    let once = sides.windows(2).all(|w| w[0] != w[1]);
    let paired = |&[a, b]: &[u32; 2]| sides.binary_search(&[b, a]).is_ok();
    let paired = sides.iter().all(paired);
    let two = Edges::of(mesh).iter().all(|(_, t)| t.len() == 2);
    once && paired && two
}

/// Vertices - edges + triangles, of the vertices that are used.
fn euler(mesh: &Mesh) -> i64 {
    let edges = Edges::of(mesh).len() as i64;
    mesh.positions().len() as i64 - edges + mesh.triangles().len() as i64
}

/// The triangles in connected parts, by the lowest vertex of each.
fn parts(mesh: &Mesh) -> Vec<Vec<usize>> {
    let mut parent: Vec<usize> = (0..mesh.positions().len()).collect();
    fn root(parent: &mut [usize], mut v: usize) -> usize {
        while parent[v] != v {
            parent[v] = parent[parent[v]];
            v = parent[v];
        }
        v
    }
    for t in mesh.triangles() {
        for k in [1, 2] {
            let [a, b] = [t[0], t[k]].map(|v| root(&mut parent, v as usize));
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut found = vec![Vec::new(); mesh.positions().len()];
    for (i, t) in mesh.triangles().iter().enumerate() {
        found[root(&mut parent, t[0] as usize)].push(i);
    }
    found.retain(|part| !part.is_empty());
    found
}

#[test]
fn closed_meshes_have_two_triangles_at_every_edge_and_face_outward() {
    let pi = std::f64::consts::PI;
    let torus = generate::torus(1.0, 0.4, 96, 48);
    let tori = generate::interlocking_tori(96, 48);
    let textured = generate::textured_torus(192, 96);
    let (shells, hollow) = (generate::shells(2, 4), 4.0 / 3.0 * pi * (1.0 + 0.125));
    for (name, mesh, holes, expected) in [
        ("tetrahedron", generate::tetrahedron(), 2, 8.0 / 3.0),
        ("cube", generate::cube(), 2, 8.0),
        ("icosphere", generate::icosphere(4), 2, 4.0 / 3.0 * pi),
        ("torus", torus, 0, 2.0 * pi * pi * 0.16),
        ("tori", tori, 0, 4.0 * pi * pi * 0.09),
        ("textured-torus", textured, 0, 2.0 * pi * pi * 0.09),
        ("shells", shells, 4, hollow),
    ] {
        assert!(closed(&mesh), "{name}");
        assert_eq!(euler(&mesh), holes, "{name}");
        let v = volume(&mesh);
        let near = (v - expected).abs() < 0.01 * expected;
        assert!(near, "{name}: volume {v}, expected {expected}");
    }
}

#[test]
fn the_parts_of_the_engine_are_closed_apart_and_hidden_by_the_casing() {
    for (detail, count) in [(1, 12_504), (2, 50_016)] {
        let mesh = generate::engine(detail);
        assert!(closed(&mesh));
        let total = mesh.triangles().len();
        assert_eq!(total, count);
        let parts = parts(&mesh);
        assert!(parts.len() > 9 + 50, "{} parts", parts.len());
        let mut outer = f64::INFINITY;
        for (k, part) in parts.iter().enumerate().take(9) {
            let radii = part.iter().flat_map(|&t| mesh.corners(t)).map(math::length);
            let (low, high) =
                radii.fold((f64::INFINITY, 0.0_f64), |(l, h), r| (l.min(r), h.max(r)));
            assert!(high < outer, "part {k}: {low}..{high} in {outer}");
            // The flat triangles of a sphere reach further in than their corners.
            outer = flat_radius(&mesh, part).min(low);
        }
        let rings = parts[9..].iter().flatten().flat_map(|&t| mesh.corners(t));
        assert!(rings.map(math::length).fold(0.0, f64::max) < outer);
        let casing = area(&mesh, 0..parts[0].len());
        let interior = area(&mesh, parts[0].len()..total);
        assert!(interior > 4.0 * casing, "{interior} inside {casing}");
        for part in &parts {
            assert!(part_volume(&mesh, part) > 0.0, "a part faces inward");
        }
    }
}

/// The distance of the origin from the plane of a part's triangles, the least.
fn flat_radius(mesh: &Mesh, part: &[usize]) -> f64 {
    let planes = part.iter().map(|&t| {
        let [a, b, c] = mesh.corners(t);
        doubled_normal([a, b, c]).normalize().dot(a)
    });
    planes.fold(f64::INFINITY, f64::min)
}

/// Six times the volume of a part.
fn part_volume(mesh: &Mesh, part: &[usize]) -> f64 {
    let corners = part.iter().map(|&t| mesh.corners(t));
    corners.map(|[a, b, c]| a.dot(b.cross(c))).sum()
}

#[test]
fn the_parts_of_the_motor_are_closed_and_all_but_three_cavities_face_outward() {
    for detail in 1..=3 {
        let mesh = generate::motor(detail);
        assert!(closed(&mesh), "detail {detail}");
        let parts = parts(&mesh);
        assert_eq!(parts.len(), 169);
        let inward = |&k: &usize| part_volume(&mesh, &parts[k]) < 0.0;
        let inward: Vec<usize> = (0..parts.len()).filter(inward).collect();
        assert_eq!(inward, [3, 4, 5], "after the three housings");
        for (housing, cavity) in [(0, 3), (1, 4), (2, 5)] {
            // Walls have a thickness: every corner of the cavity is inside the box of its housing.
            let bounds = |part: &[usize]| {
                let points = part.iter().flat_map(|&t| mesh.corners(t));
                points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
                    (low.min(p), high.max(p))
                })
            };
            let ((low, high), (l, h)) = (bounds(&parts[housing]), bounds(&parts[cavity]));
            assert!((low + 0.02).cmplt(l).all() && h.cmplt(high - 0.02).all());
        }
    }
    assert_eq!(generate::motor(0), generate::motor(1));
}

#[test]
fn the_casing_hides_what_it_encases() {
    for (detail, count) in [(1, 320 + 512), (2, 1_280 + 2_048)] {
        let mesh = generate::encased(detail);
        assert!(closed(&mesh));
        assert_eq!(mesh.triangles().len(), count);
        let parts = parts(&mesh);
        assert_eq!(parts.len(), 3);
        assert!(parts.iter().all(|part| part_volume(&mesh, part) > 0.0));
        let inner = flat_radius(&mesh, &parts[0]);
        let rest = parts[1..].iter().flatten().flat_map(|&t| mesh.corners(t));
        let outer = rest.map(math::length).fold(0.0, f64::max);
        assert!(outer < inner, "{outer} in {inner}");
    }
}

#[test]
fn the_links_of_the_chain_do_not_touch() {
    let mesh = generate::interlocking_tori(64, 32);
    let (a, b) = mesh.positions().split_at(mesh.positions().len() / 2);
    let pairs = a
        .iter()
        .flat_map(|p| b.iter().map(move |q| p.distance_squared(*q)));
    let nearest = pairs.fold(f64::INFINITY, f64::min);
    assert!(nearest > 0.3 * 0.3, "{nearest}");
    let inside = |p: &&DVec3| p.x > -0.3 && p.x < 0.3;
    assert!(a.iter().any(|p| inside(&p)) && b.iter().any(|p| inside(&p)));
}

#[test]
fn a_grid_has_a_boundary_around_it_and_faces_up() {
    for height in [Height::Flat, Height::Polynomial, Height::Waves] {
        let mesh = generate::grid(7, 5, height);
        assert_eq!(mesh.triangles().len(), 70);
        assert_eq!(Edges::of(&mesh).boundary_count(), 24);
        assert!((0..70).all(|t| doubled_normal(mesh.corners(t)).z > 0.0));
        let flat = mesh.positions().iter().all(|p| p.z.abs() <= 0.0);
        assert_eq!(flat, height == Height::Flat);
        assert!(mesh.positions().iter().all(|p| p.z.abs() <= 0.6));
    }
}

#[test]
fn the_textured_torus_has_a_seam_both_ways_and_the_whole_texture() {
    let (n, m) = (24, 12);
    let mesh = generate::textured_torus(n, m);
    let attributes = mesh.attributes();
    let uv = attributes.channel(ChannelKind::TexCoord(0)).expect("UVs");
    assert_eq!(attributes.wedge_count(), ((n + 1) * (m + 1)) as usize);
    assert_eq!(mesh.positions().len(), (n * m) as usize);
    let mut covered = 0.0;
    for wedges in attributes.corners() {
        let [a, b, c] = wedges.map(|w| attributes.value(uv, w));
        covered += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    assert!((covered - 1.0).abs() < 1e-6, "{covered} of the texture");
    // A vertex has one wedge inside, two on one seam, four where the seams cross.
    let mut at: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions().len()];
    for (t, w) in mesh.triangles().iter().zip(attributes.corners()) {
        for k in 0..3 {
            at[t[k] as usize].push(w[k]);
        }
    }
    let mut counts = [0; 5];
    for wedges in &mut at {
        wedges.sort_unstable();
        wedges.dedup();
        counts[wedges.len()] += 1;
    }
    assert_eq!(counts, [0, (n - 1) * (m - 1), n + m - 2, 0, 1]);
}

#[test]
fn every_side_of_the_cube_has_its_own_texture_normal_and_material() {
    let mesh = generate::cube();
    let attributes = mesh.attributes();
    let normal = attributes.channel(ChannelKind::Normal).expect("normals");
    let uv = attributes.channel(ChannelKind::TexCoord(0)).expect("UVs");
    assert_eq!((mesh.positions().len(), attributes.wedge_count()), (8, 24));
    for t in 0..12 {
        let n = doubled_normal(mesh.corners(t)) / 4.0;
        let wedges = attributes.corners()[t];
        for w in wedges {
            assert_eq!(DVec3::from_slice(attributes.value(normal, w)), n);
        }
        let [a, b, c] = wedges.map(|w| attributes.value(uv, w));
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert!(turn > 0.0, "the texture of triangle {t} is mirrored");
        let name = &mesh.materials().names[mesh.materials().of(t) as usize];
        let sign = if n.element_sum() > 0.0 { "+" } else { "-" };
        let axis = n.to_array().iter().position(|x| x.abs() > 0.5);
        let axis = ["x", "y", "z"][axis.expect("an axis")];
        assert_eq!(*name, format!("{axis}{sign}"));
    }
}

#[test]
fn the_probe_has_everything_it_is_there_for() {
    let mesh = generate::probe();
    assert!(mesh.triangles().len() < 500, "{}", mesh.triangles().len());
    assert!(mesh.positions().iter().all(|p| math::length(*p) < 1.7));
    let edges = Edges::of(&mesh);
    assert!(edges.boundary_count() > 16, "an open boundary");
    assert!(edges.iter().any(|(_, t)| t.len() > 2), "non-manifold edges");
    let mut sorted: Vec<[u32; 3]> = mesh.triangles().to_vec();
    for t in &mut sorted {
        t.sort_unstable();
    }
    sorted.sort_unstable();
    let mut threes = sorted.windows(3);
    let thrice = threes.any(|w| w[0] == w[1] && w[1] == w[2]);
    assert!(thrice, "a face that occurs thrice");
    let shapes = (0..mesh.triangles().len()).map(|t| {
        let [a, b, c] = mesh.corners(t);
        let sides = [[a, b], [b, c], [c, a]].map(|[p, q]| p.distance_squared(q));
        let longest = sides.into_iter().fold(0.0, f64::max);
        (math::length(doubled_normal([a, b, c])), longest)
    });
    let degenerate = shapes.clone().filter(|(area, _)| *area < 1e-9);
    assert_eq!(degenerate.count(), 3, "degenerate");
    let slivers = shapes.filter(|&(area, longest)| area > 1e-9 && area < 0.005 * longest);
    assert!(slivers.count() > 20, "slivers");
    // Interpenetration: an edge of the tetrahedron passes through the sphere.
    let radii = mesh.positions()[42..46].iter().map(|&p| math::length(p));
    let radii: Vec<f64> = radii.collect();
    assert!(radii.iter().all(|&r| r > 0.5), "{radii:?}");
    assert!(mesh.positions()[42].distance(mesh.positions()[43]) < 2.0 * 0.79);
}

#[test]
fn every_name_has_a_mesh_and_other_names_have_none() {
    for (name, _) in generate::NAMED {
        let mesh = generate::by_name(name).expect(name);
        assert!(!mesh.triangles().is_empty(), "{name}");
        assert_eq!(Some(mesh), generate::by_name(name));
        assert!(!name.contains([' ', '_']));
    }
    assert_eq!(generate::by_name("Engine"), None);
    assert_eq!(generate::by_name(""), None);
}

#[test]
fn random_numbers_are_those_of_the_published_generator() {
    // The demonstration program of the PCG library: seed 42, stream 54.
    let mut random = Pcg32::new(42, 54);
    let [a, b, c] = [0xa15c_02b7, 0x7b47_f409, 0xba1d_3330];
    let [d, e, f] = [0x83d2_f293, 0xbfa4_784b, 0xcbed_606e];
    assert_eq!([(); 6].map(|()| random.bits()), [a, b, c, d, e, f]);
}

proptest! {
    #![proptest_config(crate::support::cases(256))]

    #[test]
    fn any_parameters_give_a_valid_closed_mesh(
        (around, across, count) in (0_u32..40, 0_u32..40, 0_u32..6), level in 0_u32..4,
    ) {
        prop_assert!(closed(&generate::torus(1.0, 0.25, around, across)));
        prop_assert!(closed(&generate::textured_torus(around, across)));
        prop_assert!(closed(&generate::interlocking_tori(around, across)));
        let shells = generate::shells(count, level);
        prop_assert!(closed(&shells));
        prop_assert_eq!(euler(&shells), 2 * i64::from(count.max(1)));
        prop_assert_eq!(generate::icosphere(level).triangles().len(), 20 << (2 * level));
        let cells = around.max(1) * across.max(1);
        prop_assert_eq!(generate::grid(around, across, Height::Waves).triangles().len() as u32, 2 * cells);
    }
}
