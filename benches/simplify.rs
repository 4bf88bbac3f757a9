//! How long is a run? Every method on a generated mesh of 20,480 triangles, and on the bunny where it is at hand; and the
//! rows of the README's table under their names there, for example `cargo bench --bench simplify -- 'row/dragon'`. What
//! `best` and the dragon take is minutes.

#![expect(
    clippy::print_stdout,
    reason = "the bunny may be absent, and whoever reads the figures should know"
)]

use std::{hint::black_box, path::PathBuf};

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use lodmark::{
    io,
    mesh::{Mesh, canonical, generate, weld},
    simplify::{
        Options, Target,
        image::{DrivingShading, ImageOptions, Preset},
        simplify,
    },
};

fn methods(c: &mut Criterion) {
    let mut meshes: Vec<(&str, Mesh)> =
        vec![("sphere 20,480", canonical(&generate::icosphere(5)).mesh)];
    match io::read(&models().join("bunny.ply")) {
        Ok(loaded) => meshes.push(("bunny", canonical(&weld(loaded.mesh).mesh).mesh)),
        Err(e) => println!("the bunny is left out: {e}"),
    }
    let mut group = c.benchmark_group("simplify");
    group.sample_size(10);
    for (name, mesh) in &meshes {
        let target = Target::Triangles(1_333);
        for options in [
            Options::image(target),
            Options::memoryless(target),
            Options::quadric(target),
        ] {
            group.bench_function(
                format!("{name} to 1,333 by {}", options.method.name()),
                |b| {
                    b.iter(|| black_box(simplify(mesh, &options).expect("simplified")));
                },
            );
        }
    }
    group.finish();
}

/// A row of the README's table (benches/measure.py table): its name there, the model, the target and what else is asked for.
struct Row {
    name: &'static str,
    model: &'static str,
    triangles: u64,
    options: fn(Target) -> Options,
}

const ROWS: &[Row] = &[
    Row {
        name: "bunny --triangles 1333 --preset fast",
        model: "bunny",
        triangles: 1_333,
        options: |target| recipe(target, Preset::Fast, DrivingShading::Flat),
    },
    Row {
        name: "bunny --triangles 1333",
        model: "bunny",
        triangles: 1_333,
        options: Options::image,
    },
    Row {
        name: "bunny --triangles 1333 --preset best",
        model: "bunny",
        triangles: 1_333,
        options: |target| recipe(target, Preset::Best, DrivingShading::Flat),
    },
    Row {
        name: "bunny --triangles 304",
        model: "bunny",
        triangles: 304,
        options: Options::image,
    },
    Row {
        name: "dragon --triangles 8191",
        model: "dragon",
        triangles: 8_191,
        options: Options::image,
    },
    Row {
        name: "bunny --triangles 1333 --shading gouraud",
        model: "bunny",
        triangles: 1_333,
        options: |target| recipe(target, Preset::Default, DrivingShading::Gouraud),
    },
    Row {
        name: "bunny --triangles 1333 --shading mixed",
        model: "bunny",
        triangles: 1_333,
        options: |target| recipe(target, Preset::Default, DrivingShading::Mixed),
    },
    Row {
        name: "dragon --triangles 8191 --method memoryless",
        model: "dragon",
        triangles: 8_191,
        options: Options::memoryless,
    },
    Row {
        name: "dragon --triangles 8191 --method quadric",
        model: "dragon",
        triangles: 8_191,
        options: Options::quadric,
    },
];

fn recipe(target: Target, preset: Preset, shading: DrivingShading) -> Options {
    let own = ImageOptions {
        shading,
        ..preset.options()
    };
    Options::new(own, target)
}

fn models() -> PathBuf {
    std::env::var_os("LODMARK_MODELS")
        .map_or_else(|| PathBuf::from("../shared/models"), PathBuf::from)
}

/// The rows of the table, without reading and writing.
fn rows(c: &mut Criterion) {
    let mut group = c.benchmark_group("row");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    for model in ["bunny", "dragon"] {
        let mesh = match io::read(&models().join(format!("{model}.ply"))) {
            Ok(loaded) => canonical(&weld(loaded.mesh).mesh).mesh,
            Err(e) => {
                println!("the rows of {model} are left out: {e}");
                continue;
            }
        };
        for row in ROWS.iter().filter(|row| row.model == model) {
            let options = (row.options)(Target::Triangles(row.triangles));
            group.bench_function(row.name, |b| {
                b.iter(|| black_box(simplify(&mesh, &options).expect("simplified")));
            });
        }
    }
    group.finish();
}

/// The row that only reads: the file is in the cache of the system.
fn reading(c: &mut Criterion) {
    let path = models().join("dragon.ply");
    if !path.exists() {
        println!("reading is left out: {} is not there", path.display());
        return;
    }
    let mut group = c.benchmark_group("row");
    group.sample_size(10);
    group.bench_function("read dragon.ply", |b| {
        b.iter(|| black_box(io::read(&path).expect("read")));
    });
    group.finish();
}

/// The cost of a collapse by size; benches/measure.py curve has more sizes, methods and models.
fn scale(c: &mut Criterion) {
    let mut group = c.benchmark_group("scale");
    group.sample_size(10);
    for side in [190, 420, 920] {
        let mesh = canonical(&generate::grid(side, side, generate::Height::Waves)).mesh;
        let triangles = mesh.triangles().len() as u64;
        group.throughput(Throughput::Elements(triangles / 2));
        let options = Options::memoryless(Target::Triangles(triangles / 100));
        group.bench_function(
            format!("collapses of {triangles} triangles to a hundredth"),
            |b| {
                b.iter(|| black_box(simplify(&mesh, &options).expect("simplified")));
            },
        );
    }
    group.finish();
}

criterion_group!(benches, methods, rows, reading, scale);
criterion_main!(benches);
