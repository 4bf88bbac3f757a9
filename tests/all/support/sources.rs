//! What every file of tests must keep to.

use std::{fs, path::Path};

/// Every Rust file below a folder, with its text.
fn texts(folder: &Path, into: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            texts(&path, into);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = fs::read_to_string(&path).expect("a source file");
            into.push((path.display().to_string(), text));
        }
    }
}

#[test]
fn no_property_test_writes_into_the_source_tree() {
    let mut sources = Vec::new();
    for folder in ["tests", "src"] {
        texts(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join(folder),
            &mut sources,
        );
    }
    let mut blocks = 0;
    for (path, text) in sources {
        // Pieces of a string, so that this file holds none of what it looks for.
        for (at, start) in text.match_indices(concat!("proptest", "! {")) {
            let mut lines = text[at + start.len()..].lines().map(str::trim);
            let first = lines.find(|line| !line.is_empty() && !line.starts_with("//"));
            let first = first.unwrap_or_default();
            let config = first.strip_prefix("#![proptest_config(");
            // `cases` and `bounded` of this room turn off the file in which failures would be kept.
            let ours = config.is_some_and(|c| {
                let c = c.trim_start_matches("crate::support::");
                ["cases(", "bounded("].iter().any(|own| c.starts_with(own))
                    || c.contains("failure_persistence: None")
            });
            assert!(ours, "{path}: a property test begins with `{first}`");
            blocks += 1;
        }
        let runner = concat!("TestRunner", "::");
        assert!(!text.contains(runner), "{path}: a runner of its own");
    }
    assert!(blocks > 40, "{blocks}");
}
