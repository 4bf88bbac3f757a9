//! A four-cylinder engine as a CAD program would give it: every part modelled, most of them out of sight.
//!
//! It stands for the model "motor" of Zhang & Turk 2002 (140,113 polygons, V(M) = 0.264): a box with some mechanical parts on
//! it hides many curved ones. x points along the crankshaft to the front, z up.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{
    Surface,
    motor_inside::add_inner_parts,
    solids::{cavity, profile, round_box, turned, wire},
};
use crate::{mesh::Mesh, num::math};

/// Largest detail: 700,000 triangles.
const DETAIL_LIMIT: u32 = 8;

/// Middles of the cylinders along the crankshaft.
pub(super) const CYLINDERS: [f64; 4] = [-0.66, -0.22, 0.22, 0.66];

/// A four-cylinder engine, some 2.4 long: block, head cover and oil pan with their walls, manifolds, pulleys, alternator,
/// starter, filter, plugs and bolts outside; liners, pistons, rods, crankshaft, gears, camshaft, valves, springs and
/// threaded studs inside.
///
/// Every part is closed and faces outward, except three cavities, which face inward. `detail` 1, 2, 3 (to 8) multiplies
/// the segments in every direction: 20,602, 56,808, 115,360 triangles.
pub fn motor(detail: u32) -> Mesh {
    let n = Detail(detail.clamp(1, DETAIL_LIMIT));
    let mut surface = Surface::default();
    housings(&mut surface, n);
    pulleys(&mut surface, n);
    fittings(&mut surface, n);
    plugs_and_bolts(&mut surface, n);
    manifolds(&mut surface, n);
    add_inner_parts(&mut surface, n);
    surface.into_mesh()
}

/// Fineness of the model: 2 for the numbers of segments as they are written below.
#[derive(Clone, Copy)]
pub(super) struct Detail(u32);

impl Detail {
    /// A number of segments.
    pub(super) fn of(self, segments: u32) -> u32 {
        (segments * self.0).div_ceil(2)
    }
}

/// Turns the z axis into the x axis, without mirroring.
pub(super) fn lengthwise(p: DVec3) -> DVec3 {
    DVec3::new(p.z, p.x, p.y)
}

/// Turns the z axis into the y axis, without mirroring.
pub(super) fn crosswise(p: DVec3) -> DVec3 {
    DVec3::new(p.y, p.z, p.x)
}

/// A circle.
pub(super) fn round(_: f64, _: f64) -> f64 {
    1.0
}

/// A hexagon.
fn hexagon(theta: f64, _: f64) -> f64 {
    toothed(6.0, 0.06)(theta, 0.0)
}

/// `count` teeth of a height that is a share of the radius.
pub(super) fn toothed(count: f64, height: f64) -> impl Fn(f64, f64) -> f64 {
    move |theta, _| 1.0 + height * math::cos(count * theta)
}

/// Block, head cover and oil pan with their walls, ribs on the block and a ridge on the cover.
fn housings(surface: &mut Surface, n: Detail) {
    let block = round_box(DVec3::new(1.0, 0.42, 0.45), 0.05, n.of(3));
    surface.add(&block, |p| p);
    let head = round_box(DVec3::new(0.97, 0.38, 0.2), 0.08, n.of(4));
    surface.add(&head, |p| p + DVec3::Z * 0.67);
    let pan = round_box(DVec3::new(0.92, 0.36, 0.13), 0.06, n.of(3));
    let deeper = |p: DVec3| {
        if p.z < 0.0 {
            1.0 + 0.5 * (0.92 - p.x) / 0.92
        } else {
            1.0
        }
    };
    surface.add(&pan, |p| DVec3::new(p.x, p.y, p.z * deeper(p) - 0.6));
    for (half, z) in [
        (DVec3::new(0.95, 0.355, 0.4), 0.0),
        (DVec3::new(0.92, 0.33, 0.15), 0.67),
        (DVec3::new(0.87, 0.31, 0.09), -0.6),
    ] {
        let walls = cavity(round_box(half, 0.03, n.of(2)));
        surface.add(&walls, |p| DVec3::new(p.x, p.y, p.z + z));
    }
    let rib = round_box(DVec3::new(0.025, 0.02, 0.33), 0.015, n.of(2));
    for k in 0..10_i32 {
        let x = 0.2 * (f64::from(k) - 4.5);
        for side in [-1.0, 1.0] {
            surface.add(&rib, |p| p + DVec3::new(x, 0.442 * side, -0.05));
        }
    }
    let ridge = round_box(DVec3::new(0.85, 0.1, 0.02), 0.015, n.of(2));
    surface.add(&ridge, |p| p + DVec3::Z * 0.892);
}

/// Pulleys, alternator and flywheel, at the ends of the shafts.
fn pulleys(surface: &mut Surface, n: Detail) {
    // With a groove, as shares of radius and width.
    let radii = [
        0.0, 0.4, 0.45, 1.0, 1.0, 0.85, 0.85, 1.0, 1.0, 0.3, 0.25, 0.0,
    ];
    let heights = [0.0, 0.0, 0.2, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0, 1.0, 1.2, 1.2];
    let groove = |r: f64, w: f64| profile(&radii.map(|x| x * r), &heights.map(|x| x * w));
    // Pulleys of crankshaft, water pump and alternator at the front.
    for (r, y, z) in [(0.19, 0.0, -0.25), (0.14, 0.0, 0.24), (0.09, 0.56, 0.1)] {
        let pulley = turned(&groove(r, 0.09), n.of(20), round);
        surface.add(&pulley, |p| lengthwise(p) + DVec3::new(1.03, y, z));
    }
    let radii = [0.0, 0.08, 0.12, 0.12, 0.08, 0.0];
    let heights = [0.0, 0.0, 0.05, 0.3, 0.34, 0.34];
    let finned = turned(&profile(&radii, &heights), n.of(24), toothed(12.0, 0.03));
    surface.add(&finned, |p| lengthwise(p) + DVec3::new(0.66, 0.57, 0.1));
    let radii = [0.0, 0.36, 0.4, 0.4, 0.3, 0.0];
    let heights = [0.0, 0.0, 0.03, 0.1, 0.13, 0.13];
    let housing = turned(&profile(&radii, &heights), n.of(28), round);
    surface.add(&housing, |p| lengthwise(p) + DVec3::new(-1.16, 0.0, -0.1));
}

/// Starter, oil filter and oil cap.
fn fittings(surface: &mut Surface, n: Detail) {
    let radii = [0.0, 0.06, 0.08, 0.08, 0.05, 0.0];
    let heights = [0.0, 0.0, 0.03, 0.3, 0.34, 0.34];
    let starter = turned(&profile(&radii, &heights), n.of(14), round);
    surface.add(&starter, |p| lengthwise(p) + DVec3::new(-0.95, -0.57, -0.3));
    let radii = [0.0, 0.06, 0.1, 0.1, 0.08, 0.0];
    let heights = [0.0, 0.0, 0.02, 0.18, 0.22, 0.22];
    let filter = turned(&profile(&radii, &heights), n.of(16), toothed(16.0, 0.015));
    surface.add(&filter, |p| crosswise(p) + DVec3::new(-0.1, 0.46, -0.27));
    let radii = [0.0, 0.07, 0.08, 0.08, 0.0];
    let heights = [0.0, 0.0, 0.02, 0.05, 0.06];
    let cap = turned(&profile(&radii, &heights), n.of(16), toothed(8.0, 0.05));
    surface.add(&cap, |p| p + DVec3::new(-0.8, 0.2, 0.872));
}

/// Plugs in the head cover, and bolts along it and the pan.
fn plugs_and_bolts(surface: &mut Surface, n: Detail) {
    let radii = [0.0, 0.035, 0.035, 0.02, 0.02, 0.025, 0.025, 0.0];
    let heights = [0.0, 0.0, 0.03, 0.04, 0.12, 0.13, 0.16, 0.17];
    let plug = turned(&profile(&radii, &heights), n.of(12), hexagon);
    for x in CYLINDERS {
        surface.add(&plug, |p| p + DVec3::new(x, 0.0, 0.914));
    }
    // Bolts along both sides of the head cover and of the pan.
    let radii = [0.0, 0.022, 0.022, 0.018, 0.0];
    let heights = [0.0, 0.0, 0.02, 0.025, 0.025];
    let bolt = turned(&profile(&radii, &heights), n.of(6), hexagon);
    for k in 0..5_i32 {
        let x = 0.4 * f64::from(k - 2);
        for side in [-1.0, 1.0] {
            // Heads point to the side.
            let turn = |p: DVec3| DVec3::new(p.x, p.z * side, -p.y * side);
            surface.add(&bolt, |p| turn(p) + DVec3::new(x + 0.11, 0.383 * side, 0.6));
            surface.add(&bolt, |p| turn(p) + DVec3::new(x, 0.363 * side, -0.55));
        }
    }
}

/// Bent pipes from the cylinders: intake on one side, exhaust on the other.
fn manifolds(surface: &mut Surface, n: Detail) {
    for (side, radius, reach, drop) in [(1.0, 0.055, 0.3, -0.12), (-1.0, 0.06, 0.24, -0.3)] {
        for x in CYLINDERS {
            let steps = n.of(8);
            let path: Vec<DVec3> = (0..=steps)
                .map(|k| {
                    let t = f64::from(k) / f64::from(steps);
                    let angle = 0.25 * TAU * t;
                    let y = 0.43 + reach * math::sin(angle);
                    let z = 0.3 + drop * (1.0 - math::cos(angle));
                    DVec3::new(x, side * y, z)
                })
                .collect();
            surface.add(&wire(&path, radius, n.of(10)), |p| p);
        }
        let radii = [0.0, 0.06, 0.075, 0.075, 0.06, 0.0];
        let heights = [-0.85, -0.85, -0.82, 0.82, 0.85, 0.85];
        let collector = turned(&profile(&radii, &heights), n.of(12), round);
        let (y, z) = (0.43 + reach, 0.3 + drop - 0.085);
        surface.add(&collector, |p| lengthwise(p) + DVec3::new(0.0, side * y, z));
    }
}
