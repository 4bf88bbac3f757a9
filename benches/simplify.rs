//! How long is a run? Every method on a generated mesh of 20,480 triangles, and on the bunny where it is at hand.

#![expect(
    clippy::print_stdout,
    reason = "the bunny may be absent, and whoever reads the figures should know"
)]

use std::{hint::black_box, path::PathBuf};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
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

/// The rows of the geometric methods at scale: the dragon to 8,191 triangles, and the cost of a collapse by size.
fn scale(c: &mut Criterion) {
    let models = std::env::var_os("LODMARK_MODELS")
        .map_or_else(|| PathBuf::from("../shared/models"), PathBuf::from);
    let mut group = c.benchmark_group("scale");
    group.sample_size(10);
    match io::read(&models.join("dragon.ply")) {
        Ok(loaded) => {
            let mesh = canonical(&weld(loaded.mesh).mesh).mesh;
            let target = Amount::Triangles(8_191);
            for options in [Options::memoryless(target), Options::quadric(target)] {
                group.bench_function(
                    format!("dragon to 8,191 by {}", options.method.name()),
                    |b| {
                        b.iter(|| {
                            black_box(simplify(&mesh, &options, &Silent).expect("simplified"))
                        });
                    },
                );
            }
        }
        Err(e) => println!("the dragon is left out: {e}"),
    }
    for side in [190, 420, 920] {
        let mesh = canonical(&generate::grid(side, side, generate::Height::Waves)).mesh;
        let triangles = mesh.triangles().len() as u64;
        group.throughput(Throughput::Elements(triangles / 2));
        let options = Options::memoryless(Amount::Triangles(triangles / 100));
        group.bench_function(
            format!("collapses of {triangles} triangles to a hundredth"),
            |b| {
                b.iter(|| black_box(simplify(&mesh, &options, &Silent).expect("simplified")));
            },
        );
    }
    group.finish();
}

criterion_group!(benches, methods, scale);
criterion_main!(benches);
