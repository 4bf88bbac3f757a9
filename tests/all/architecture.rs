//! The layers of the crate, and that the code has no other imports.

use std::{fs, path::Path};

/// Every stage with the stages it may import. Data flows one way: an import points to an earlier line.
/// A new arrow is added here in the commit that needs it.
const ALLOWED: &[(&str, &[&str])] = &[
    ("error", &[]),
    ("parallel", &["error"]),
    ("progress", &["error"]),
    ("num", &["error"]),
    ("encode", &["error", "num"]),
    ("geometry", &["error", "num"]),
    ("mesh", &["error", "num", "geometry"]),
    ("io", &["error", "num", "encode", "geometry", "mesh"]),
    ("view", &["error", "num", "encode", "geometry", "mesh"]),
    (
        "raster",
        &["error", "progress", "num", "geometry", "mesh", "view"],
    ),
    (
        "metric",
        &[
            "error", "progress", "num", "encode", "geometry", "mesh", "view", "raster",
        ],
    ),
    (
        "visibility",
        &[
            "error", "progress", "num", "encode", "geometry", "mesh", "view", "raster",
        ],
    ),
    (
        "validate",
        &[
            "error", "progress", "num", "geometry", "mesh", "view", "raster",
        ],
    ),
    (
        "bound",
        &["error", "progress", "num", "encode", "geometry", "mesh"],
    ),
    (
        "collapse",
        &["error", "progress", "num", "encode", "geometry", "mesh"],
    ),
    (
        "simplify",
        &[
            "error",
            "progress",
            "num",
            "encode",
            "geometry",
            "mesh",
            "io",
            "view",
            "raster",
            "metric",
            "visibility",
            "bound",
            "collapse",
        ],
    ),
    (
        "chain",
        &[
            "error",
            "progress",
            "num",
            "encode",
            "mesh",
            "io",
            "view",
            "raster",
            "metric",
            "visibility",
            "bound",
            "simplify",
        ],
    ),
    (
        "selfcheck",
        &[
            "error",
            "progress",
            "num",
            "encode",
            "geometry",
            "mesh",
            "io",
            "view",
            "raster",
            "metric",
            "visibility",
            "bound",
            "simplify",
        ],
    ),
    (
        "front",
        &[
            "error",
            "progress",
            "num",
            "encode",
            "mesh",
            "view",
            "raster",
            "metric",
            "visibility",
            "bound",
            "collapse",
            "simplify",
            "chain",
        ],
    ),
    (
        "cli",
        &[
            "error",
            "progress",
            "num",
            "encode",
            "geometry",
            "mesh",
            "io",
            "view",
            "raster",
            "metric",
            "visibility",
            "validate",
            "bound",
            "collapse",
            "simplify",
            "chain",
            "selfcheck",
            "front",
        ],
    ),
];

/// Every stage may share work among threads.
const EVERYWHERE: &str = "parallel";

/// `crate::a::b` and `crate::{a, b::c}` both import `a`; names re-exported at the root count as their stage.
fn imports(source: &str) -> Vec<String> {
    let source = source.replace("in crate::rooms::", "in crate::");
    let mut found = Vec::new();
    for (at, _) in source.match_indices("crate::") {
        let rest = &source[at + "crate::".len()..];
        let names: Vec<&str> = if let Some(group) = rest.strip_prefix('{') {
            let mut depth = 0;
            let end = group
                .find(|c| {
                    depth += i32::from(c == '{') - i32::from(c == '}');
                    depth < 0
                })
                .unwrap_or(group.len());
            let mut depth = 0;
            group[..end]
                .split(|c| {
                    depth += i32::from(c == '{') - i32::from(c == '}');
                    c == ',' && depth == 0
                })
                .collect()
        } else {
            vec![rest]
        };
        for name in names {
            let first: String = name
                .trim()
                .chars()
                .take_while(|c| c.is_alphanumeric() || *c == '_')
                .collect();
            match first.as_str() {
                "" => {}
                "Error" | "Result" => found.push("error".into()),
                "Progress" | "Silent" => found.push("progress".into()),
                _ => found.push(first),
            }
        }
    }
    found
}

fn rust_files(folder: &Path, into: &mut Vec<std::path::PathBuf>) {
    for entry in fs::read_dir(folder).expect("src is readable") {
        let path = entry.expect("src is readable").path();
        if path.is_dir() {
            rust_files(&path, into);
        } else if path.extension().is_some_and(|e| e == "rs") {
            into.push(path);
        }
    }
}

#[test]
fn no_stage_imports_a_later_one() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&src, &mut files);
    let mut wrong = Vec::new();
    for file in files {
        let relative = file.strip_prefix(&src).expect("below src");
        let stage = relative
            .iter()
            .next()
            .expect("a name")
            .to_string_lossy()
            .replace(".rs", "");
        if stage == "lib" || stage == "main" {
            continue;
        }
        let Some((_, allowed)) = ALLOWED.iter().find(|(name, _)| *name == stage) else {
            wrong.push(format!(
                "{}: the stage `{stage}` is not in the table",
                relative.display()
            ));
            continue;
        };
        let text = fs::read_to_string(&file).expect("source is readable");
        for import in imports(&text) {
            let is_allowed = [EVERYWHERE, &stage].contains(&import.as_str())
                || allowed.contains(&import.as_str());
            if !is_allowed {
                wrong.push(format!(
                    "{}: `{stage}` may not import `{import}`",
                    relative.display()
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn threads_are_shared_in_one_place() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&src, &mut files);
    let names_rayon = |file: &std::path::PathBuf| {
        fs::read_to_string(file).is_ok_and(|text| text.contains("rayon"))
    };
    files.retain(names_rayon);
    assert_eq!(files, [src.join("parallel.rs")]);
}

#[test]
fn the_table_of_stages_points_one_way() {
    for (i, (stage, allowed)) in ALLOWED.iter().enumerate() {
        for import in *allowed {
            assert!(
                ALLOWED[..i].iter().any(|(earlier, _)| earlier == import),
                "{stage} -> {import} points forward"
            );
        }
    }
}

#[test]
fn an_import_inside_braces_is_seen() {
    let source = "use crate::{Error, mesh::{Mesh, Edge}, cli};\nfn f() { crate::raster::g() }";
    assert_eq!(imports(source), ["error", "mesh", "cli", "raster"]);
}
