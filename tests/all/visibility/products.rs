//! What follows from a measurement: hidden parts, the table, convergence, coloured meshes.

use lodmark::{
    Error, Silent,
    io::{self, Format},
    mesh::{ChannelKind, Mesh, MeshParts, generate},
    num::math,
    raster,
    view::{Projection, Sphere, ViewSet, sets::octahedron},
    visibility::{MeasureOptions, PartialVisibility, convergence, measure, ply, remove_hidden},
};
use proptest::prelude::*;

use crate::support::scene_of;

use super::{nested, small};

#[test]
fn removing_what_is_hidden_changes_no_picture() {
    let (mesh, outer) = nested(3);
    let found = measure(&mesh, &small(1, 64), &Silent).expect("measures");
    let kept = remove_hidden(&mesh, &found, 0).expect("something is seen");
    let expected = outer.iter().filter(|&&o| o).count();
    assert_eq!(kept.triangles().len(), expected);
    assert_eq!(
        kept.positions().len(),
        expected / 2 + 2,
        "of one closed sphere"
    );
    let sphere = Sphere::of_mesh(&mesh).expect("triangles");
    let views = octahedron(1);
    let set = ViewSet::around(&sphere, &views, 64, 64, Projection::Perspective).expect("views");
    let scenes = [&mesh, &kept].map(scene_of);
    for view in &set.views {
        let [before, after] = scenes
            .each_ref()
            .map(|s| raster::depths(&raster::keys(s, view, &set)));
        assert_eq!(before, after);
    }
}

proptest! {
    #![proptest_config(crate::support::cases(12))]

    #[test]
    fn a_ring_more_keeps_more_and_the_neighbours(rings in 0..5_u32) {
        let mesh = generate::torus(1.0, 0.4, 24, 12);
        // One camera looks along the axis of the first quarter of views: much is hidden.
        let options = small(0, 64);
        let one = PartialVisibility::of_views(&mesh, &options, 0..1, &Silent).expect("counts");
        prop_assert!(!one.is_complete());
        let found = measure(&mesh, &options, &Silent).expect("measures");
        let some: Vec<bool> = found.views().iter().map(|&n| n > 0).collect();
        // Rings by distance over shared vertices, from the definition.
        let mut kept = some;
        for _ in 0..rings {
            let touched = |v: &u32| {
                mesh.triangles().iter().zip(&kept).any(|(t, &k)| k && t.contains(v))
            };
            kept = mesh.triangles().iter().map(|t| t.iter().any(touched)).collect();
        }
        let result = remove_hidden(&mesh, &found, rings).expect("something is seen");
        prop_assert_eq!(result.triangles().len(), kept.iter().filter(|&&k| k).count());
        let corners = |m: &Mesh, t: usize| m.corners(t);
        let chosen = (0..kept.len()).filter(|&t| kept[t]);
        for (new, old) in chosen.enumerate() {
            prop_assert_eq!(corners(&result, new), corners(&mesh, old));
        }
    }
}

#[test]
fn as_many_rings_of_a_half_hidden_tube_stay_as_are_asked_for() {
    // A long tube along x: only its mouth is seen from its ends.
    let around = 12;
    let along = 40;
    let mut positions = Vec::new();
    for i in 0..=along {
        for j in 0..around {
            let angle = f64::from(j) / f64::from(around) * std::f64::consts::TAU;
            positions.push(glam::DVec3::new(
                f64::from(i),
                math::cos(angle),
                math::sin(angle),
            ));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..along {
        for j in 0..around {
            let [a, b] = [j, (j + 1) % around].map(|j| (i * around + j) as u32);
            let [c, d] = [a, b].map(|v| v + around as u32);
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    let tube = triangles.len();
    // A box around it, open at both ends, hides its outside.
    let first = positions.len() as u32;
    for x in [-1.0, f64::from(along) + 1.0] {
        for (y, z) in [(-1.2, -1.2), (1.2, -1.2), (1.2, 1.2), (-1.2, 1.2)] {
            positions.push(glam::DVec3::new(x, y, z));
        }
    }
    for i in 0..4 {
        let [a, b] = [i, (i + 1) % 4].map(|i| first + i);
        triangles.extend([[a, b, a + 4], [b, b + 4, a + 4]]);
    }
    let mesh = Mesh::from_triangles(positions, triangles).expect("a mesh");
    let options = MeasureOptions {
        edge_limit: None,
        ..small(2, 128)
    };
    let found = measure(&mesh, &options, &Silent).expect("measures");
    assert!(found.never_seen() > tube / 4, "{}", found.never_seen());
    let count = |rings| {
        let kept = remove_hidden(&mesh, &found, rings).expect("something is seen");
        kept.triangles().len()
    };
    let seen = mesh.triangles().len() - found.never_seen();
    assert_eq!(count(0), seen);
    assert!(count(1) > count(0) && count(2) > count(1));
    assert_eq!(count(100), mesh.triangles().len());
}

#[test]
fn attributes_and_materials_outlive_the_hidden_part() {
    let (shells, outer) = nested(1);
    let textured = generate::textured_torus(12, 6);
    let mut parts: MeshParts = textured.clone().into_parts();
    parts.materials.names = vec!["a".into(), "b".into()];
    parts.materials.of_triangle = (0..parts.triangles.len() as u32).map(|t| t % 2).collect();
    let mesh = Mesh::new(parts).expect("a mesh");
    let found = measure(&mesh, &small(1, 64), &Silent).expect("measures");
    let kept = remove_hidden(&mesh, &found, 0).expect("something is seen");
    let chosen: Vec<usize> = (0..mesh.triangles().len())
        .filter(|&t| found.views()[t] > 0)
        .collect();
    let uv = ChannelKind::TexCoord(0);
    for (new, &old) in chosen.iter().enumerate() {
        assert_eq!(kept.materials().of(new), mesh.materials().of(old));
        let [a, b] = [(&kept, new), (&mesh, old)].map(|(m, t)| {
            let channel = m.attributes().channel(uv).expect("texture coordinates");
            m.attributes().corners()[t].map(|w| m.attributes().value(channel, w).to_vec())
        });
        assert_eq!(a, b);
    }
    let foreign = measure(&shells, &small(0, 32), &Silent).expect("measures");
    assert!(matches!(
        remove_hidden(&mesh, &foreign, 0),
        Err(Error::Usage(_))
    ));
    assert!(outer.contains(&true));
}

#[test]
fn the_table_has_the_bits_of_the_counts() {
    let mesh = generate::interlocking_tori(10, 6);
    let options = small(1, 48);
    let (survey, table) = PartialVisibility::with_table(&mesh, &options, &Silent).expect("counts");
    let found = survey.finish(&mesh).expect("complete");
    assert_eq!((table.packed().width(), table.packed().height()), (30, 18));
    let mut ones = 0;
    for (t, &views) in found.views().iter().enumerate() {
        let seen = (0..18).filter(|&view| table.sees(view, t)).count();
        assert_eq!(seen, views as usize, "triangle {t}");
        ones += seen;
    }
    let bits = table
        .packed()
        .values()
        .iter()
        .map(|b| b.count_ones() as usize);
    assert_eq!(
        bits.sum::<usize>(),
        ones,
        "nothing beyond the last triangle"
    );
    for view in [0, 7, 17] {
        let one =
            PartialVisibility::of_views(&mesh, &options, view..view + 1, &Silent).expect("counts");
        assert_eq!(one.views().len(), 1);
        assert!((0..mesh.triangles().len()).any(|t| table.sees(view, t)));
    }
}

#[test]
fn more_cameras_bring_a_smaller_error() {
    let mesh = generate::interlocking_tori(8, 5);
    let options = MeasureOptions {
        edge_limit: None,
        ..small(0, 24)
    };
    let steps = convergence(&mesh, &options, &Silent).expect("measures");
    let cameras: Vec<u32> = steps.iter().map(|s| s.cameras).collect();
    assert_eq!(cameras, [6, 18, 66, 258, 1_026, 4_098]);
    assert!(steps[5].error.to_bits() == 0);
    assert!(steps[0].error > 3.0 * steps[3].error, "{steps:?}");
    assert!(steps[3].error < 0.02, "{steps:?}");
    let direct = measure(
        &mesh,
        &MeasureOptions {
            octahedron: 2,
            ..options
        },
        &Silent,
    )
    .expect("measures");
    assert_eq!(steps[2].mesh.to_bits(), direct.mesh().to_bits());
}

#[test]
fn a_coloured_mesh_is_read_back_as_it_was() {
    for mesh in [generate::torus(1.0, 0.4, 8, 5), generate::cube()] {
        let found = measure(&mesh, &small(0, 32), &Silent).expect("measures");
        let bytes = ply::encode(&mesh, &found).expect("writes");
        let read = io::read_bytes(Format::Ply, &bytes, "x")
            .expect("reads")
            .mesh;
        assert_eq!(read.positions(), mesh.positions());
        assert_eq!(read.triangles(), mesh.triangles());
        assert_eq!(read.precision(), mesh.precision());
        let last = found.triangles().last().copied().expect("a triangle") as f32;
        assert_eq!(bytes[bytes.len() - 4..], last.to_le_bytes());
        assert_eq!(
            bytes[bytes.len() - 7..bytes.len() - 4],
            lodmark::visibility::color(*found.triangles().last().expect("a triangle"))
        );
    }
    let cube = measure(&generate::cube(), &small(0, 32), &Silent).expect("measures");
    let refused = ply::encode(&generate::tetrahedron(), &cube);
    assert!(matches!(refused, Err(Error::Usage(_))));
}
