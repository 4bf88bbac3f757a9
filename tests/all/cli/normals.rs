//! `lodmark simplify --normals`: the choice, its price, and replays of it.

use lodmark::mesh::generate;

use crate::{
    simplify::normals::smooth,
    support::{expect, folder, json, put, text},
};

#[test]
fn every_choice_tells_its_price_and_is_replayed_bit_for_bit() {
    let dir = folder();
    put(&dir, "in.ply", &smooth(generate::torus(1.0, 0.4, 24, 12)));
    for (normals, told) in [
        ("fit", "normals fitted: "),
        ("carry", ""),
        ("recompute", "normals recomputed: "),
        ("drop", "normals dropped: "),
    ] {
        let words = "simplify in.ply out.ply -t 60 --method memoryless --history h --json run.json";
        let said = expect(&dir, 0, &format!("{words} --normals {normals}"));
        assert!(said.contains(told), "{said}");
        assert_eq!(said.contains("normals "), normals != "carry", "{said}");
        let run = json(&dir, "run.json");
        let report = &run["normals"];
        if normals == "carry" {
            assert!(report.is_null() && run["options"]["normals"].is_null());
        } else {
            assert_eq!(run["options"]["normals"], normals);
            assert_eq!(report["normals"], normals);
            let least = run["vertices_out"].as_u64();
            assert_eq!(report["stored_vertices_carried"].as_u64(), least);
            assert!(report["stored_vertices"].as_u64() >= least);
        }
        expect(&dir, 0, "replay in.ply h again.ply -t 60 --json again.json");
        assert_eq!(
            json(&dir, "again.json")["content_sha256"],
            run["content_sha256"]
        );
    }
    expect(
        &dir,
        0,
        "simplify in.ply out.obj -t 60 --method memoryless --normals drop",
    );
    assert!(!text(&dir, "out.obj").contains("vn "));
}

#[test]
fn an_input_without_normals_has_no_price() {
    let dir = folder();
    put(&dir, "in.ply", &generate::torus(1.0, 0.4, 24, 12));
    for normals in ["fit", "recompute", "drop"] {
        let words = format!(
            "simplify in.ply o.ply -t 60 --method quadric --json r.json --normals {normals}"
        );
        assert!(!expect(&dir, 0, &words).contains("normals"));
        assert!(json(&dir, "r.json")["normals"].is_null());
    }
}
