//! Meshes: welding, canonical order, and digests, against brute force.

use glam::DVec3;
use lodmark::{
    mesh::{
        Attributes, ChannelKind, Findings, Materials, Mesh, MeshParts, canonical, content_sha256,
        weld,
    },
    num::Precision,
};
use proptest::prelude::*;

pub(crate) fn mesh(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Mesh {
    let positions = positions.iter().map(|&p| DVec3::from(p)).collect();
    Mesh::from_triangles(positions, triangles.to_vec()).expect("valid")
}

pub(crate) const TETRAHEDRON: [[f64; 3]; 4] =
    [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
pub(crate) const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

#[test]
fn zeros_of_either_sign_weld_and_neighbours_in_the_last_bit_do_not() {
    let next = f64::from(1.0_f32.next_up());
    let welded = weld(mesh(
        &[
            [0.0, 1.0, 0.0],
            [-0.0, 1.0, 0.0],
            [0.0, next, 0.0],
            [0.0, 1.0, -0.0],
        ],
        &[[0, 1, 2], [3, 2, 1]],
    ));
    assert_eq!(welded.merged, 2);
    assert_eq!(welded.mesh.positions().len(), 2);
    let first = welded.mesh.positions()[0];
    assert!(first.x.is_sign_positive(), "the first stays");
    assert_eq!(welded.mesh.triangles(), [[0, 0, 1], [0, 1, 0]]);
}

#[test]
fn degenerate_triangles_go_and_flat_ones_stay_in_canonical_order() {
    let done = canonical(&mesh(
        &[
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [7.0; 3],
            [8.0; 3],
        ],
        &[[2, 0, 1], [0, 0, 1], [3, 3, 3]],
    ));
    assert_eq!((done.degenerate, done.unreferenced), (2, 2));
    assert_eq!(done.mesh.triangles(), [[0, 1, 2]]);
    assert_eq!(canonical(&Mesh::default()).mesh, Mesh::default());
}

#[test]
fn the_morton_curve_visits_the_corners_of_a_cube_in_binary_order() {
    let corner = |i: u8| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
    let cube: Vec<[f64; 3]> = (0..8).rev().map(corner).collect();
    let done = canonical(&mesh(&cube, &[[0, 1, 2], [3, 4, 5], [6, 7, 0]]));
    let expected: Vec<DVec3> = cube.iter().rev().map(|&p| DVec3::from(p)).collect();
    assert_eq!(done.mesh.positions(), expected);
}

#[test]
fn an_orientation_survives_the_canonical_order() {
    let volume = |m: &Mesh| -> f64 {
        let corners = (0..m.triangles().len()).map(|t| m.corners(t));
        corners.map(|[a, b, c]| a.dot(b.cross(c))).sum()
    };
    let before = mesh(&TETRAHEDRON, &FACES);
    let after = canonical(&before).mesh;
    assert_eq!(volume(&before).to_bits(), 1.0_f64.to_bits());
    assert_eq!(volume(&after).to_bits(), 1.0_f64.to_bits());
}

#[test]
fn the_extent_of_the_largest_coordinates_does_not_overflow() {
    let huge = Mesh::new(MeshParts {
        positions: vec![DVec3::splat(-f64::MAX), DVec3::splat(f64::MAX), DVec3::ZERO],
        triangles: vec![[1, 0, 2]],
        precision: Precision::F64,
        ..MeshParts::default()
    })
    .expect("valid");
    let done = canonical(&huge).mesh;
    let expected = [-f64::MAX, 0.0, f64::MAX].map(DVec3::splat);
    assert_eq!(done.positions(), expected);
    assert_eq!(Findings::of(&huge).zero_area_triangles.count, 1);
}

#[test]
fn a_digest_changes_with_every_part_and_is_pinned() {
    let base = mesh(&TETRAHEDRON, &FACES);
    let empty = content_sha256(&Mesh::default());
    // SHA-256 of the text, then 32 as u64, then 8 lengths of zero: computed with another program.
    assert_eq!(empty, EMPTY_DIGEST);
    let digest = content_sha256(&base);
    let mut seen = vec![empty, digest];
    let changes: [fn(&mut MeshParts); 8] = [
        |p| p.positions[0].x = -0.0,
        |p| p.triangles.swap(0, 1),
        |p| p.triangles[0].rotate_left(1),
        |p| p.precision = Precision::F64,
        |p| p.materials.libraries.push("a".into()),
        |p| p.materials.names.push("a".into()),
        |p| p.attributes = textured(0),
        |p| p.attributes = textured(1),
    ];
    for change in changes {
        let mut parts = base.clone().into_parts();
        change(&mut parts);
        seen.push(content_sha256(&Mesh::new(parts).expect("valid")));
    }
    let count = seen.len();
    seen.sort();
    seen.dedup();
    assert_eq!(seen.len(), count);
    assert!(seen.iter().all(|d| d.len() == 64));
}

/// Texture coordinates of the four faces, all the same, in a set.
fn textured(set: u8) -> Attributes {
    let kinds = [ChannelKind::TexCoord(set)];
    Attributes::new(&kinds, vec![0.0; 6], vec![[0; 3]; 4]).expect("fits")
}

const EMPTY_DIGEST: &str = "8099889b33edd09f728f46221e57faa7e52f564622347092e8a76f1f5aa6ca15";

/// A small mesh with attributes and materials; vertices at different places.
#[derive(Clone, Debug)]
pub(crate) struct Soup {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// Values of every corner.
    uvs: Vec<[[f64; 2]; 3]>,
    materials: Vec<Option<&'static str>>,
}

impl Soup {
    pub(crate) fn mesh(&self, reversed_names: bool) -> Mesh {
        let mut names = vec!["a".to_string(), "b".to_string(), "unused".to_string()];
        if reversed_names {
            names.reverse();
        }
        let number = |m: &str| names.iter().position(|n| n == m).expect("one of them") as u32;
        let materials = self.materials.iter();
        let of_triangle = materials
            .map(|m| m.map_or(Materials::NONE, number))
            .collect();
        let corners = (0..self.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let corners = corners.collect();
        let values = self.uvs.iter().flatten().flatten().copied().collect();
        Mesh::new(MeshParts {
            positions: self.positions.clone(),
            triangles: self.triangles.clone(),
            attributes: Attributes::new(&[ChannelKind::TexCoord(0)], values, corners)
                .expect("fits"),
            materials: Materials {
                names,
                of_triangle,
                ..Materials::default()
            },
            precision: Precision::F32,
        })
        .expect("valid")
    }
}

pub(crate) fn soups() -> impl Strategy<Value = Soup> {
    (3_usize..9, 1_usize..14).prop_flat_map(|(vertices, triangles)| {
        // Mostly the same few vertices: copies of triangles are where an order is hard to find.
        let index = prop_oneof![4 => 0..3_u32, 1 => 0..vertices as u32];
        let value = prop::sample::select(vec![0.0, 0.0, 0.0, 0.0, -0.0, 0.5, f64::NAN]);
        let corner = [value.clone(), value];
        (
            prop::collection::btree_set([-3_i8..3, -3_i8..3, -3_i8..3], vertices),
            prop::collection::vec([index.clone(), index.clone(), index], triangles),
            prop::collection::vec([corner.clone(), corner.clone(), corner], triangles),
            prop::collection::vec(
                prop::option::of(prop::sample::select(vec!["a", "b"])),
                triangles,
            ),
        )
            .prop_map(|(places, triangles, uvs, materials)| Soup {
                positions: places
                    .into_iter()
                    .map(|p| DVec3::from(p.map(|x| f64::from(x) * 0.1)))
                    .collect(),
                triangles,
                uvs,
                materials,
            })
    })
}

/// The same surface in another order, decided by `keys`.
fn shuffled(soup: &Soup, keys: &[u32]) -> Soup {
    let key = |i: usize| keys[i % keys.len()].rotate_left(i as u32);
    let mut order: Vec<usize> = (0..soup.positions.len()).collect();
    order.sort_by_key(|&i| key(i));
    let mut renumbered = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        renumbered[old] = new as u32;
    }
    let mut faces: Vec<usize> = (0..soup.triangles.len()).collect();
    faces.sort_by_key(|&i| key(i + 7));
    let turned = |t: usize| key(t + 13) as usize % 3;
    let triangle = |&t: &usize| {
        let mut corners = soup.triangles[t].map(|v| renumbered[v as usize]);
        corners.rotate_left(turned(t));
        corners
    };
    let uvs = |&t: &usize| {
        let mut corners = soup.uvs[t];
        corners.rotate_left(turned(t));
        corners
    };
    Soup {
        positions: order.iter().map(|&i| soup.positions[i]).collect(),
        triangles: faces.iter().map(triangle).collect(),
        uvs: faces.iter().map(uvs).collect(),
        materials: faces.iter().map(|&t| soup.materials[t]).collect(),
    }
}

/// Every triangle as the places, attribute bits and material of its corners, smallest rotation, sorted.
type Corner = ([u64; 3], [u64; 2]);
fn surface(mesh: &Mesh) -> Vec<([Corner; 3], Option<String>)> {
    let attributes = mesh.attributes();
    let mut all: Vec<_> = (0..mesh.triangles().len())
        .filter(|&t| {
            let [a, b, c] = mesh.triangles()[t];
            a != b && b != c && c != a
        })
        .map(|t| {
            let corner = |i: usize| {
                let place = mesh.corners(t)[i].to_array().map(f64::to_bits);
                let row = attributes.row(attributes.corners()[t][i]);
                (place, [row[0].to_bits(), row[1].to_bits()])
            };
            let mut corners = [corner(0), corner(1), corner(2)];
            let smallest = (0..3).min_by_key(|&i| corners[i]).expect("three");
            corners.rotate_left(smallest);
            (
                corners,
                mesh.materials()
                    .names
                    .get(mesh.materials().of(t) as usize)
                    .cloned(),
            )
        })
        .collect();
    all.sort();
    all
}

proptest! {
    #![proptest_config(crate::support::cases(500))]

    #[test]
    fn shuffled_meshes_have_one_canonical_form(
        soup in soups(),
        keys in prop::collection::vec(any::<u32>(), 1..30),
        reversed: bool,
    ) {
        let one = canonical(&soup.mesh(false));
        let other = canonical(&shuffled(&soup, &keys).mesh(reversed));
        prop_assert_eq!(content_sha256(&one.mesh), content_sha256(&other.mesh));
        prop_assert_eq!((one.degenerate, one.unreferenced), (other.degenerate, other.unreferenced));
        let again = canonical(&one.mesh);
        prop_assert_eq!(content_sha256(&again.mesh), content_sha256(&one.mesh), "twice is once");
        prop_assert_eq!(surface(&one.mesh), surface(&soup.mesh(false)), "the same surface");
        for t in one.mesh.triangles().windows(2) {
            prop_assert!(t[0] <= t[1]);
        }
        let rows: Vec<(u32, Vec<u64>)> = one.mesh.triangles().as_flattened().iter()
            .zip(one.mesh.attributes().corners().as_flattened())
            .map(|(&v, &w)| (v, one.mesh.attributes().row(w).iter().map(|x| x.to_bits()).collect()))
            .collect();
        let mut different = rows.clone();
        different.sort();
        different.dedup();
        prop_assert_eq!(different.len(), one.mesh.attributes().wedge_count(), "no wedge twice, none unused");
    }

    #[test]
    fn welding_merges_what_is_equal_and_nothing_else(
        places in prop::collection::vec([-1_i8..2, -1_i8..2, -1_i8..2], 1..20),
        negative in prop::collection::vec(any::<bool>(), 20),
        corners in prop::collection::vec(any::<[prop::sample::Index; 3]>(), 0..20),
    ) {
        let positions: Vec<DVec3> = places
            .iter()
            .zip(&negative)
            .map(|(p, &n)| DVec3::from(p.map(|x| if x == 0 && n { -0.0 } else { f64::from(x) })))
            .collect();
        let triangles: Vec<[u32; 3]> = corners.iter().map(|c| [0, 1, 2].map(|i| c[i].index(places.len()) as u32)).collect();
        let before = Mesh::from_triangles(positions.clone(), triangles).expect("valid");
        let after = weld(before.clone());
        let firsts: Vec<DVec3> = (0..positions.len())
            .filter(|&i| !(0..i).any(|j| positions[j] == positions[i]))
            .map(|i| positions[i])
            .collect();
        prop_assert_eq!(after.merged, positions.len() - firsts.len());
        let bits = |all: &[DVec3]| -> Vec<[u64; 3]> { all.iter().map(|p| p.to_array().map(f64::to_bits)).collect() };
        prop_assert_eq!(bits(after.mesh.positions()), bits(&firsts));
        for t in 0..before.triangles().len() {
            prop_assert_eq!(before.corners(t), after.mesh.corners(t));
        }
        prop_assert_eq!(Findings::of(&before).duplicate_positions.count, after.merged);
    }
}
