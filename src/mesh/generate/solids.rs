//! Closed bodies to build machines from: turned on a lathe, bent from wire, hollow, and boxes with round edges.
//!
//! All face outward. Counts below what a closed body needs are brought up to that.

use std::{collections::BTreeMap, f64::consts::TAU};

use glam::DVec3;

use super::{Surface, torus::swept};
use crate::num::{Each, math};

/// A body turned around the z axis: `rows` are radius and height from bottom to top, both ends on the axis (whatever
/// their radius says), each of the others has `around` vertices; a flat
/// and round end has no vertex in its middle. `shape` gives the factor of a radius at an angle and
/// height: 1 for a round body.
pub(super) fn turned(rows: &[(f64, f64)], around: u32, shape: impl Fn(f64, f64) -> f64) -> Surface {
    let around = around.max(3);
    let ring = |&(radius, z): &(f64, f64)| -> Vec<DVec3> {
        let place = |k| {
            let theta = TAU * (f64::from(k) / f64::from(around));
            let r = radius * shape(theta, z);
            DVec3::new(r * math::cos(theta), r * math::sin(theta), z)
        };
        (0..around).map(place).collect()
    };
    let inner = rows.get(1..rows.len().saturating_sub(1)).unwrap_or(&[]);
    let rings: Vec<Vec<DVec3>> = inner.iter().map(ring).collect();
    let pole = |end: usize, next: usize| {
        let ((_, z), (_, beside)) = (rows.get(end)?, rows.get(next)?);
        let cone = (z - beside).abs() > 0.0;
        let round = (0..around).all(|k| {
            let theta = TAU * (f64::from(k) / f64::from(around));
            (shape(theta, *beside) - shape(0.0, *beside)).abs() < 1e-9
        });
        (cone || !round).then_some(DVec3::Z * *z)
    };
    let last = rows.len().saturating_sub(1);
    capped(&rings, pole(0, 1), pole(last, last.saturating_sub(1)))
}

/// A round wire of `radius` along `path`, with `across` vertices around it and flat ends.
pub(super) fn wire(path: &[DVec3], radius: f64, across: u32) -> Surface {
    let across = across.max(3);
    let (mut rings, mut side) = (Vec::new(), DVec3::ZERO);
    for (i, &p) in path.iter().enumerate() {
        let (before, after) = (path[i.saturating_sub(1)], path[(i + 1).min(path.len() - 1)]);
        let along = math::unit(after - before).unwrap_or(DVec3::Z);
        // The side turns as little as possible; at first it is any that is not along the path.
        for start in [side, DVec3::X, DVec3::Y] {
            let across = start - along * along.dot(start);
            if across.dot(across) > 0.1 {
                side = math::unit(across).unwrap_or(start);
                break;
            }
        }
        let other = along.cross(side);
        let place = |k| {
            let phi = TAU * (f64::from(k) / f64::from(across));
            p + (side * math::cos(phi) + other * math::sin(phi)) * radius
        };
        rings.push((0..across).map(place).collect::<Vec<_>>());
    }
    capped(&rings, None, None)
}

/// A tube around the z axis with walls between two radii and two heights.
pub(super) fn hollow(radii: [f64; 2], heights: [f64; 2], around: u32) -> Surface {
    let ([inner, outer], [low, high]) = (radii, heights);
    let corners = [(outer, low), (outer, high), (inner, high), (inner, low)];
    swept(around.max(3), 4, 0.0, move |_, phi| {
        // A quarter of a turn for each corner, up to rounding.
        let (r, z) = corners[((phi / TAU * 4.0 + 0.5) as usize).min(3)];
        [r, z]
    })
}

/// The box with the given half sides around the origin: edges rounded with `radius` in twice `steps` steps, two
/// triangles in the flat part of each side.
pub(super) fn round_box(half: DVec3, radius: f64, steps: u32) -> Surface {
    let lines = [0, 1, 2].each(|axis| lines(half[axis], radius, steps.max(1)));
    let n = lines.each_ref().each(|l| l.len() as u32 - 1);
    let mut surface = Surface::default();
    let mut numbers: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let core = half - DVec3::splat(radius);
    let mut vertex = |at: [u32; 3]| {
        *numbers.entry(at).or_insert_with(|| {
            let [x, y, z] = [0, 1, 2].each(|axis| lines[axis][at[axis] as usize]);
            let p = DVec3::new(x, y, z);
            let inside = p.clamp(-core, core);
            let out = math::unit(p - inside).unwrap_or_default();
            surface.positions.push(inside + out * radius);
            surface.positions.len() as u32 - 1
        })
    };
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (side, far) in [(0, false), (n[axis], true)] {
            for j in 0..n[v] {
                for i in 0..n[u] {
                    let mut corner = |du, dv| {
                        let mut at = [0; 3];
                        (at[axis], at[u], at[v]) = (side, i + du, j + dv);
                        vertex(at)
                    };
                    let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    let inward = [[a, c, b], [a, d, c]];
                    triangles.extend(if far { [[a, b, c], [a, c, d]] } else { inward });
                }
            }
        }
    }
    surface.triangles = triangles;
    surface
}

/// The surface turned inside out: a cavity.
pub(super) fn cavity(mut surface: Surface) -> Surface {
    for [_, b, c] in &mut surface.triangles {
        std::mem::swap(b, c);
    }
    surface
}

/// Where the grid of a box meets an axis: equal angles around the rounded edges.
fn lines(half: f64, radius: f64, steps: u32) -> Vec<f64> {
    let flat = half - radius;
    let bent = |k: u32| {
        let angle = TAU / 8.0 * (f64::from(k) / f64::from(steps));
        flat + radius * (math::sin(angle) / math::cos(angle))
    };
    let mut lines: Vec<f64> = (1..=steps).rev().map(|k| -bent(k)).collect();
    lines.extend([-flat, flat]);
    lines.extend((1..=steps).map(bent));
    lines
}

/// The rows of a body to be [`turned`], by their radii and their heights.
pub(super) fn profile(radii: &[f64], heights: &[f64]) -> Vec<(f64, f64)> {
    radii.iter().copied().zip(heights.iter().copied()).collect()
}

/// Every line of a profile in `steps` parts.
pub(super) fn refined(profile: &[(f64, f64)], steps: u32) -> Vec<(f64, f64)> {
    let steps = steps.max(1);
    let mut rows: Vec<(f64, f64)> = profile.first().copied().into_iter().collect();
    for pair in profile.windows(2) {
        let ((r, z), (r2, z2)) = (pair[0], pair[1]);
        for k in 1..=steps {
            let t = f64::from(k) / f64::from(steps);
            rows.push((r + (r2 - r) * t, z + (z2 - z) * t));
        }
    }
    rows
}

/// Rings of equally many vertices, joined to one another and closed at either end: towards a point, or flat.
fn capped(rings: &[Vec<DVec3>], start: Option<DVec3>, end: Option<DVec3>) -> Surface {
    let around = rings.first().map_or(0, Vec::len) as u32;
    let mut surface = Surface::default();
    surface.positions.extend(rings.iter().flatten());
    for row in 1..rings.len() as u32 {
        let (low, high) = ((row - 1) * around, row * around);
        for k in 0..around {
            let next = (k + 1) % around;
            let [a, b, c, d] = [low + k, low + next, high + next, high + k];
            surface.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let top = (rings.len() as u32).saturating_sub(1) * around;
    for (first, pole, up) in [(0, start, false), (top, end, true)] {
        let middle = surface.positions.len() as u32;
        surface.positions.extend(pole);
        let (center, sides) = match pole {
            Some(_) => (middle, 0..around),
            None => (first, 1..around.saturating_sub(1)),
        };
        for k in sides {
            let (k, next) = (first + k, first + (k + 1) % around);
            let [from, to] = if up { [k, next] } else { [next, k] };
            surface.triangles.push([center, from, to]);
        }
    }
    surface
}
