//! Files that are none, results that nobody takes, outputs that cannot be: what a user's shell can do to the command.

use std::{fs, process::Command};

use lodmark::{
    mesh::{Mesh, MeshParts, generate},
    num::Precision,
    simplify::{Options, Target, simplify},
};
use proptest::prelude::*;

use crate::support::{code, expect, folder, lodmark, put, split, stderr, stdout};

const TORUS: [&str; 4] = ["simplify", "torus.ply", "out.ply", "--triangles"];

fn with_torus() -> tempfile::TempDir {
    let folder = folder();
    put(&folder, "torus.ply", &generate::torus(1.0, 0.4, 12, 6));
    folder
}

#[test]
fn a_negative_number_is_out_of_range_and_no_unknown_option() {
    let folder = with_torus();
    fs::write(folder.path().join("history"), "").expect("writes");
    for (arguments, said) in [
        (
            vec!["simplify", "torus.ply", "o.ply", "--triangles", "-1"],
            "-1 triangles make no mesh",
        ),
        (
            vec!["simplify", "torus.ply", "o.ply", "--triangles", "0"],
            "0 triangles make no mesh",
        ),
        (
            vec!["simplify", "torus.ply", "o.ply", "--ratio", "-0.5"],
            "the ratio -0.5 is not in",
        ),
        (
            vec!["simplify", "torus.ply", "o.ply", "--error-rms", "-1"],
            "error-rms is -1",
        ),
        (
            split("replay torus.ply history o.ply --triangles -1"),
            "-1 triangles make no mesh",
        ),
    ] {
        let message = expect(&folder, 2, &arguments);
        assert!(message.contains(said), "{arguments:?}: {message}");
    }
}

#[test]
fn a_preset_is_refused_by_methods_that_have_none() {
    let folder = with_torus();
    let arguments = [
        &TORUS[..],
        &["50", "--method", "quadric", "--preset", "paper"],
    ]
    .concat();
    assert!(expect(&folder, 2, &arguments).contains("--preset means nothing"));
}

#[test]
fn an_output_that_cannot_be_written_is_found_before_the_work_and_leaves_nothing() {
    let folder = with_torus();
    for option in ["--json", "--history"] {
        let arguments = [&TORUS[..], &["50", option, "nowhere/file"]].concat();
        let message = expect(&folder, 5, &arguments);
        assert!(message.contains("nowhere/file"), "{message}");
        assert!(!message.contains("collapses"), "after the work: {message}");
    }
    let twice = [&TORUS[..], &["50", "--json", "out.ply"]].concat();
    assert!(expect(&folder, 2, &twice).contains("written twice"));
    fs::create_dir(folder.path().join("dir.ply")).expect("a folder");
    let message = expect(&folder, 5, "simplify torus.ply dir.ply -t 50");
    assert!(message.contains("it is a folder"), "{message}");
    let left = fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(left, 2, "only the input and the folder");
}

#[cfg(target_os = "linux")]
#[test]
fn an_endless_input_is_refused() {
    let folder = with_torus();
    for arguments in [
        &["check", "/dev/zero"][..],
        &["replay", "torus.ply", "/dev/zero", "out.ply", "-t", "9"],
        &["render", "torus.ply", "out", "--views", "/dev/zero"],
    ] {
        let message = expect(&folder, 3, arguments);
        assert!(message.contains("more than"), "{arguments:?}: {message}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_an_error_of_the_system_and_no_bug() {
    let folder = with_torus();
    let full = || {
        fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("linux has it")
    };
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lodmark"));
        command.current_dir(folder.path()).args(arguments);
        command
    };
    for arguments in [&["check", "torus.ply"][..], &["inspect", "torus.ply"]] {
        let output = run(arguments).stdout(full()).output().expect("starts");
        assert_eq!(code(&output), 5, "{}", stderr(&output));
        assert!(
            stderr(&output).contains("standard output"),
            "{}",
            stderr(&output)
        );
        let output = run(arguments).stderr(full()).output().expect("starts");
        assert_eq!(code(&output), 0, "a deaf stderr changes nothing");
    }
    let json = [&TORUS[..], &["50", "--json", "/dev/full"]].concat();
    assert!(expect(&folder, 5, &json).contains("/dev/full"));
}

#[test]
fn a_report_that_cannot_be_written_comes_with_no_result_line() {
    let folder = with_torus();
    for arguments in [
        &[
            "render",
            "torus.ply",
            "out",
            "--size",
            "8",
            "--json",
            "nowhere/r",
        ][..],
        &split("simplify torus.ply out.ply -t 50 --json nowhere/r"),
    ] {
        expect(&folder, 5, arguments);
    }
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
            Mesh::new(MeshParts { positions, triangles: mesh.triangles().to_vec(), precision: Precision::F64, ..MeshParts::default() })
                .expect("finite")
        };
        for run in [Options::image, Options::memoryless, Options::quadric] {
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
        let mut command = Command::new("cat");
        let mut cat = command
            .stdin(file)
            .stdout(std::process::Stdio::piped())
            .spawn()
            .expect("cat starts");
        let piped = Command::new(env!("CARGO_BIN_EXE_lodmark"))
            .args(["check", "/dev/stdin"])
            .stdin(cat.stdout.take().expect("a pipe"))
            .output()
            .expect("starts");
        cat.wait().expect("cat ends");
        assert_eq!(code(&piped), code(&direct), "{}", stderr(&piped));
        assert_eq!(stdout(&piped), stdout(&direct));
    }
}

#[test]
fn more_driving_pixels_than_fit_into_memory_are_refused() {
    let folder = with_torus();
    for more in [
        &["--size", "2048"][..],
        &["--size", "256", "--views", "octahedron:5"],
    ] {
        let arguments = [&TORUS[..], &["50"], more].concat();
        let message = expect(&folder, 4, &arguments);
        assert!(message.contains("do not fit"), "{arguments:?}: {message}");
    }
}
