//! Files that are none, results that nobody takes, outputs that cannot be: what a user's shell can do to the command.

use std::{
    fs,
    process::{Command, Stdio},
};

use lodmark::{
    mesh::{Mesh, MeshParts, generate},
    num::Precision,
    simplify::{Options, Target, image::Preset, simplify},
};
use proptest::prelude::*;

use crate::support::{code, command, expect, folder, lodmark, put, refused, stderr, stdout};

/// A simplification of the torus to 50 triangles, with more arguments.
fn simplified(more: &str) -> String {
    format!("simplify torus.ply out.ply --triangles 50 {more}")
}

fn with_torus() -> tempfile::TempDir {
    let folder = folder();
    put(&folder, "torus.ply", &generate::torus(1.0, 0.4, 12, 6));
    folder
}

#[test]
fn a_negative_number_is_out_of_range_and_no_unknown_option() {
    let folder = with_torus();
    fs::write(folder.path().join("history"), "").expect("writes");
    for (words, said) in [
        (
            "simplify torus.ply o.ply --triangles -1",
            "-1 triangles make no mesh",
        ),
        (
            "simplify torus.ply o.ply --triangles 0",
            "0 triangles make no mesh",
        ),
        (
            "simplify torus.ply o.ply --ratio -0.5",
            "the ratio -0.5 is not in",
        ),
        ("simplify torus.ply o.ply --error-rms -1", "error-rms is -1"),
        (
            "replay torus.ply history o.ply --triangles -1",
            "-1 triangles make no mesh",
        ),
    ] {
        refused(&folder, 2, words, said);
    }
}

#[test]
fn a_preset_is_refused_by_methods_that_have_none() {
    let folder = with_torus();
    let words = simplified("--method quadric --preset paper");
    refused(&folder, 2, &words, "--preset means nothing");
}

#[test]
fn an_output_that_cannot_be_written_is_found_before_the_work_and_leaves_nothing() {
    let folder = with_torus();
    for option in ["--json", "--history"] {
        let message = expect(&folder, 5, &simplified(&format!("{option} nowhere/file")));
        assert!(message.contains("nowhere/file"), "{message}");
        assert!(!message.contains("collapses"), "after the work: {message}");
    }
    refused(&folder, 2, &simplified("--json out.ply"), "written twice");
    fs::create_dir(folder.path().join("dir.ply")).expect("a folder");
    refused(
        &folder,
        5,
        "simplify torus.ply dir.ply -t 50",
        "it is a folder",
    );
    let left = fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(left, 2, "only the input and the folder");
}

#[cfg(target_os = "linux")]
#[test]
fn an_endless_input_is_refused() {
    let folder = with_torus();
    for words in [
        "check /dev/zero",
        "replay torus.ply /dev/zero out.ply -t 9",
        "render torus.ply out --views /dev/zero",
    ] {
        refused(&folder, 3, words, "more than");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_an_error_of_the_system_and_no_bug() {
    let folder = with_torus();
    let full = || {
        let mut options = fs::OpenOptions::new();
        options.write(true).open("/dev/full").expect("linux has it")
    };
    for words in ["check torus.ply", "inspect torus.ply"] {
        let run = || command(&folder, words);
        let output = run().stdout(full()).output().expect("starts");
        let said = stderr(&output);
        assert_eq!(code(&output), 5, "{said}");
        assert!(said.contains("standard output"), "{said}");
        let output = run().stderr(full()).output().expect("starts");
        assert_eq!(code(&output), 0, "a deaf stderr changes nothing");
    }
    refused(&folder, 5, &simplified("--json /dev/full"), "/dev/full");
}

#[test]
fn a_report_that_cannot_be_written_comes_with_no_result_line() {
    let folder = with_torus();
    expect(&folder, 5, "render torus.ply out --size 8 --json nowhere/r");
    expect(&folder, 5, &simplified("--json nowhere/r"));
}

proptest! {
    #![proptest_config(crate::support::cases(6))]

    #[test]
    fn a_scaled_mesh_gives_the_scaled_result_bit_for_bit(exponent in -900_i32..900, target in 20_u64..100) {
        let mesh = generate::torus(1.0, 0.4, 12, 6);
        let half = if exponent < 0 { 0.5 } else { 2.0 };
        let factor = (0..exponent.unsigned_abs()).fold(1.0_f64, |f, _| f * half);
        let double = |factor: f64| {
            let positions = mesh.positions().iter().map(|&p| p * factor).collect();
            let triangles = mesh.triangles().to_vec();
            Mesh::new(MeshParts { positions, triangles, precision: Precision::F64, ..MeshParts::default() })
                .expect("finite")
        };
        let by_pictures = |target| Options::image(target).preset(Preset::Fast);
        for run in [by_pictures, Options::memoryless, Options::quadric] {
            let options = run(Target::Triangles(target));
            let [one, other] = [1.0, factor].map(|f| {
                simplify(&double(f), &options).expect("simplifies").mesh
            });
            prop_assert_eq!(one.triangles(), other.triangles());
            let scaled: Vec<_> = one.positions().iter().map(|&p| p * factor).collect();
            prop_assert_eq!(scaled.as_slice(), other.positions());
        }
    }
}

#[test]
fn a_pipe_is_read_like_a_file() {
    let folder = with_torus();
    let direct = lodmark(&folder, "check torus.ply");
    if cfg!(target_os = "linux") {
        let file = fs::File::open(folder.path().join("torus.ply")).expect("opens");
        let mut cat = Command::new("cat");
        let cat = cat.stdin(file).stdout(Stdio::piped()).spawn();
        let mut cat = cat.expect("cat starts");
        let pipe = cat.stdout.take().expect("a pipe");
        let piped = command(&folder, "check /dev/stdin").stdin(pipe).output();
        let piped = piped.expect("starts");
        cat.wait().expect("cat ends");
        assert_eq!(code(&piped), code(&direct), "{}", stderr(&piped));
        assert_eq!(stdout(&piped), stdout(&direct));
    }
}

#[test]
fn more_driving_pixels_than_fit_into_memory_are_refused() {
    let folder = with_torus();
    for more in ["--size 2048", "--size 256 --views octahedron:5"] {
        refused(&folder, 4, &simplified(more), "do not fit");
    }
}
