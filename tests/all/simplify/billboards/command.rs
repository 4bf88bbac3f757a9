//! Interruption, and the command with its files.

use std::process::Command;

use lodmark::{
    Error,
    bound::planar::Aperture,
    io,
    simplify::billboards::{BillboardOptions, Limit, billboards, files},
};

use super::{before_the_city, blocks, cloud, within};
use crate::support::{Impatient, split};

#[test]
fn a_user_who_wants_to_stop_does_not_wait_for_the_end() {
    let mesh = blocks(4);
    let stopped = billboards(&mesh, &before_the_city(), &within(0.1), &Impatient);
    assert!(matches!(stopped, Err(Error::Interrupted)));
    let folder = crate::support::folder();
    let whole = cloud(&mesh, &before_the_city(), &within(0.1));
    let stopped = files::write(folder.path(), &whole, &mesh, &Impatient);
    assert!(matches!(stopped, Err(Error::Interrupted)));
    assert!(!folder.path().join("billboards.obj").exists());
}

#[test]
fn what_the_command_writes_is_read_back() {
    let folder = crate::support::folder();
    let path = |name: &str| folder.path().join(name);
    let mesh = blocks(6);
    io::write(&path("city.obj"), &mesh).expect("written");
    let cell = lodmark::bound::view_cell::file::to_json(&before_the_city()).expect("JSON");
    std::fs::write(path("cell.json"), cell).expect("written");
    let run = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_lodmark"))
            .current_dir(folder.path())
            .args(split("billboards city.obj out --cell cell.json --quiet"))
            .args(arguments)
            .output()
            .expect("it starts")
    };
    let done = run(&split("--error-deg 0.5 --texels 64 --json report.json"));
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(
        done.status.success(),
        "{said} {}",
        String::from_utf8_lossy(&done.stderr)
    );
    let json = std::fs::read_to_string(path("report.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let quads = report["quads"].as_u64().expect("a number") as usize;
    assert!(quads > 4 && said.contains(" vertical and "), "{said}");
    let loaded = io::read(&path("out/billboards.obj")).expect("a mesh").mesh;
    assert_eq!(loaded.triangles().len(), 2 * quads);
    assert_eq!(loaded.materials().names.len(), quads);
    let library = std::fs::read_to_string(path("out/billboards.mtl")).expect("a library");
    for i in 0..quads {
        assert!(
            library.contains(&format!("map_Kd quad-{i:04}.png")),
            "{library}"
        );
        let picture = std::fs::read(path(&format!("out/quad-{i:04}.png"))).expect("a texture");
        assert!(picture.starts_with(b"\x89PNG"));
    }
    let options = BillboardOptions {
        texels: 64,
        ..BillboardOptions::within(Limit::Angle(Aperture::degrees(0.5).expect("below 90")))
    };
    let own = cloud(&mesh, &before_the_city(), &options);
    assert_eq!(
        loaded.positions()[..4],
        own.quads[0].corners(),
        "a bit was lost"
    );
    for (wrong, code) in [
        (&["--error-deg", "90"][..], 2),
        (&[], 2),
        (&["--error-deg", "1", "--directions", "0"], 2),
        (&["--error-deg", "1", "--up", "y"], 2),
    ] {
        let refused = run(wrong);
        assert_eq!(refused.status.code(), Some(code), "{wrong:?}");
    }
}
