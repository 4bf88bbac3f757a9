//! The two scenes that view-dependent billboards are measured on (Eisemann & Décoret 2007, figures 17 and 18, as far as
//! the paper tells). The ground is z = 0, up is z.

use glam::DVec3;

use super::{Mesh, Pcg32, Surface};
use crate::num::Each;

/// Buildings along a street.
const COLUMNS: u32 = 20;
/// Streets of buildings, one behind the other.
const ROWS: u32 = 21;
/// From one block to the next.
const PITCH: f64 = 2.4;
/// Streets from one wide street to the next.
const WIDE_EVERY: u32 = 5;
/// Its width.
const WIDE: f64 = 4.0;
/// Distance of a facade behind the street line.
const SETBACKS: [f64; 3] = [0.0, 0.01, 0.03];

/// A city of 20 x 21 box buildings without floors: 4,200 triangles. Blocks have sides from 1.0 to 1.6, the same along a
/// street, so that facades are flush with the street lines on all four sides but for setbacks of 0, 0.01 or 0.03;
/// heights are from 1 to 8. Blocks follow at a pitch of 2.4, and every fifth street is 4 wide. The first row begins at
/// y = 0 and the first column at x = 0: a viewer at y <= -6 is at least 6 away.
pub fn city() -> Mesh {
    buildings(COLUMNS, ROWS)
}

/// A [`city`] of `rows` streets with `columns` buildings each: 10 triangles per building.
pub fn buildings(columns: u32, rows: u32) -> Mesh {
    let mut random = Pcg32::new(7, 1);
    let columns = blocks(columns, &mut random);
    let rows = blocks(rows, &mut random);
    let mut surface = Surface::default();
    for &[front, back] in &rows {
        for &[left, right] in &columns {
            let height = 1.0 + 7.0 * random.unit();
            let mut setback = || SETBACKS[random.bits() as usize % SETBACKS.len()];
            let low = [left + setback(), front + setback()];
            let high = [right - setback(), back - setback()];
            surface.add(&building(low, high, height), |p| p);
        }
    }
    surface.into_mesh()
}

/// From where to where the blocks go along one axis.
fn blocks(count: u32, random: &mut Pcg32) -> Vec<[f64; 2]> {
    let mut start = 0.0;
    (1..=count)
        .map(|i| {
            let block = [start, start + 1.0 + 0.6 * random.unit()];
            let wide = i.is_multiple_of(WIDE_EVERY);
            start = if wide { block[1] + WIDE } else { start + PITCH };
            block
        })
        .collect()
}

/// Four walls and a roof.
fn building(low: [f64; 2], high: [f64; 2], height: f64) -> Surface {
    let ([left, front], [right, back]) = (low, high);
    let ground = [[left, front], [right, front], [right, back], [left, back]];
    let at = |z: f64| ground.each(|[x, y]| rounded(DVec3::new(x, y, z)));
    let mut positions = at(0.0).to_vec();
    positions.extend(at(height));
    let mut triangles = Vec::new();
    for i in 0..4 {
        let j = (i + 1) % 4;
        triangles.extend([[i, j, j + 4], [i, j + 4, i + 4]]);
    }
    triangles.extend([[4, 5, 6], [4, 6, 7]]);
    Surface {
        positions,
        triangles,
    }
}

/// A forest of 10,000 trees, each a rectangle of 2 triangles that faces the middle, in a disc of radius 500 around the
/// origin: 20,000 triangles. Trees are 4 to 8 high and half as wide. Its viewers are on a segment of length 20 around
/// the origin, along the x-axis.
pub fn forest() -> Mesh {
    trees(10_000, 500.0)
}

/// The first `count` trees of the [`forest`], in a disc of this radius.
pub fn trees(count: u32, radius: f64) -> Mesh {
    let mut random = Pcg32::new(7, 2);
    let mut surface = Surface::default();
    for _ in 0..count {
        let (place, squared) = loop {
            let mut side = || radius * (2.0 * random.unit() - 1.0);
            let place = DVec3::new(side(), side(), 0.0);
            let squared = place.dot(place);
            if squared > 0.0 && squared <= radius * radius {
                break (place, squared);
            }
        };
        let height = 4.0 + 4.0 * random.unit();
        let away = place / crate::num::math::sqrt(squared);
        let half = DVec3::new(-away.y, away.x, 0.0) * (height / 4.0);
        let up = DVec3::new(0.0, 0.0, height);
        let (a, b) = (place + half, place - half);
        let corners = [a, b, b + up, a + up];
        let tree = Surface {
            positions: corners.each(rounded).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        surface.add(&tree, |p| p);
    }
    surface.into_mesh()
}

/// To the precision of a file.
fn rounded(p: DVec3) -> DVec3 {
    p.as_vec3().as_dvec3()
}
