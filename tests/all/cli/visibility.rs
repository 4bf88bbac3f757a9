//! The commands `visibility` and `merge-visibility`.

use std::fs;

use lodmark::{io, mesh::generate};

use crate::support::{bytes, code, expect, folder, json, lodmark, put, refused, stdout, text};

#[test]
fn the_report_has_every_key_that_scripts_rely_on() {
    let dir = folder();
    put(&dir, "in.ply", &generate::shells(2, 2));
    let words = "visibility in.ply --cameras 18 --size 48 --json r.json --out v.ply";
    let output = lodmark(&dir, words);
    assert_eq!(code(&output), 0);
    let said = stdout(&output);
    let told = said.contains("V(M)") && said.contains("never seen");
    assert!(told, "{said}");
    let report = json(&dir, "r.json");
    assert_eq!(report["schema"], 1);
    assert_eq!(report["command"], "visibility");
    assert_eq!(report["cameras"], 18);
    assert_eq!(report["never_seen_triangles"], 320);
    for (name, least, most) in [("v_mesh", 0.5, 1.0), ("never_seen_area", 0.1, 0.5)] {
        let value = report[name].as_f64();
        assert!(value.is_some_and(|v| v > least && v < most), "{name}");
    }
    assert_eq!(report["options"]["measurement"]["octahedron"], 1);
    let colored = io::read(&dir.path().join("v.ply")).expect("reads").mesh;
    assert_eq!(colored.triangles().len(), 640);
}

#[test]
fn views_on_several_machines_give_the_file_of_one() {
    let dir = folder();
    put(&dir, "in.ply", &generate::torus(1.0, 0.4, 16, 8));
    let common = "visibility in.ply --cameras 18 --size 32 --partial";
    let run = |more: &str| expect(&dir, 0, &format!("{common} {more}"));
    run("all.vis --json direct.json");
    for (range, name) in [("7..18", "c.vis"), ("0..2", "a.vis"), ("2..7", "b.vis")] {
        run(&format!("{name} --view-range {range} --threads 3"));
    }
    let said = expect(&dir, 0, "merge-visibility c.vis a.vis --out ca.vis");
    assert!(said.contains("0..2, 7..18 of 18"), "{said}");
    let words = "merge-visibility b.vis ca.vis --out sum.vis --json m.json";
    expect(&dir, 0, words);
    assert_eq!(json(&dir, "m.json")["complete"], true);
    assert_eq!(bytes(&dir, "sum.vis"), bytes(&dir, "all.vis"));
    expect(&dir, 0, "visibility in.ply --from sum.vis --json from.json");
    let [direct, from] = ["direct.json", "from.json"].map(|name| json(&dir, name));
    assert_eq!(direct["v_mesh"], from["v_mesh"]);
    let words = "merge-visibility a.vis ca.vis --out x.vis";
    refused(&dir, 2, words, "views 0..2 in common");
    assert!(!dir.path().join("x.vis").exists());
    let said = expect(&dir, 3, "visibility in.ply --from ca.vis");
    let named = said.contains("ca.vis") && said.contains("merge the missing parts");
    assert!(named, "{said}");
    put(&dir, "other.ply", &generate::torus(1.0, 0.5, 16, 8));
    let said = expect(&dir, 3, "visibility other.ply --from sum.vis");
    let named = said.contains("sum.vis") && said.contains("another mesh;");
    assert!(named, "{said}");
    refused(
        &dir,
        3,
        "merge-visibility in.ply --out x.vis",
        "not a survey",
    );
}

#[test]
fn no_order_of_triangles_in_the_file_changes_the_answer() {
    let dir = folder();
    let mesh = generate::interlocking_tori(10, 6);
    put(&dir, "a.ply", &mesh);
    let mut parts = mesh.into_parts();
    parts.triangles.reverse();
    let reversed = lodmark::mesh::Mesh::new(parts).expect("a mesh");
    put(&dir, "b.ply", &reversed);
    for name in ["a", "b"] {
        let words = format!("visibility {name}.ply --cameras 6 --size 32 --partial {name}.vis");
        expect(&dir, 0, &words);
    }
    assert_eq!(bytes(&dir, "a.vis"), bytes(&dir, "b.vis"));
}

#[test]
fn every_product_is_written_at_once() {
    let dir = folder();
    put(&dir, "in.obj", &generate::shells(2, 1));
    let words = "visibility in.obj --cameras 6 --size 24 --paper --fractional --two-sided --edge-limit none --out v.ply --table f.npy --convergence figure.svg --remove-hidden outer.obj --rings 1 --partial p.vis --json r.json";
    expect(&dir, 0, words);
    let table = lodmark::encode::npy::read_plane::<u8>(&dir.path().join("f.npy")).expect("reads");
    assert_eq!((table.width(), table.height()), (20, 6));
    let outer = io::read(&dir.path().join("outer.obj")).expect("reads").mesh;
    assert_eq!(outer.triangles().len(), 80);
    let csv = text(&dir, "figure.csv");
    assert_eq!(csv.lines().count(), 7);
    assert!(csv.starts_with("cameras,error,v_mesh\n6,"), "{csv}");
    let svg = text(&dir, "figure.svg");
    assert!(svg.starts_with("<svg") && svg.contains("4098"));
    assert_eq!(json(&dir, "r.json")["triangles_kept"], 80);
    assert!(dir.path().join("p.vis").exists());
}

#[test]
fn requests_that_make_no_sense_begin_no_work() {
    let dir = folder();
    put(&dir, "in.ply", &generate::cube());
    for words in [
        "--cameras 7",
        "--size 0",
        "--edge-limit 0",
        "--subpixel-bits 9",
        "--out v.stl",
        "--rings 1",
        "--view-range 0..3",
        "--view-range 0-3 --partial p",
        "--view-range 0..259 --partial p",
        "--view-range 0..3 --partial p --out v.ply",
        "--from p --paper",
        "--from p --table t.npy",
        "--partial p --out p.ply --table p.ply",
        "--out p.ply --json ./p.ply",
        "--out ./p.ply --json ../FOLDER/p.ply",
    ] {
        let own = dir.path().file_name().and_then(|n| n.to_str());
        let words = words.replace("FOLDER", own.expect("a name"));
        expect(&dir, 2, &format!("visibility in.ply {words}"));
    }
    let mut left: Vec<_> = fs::read_dir(dir.path()).expect("a folder").collect();
    assert_eq!(left.len(), 1, "{:?}", left.pop());
}

#[test]
fn no_figure_takes_the_name_of_another() {
    let dir = folder();
    put(&dir, "in.ply", &generate::cube());
    fs::write(dir.path().join("cube-0.csv"), "mine").expect("writes");
    let words = "visibility in.ply --cameras 6 --size 16 --convergence cube-0.5";
    expect(&dir, 0, words);
    assert_eq!(text(&dir, "cube-0.csv"), "mine");
    assert!(text(&dir, "cube-0.5.csv").starts_with("cameras,"));
    assert!(text(&dir, "cube-0.5.svg").contains("<svg"));
}

#[test]
fn counts_of_another_version_are_refused() {
    use sha2::{Digest, Sha256};
    let dir = folder();
    put(&dir, "in.ply", &generate::cube());
    let words = "visibility in.ply --cameras 6 --size 16 --partial own.vis";
    expect(&dir, 0, words);
    let mut bytes = bytes(&dir, "own.vis");
    let version = env!("CARGO_PKG_VERSION").as_bytes();
    // After the magic, the format and the length.
    let at = 16;
    assert_eq!(&bytes[at..at + version.len()], version);
    bytes[at] = if bytes[at] == b'9' { b'8' } else { b'9' };
    let end = bytes.len() - 32;
    let seal = Sha256::digest(&bytes[..end]);
    bytes[end..].copy_from_slice(&seal);
    fs::write(dir.path().join("other.vis"), bytes).expect("writes");
    let said = expect(&dir, 4, "visibility in.ply --from other.vis");
    let named = said.contains("other.vis") && said.contains("measure again");
    assert!(named, "{said}");
    let words = "simplify in.ply out.ply -t 4 --method visibility --visibility other.vis";
    expect(&dir, 4, words);
}
