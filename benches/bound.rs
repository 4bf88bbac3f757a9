//! How fast are exact bounds? Extents of points and intervals of faces in the plane for a segment view cell, and extents
//! in space for cells of every kind, on one thread.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{DVec2, DVec3};
use lodmark::{
    bound::{
        planar::{Aperture, Projection, Rays, ViewerSegment, segment_extent, segment_extents},
        point::extent,
        view_cell::ViewCell,
    },
    mesh::generate::Pcg32,
};

const COUNT: usize = 10_000;

struct Input {
    cell: ViewerSegment,
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
        cell: ViewerSegment::between(DVec2::ZERO, DVec2::new(3.0, 0.5)).expect("finite ends"),
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

fn extents_in_space(c: &mut Criterion) {
    let mut random = Pcg32::new(7, 8);
    let mut at = |size: f64| {
        let mut x = || (2.0 * random.unit() - 1.0) * size;
        DVec3::new(x(), x(), x())
    };
    let tasks: Vec<(DVec3, DVec3)> = (0..COUNT)
        .map(|_| {
            (
                at(8.0) + DVec3::Z * 12.0,
                (at(1.0) + DVec3::X * 1e-3).normalize(),
            )
        })
        .collect();
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let square = square.map(|[x, y]| DVec3::new(x, y, 0.0));
    let cells = [
        (
            "segment",
            ViewCell::segment([DVec3::ZERO, DVec3::new(3.0, 0.5, 0.2)]),
        ),
        ("square", ViewCell::polygon(&square)),
        ("box", ViewCell::cuboid(-DVec3::ONE, DVec3::ONE)),
        ("half-space", ViewCell::half_space(DVec3::ZERO, DVec3::Z)),
    ];
    let aperture = Aperture::degrees(0.5).expect("below 90");
    let mut group = c.benchmark_group("bound");
    group.throughput(Throughput::Elements(COUNT as u64));
    for (name, cell) in cells {
        let cell = cell.expect("a cell");
        group.bench_function(format!("point extents in space for a {name} cell"), |b| {
            b.iter(|| {
                for &(p, d) in &tasks {
                    black_box(extent(&cell, p, d, aperture));
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, extents, intervals, extents_in_space);
criterion_main!(benches);
