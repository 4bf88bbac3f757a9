//! Oracles: other programs that compute or check the same thing, run by Python or Node.js.
//!
//! What they need is installed below `target/oracles` the first time, from pinned hashes; `LODMARK_EMBREE_DIR` names a
//! folder that has it already (`pip install --target`). Without either their tests print why they are skipped; with
//! `LODMARK_REQUIRE_ORACLES=1` they fail.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    sync::OnceLock,
    thread,
    time::Duration,
};

use sha2::{Digest, Sha256};

const REQUIREMENTS: &str = include_str!("../../oracles/requirements.txt");

fn script() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/oracles/embree.py")
}

/// A line for whoever looks at the output of a test.
#[expect(
    clippy::print_stderr,
    reason = "the reason for skipping, or what was measured"
)]
pub(crate) fn say(line: &str) {
    eprintln!("{line}");
}

/// Runs a program; what it printed, or what it said went wrong.
fn run(command: &mut Command) -> Result<String, String> {
    let output = command
        .output()
        .map_err(|e| format!("{command:?} does not start: {e}"))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        let said = String::from_utf8_lossy(&output.stderr);
        Err(format!("{command:?} said {said}"))
    }
}

fn python(packages: &Path) -> Command {
    let mut command = Command::new("python3");
    command
        .env("PYTHONPATH", packages)
        .env("PYTHONDONTWRITEBYTECODE", "1");
    command
}

/// The folder with Embree's Python packages: given, there already, or installed now.
fn provision() -> Result<PathBuf, String> {
    let check = |packages: &Path| run(python(packages).arg(script()).arg("check"));
    if let Ok(given) = std::env::var("LODMARK_EMBREE_DIR") {
        return check(Path::new(&given)).map(|_| given.into());
    }
    let version = "import platform, sys; print(sys.version, platform.platform())";
    let version = run(Command::new("python3").args(["-c", version]))?;
    let packages = installed("embree", &[REQUIREMENTS, &version], install)?;
    check(&packages).map(|_| packages)
}

/// The folder of what `install` makes of the inputs: there already, or made now.
fn installed(
    name: &str,
    inputs: &[&str],
    install: fn(&Path, &Path) -> Result<(), String>,
) -> Result<PathBuf, String> {
    let mut hash = Sha256::new();
    for input in inputs {
        hash.update(input);
    }
    let stamp: String = hash.finalize().iter().map(|b| format!("{b:02x}")).collect();
    let oracles = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("oracles");
    fs::create_dir_all(&oracles).map_err(|e| e.to_string())?;
    let packages = oracles.join(format!("{name}-{}", &stamp[..16]));
    // The folder gets its name when it is complete: what has the name is good.
    let lock = oracles.join("lock");
    for _ in 0..600 {
        if packages.exists() {
            return Ok(packages);
        }
        match fs::File::create_new(&lock) {
            Ok(_) => {
                let installed = install(&oracles, &packages);
                let unlocked = fs::remove_file(&lock).map_err(|e| e.to_string());
                return installed.and(unlocked).map(|()| packages);
            }
            // Another test program is at it.
            Err(_) => thread::sleep(Duration::from_millis(500)),
        }
    }
    Err(format!(
        "another test has been installing for 5 minutes; if there is none, remove {}",
        lock.display()
    ))
}

fn install(oracles: &Path, packages: &Path) -> Result<(), String> {
    let partial = tempfile::tempdir_in(oracles).map_err(|e| e.to_string())?;
    let requirements = partial.path().join("requirements.txt");
    fs::write(&requirements, REQUIREMENTS).map_err(|e| e.to_string())?;
    let target = partial.path().join("packages");
    let mut pip = Command::new("python3");
    pip.args([
        "-m",
        "pip",
        "install",
        "-q",
        "--no-deps",
        "--only-binary=:all:",
        "--require-hashes",
    ])
    .args(["--disable-pip-version-check", "--target"])
    .arg(&target)
    .arg("-r")
    .arg(&requirements);
    run(&mut pip).map_err(|said| {
        format!(
            "{said}\ninstall it by hand and name the folder in LODMARK_EMBREE_DIR:\n  python3 -m pip install --no-deps \
             --only-binary=:all: --require-hashes --target FOLDER -r tests/oracles/requirements.txt"
        )
    })?;
    fs::rename(&target, packages).map_err(|e| e.to_string())
}

/// The packages, or a printed reason why there are none.
pub(crate) fn embree() -> Option<&'static Path> {
    static PACKAGES: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    had("Embree", PACKAGES.get_or_init(provision), true)
}

/// What was provisioned, or a printed reason why there is nothing.
fn had<'a>(name: &str, found: &'a Result<PathBuf, String>, can_be: bool) -> Option<&'a Path> {
    match found {
        Ok(packages) => Some(packages),
        Err(why) => {
            let required = std::env::var("LODMARK_REQUIRE_ORACLES").is_ok_and(|v| v == "1");
            assert!(
                !(required && can_be),
                "{name} is required and cannot be had: {why}"
            );
            say(&format!("skipped, because {name} cannot be had: {why}"));
            None
        }
    }
}

const VALIDATOR: &str = include_str!("../../oracles/validator/package.json");
const VALIDATOR_LOCK: &str = include_str!("../../oracles/validator/package-lock.json");

/// The folder with the official validator of glTF, or a printed reason why there is none. Where there is no Node.js it
/// cannot be required.
pub(crate) fn gltf_validator() -> Option<&'static Path> {
    static FOLDER: OnceLock<Result<PathBuf, String>> = OnceLock::new();
    let node = run(Command::new("node").arg("--version"));
    let can_be = node.is_ok();
    let found = FOLDER.get_or_init(|| {
        node?;
        installed("validator", &[VALIDATOR, VALIDATOR_LOCK], install_validator)
    });
    had("gltf-validator", found, can_be)
}

fn install_validator(oracles: &Path, folder: &Path) -> Result<(), String> {
    let partial = tempfile::tempdir_in(oracles).map_err(|e| e.to_string())?;
    let made = partial.path().join("validator");
    let write =
        |name: &str, text: &str| fs::write(made.join(name), text).map_err(|e| e.to_string());
    fs::create_dir(&made).map_err(|e| e.to_string())?;
    write("package.json", VALIDATOR)?;
    write("package-lock.json", VALIDATOR_LOCK)?;
    let mut npm = Command::new("npm");
    npm.args(["ci", "--ignore-scripts", "--no-audit", "--no-fund"]);
    run(npm.current_dir(&made))?;
    fs::rename(&made, folder).map_err(|e| e.to_string())
}

/// The codes of the errors that the validator finds in each of some files.
pub(crate) fn gltf_errors(validator: &Path, files: &[PathBuf]) -> Vec<Vec<String>> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/oracles/validator/validate.mjs");
    let said = run(Command::new("node").arg(script).arg(validator).args(files));
    let said = said.expect("the validator runs");
    let codes = |line: &str| line.split_whitespace().map(String::from).collect();
    let found: Vec<Vec<String>> = said.lines().map(codes).collect();
    assert_eq!(found.len(), files.len());
    found
}

/// Triangles of each file and its distance from the original, in levels, as trimesh reads and Embree draws them.
pub(crate) fn foreign_pictures(
    packages: &Path,
    original: &Path,
    files: &[PathBuf],
) -> Vec<(usize, f64)> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/oracles/pictures.py");
    let mut command = python(packages);
    let said = run(command.arg(script).arg("rms").arg(original).args(files));
    let said = said.expect("the pictures are drawn");
    let line = |line: &str| {
        let (triangles, rms) = line.split_once(' ').expect("two numbers");
        (
            triangles.parse().expect("a count"),
            rms.parse().expect("a number"),
        )
    };
    said.lines().map(line).collect()
}

/// Runs a command of the script on an exchange folder.
pub(crate) fn oracle(packages: &Path, words: &[&str], exchange: &Path) {
    let mut command = python(packages);
    command
        .arg(script())
        .arg(words[0])
        .arg(exchange)
        .args(&words[1..]);
    let done = run(&mut command);
    assert!(done.is_ok(), "{done:?}");
}
