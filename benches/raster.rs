//! How long is a picture? ID buffers and luma of generated meshes, and of the dragon where it is at hand.

#![expect(
    clippy::print_stdout,
    reason = "the dragon may be absent, and whoever reads the figures should know"
)]

use std::{hint::black_box, path::PathBuf};

use criterion::{Criterion, criterion_group, criterion_main};
use lodmark::{
    io,
    mesh::{Mesh, generate},
    raster::{self, Scene, ZBuffer},
    view::{Sphere, ViewSet, frame_of},
};

fn views(mesh: &Mesh, size: u32) -> (Scene, ViewSet) {
    let mesh = mesh.enter_frame(frame_of(mesh));
    let sphere = Sphere::of_mesh(mesh.in_frame_units()).expect("triangles");
    let set = ViewSet {
        width: size,
        height: size,
        ..ViewSet::costs(&sphere).expect("views")
    };
    (Scene::of(&mesh), set)
}

fn pictures(c: &mut Criterion) {
    let mut group = c.benchmark_group("raster");
    group.sample_size(20);
    let sphere = generate::icosphere(6);
    let (scene, set) = views(&sphere, 480);
    group.bench_function("ids of a sphere of 81,920 triangles at 480x480", |b| {
        b.iter(|| black_box(raster::keys(&scene, &set.views[0], &set)));
    });
    group.bench_function(
        "flat luma of a sphere of 81,920 triangles at 480x480",
        |b| {
            b.iter(|| black_box(raster::luma(&scene, &set.views[0], &set)));
        },
    );
    let models = std::env::var_os("LODMARK_MODELS")
        .map_or_else(|| PathBuf::from("../shared/models"), PathBuf::from);
    match io::read(&models.join("dragon.ply")) {
        Ok(loaded) => {
            let (scene, set) = views(&loaded.mesh, 480);
            // At 8 sub-pixel bits, nothing culled, projection included, buffers reused.
            for threads in [1, 2] {
                let mut buffer = ZBuffer::new(threads);
                let mut views = set.views.iter().cycle();
                let name = format!("ID buffer 480x480 of the dragon, {threads} thread(s)");
                group.bench_function(name, |b| {
                    b.iter(|| {
                        let view = views.next().expect("a cycle does not end");
                        buffer.draw(&scene, view, &set);
                        black_box(buffer.keys());
                    });
                });
            }
        }
        Err(e) => println!("the dragon is left out: {e}"),
    }
    group.finish();
}

criterion_group!(benches, pictures);
criterion_main!(benches);
