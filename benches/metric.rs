//! Speed of the metrics on generated surfaces: what a change costs, not how fast a machine is.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use lodmark::{
    Silent,
    mesh::Mesh,
    metric::{
        luma::squared_error,
        silhouette::silhouette_histogram,
        surface::{DEFAULT_SAMPLES, surface_distance},
    },
    raster::Grid,
    view::Eye,
};

/// A wavy sheet of `2 * side * side` triangles.
fn sheet(side: u32) -> Mesh {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for y in 0..=side {
        for x in 0..=side {
            let (u, v) = (
                f64::from(x) / f64::from(side),
                f64::from(y) / f64::from(side),
            );
            let wave = (u * (1.0 - u) * 9.0 - v) * (v * (1.0 - v) * 7.0 - u);
            positions.push(DVec3::new(u, v, 0.1 * wave));
            if x < side && y < side {
                let a = y * (side + 1) + x;
                let c = a + side + 1;
                triangles.extend([[a, a + 1, c + 1], [a, c + 1, c]]);
            }
        }
    }
    Mesh::from_triangles(positions, triangles).expect("indices of the grid")
}

fn metrics(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("metric");
    group.sample_size(10);
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
