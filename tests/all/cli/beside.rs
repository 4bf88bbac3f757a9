//! Files that are written beside the one that was named: the buffer of a glTF document.

use std::fs;

use lodmark::mesh::generate;

use crate::support::{bytes, expect, folder, put, refused};

#[test]
fn a_buffer_that_cannot_be_written_ends_with_5_before_anything_is_read() {
    let dir = folder();
    fs::create_dir(dir.path().join("out.bin")).expect("a folder");
    // Whoever had read these would have said 3.
    fs::write(dir.path().join("in.ply"), "noise").expect("writes");
    for words in [
        "simplify in.ply out.gltf -t 5",
        "replay in.ply in.ply out.gltf -t 5",
        "visibility in.ply --remove-hidden out.gltf",
    ] {
        refused(&dir, 5, words, "out.bin: it is a folder");
        // Other formats have no buffer.
        expect(&dir, 3, &words.replace("out.gltf", "out.glb"));
    }
    assert!(!dir.path().join("out.gltf").exists());
}

#[test]
fn a_buffer_that_is_replaced_with_its_document_is_tried_and_the_file_of_another_is_left_alone() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(1));
    let words = "simplify in.ply out.gltf -t 20 --method memoryless";
    fs::write(dir.path().join("out.bin"), "of another").expect("writes");
    expect(&dir, 0, words);
    assert_eq!(bytes(&dir, "out.bin"), b"of another");
    assert!(dir.path().join("out-2.bin").exists());
    // From now on the name is that of the document's own buffer.
    let buffer = dir.path().join("out.bin");
    let mut permissions = fs::metadata(&buffer).expect("is there").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&buffer, permissions).expect("is ours");
    refused(&dir, 5, words, "out.bin: the existing file is read-only");
}

#[test]
fn no_other_output_takes_the_name_of_the_buffer() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(1));
    let words = "simplify in.ply out.gltf -t 20 --method memoryless --history out.bin";
    refused(&dir, 2, words, "out.bin would be written twice");
    expect(
        &dir,
        0,
        "simplify in.ply out.gltf -t 20 --method memoryless --history other.bin",
    );
    assert!(dir.path().join("out.bin").exists());
}
