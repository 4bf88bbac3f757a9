//! What is found in a mesh, against counting by hand.

use lodmark::mesh::{Findings, Mesh, canonical};
use proptest::prelude::*;

use super::canonical::{FACES, TETRAHEDRON, mesh, soups};
use crate::support::read_model;

#[test]
fn a_closed_tetrahedron_is_clean() {
    let found = Findings::of(&mesh(&TETRAHEDRON, &FACES));
    assert!(found.clean, "{}", found.report());
    assert_eq!((found.edges, found.components), (6, 1));
    assert_eq!((found.boundary_edges, found.boundary_loops), (0, 0));
    assert!((found.area - (1.5 + square_root(0.75))).abs() < 1e-12);
    assert!(found.report().ends_with("clean\n"));
}

/// By Newton's method.
fn square_root(x: f64) -> f64 {
    (0..60).fold(1.0, |root, _| 0.5 * (root + x / root))
}

#[test]
fn every_problem_is_found_with_its_place() {
    let mut positions = TETRAHEDRON.to_vec();
    positions.extend([
        [5.0, 0.0, 0.0],
        [6.0, 0.0, 0.0],
        [5.0, 1.0, 0.0],
        [0.0; 3],
        [0.5, 0.0, 0.0],
        [9.0; 3],
    ]);
    let mut triangles = FACES.to_vec();
    triangles.extend([
        [4, 5, 5], // 4: repeats a vertex
        [0, 8, 1], // 5: no area; a third triangle at 0-1
        [2, 1, 0], // 6: a copy of 0, turned round
        [3, 4, 6], // 7: meets the tetrahedron in a vertex only
    ]);
    let found = Findings::of(&mesh(&positions, &triangles));
    assert!(!found.clean);
    assert_eq!(found.degenerate_triangles.examples, [[4]]);
    assert_eq!(found.zero_area_triangles.examples, [[5]]);
    assert_eq!(found.duplicate_triangles.examples, [[6]]);
    assert_eq!(found.non_manifold_edges.examples, [[0, 1], [0, 2], [1, 2]]);
    assert_eq!(found.non_manifold_vertices.examples, [[3]]);
    assert_eq!(found.duplicate_positions.examples, [[7]]);
    assert_eq!(found.unreferenced_vertices.examples, [[7], [9]]);
    assert_eq!(found.components, 1, "all hang together by vertices");
    let report = found.report();
    let told = "problem: 3 edges with more than two triangles: 0-1, 0-2, 1-2\n";
    assert!(report.contains(told), "{report}");
    assert!(report.ends_with("not clean\n"));
    let json = serde_json::to_value(&found).expect("serializes");
    assert_eq!(json["non_manifold_edges"]["count"], 3);
    assert_eq!(json["clean"], false);
}

#[test]
fn triangles_of_opposite_orientation_are_found() {
    let found = Findings::of(&mesh(&TETRAHEDRON, &[[0, 1, 2], [0, 1, 3]]));
    assert_eq!(found.misoriented_edges.examples, [[0, 1]]);
    let found = Findings::of(&mesh(&TETRAHEDRON, &[[0, 1, 2], [1, 0, 3]]));
    assert!(found.clean);
    assert_eq!((found.boundary_edges, found.boundary_loops), (4, 1));
}

#[test]
fn two_holes_that_touch_in_a_point_are_two_loops() {
    // Two triangles that share one vertex: two fans, two outlines.
    let bow = Findings::of(&mesh(
        &[
            [0.0; 3],
            [1.0, 1.0, 0.0],
            [1.0, -1.0, 0.0],
            [-1.0, 1.0, 0.0],
            [-1.0, -1.0, 0.0],
        ],
        &[[0, 2, 1], [0, 3, 4]],
    ));
    assert_eq!((bow.boundary_edges, bow.boundary_loops), (6, 2));
    assert_eq!(bow.components, 1);
    assert_eq!(bow.non_manifold_vertices.count, 1);
}

#[test]
fn examples_end_at_five_and_the_count_does_not() {
    let found = Findings::of(&mesh(&[[0.0; 3]], &[[0, 0, 0]; 9]));
    let degenerate = &found.degenerate_triangles;
    assert_eq!((degenerate.count, degenerate.examples.len()), (9, 5));
    assert_eq!(found.duplicate_triangles.count, 0);
    assert!(!Findings::of(&Mesh::default()).clean);
}

proptest! {
    #![proptest_config(crate::support::cases(500))]

    #[test]
    fn findings_agree_with_counting_by_hand(soup in soups()) {
        let mesh = soup.mesh(false);
        let found = Findings::of(&mesh);
        let whole: Vec<[u32; 3]> = mesh.triangles().to_vec();
        let has = |t: &[u32; 3], u, v| u != v && t.contains(&u) && t.contains(&v);
        let n = mesh.positions().len() as u32;
        let (mut boundary, mut crowded, mut edges) = (0, 0, 0);
        for u in 0..n {
            for v in u + 1..n {
                let count = whole.iter().filter(|t| has(t, u, v)).count();
                edges += usize::from(count > 0);
                boundary += usize::from(count == 1);
                crowded += usize::from(count > 2);
            }
        }
        prop_assert_eq!((found.edges, found.boundary_edges, found.non_manifold_edges.count), (edges, boundary, crowded));
        let free = (0..n).filter(|v| !whole.iter().any(|t| t.contains(v))).count();
        prop_assert_eq!(found.unreferenced_vertices.count, free);
        // Components by flooding.
        let mut label: Vec<usize> = (0..whole.len()).collect();
        for _ in 0..whole.len() {
            for a in 0..whole.len() {
                for b in 0..whole.len() {
                    if whole[a].iter().any(|v| whole[b].contains(v)) {
                        label[a] = label[a].min(label[b]);
                    }
                }
            }
        }
        label.sort_unstable();
        label.dedup();
        prop_assert_eq!(found.components, label.len());
        // Fans by flooding.
        let mut pinched = 0;
        for v in 0..n {
            let here: Vec<&[u32; 3]> = whole.iter().filter(|t| t.contains(&v) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]).collect();
            let mut label: Vec<usize> = (0..here.len()).collect();
            for _ in 0..here.len() {
                for a in 0..here.len() {
                    for b in 0..here.len() {
                        if here[a].iter().any(|&w| w != v && here[b].contains(&w)) {
                            label[a] = label[a].min(label[b]);
                        }
                    }
                }
            }
            label.sort_unstable();
            label.dedup();
            pinched += usize::from(label.len() > 1);
        }
        prop_assert_eq!(found.non_manifold_vertices.count, pinched);
    }
}

#[test]
fn real_models_have_their_published_boundaries() {
    let Some(loaded) = read_model("bunny.ply") else {
        return;
    };
    let bunny = loaded.mesh;
    let found = Findings::of(&bunny);
    let outline = (found.boundary_edges, found.boundary_loops);
    assert_eq!(outline, (223, 5), "{}", found.report());
    let done = canonical(&bunny);
    let after = Findings::of(&done.mesh);
    assert_eq!((after.boundary_edges, after.boundary_loops), (223, 5));
    assert_eq!(after.edges, found.edges);
}
