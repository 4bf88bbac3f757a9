//! The help texts: every file that a command takes is shown whole, in a form that its reader takes.

use lodmark::{bound::view_cell, view};

use crate::support::{code, folder, lodmark, split, stdout};

/// The JSON objects in a text, wherever lines were broken.
fn objects(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let text = lines.join(" ");
    let starts = text.match_indices("{\"schema\"").map(|(at, _)| at);
    let whole = |at: usize| {
        let mut values = serde_json::Deserializer::from_str(&text[at..]).into_iter();
        let value: serde_json::Value = values.next()?.ok()?;
        Some(value.to_string())
    };
    let object = |at| whole(at).unwrap_or_else(|| panic!("no JSON: {}", &text[at..]));
    starts.map(object).collect()
}

#[test]
fn every_example_in_a_help_text_is_read_as_the_file_that_it_shows() {
    let dir = folder();
    for (command, cells, views) in [
        ("simplify", 8, 1),
        ("bound", 8, 0),
        ("bound-region", 8, 0),
        ("verify", 8, 0),
        ("billboards", 8, 0),
        ("render", 0, 1),
        ("compare", 0, 1),
        ("check-rays", 0, 1),
    ] {
        let output = lodmark(&dir, &[command, "--help"]);
        assert_eq!(code(&output), 0);
        let (mut read, mut drawn) = (0, 0);
        for text in objects(&stdout(&output)) {
            if text.contains("\"views\"") {
                drawn += 1;
                view::file::from_json(&text, "help").expect("a view file");
            } else {
                read += 1;
                view_cell::file::from_json(&text, "help").expect("a cell file");
            }
        }
        assert_eq!((read, drawn), (cells, views), "{command}");
    }
}

#[test]
fn every_binary_file_is_named_with_what_writes_and_what_reads_it() {
    let dir = folder();
    for (command, names) in [
        ("replay", &["simplify --history"][..]),
        (
            "simplify",
            &[
                "simplify --history",
                "verify --bound",
                "visibility --partial",
            ],
        ),
        ("verify", &["simplify --bound-out"]),
        ("bound", &["simplify --bound-out"]),
        ("visibility", &["merge-visibility"]),
        ("merge-visibility", &["visibility --partial"]),
        ("levels", &["visibility --partial"]),
    ] {
        let text = stdout(&lodmark(&dir, &[command, "--help"]));
        let text = split(&text).join(" ");
        for name in names {
            assert!(text.contains(name), "{command}: {name}");
        }
    }
}

#[test]
fn the_short_help_leaves_out_what_few_need_and_the_long_one_has_it() {
    let dir = folder();
    let [short, long] = ["-h", "--help"].map(|word| stdout(&lodmark(&dir, &["simplify", word])));
    let rare = "--engine --evaluation --measure-rank --volume --growing --probabilistic --attributes --keep-folds";
    for option in split(rare) {
        assert!(!short.contains(option) && long.contains(option), "{option}");
    }
    assert!(short.contains("--triangles") && short.contains("--preset"));
}
