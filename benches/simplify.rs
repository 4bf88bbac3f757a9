//! How long is a run? Every method on a generated mesh of 20,480 triangles, and on the bunny where it is at hand.

#![expect(
    clippy::print_stdout,
    reason = "the bunny may be absent, and whoever reads the figures should know"
)]

use std::{hint::black_box, path::PathBuf};

use criterion::{Criterion, criterion_group, criterion_main};
use lodmark::{
    Silent, io,
    mesh::{Mesh, canonical, generate, weld},
    simplify::{Amount, Options, simplify},
};

fn methods(c: &mut Criterion) {
    let models = std::env::var_os("LODMARK_MODELS")
        .map_or_else(|| PathBuf::from("../shared/models"), PathBuf::from);
    let mut meshes: Vec<(&str, Mesh)> =
        vec![("sphere 20,480", canonical(&generate::icosphere(5)).mesh)];
    match io::read(&models.join("bunny.ply")) {
        Ok(loaded) => meshes.push(("bunny", canonical(&weld(loaded.mesh).mesh).mesh)),
        Err(e) => println!("the bunny is left out: {e}"),
    }
    let mut group = c.benchmark_group("simplify");
    group.sample_size(10);
    for (name, mesh) in &meshes {
        let target = Amount::Triangles(1_333);
        for options in [
            Options::image(target),
            Options::memoryless(target),
            Options::quadric(target),
        ] {
            group.bench_function(
                format!("{name} to 1,333 by {}", options.method.name()),
                |b| {
                    b.iter(|| black_box(simplify(mesh, &options, &Silent).expect("simplified")));
                },
            );
        }
    }
    group.finish();
}

criterion_group!(benches, methods);
criterion_main!(benches);
