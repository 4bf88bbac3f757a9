//! How fast are exact bounds? Extents of points and intervals of faces for a segment view cell, on one thread.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec2;
use lodmark::{
    bound::planar::{Aperture, Projection, Rays, SegmentCell, segment_extent, segment_extents},
    mesh::generate::Pcg32,
};

const COUNT: usize = 10_000;

struct Input {
    cell: SegmentCell,
    aperture: Aperture,
    points: Vec<DVec2>,
    ends: Vec<DVec2>,
    directions: Vec<DVec2>,
}

fn input() -> Input {
    let mut random = Pcg32::new(7, 7);
    let mut at = |size: f64| DVec2::new(random.unit() * size, random.unit() * size);
    let points: Vec<DVec2> = (0..COUNT).map(|_| at(20.0) + DVec2::ONE).collect();
    Input {
        cell: SegmentCell::between(DVec2::ZERO, DVec2::new(3.0, 0.5)).expect("finite ends"),
        aperture: Aperture::degrees(0.5).expect("below 90"),
        ends: points.iter().map(|&p| p + at(2.0)).collect(),
        directions: (0..COUNT)
            .map(|_| DVec2::from_angle(at(std::f64::consts::TAU).x))
            .collect(),
        points,
    }
}

fn extents(c: &mut Criterion) {
    let input = input();
    let mut group = c.benchmark_group("bound");
    group.throughput(Throughput::Elements(COUNT as u64));
    group.bench_function("point extents for a segment cell, one by one", |b| {
        b.iter(|| {
            for (&p, &d) in input.points.iter().zip(&input.directions) {
                black_box(segment_extent(&input.cell, p, d, input.aperture));
            }
        });
    });
    let column = |of: &[DVec2], k: usize| of.iter().map(|p| p[k]).collect::<Vec<f64>>();
    let (x, y) = (column(&input.points, 0), column(&input.points, 1));
    let (dx, dy) = (column(&input.directions, 0), column(&input.directions, 1));
    let (mut lengths, mut viewpoints) = (vec![0.0; COUNT], vec![0.0; COUNT]);
    group.bench_function("point extents for a segment cell, in columns", |b| {
        b.iter(|| {
            let rays = Rays {
                x: &x,
                y: &y,
                dx: &dx,
                dy: &dy,
            };
            segment_extents(
                &input.cell,
                black_box(rays),
                input.aperture,
                &mut lengths,
                &mut viewpoints,
            )
            .expect("equal columns");
            black_box((&lengths, &viewpoints));
        });
    });
    group.finish();
}

fn intervals(c: &mut Criterion) {
    let input = input();
    let mut group = c.benchmark_group("bound");
    group.throughput(Throughput::Elements(COUNT as u64));
    let projection = Projection::new(&input.cell, DVec2::from_angle(1.1), input.aperture);
    group.bench_function("face intervals for a segment cell, one direction", |b| {
        b.iter(|| {
            for (&from, &to) in input.points.iter().zip(&input.ends) {
                black_box(projection.interval(from, to));
            }
        });
    });
    group.bench_function("face intervals for a segment cell, a direction each", |b| {
        b.iter(|| {
            for i in 0..COUNT {
                let projection = Projection::new(&input.cell, input.directions[i], input.aperture);
                black_box(projection.interval(input.points[i], input.ends[i]));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, extents, intervals);
criterion_main!(benches);
