//! The parts of the [`motor`](super::motor()) that nobody sees: inside the block, and inside the head cover.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{
    Surface,
    motor::{CYLINDERS, Detail, crosswise, lengthwise, round, toothed},
    solids::{hollow, profile, refined, round_box, turned, wire},
};
use crate::num::math;

/// Adds everything that block and head cover hide.
pub(super) fn add_inner_parts(surface: &mut Surface, n: Detail) {
    bottom_end(surface, n);
    gears(surface, n);
    studs(surface, n);
    valve_train(surface, n);
}

/// A part of the crankshaft with a groove for oil: radius and length.
fn journal([r, l]: [f64; 2], n: Detail) -> Surface {
    let radii = [0.0, 1.0, 1.0, 0.85, 1.0, 1.0, 0.0].map(|x| x * r);
    let heights = [-0.5, -0.5, -0.1, 0.0, 0.1, 0.5, 0.5].map(|x| x * l);
    turned(&profile(&radii, &heights), n.of(14), round)
}

/// Radius and height along a piston with three grooves for rings.
fn piston_profile() -> Vec<(f64, f64)> {
    let mut profile = vec![(0.0, 0.0), (0.1, 0.0), (0.13, -0.06), (0.146, -0.06)];
    for k in 0..3_i32 {
        let z = 0.01 + 0.025 * f64::from(k);
        let top = z + 0.012;
        profile.extend([(0.146, z), (0.136, z), (0.136, top), (0.146, top)]);
    }
    profile.extend([(0.146, 0.1), (0.12, 0.1), (0.08, 0.085), (0.0, 0.08)]);
    profile
}

/// Inside the block: liners, pistons, rods, crankshaft.
fn bottom_end(surface: &mut Surface, n: Detail) {
    let liner = hollow([0.152, 0.17], [-0.08, 0.38], n.of(20));
    let piston = turned(&piston_profile(), n.of(20), round);
    let pin = [(0.0, -0.09), (0.02, -0.09), (0.02, 0.09), (0.0, 0.09)];
    let pin = turned(&pin, n.of(10), round);
    let shank = round_box(DVec3::new(0.012, 0.025, 0.1), 0.01, n.of(2));
    let web = [
        (0.0, -0.016),
        (0.085, -0.016),
        (0.095, 0.0),
        (0.085, 0.016),
        (0.0, 0.016),
    ];
    // Heavier on the side away from the pin.
    let web = turned(&web, n.of(18), |theta, _| 1.0 + 0.25 * math::cos(theta));
    let ear = hollow([0.042, 0.06], [-0.022, 0.022], n.of(14));
    for (k, x) in CYLINDERS.into_iter().enumerate() {
        surface.add(&liner, |p| p + DVec3::new(x, 0.0, 0.0));
        // The outer pistons are up when the inner ones are down.
        let throw = if k == 0 || k == 3 { 0.07 } else { -0.07 };
        let top = 0.17 + throw;
        surface.add(&piston, |p| p + DVec3::new(x, 0.0, top));
        surface.add(&pin, |p| crosswise(p) + DVec3::new(x, 0.0, top - 0.09));
        surface.add(&shank, |p| p + DVec3::new(x, 0.0, top - 0.215));
        let crank = -0.25 + throw;
        surface.add(&ear, |p| lengthwise(p) + DVec3::new(x, 0.0, crank + 0.02));
        let journal = journal([0.038, 0.09], n);
        surface.add(&journal, |p| {
            lengthwise(p) + DVec3::new(x, 0.0, crank + 0.02)
        });
        for side in [-1.0, 1.0] {
            let turn = if throw > 0.0 { -1.0 } else { 1.0 };
            surface.add(&web, |p| {
                DVec3::new(p.z, p.y * -turn, p.x * turn) + DVec3::new(x + 0.07 * side, 0.0, -0.25)
            });
        }
    }
    let journal = journal([0.05, 0.2], n);
    for x in [-0.85, -0.44, 0.0, 0.44] {
        surface.add(&journal, |p| lengthwise(p) + DVec3::new(x, 0.0, -0.25));
    }
}

/// Timing gears at the front, oil pump at the back.
fn gears(surface: &mut Surface, n: Detail) {
    let radii = [0.0, 0.5, 0.55, 1.0, 1.0, 0.55, 0.5, 0.0];
    let heights = [-0.03, -0.03, -0.015, -0.02, 0.02, 0.015, 0.03, 0.03];
    let disc = |r: f64| profile(&radii.map(|x| x * r), &heights);
    for (r, teeth, x, y, z) in [
        (0.08, 20.0, 0.88, 0.0, -0.28),
        (0.12, 30.0, 0.88, 0.12, -0.1),
        (0.12, 30.0, 0.88, -0.12, 0.12),
        (0.05, 12.0, -0.85, 0.25, -0.3),
        (0.05, 12.0, -0.85, -0.25, -0.3),
    ] {
        let gear = turned(&disc(r), n.of(4 * teeth as u32), toothed(teeth, 0.06));
        surface.add(&gear, |p| lengthwise(p) + DVec3::new(x, y, z));
    }
}

/// Studs with threads beside the cylinders.
fn studs(surface: &mut Surface, n: Detail) {
    let stud = [(0.0, -0.3), (0.02, -0.3), (0.02, 0.37), (0.0, 0.37)];
    let thread = |theta: f64, z: f64| 1.0 + 0.12 * math::cos(theta - TAU * z / 0.05);
    let stud = turned(&refined(&stud, n.of(36)), n.of(7), thread);
    for k in 0..5_i32 {
        for side in [-1.0, 1.0] {
            let x = 0.44 * f64::from(k - 2);
            surface.add(&stud, |p| p + DVec3::new(0.96 * x, 0.28 * side, 0.0));
        }
    }
}

/// Inside the head cover: camshaft, valves, springs.
fn valve_train(surface: &mut Surface, n: Detail) {
    let shaft = [(0.0, -0.88), (0.035, -0.88), (0.035, 0.88), (0.0, 0.88)];
    let lobe = |x: f64| math::cos(TAU * (x / 0.22));
    let lobed = |theta: f64, x: f64| {
        // A lobe over every valve, each pair at its own angle.
        let turn = math::sin(7.0 * x);
        let on = (2.0 * lobe(x) - 1.0).clamp(0.0, 1.0);
        1.0 + on * (0.35 + 0.35 * math::cos(theta - TAU * turn))
    };
    let shaft = turned(&refined(&shaft, n.of(64)), n.of(12), lobed);
    surface.add(&shaft, |p| lengthwise(p) + DVec3::new(0.0, 0.0, 0.745));
    let radii = [0.0, 0.05, 0.05, 0.02, 0.01, 0.01, 0.0];
    let heights = [0.0, 0.0, 0.006, 0.025, 0.04, 0.15, 0.15];
    let valve = turned(&profile(&radii, &heights), n.of(12), round);
    let radii = [0.0, 0.035, 0.035, 0.02, 0.0];
    let heights = [0.0, 0.0, 0.01, 0.018, 0.018];
    let keeper = turned(&profile(&radii, &heights), n.of(14), round);
    let turns = 4.5;
    let steps = n.of(48);
    let helix: Vec<DVec3> = (0..=steps)
        .map(|k| {
            let t = f64::from(k) / f64::from(steps);
            let angle = TAU * turns * t;
            DVec3::new(0.03 * math::cos(angle), 0.03 * math::sin(angle), 0.1 * t)
        })
        .collect();
    let spring = wire(&helix, 0.005, n.of(5));
    for x in CYLINDERS {
        for (dx, y) in [(-0.09, 0.16), (0.09, 0.16), (-0.09, -0.16), (0.09, -0.16)] {
            let at = DVec3::new(x + dx, y, 0.54);
            surface.add(&valve, |p| p + at);
            surface.add(&spring, |p| p + at + DVec3::Z * 0.045);
            surface.add(&keeper, |p| p + at + DVec3::Z * 0.153);
        }
    }
}
