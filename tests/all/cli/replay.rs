//! `lodmark replay` on histories that another version wrote.

use std::fs;

use lodmark::mesh::generate::{self, Height};

use crate::support::{expect, folder, json, put};

#[test]
fn histories_of_an_earlier_version_are_read_and_give_its_meshes() {
    // Written by ad8bc35: `simplify in.obj o.obj -t 40 --method image --preset fast --size 64`, whose polishing moved 28
    // vertices and flipped an edge, and `--method memoryless`; hashes of the last level and of 80 triangles.
    let image = include_bytes!("../../data/ad8bc35-image.history");
    let memoryless = include_bytes!("../../data/ad8bc35-memoryless.history");
    let written = [
        (
            &image[..],
            "57af45e687962f6f5f97518cdd58f02e9e3a1587034db2756010cecb8f61d744",
            "0535084b8c017e1b0d262dcecb95fc83169ccc73a44420be06bffd6856aeef66",
        ),
        (
            &memoryless[..],
            "72a6280af4445a5c7b90f74272f66750cefbafc42eabdeb842f584abfd4edf35",
            "3fb1551179107730c07f2850b0e2319f5118c186c358c317e2ccfa8cedf0ec44",
        ),
    ];
    let dir = folder();
    put(&dir, "in.obj", &generate::grid(8, 8, Height::Waves));
    for (bytes, last, middle) in written {
        fs::write(dir.path().join("old.history"), bytes).expect("writes");
        for (level, sha256) in [("40", last), ("80", middle)] {
            let words = format!("replay in.obj old.history o.obj -t {level} --json o.json");
            expect(&dir, 0, &words);
            assert_eq!(json(&dir, "o.json")["content_sha256"], sha256, "{level}");
        }
    }
}
