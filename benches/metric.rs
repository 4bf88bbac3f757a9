//! Speed of the metrics on generated surfaces: what a change costs, not how fast a machine is.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lodmark::{
    Silent,
    mesh::generate::{self, Height},
    metric::{
        luma::squared_error,
        silhouette::silhouette_histogram,
        surface::{DEFAULT_SAMPLES, surface_distance},
    },
    raster::Grid,
    view::Eye,
};

fn metrics(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("metric");
    group.sample_size(10);
    let sheet = |side| generate::grid(side, side, Height::Waves);
    let (fine, coarse) = (sheet(186), sheet(26));
    group.bench_function("surface distance, 69k and 1.3k triangles", |b| {
        b.iter(|| surface_distance(black_box(&fine), &coarse, DEFAULT_SAMPLES, &Silent));
    });
    let eyes = [Eye::Axis(DVec3::ONE); 20];
    group.bench_function("silhouette histogram, 69k triangles, 20 views", |b| {
        b.iter(|| silhouette_histogram(black_box(&fine), &eyes, &Silent));
    });
    let image = Grid::filled(512, 512, 500_u16);
    let other = Grid::filled(512, 512, 501_u16);
    group.bench_function("squared luma error, 512 x 512", |b| {
        b.iter(|| squared_error(black_box(&image), &other, 4));
    });
    group.finish();
}

criterion_group!(benches, metrics);
criterion_main!(benches);
