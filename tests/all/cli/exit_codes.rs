//! The command as a user runs it: exit codes, messages, streams, and files that appear whole or not at all.

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

use glam::DVec3;
use lodmark::{
    io,
    mesh::{content_sha256, generate},
};
use tempfile::TempDir;

use crate::support::{bytes, code, command, expect, folder, lodmark, put, refused, stderr, stdout};

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let entries = entries.map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = entries.map(|name| name.to_string_lossy().into()).collect();
    names.sort();
    names
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn a_request_without_sense_ends_with_2_and_says_what_to_do() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(1));
    for (words, said) in [
        ("", "Usage"),
        ("explode in.ply", "no command `explode`"),
        ("simplify in.ply", "OUT"),
        ("render in.ply d --samples 3", "samples"),
        ("render in.ply d --size 9999", "4096"),
    ] {
        refused(&dir, 2, words, said);
    }
    for (more, said) in [
        ("", "--triangles"),
        ("--triangles 0", "at least 1"),
        ("--triangles -1", "-1"),
        ("--triangles many", "--triangles"),
        ("--ratio 0", "ratio"),
        ("--ratio 1.5", "ratio"),
        ("--ratio NaN", "ratio"),
        ("--ratio 0.5 --triangles 5", "cannot be used with"),
        ("-t 9 --method guess", "memoryless"),
        ("-t 9 --threads 0", "--threads"),
        ("-t 9 --colour", "--colour"),
        ("-t 9 --method quadric --size 64", "--size"),
        ("-t 9 --size 0", "0"),
        ("-t 9 --views cube", "dodecahedron"),
        ("--error-rms 2 --method memoryless", "--error-rms"),
        ("--error-rms -1", "-1"),
    ] {
        refused(&dir, 2, &format!("simplify in.ply out.ply {more}"), said);
    }
    assert_eq!(names(dir.path()), ["in.ply"], "nothing was made");
}

#[test]
fn help_and_version_are_results_and_go_to_stdout() {
    let dir = folder();
    for words in ["--help", "--version", "simplify --help"] {
        let output = lodmark(&dir, words);
        assert_eq!(code(&output), 0);
        assert!(stdout(&output).contains("lodmark"), "{words:?}");
        assert_eq!(stderr(&output), "");
    }
}

#[test]
fn an_output_of_unknown_format_is_refused_before_any_work() {
    let dir = folder();
    // The input does not even exist: nobody has looked for it yet.
    let said = expect(&dir, 2, "simplify in.ply out.step -t 5");
    assert!(said.contains("out.step") && said.contains(".obj"), "{said}");
}

#[test]
fn a_damaged_file_is_named_with_the_place_of_the_damage() {
    let dir = folder();
    let huge_ply = "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n\
                    property float y\nproperty float z\nelement face 4000000000\n\
                    property list uchar int vertex_indices\nend_header\n";
    let mut huge_stl = vec![0_u8; 80];
    huge_stl.extend(u32::MAX.to_le_bytes());
    let triangle = |from, to| TRIANGLE.replace(from, to).into_bytes();
    for (name, content, place) in [
        ("nan.obj", triangle("1 0 0", "1 nan 0"), "line 2"),
        ("infinite.obj", triangle("0 1 0", "0 1e999 0"), "line 3"),
        ("index.obj", triangle("f 1 2 3", "f 1 2 4"), "line 4"),
        ("huge.ply", huge_ply.as_bytes().to_vec(), "4000000000"),
        ("huge.stl", huge_stl, "4294967295"),
        ("empty.obj", Vec::new(), "empty"),
        ("points.obj", b"v 0 0 0\nv 1 0 0\n".to_vec(), "no triangles"),
        (
            "noise.bin",
            vec![0xff; 64],
            "expected an OBJ, PLY, STL or glTF",
        ),
    ] {
        fs::write(dir.path().join(name), content).expect("writes");
        let said = expect(&dir, 3, &["simplify", name, "out.ply", "-t", "1"]);
        let named = said.contains(name) && said.contains(place);
        assert!(named, "{name}: {said}");
        assert!(!dir.path().join("out.ply").exists());
    }
}

#[test]
fn coordinates_at_the_ends_of_the_range_are_simplified_like_others() {
    let dir = folder();
    let sphere = generate::icosphere(1);
    let face = |t: &[u32; 3]| format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    let faces: String = sphere.triangles().iter().map(face).collect();
    for scale in ["e37", "e-30", "e-40"] {
        let point =
            |p: &DVec3| format!("v {:.6}{scale} {:.6}{scale} {:.6}{scale}\n", p.x, p.y, p.z);
        let points: String = sphere.positions().iter().map(point).collect();
        fs::write(dir.path().join("in.obj"), points + &faces).expect("writes");
        for method in ["memoryless", "quadric", "image"] {
            let words = format!("simplify in.obj out.obj -t 40 --method {method}");
            expect(&dir, 0, &words);
            let made = io::read(&dir.path().join("out.obj")).expect("reads").mesh;
            assert!(made.triangles().len() <= 40, "{scale} {method}");
        }
    }
}

#[test]
fn a_file_that_is_not_there_ends_with_5_and_its_name() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(1));
    for words in [
        "simplify none.ply out.ply -t 5",
        "check none.ply",
        "inspect none.ply",
        "render none.ply d",
        "compare none.ply in.ply",
        "compare in.ply none.ply",
    ] {
        refused(&dir, 5, words, "cannot read none.ply");
    }
    assert_eq!(names(dir.path()), ["in.ply"]);
}

#[test]
fn what_this_version_cannot_do_ends_with_4() {
    let dir = folder();
    let draco =
        r#"{"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"]}"#;
    fs::write(dir.path().join("in.gltf"), draco).expect("writes");
    refused(&dir, 4, "lod in.gltf out", "draco");
    assert_eq!(names(dir.path()), ["in.gltf"]);
}

#[test]
fn a_target_above_the_input_copies_it() {
    let dir = folder();
    let mesh = generate::torus(1.0, 0.4, 12, 8);
    put(&dir, "in.ply", &mesh);
    for method in ["image", "memoryless", "quadric"] {
        let words = format!("simplify in.ply out.ply -t 9999 --method {method}");
        let said = expect(&dir, 0, &words);
        assert!(said.contains("copy"), "{said}");
        let made = io::read(&dir.path().join("out.ply")).expect("reads").mesh;
        let canonical = lodmark::mesh::canonical(&mesh).mesh;
        let [made, canonical] = [&made, &canonical].map(content_sha256);
        assert_eq!(made, canonical, "{method}");
    }
}

#[test]
fn a_target_out_of_reach_is_said_and_with_strict_refused() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(2));
    let words = "simplify in.ply out.ply -t 1 --method memoryless --topology preserve";
    let said = expect(&dir, 0, words);
    assert!(said.contains("no edge may be collapsed"), "{said}");
    let before = bytes(&dir, "out.ply");
    expect(&dir, 2, &format!("{words} --strict --ratio 0.9"));
    let strict = format!("{words} --strict --json report.json");
    refused(&dir, 6, &strict, "nothing was written");
    assert_eq!(bytes(&dir, "out.ply"), before);
    assert_eq!(names(dir.path()), ["in.ply", "out.ply"]);
}

#[test]
fn results_go_to_stdout_and_talk_to_stderr() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(2));
    let words = "simplify in.ply out.ply -t 100 --method quadric";
    let loud = lodmark(&dir, words);
    let quiet = lodmark(&dir, &format!("{words} --quiet"));
    assert_eq!((code(&loud), code(&quiet)), (0, 0));
    let result = "out.ply: 320 -> 100 triangles, 52 vertices\n";
    assert_eq!(stdout(&loud), result);
    assert_eq!(stdout(&quiet), stdout(&loud));
    assert!(stderr(&loud).contains("collapses"));
    assert_eq!(stderr(&quiet), "");
}

#[test]
fn a_mesh_with_findings_is_a_negative_answer_and_no_failure() {
    let dir = folder();
    put(&dir, "closed.ply", &generate::icosphere(1));
    fs::write(dir.path().join("bad.obj"), format!("{TRIANGLE}f 1 1 2\n")).expect("writes");
    expect(&dir, 0, "check closed.ply");
    let output = lodmark(&dir, "check bad.obj");
    assert_eq!(code(&output), 1);
    assert!(!stdout(&output).is_empty());
}

#[test]
fn a_failure_to_write_leaves_nothing_behind() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(1));
    fs::create_dir(dir.path().join("out.ply")).expect("a folder");
    for out in ["out.ply", "missing/out.ply"] {
        let words = format!("simplify in.ply {out} -t 40 --method quadric");
        refused(&dir, 5, &words, out);
    }
    let words = "compare in.ply in.ply --size 8 --no-distance --difference missing/d.png";
    expect(&dir, 5, words);
    assert_eq!(names(dir.path()), ["in.ply", "out.ply"]);
    assert!(names(&dir.path().join("out.ply")).is_empty());
}

#[test]
fn an_existing_output_is_replaced_in_one_step() {
    let dir = folder();
    put(&dir, "in.ply", &generate::icosphere(1));
    let out = dir.path().join("out.ply");
    fs::write(&out, b"what was there before").expect("writes");
    let mut open = fs::File::open(&out).expect("opens");
    expect(&dir, 0, "simplify in.ply out.ply -t 40 --method quadric");
    // Who had the old file open still reads all of it: it was not written over.
    let mut old = String::new();
    std::io::Read::read_to_string(&mut open, &mut old).expect("reads");
    assert_eq!(old, "what was there before");
    assert_eq!(io::read(&out).expect("reads").mesh.triangles().len(), 40);
    assert_eq!(names(dir.path()), ["in.ply", "out.ply"]);
}

#[test]
fn no_number_of_threads_changes_a_byte_of_a_result() {
    let dir = folder();
    put(&dir, "in.ply", &generate::torus(1.0, 0.4, 24, 16));
    for method in ["image", "memoryless", "quadric", "visibility"] {
        let mut all = Vec::new();
        for threads in ["1", "2", "3", "8"] {
            let more = match method {
                "image" => "--size 64 --start-triangles none",
                "visibility" => "--cameras 18 --visibility-size 64",
                _ => "",
            };
            let words = format!(
                "simplify in.ply out.ply -t 300 --method {method} --threads {threads} --json report.json \
                 --history history.bin {more}"
            );
            expect(&dir, 0, &words);
            all.push(["out.ply", "report.json", "history.bin"].map(|name| bytes(&dir, name)));
        }
        assert!(all.iter().all(|files| *files == all[0]), "{method}");
    }
}

/// Presses the interrupt key once the command has said that it is at work.
#[cfg(unix)]
fn interrupt(dir: &TempDir, words: &str) -> Output {
    use std::io::{BufRead, BufReader, Read};
    let mut child = command(dir, words)
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the command starts");
    let mut talk = BufReader::new(child.stderr.take().expect("piped"));
    let mut said = String::new();
    while !said.contains(" of ") {
        let length = talk.read_line(&mut said).expect("text");
        assert!(length > 0, "ended early: {said}");
    }
    let kill = format!("kill -INT {}", child.id());
    let sent = Command::new("sh").args(["-c", &kill]).status();
    assert!(sent.expect("a shell").success());
    talk.read_to_string(&mut said).expect("text");
    let mut output = child.wait_with_output().expect("it ends");
    output.stderr = said.into_bytes();
    output
}

#[test]
#[cfg(unix)]
fn an_interrupted_run_ends_with_130_and_leaves_what_was_there() {
    let dir = folder();
    let grid = generate::grid(96, 96, generate::Height::Waves);
    put(&dir, "in.ply", &grid);
    fs::write(dir.path().join("out.ply"), b"before").expect("writes");
    for words in [
        "simplify in.ply out.ply -t 10 --start-triangles none --json report.json --history h.bin",
        "compare in.ply in.ply --size 1024 --samples 4 --json report.json --difference d.png",
    ] {
        let output = interrupt(&dir, words);
        assert_eq!(code(&output), 130, "{words:?} said {}", stderr(&output));
        assert!(stderr(&output).contains("nothing was written"));
        assert_eq!(stdout(&output), "");
        assert_eq!(names(dir.path()), ["in.ply", "out.ply"]);
        assert_eq!(bytes(&dir, "out.ply"), b"before");
    }
}
