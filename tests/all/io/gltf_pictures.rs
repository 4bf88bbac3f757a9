//! A reader and a renderer of others see in our files what we see.

use std::path::Path;

use lodmark::{
    Silent, compare_with, io,
    mesh::{Mesh, canonical, weld},
    options::CompareOptions,
    simplify::{Options, Target, simplify},
};

use crate::support::{
    asset_file, folder,
    oracle::{embree, foreign_pictures},
    say,
};

fn read(path: &Path) -> Mesh {
    let stored = io::read(path).expect("a good file").mesh;
    canonical(&weld(stored).mesh).mesh
}

#[test]
fn a_loader_that_is_not_ours_agrees_on_which_result_is_nearer() {
    let names = ["DamagedHelmet.glb", "CesiumMan.glb"];
    let Some(packages) = embree() else { return };
    let folder = folder();
    for (number, original) in names.iter().filter_map(|name| asset_file(name)).enumerate() {
        let mesh = read(&original);
        let mut files = Vec::new();
        for share in [0.2, 0.03] {
            let options = Options::memoryless(Target::ratio(share));
            let less = simplify(&mesh, &options).expect("it runs").mesh;
            let extension = if files.len() % 2 == 0 { "glb" } else { "gltf" };
            let out = folder
                .path()
                .join(format!("{number}-{}/a.{extension}", files.len()));
            std::fs::create_dir_all(out.parent().expect("a folder")).expect("a folder");
            io::write(&out, &less).expect("written");
            files.push(out);
        }
        let peers = ["10-opengl-decimate", "10-meshlab-free", "2-meshlab-free"];
        if number == 0 {
            let peer = |name: &&str| asset_file(&format!("peers/DamagedHelmet-{name}.gltf"));
            files.extend(peers.iter().filter_map(peer));
        }
        let theirs = foreign_pictures(packages, &original, &files);
        let candidates: Vec<Mesh> = files.iter().map(|file| read(file)).collect();
        let mut options = CompareOptions::default().pictures(256, 1);
        options.distance_samples = None;
        (options.silhouettes, options.folds) = (false, false);
        let found = compare_with(
            &mesh,
            &candidates.iter().collect::<Vec<_>>(),
            &options,
            &Silent,
        );
        let found = found
            .expect("comparable")
            .candidates
            .into_iter()
            .zip(&files);
        let ours: Vec<(usize, f64)> = found
            .map(|(report, file)| {
                let stored = io::read(file).expect("a good file").mesh;
                let pictures = report.errors.pictures.expect("pictures");
                (stored.triangles().len(), pictures.rms_flat)
            })
            .collect();
        for (a, b) in (0..files.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
            assert_eq!(
                ours[a].0,
                theirs[a].0,
                "triangles of {}",
                files[a].display()
            );
            let clear = |x: f64, y: f64| x < 0.9 * y || y < 0.9 * x;
            if clear(ours[a].1, ours[b].1) && clear(theirs[a].1, theirs[b].1) {
                let nearer = [&ours, &theirs].map(|rms| rms[a].1 < rms[b].1);
                assert_eq!(nearer[0], nearer[1], "{ours:?} {theirs:?}");
            }
        }
        say(&format!(
            "{}: ours {ours:.2?}, theirs {theirs:.2?}",
            original.display()
        ));
    }
}
