//! The golden set: that it holds, and that it would notice if it did not.

use std::{collections::BTreeSet, fs, path::Path};

use lodmark::{
    Silent,
    encode::{
        hash::plane_sha256,
        png::{self, Picture},
    },
    mesh::generate,
    num::fixed::SubpixelBits,
    raster::{self, Grid},
    selfcheck::{GROUPS, Group, Item, Mismatch, RECORD_NAME, Record, bless, check, picture_path},
    view::{Sphere, ViewSet},
};

use crate::support::{code, folder, lodmark, scene_of, stdout};

fn checked_in() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/golden"))
}

/// Items that cost nothing, one of them with a picture.
fn few_items() -> Vec<Item> {
    let plane = Grid::new(4, 2, (0..8).map(|i| i * 30).collect()).expect("4 * 2 values");
    let item = |name: &str, value: &str, picture| Item {
        name: name.into(),
        value: value.into(),
        picture,
    };
    vec![
        item("a/one", "1 2 3", None),
        item("a/two", &plane_sha256(&plane), Some(Picture::Grey(plane))),
        item("ab/three", "x", None),
    ]
}

fn names(mismatches: &[Mismatch]) -> Vec<&str> {
    mismatches.iter().map(|m| m.name.as_str()).collect()
}

#[test]
fn every_golden_holds() {
    let items = Group::all(&Silent).expect("every case runs");
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
    let mismatches = check(checked_in(), &items, &out).expect("the goldens are readable");
    let lines: Vec<String> = mismatches.iter().map(Mismatch::to_string).collect();
    assert!(
        mismatches.is_empty(),
        "see {}; if the change is meant, `cargo run --release -- golden bless`, and say why in the commit:\n{}",
        out.display(),
        lines.join("\n")
    );
    let distinct: BTreeSet<&str> = items.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(distinct.len(), items.len(), "names are unique");
    let groups: BTreeSet<&str> = GROUPS.iter().map(|g| g.name).collect();
    for item in &items {
        let (group, _) = item.name.split_once('/').expect("a name has a group");
        assert!(groups.contains(group), "{}", item.name);
        assert!(!item.value.is_empty() && !item.value.contains('\n'));
    }
}

#[test]
fn the_program_embeds_the_goldens_of_the_file() {
    let text = fs::read_to_string(checked_in().join(RECORD_NAME)).expect("readable");
    let embedded = Record::embedded().expect("a record");
    assert_eq!(embedded.to_text(), text);
    assert!(embedded.len() > 300);
}

#[test]
fn one_bit_of_one_sample_changes_the_hash() {
    let mesh = generate::probe();
    let sphere = Sphere::of_mesh(&mesh).expect("it has triangles");
    let set = ViewSet::costs(&sphere).expect("views");
    let scene = scene_of(&mesh);
    let luma = raster::luma(&scene, &set.views[3], &set).tones;
    let before = plane_sha256(&luma);
    for (at, bit) in [(0, 0), (luma.values().len() - 1, 7), (32_768, 3)] {
        let mut changed = luma.clone();
        changed.values_mut()[at] ^= 1 << bit;
        assert_ne!(plane_sha256(&changed), before, "bit {bit} of sample {at}");
    }
    // The sub-pixel grid is all that differs: a change far below what eyes see.
    let fine = set.clone().with_subpixel(SubpixelBits::Sixteen);
    let other = raster::keys(&scene, &fine.views[3], &fine);
    let keys = raster::keys(&scene, &set.views[3], &set);
    let [coarse, fine] = [keys, other].map(|keys| plane_sha256(&raster::depths(&keys)));
    assert_ne!(coarse, fine);
}

#[test]
fn every_planted_change_of_a_golden_is_noticed() {
    let folder = folder();
    let out = folder.path().join("out");
    let items = few_items();
    bless(folder.path(), &items).expect("target is writable");
    let found = check(folder.path(), &items, &out).expect("readable");
    assert_eq!(found, []);
    assert!(!out.exists(), "nothing to show");
    for changed in 0..items.len() {
        let mut planted = items.clone();
        let last = planted[changed].value.pop().expect("a value");
        planted[changed].value.push(char::from(last as u8 ^ 1));
        let found = check(folder.path(), &planted, &out).expect("readable");
        assert_eq!(names(&found), [items[changed].name.as_str()]);
        assert_eq!(found[0].expected.as_ref(), Some(&items[changed].value));
        assert_eq!(found[0].actual.as_ref(), Some(&planted[changed].value));
    }
}

#[test]
fn a_pixel_that_changed_by_one_level_is_shown() {
    let folder = folder();
    let out = folder.path().join("out");
    let mut items = few_items();
    bless(folder.path(), &items).expect("target is writable");
    let Some(Picture::Grey(plane)) = &mut items[1].picture else {
        panic!("a grey picture");
    };
    plane.values_mut()[5] += 1;
    items[1].value = plane_sha256(plane);
    let found = check(folder.path(), &items, &out).expect("readable");
    assert_eq!(names(&found), ["a/two"]);
    let text = found[0].to_string();
    let told = "1 of 8 pixels differ, first at (1, 1): expected 150, found 151";
    assert!(text.contains(told), "{text}");
    let strip = png::read(&picture_path(&out, "a/two")).expect("a strip was written");
    assert!(strip.into_luma().width() > 3 * 4);
    let json = fs::read_to_string(out.join("mismatches.json")).expect("a report was written");
    assert!(json.contains("a/two") && json.contains(&items[1].value));
}

#[test]
fn a_picture_that_no_longer_shows_what_is_hashed_is_named() {
    let folder = folder();
    let out = folder.path().join("out");
    let items = few_items();
    bless(folder.path(), &items).expect("target is writable");
    let path = picture_path(folder.path(), "a/two");
    let other = Grid::filled(4, 2, 9);
    png::write_grey(&path, &other).expect("target is writable");
    let found = check(folder.path(), &items, &out).expect("readable");
    assert_eq!(names(&found), ["a/two.png"]);
    fs::remove_file(&path).expect("it exists");
    let found = check(folder.path(), &items, &out).expect("readable");
    assert_eq!(names(&found), ["a/two.png"]);
    assert!(found[0].to_string().contains("golden bless"));
    bless(folder.path(), &items).expect("target is writable");
    let found = check(folder.path(), &items, &out).expect("readable");
    assert_eq!(found, []);
}

#[test]
fn a_golden_that_is_missing_or_left_over_is_named() {
    let folder = folder();
    let out = folder.path().join("out");
    let items = few_items();
    let nothing = check(folder.path(), &items, &out).expect("an empty folder is no error");
    assert_eq!(names(&nothing), ["a/one", "a/two", "ab/three", "a/two.png"]);
    for mismatch in &nothing {
        let text = mismatch.to_string();
        assert!(text.contains("`lodmark golden bless`"), "{text}");
    }
    bless(folder.path(), &items).expect("target is writable");
    let found = check(folder.path(), &items[1..], &out).expect("readable");
    assert_eq!(names(&found), ["a/one"]);
    assert_eq!(found[0].actual, None);
    let record = Record::of(&items);
    assert_eq!(record.group("a").len(), 2, "`ab/three` is of another group");
    let read = Record::parse(&record.to_text(), "-").expect("a record");
    assert_eq!(read, record);
}

#[test]
fn a_damaged_record_is_refused() {
    for (text, place) in [
        ("a/one\n", "line 1"),
        ("# x\na/one 1\na/one 1\n", "line 3 repeats `a/one`"),
    ] {
        let refused = Record::parse(text, "-").expect_err("damaged");
        assert!(refused.to_string().contains(place), "{refused}");
    }
    let folder = folder();
    fs::write(folder.path().join(RECORD_NAME), "nonsense\n").expect("target is writable");
    let refused = check(folder.path(), &few_items(), folder.path()).expect_err("damaged");
    assert_eq!(refused.exit_code(), 3);
}

#[test]
fn the_command_checks_itself_without_files() {
    let folder = folder();
    // The whole set is computed by `every_golden_holds`, and by the command in every lane of `reproduce.py`.
    let chosen = ["pictures", "replay"];
    let words = "selfcheck --threads 3 --group pictures --group replay";
    let done = lodmark(&folder, words);
    let said = stdout(&done);
    assert_eq!(code(&done), 0, "{said}");
    assert!(said.contains("3 threads"), "{said}");
    for group in GROUPS {
        let line = format!("  {} ", group.name);
        assert_eq!(said.contains(&line), chosen.contains(&group.name), "{said}");
    }
    let left = fs::read_dir(folder.path()).expect("readable").count();
    assert_eq!(left, 0, "nothing is written");
}

#[test]
fn the_command_refuses_a_golden_that_does_not_hold() {
    let folder = folder();
    fs::create_dir(folder.path().join("golden")).expect("target is writable");
    for entry in fs::read_dir(checked_in()).expect("readable") {
        let path = entry.expect("readable").path();
        let name = path.file_name().expect("a name");
        fs::copy(&path, folder.path().join("golden").join(name)).expect("target is writable");
    }
    let record = folder.path().join("golden").join(RECORD_NAME);
    let text = fs::read_to_string(&record).expect("readable");
    let mut lines = text.lines().filter_map(|line| line.split_once(' '));
    let picture = lines.find(|(name, _)| *name == "pictures/probe/00/luma");
    let (name, value) = picture.expect("the golden of a picture");
    let first = if value.starts_with('0') { "1" } else { "0" };
    let planted = format!("{name} {first}{}", &value[1..]);
    fs::write(&record, text.replace(&format!("{name} {value}"), &planted)).expect("writable");
    let done = lodmark(&folder, "golden check --group pictures --out out");
    let said = stdout(&done);
    assert_eq!(code(&done), 1, "{said}");
    let told = format!("{planted}, found {value}").replacen(' ', ": expected ", 1);
    assert!(said.contains(&told), "{said}");
    assert!(folder.path().join("out/mismatches.json").exists());
}
