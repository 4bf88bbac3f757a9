//! A mesh that reads and writes itself, and one from the arrays of an engine.

use std::fs;

use lodmark::{Error, Mesh, mesh::generate};

use crate::support::folder;

#[test]
fn a_mesh_is_read_welded_and_in_canonical_order() {
    let folder = folder();
    let path = folder.path().join("a.obj");
    let corners = "v 1 0 0\nv 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 9 9 9\n";
    fs::write(&path, format!("{corners}f 1 3 2\nf 6 5 4\nf 1 4 3\n")).expect("target is writable");
    let stored = Mesh::read_as_stored(&path).expect("read");
    assert_eq!((stored.positions().len(), stored.triangles().len()), (7, 3));
    let mesh = Mesh::read(&path).expect("read");
    assert_eq!((mesh.positions().len(), mesh.triangles().len()), (4, 2));
    let other = folder.path().join("b.obj");
    let turned = "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nf 4 2 3\nf 3 2 1\n";
    fs::write(&other, turned).expect("target is writable");
    assert_eq!(Mesh::read(&other).expect("read"), mesh);
}

#[test]
fn a_mesh_that_was_written_reads_back_as_it_was() {
    let folder = folder();
    let mesh = lodmark::mesh::canonical(&generate::textured_torus(12, 6)).mesh;
    for name in ["a.obj", "a.ply"] {
        let path = folder.path().join(name);
        mesh.write(&path).expect("written");
        assert_eq!(Mesh::read(&path).expect("read"), mesh, "{name}");
    }
    let refused = mesh.write(folder.path().join("a.xyz"));
    assert_eq!(refused.expect_err("no format").exit_code(), 2);
    let missing = Mesh::read(folder.path().join("b.obj"));
    assert_eq!(missing.expect_err("no file").exit_code(), 5);
}

#[test]
fn arrays_of_an_engine_become_a_welded_mesh_or_an_error_that_names_the_fault() {
    let soup: Vec<f32> = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [-0.0, 1.0, 0.0],
    ]
    .concat();
    let mesh = Mesh::from_slices(&soup, &[0, 1, 2, 3, 4, 5]).expect("a mesh");
    assert_eq!((mesh.positions().len(), mesh.triangles().len()), (4, 2));
    for (positions, triangles, words) in [
        (&soup[..17], &[0, 1, 2][..], "17 coordinates"),
        (&soup[..], &[0, 1][..], "2 corners"),
        (&soup[..9], &[0, 1, 3][..], "triangle 0 names vertex 3"),
        (&[f32::NAN; 9][..], &[0, 1, 2][..], "finite"),
    ] {
        let refused = Mesh::from_slices(positions, triangles).expect_err(words);
        assert!(matches!(refused, Error::Input { .. }), "{refused}");
        assert!(refused.to_string().contains(words), "{refused}");
    }
}
