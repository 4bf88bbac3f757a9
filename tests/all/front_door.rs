//! The promised surface: what a program without the feature `internals` sees, and how much that is.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use crate::support::{folder, meshes, put, say};

/// Items that the front page of the documentation may show; raised with a reason.
const FRONT_PAGE: usize = 40;
/// Items that the documentation may have in all; raised with a reason.
const ALL_ITEMS: usize = 150;
/// The examples in `examples/`, with the arguments that follow the mesh.
const EXAMPLES: [(&str, &[&str]); 3] = [
    ("simplify_and_compare", &["small.ply", "200"]),
    ("reference_pictures", &["pictures"]),
    ("guaranteed_bound", &["near.ply", "0.01"]),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A folder below that of the build, which later runs use again.
fn built(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Where cargo builds everything else.
fn target() -> &'static Path {
    let inside = Path::new(env!("CARGO_TARGET_TMPDIR"));
    inside.parent().expect("a folder in that of the build")
}

fn cargo(folder: &Path, target: &Path, arguments: &[&str]) {
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .args(["--offline", "--quiet", "--target-dir"])
        .arg(target)
        // As the documentation is made before a change lands, so that it is made once.
        .env("RUSTDOCFLAGS", "-D warnings")
        .current_dir(folder)
        .output()
        .expect("cargo runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "cargo {arguments:?}:\n{said}");
}

/// A package of its own that sees what any other program sees.
fn stranger() -> PathBuf {
    let folder = built("stranger");
    fs::create_dir_all(&folder).expect("a folder");
    let mut manifest = format!(
        "[package]\nname = \"stranger\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
         lodmark = {{ path = {:?}, default-features = false }}\n\n[profile.dev]\ndebug = false\nincremental = false\n",
        root()
    );
    for (name, _) in EXAMPLES {
        let path = root().join(format!("examples/{name}.rs"));
        manifest += &format!("\n[[bin]]\nname = {name:?}\npath = {path:?}\n");
    }
    fs::write(folder.join("Cargo.toml"), manifest).expect("a manifest");
    fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock")).expect("a lock file");
    folder
}

#[test]
fn the_examples_need_the_promised_surface_alone_and_run() {
    cargo(&stranger(), &built("stranger-target"), &["check"]);
    // Those that the tests built see more than a stranger does, but run the same.
    cargo(root(), target(), &["build", "--examples", "--locked"]);
    let place = folder();
    put(&place, "mesh.ply", &meshes::torus(24, 16, 1));
    for (name, arguments) in EXAMPLES {
        let program = format!("debug/examples/{name}{}", std::env::consts::EXE_SUFFIX);
        let output = Command::new(target().join(program))
            .arg("mesh.ply")
            .args(arguments)
            .current_dir(place.path())
            .output()
            .expect("an example runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{name}: {said}");
        assert!(place.path().join(arguments[0]).exists(), "{name}");
    }
}

#[test]
fn every_example_is_one_that_runs() {
    let listed: BTreeSet<String> = EXAMPLES
        .iter()
        .map(|(name, _)| format!("{name}.rs"))
        .collect();
    let found = fs::read_dir(root().join("examples")).expect("a folder");
    let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
    let found: BTreeSet<String> = found
        .map(|entry| name(entry).to_string_lossy().into_owned())
        .collect();
    assert_eq!(found, listed);
}

#[test]
fn the_readme_shows_the_example_that_the_documentation_runs() {
    let read = |name: &str| fs::read_to_string(root().join(name)).expect("a text file");
    let (readme, library) = (read("README.md"), read("src/lib.rs"));
    let example = readme.split("```rust\n").nth(1).expect("an example");
    let example = example.split("```").next().expect("its text");
    let visible = library
        .lines()
        .skip_while(|line| *line != "//! ```")
        .skip(1)
        .take_while(|line| *line != "//! ```")
        .map(|line| line.trim_start_matches("//!").trim())
        .filter(|line| !line.starts_with("# "));
    assert!(visible.eq(example.lines()));
}

/// The parts of `text` that stand between `before` and the next quotation mark.
fn quoted<'a>(text: &'a str, before: &str) -> Vec<&'a str> {
    let rest = text.split(before).skip(1);
    rest.filter_map(|part| part.split('"').next()).collect()
}

/// How often a `doc(hidden)` leaves an item out of the documentation.
fn hidden(folder: &Path) -> usize {
    let mut count = 0;
    for entry in fs::read_dir(folder).expect("src is readable") {
        let path = entry.expect("src is readable").path();
        count += if path.is_dir() {
            hidden(&path)
        } else {
            let text = fs::read_to_string(&path).expect("source is readable");
            text.matches("doc(hidden)").count()
        };
    }
    count
}

#[test]
fn the_documentation_shows_few_items() {
    const KINDS: [&str; 6] = ["struct", "enum", "trait", "fn", "constant", "type"];
    cargo(root(), target(), &["doc", "--no-deps", "--locked"]);
    let page = |name: &str| {
        fs::read_to_string(target().join("doc/lodmark").join(name))
            .expect("a page of documentation")
    };
    let shown = page("index.html");
    let shown = quoted(&shown, "class=\"")
        .into_iter()
        .filter(|class| KINDS.contains(class) || ["mod", "macro"].contains(class));
    let shown = shown.count();
    let all = page("all.html");
    let is_item = |link: &&str| {
        let name = link.rsplit('/').next().unwrap_or_default();
        KINDS
            .iter()
            .any(|kind| name.starts_with(&format!("{kind}.")))
    };
    let all: BTreeSet<&str> = quoted(&all, "href=\"")
        .into_iter()
        .filter(is_item)
        .collect();
    let all = all.len() + hidden(&root().join("src"));
    say(&format!(
        "front page: {shown} items, documentation: {all} items"
    ));
    assert!(shown <= FRONT_PAGE, "the front page shows {shown} items");
    assert!(all <= ALL_ITEMS, "the documentation has {all} items");
    assert!(
        shown > 10 && all > shown,
        "{shown} and {all} items: the pages are not read right"
    );
}
