//! How few vertical planes could any billboard cloud of the city or the forest have? A lower bound by duality:
//!
//! ```text
//! cargo run --release --example fewest -- forest 0.1 2880 400
//! cargo run --release --example fewest -- city 0.1 2880 400
//! cargo run --release --example fewest -- forest 0.1 720 200 2
//! ```
//! Scene, angle in degrees, directions of planes over half a turn, rounds, and slants of the direction of projection to
//! either side of the normal over 60 degrees (none unless given). Give every wall a weight. If no plane holds
//! walls of more than W together, then all planes together hold all walls only if there are at least (sum of weights) /
//! W of them, whoever chooses them. Rounds shrink the weights of walls on heavy planes; the best quotient is printed.
//! The bound is for planes in the directions and slants tried, at any offset; which walls fit which plane is exact.

#![allow(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "an example measures and prints; no result of the crate depends on it"
)]

use std::env;

use glam::DVec2;
use lodmark::{
    bound::planar::{Aperture, Projection, ViewerSegment},
    mesh::generate,
};

/// A share of the heaviest plane from which on weights shrink.
const HEAVY: f64 = 0.7;

/// The intervals of walls along one direction by their ends in order: a wall, and whether it ends.
type Sweep = Vec<(usize, bool)>;

fn main() {
    let words: Vec<String> = env::args().skip(1).collect();
    let parsed = || {
        let ([scene, angle, directions, rounds], slants) = match words.as_slice() {
            [s, a, d, r] => ([s, a, d, r], 0),
            [s, a, d, r, slants] => ([s, a, d, r], slants.parse().ok()?),
            _ => return None,
        };
        let aperture = Aperture::degrees(angle.parse().ok()?).ok()?;
        let (walls, cell) = walls(scene)?;
        Some((
            walls,
            cell,
            aperture,
            directions.parse().ok()?,
            rounds.parse().ok()?,
            slants,
        ))
    };
    let Some((walls, cell, aperture, directions, rounds, slants)) = parsed() else {
        println!("expected: city|forest DEGREES DIRECTIONS ROUNDS [SLANTS]");
        return;
    };
    let sweeps: Vec<Sweep> = projections(&cell, aperture, directions, slants)
        .map(|projection| sweep(&walls, &projection))
        .collect();
    println!(
        "at least {:.1} planes for {} walls",
        bound(&sweeps, walls.len(), rounds),
        walls.len()
    );
}

/// Every wall in plan, and the viewers.
fn walls(scene: &str) -> Option<(Vec<[DVec2; 2]>, ViewerSegment)> {
    let (mesh, cell) = match scene {
        "city" => (
            generate::city(),
            ViewerSegment::line(DVec2::new(0.0, -6.0), DVec2::X),
        ),
        "forest" => (
            generate::forest(),
            ViewerSegment::between(DVec2::new(-10.0, 0.0), DVec2::new(10.0, 0.0)),
        ),
        _ => return None,
    };
    // Of the two triangles of a wall the first has both ends in its first edge.
    let wall = |t: usize| {
        let [a, b, c] = mesh.corners(t).map(|p| p.truncate());
        ((b - a).perp_dot(c - a) == 0.0 && a != b).then_some([a, b])
    };
    let walls = (0..mesh.triangles().len()).step_by(2).filter_map(wall);
    Some((walls.collect(), cell.ok()?))
}

fn projections(
    cell: &ViewerSegment,
    aperture: Aperture,
    count: u32,
    slants: i32,
) -> impl Iterator<Item = Projection> {
    let turn = std::f64::consts::PI / f64::from(count);
    let slant = std::f64::consts::FRAC_PI_3 / f64::from(slants.max(1));
    (0..count).flat_map(move |k| {
        (-slants..=slants).filter_map(move |i| {
            let angle = turn * f64::from(k);
            let along = DVec2::from_angle(angle + slant * f64::from(i));
            Projection::oblique(cell, along, DVec2::from_angle(angle), aperture).ok()
        })
    })
}

fn sweep(walls: &[[DVec2; 2]], projection: &Projection) -> Sweep {
    let mut events = Vec::new();
    for (i, &[a, b]) in walls.iter().enumerate() {
        let interval = projection.interval(a, b);
        if !interval.is_empty() {
            events.extend([(interval.min, false, i), (interval.max, true, i)]);
        }
    }
    events.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    events.into_iter().map(|(_, ends, i)| (i, ends)).collect()
}

/// The heaviest plane of a direction, and where in the sweep it is.
fn heaviest(sweep: &Sweep, weights: &[f64]) -> (f64, usize) {
    let (mut sum, mut best) = (0.0, (0.0, 0));
    for (i, &(wall, ends)) in sweep.iter().enumerate() {
        sum += if ends { -weights[wall] } else { weights[wall] };
        if sum > best.0 {
            best = (sum, i);
        }
    }
    best
}

fn bound(sweeps: &[Sweep], walls: usize, rounds: u32) -> f64 {
    let mut weights = vec![1.0; walls];
    let mut most = 0.0_f64;
    for round in 0..rounds {
        let planes: Vec<(f64, usize)> = sweeps.iter().map(|s| heaviest(s, &weights)).collect();
        let heaviest = planes.iter().map(|p| p.0).fold(0.0, f64::max);
        // Sums of a sweep are rounded: far less than this.
        most = most.max(weights.iter().sum::<f64>() / (heaviest * (1.0 + 1e-9)));
        let rate = 0.5 / (1.0 + f64::from(round) / 40.0);
        let mut load = vec![0.0_f64; walls];
        for (sweep, &(weight, at)) in sweeps.iter().zip(&planes) {
            if weight > HEAVY * heaviest {
                let mut on = vec![false; walls];
                for &(wall, ends) in &sweep[..=at] {
                    on[wall] = !ends;
                }
                for (load, _) in load.iter_mut().zip(on).filter(|&(_, on)| on) {
                    *load = load.max(weight / heaviest);
                }
            }
        }
        for (weight, load) in weights.iter_mut().zip(load) {
            *weight *= if load > 0.0 {
                (-rate * (load - HEAVY) / (1.0 - HEAVY)).exp()
            } else {
                1.0 + 0.1 * rate
            };
        }
        let scale = walls as f64 / weights.iter().sum::<f64>();
        weights.iter_mut().for_each(|w| *w *= scale);
    }
    most
}
