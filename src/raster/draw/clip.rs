//! Clipping in homogeneous coordinates: only what cannot be snapped is cut.
//!
//! Rare: triangles that cross the near plane or leave the guard band. A cut point is computed from the end inside to
//! the end outside, so both triangles at an edge find the same one, without any vertex number; the polygon is cut
//! from its lexicographically smallest corner, so the corner a triangle starts with changes nothing.

use super::projector::{ClipVertex, Projector, ScreenVertex};

/// A corner of a polygon while it is cut: position and the attributes that follow it linearly.
#[derive(Clone, Copy)]
struct Corner<const N: usize> {
    vertex: ClipVertex,
    attributes: [f64; N],
}

/// A corner of a piece: on the screen, with its attributes.
pub(super) type PieceCorner<const N: usize> = (ScreenVertex, [f64; N]);

/// Cuts a triangle at the near plane and the guard band and calls `piece` for every triangle of what is left, in a
/// fixed order. False where a coordinate is not finite: the triangle is dropped.
pub(super) fn clip<const N: usize>(
    projector: &Projector,
    corners: [ClipVertex; 3],
    attributes: [[f64; N]; 3],
    mut piece: impl FnMut([PieceCorner<N>; 3]),
) -> bool {
    if corners.iter().flat_map(|v| v.c).any(|x| !x.is_finite()) {
        return false;
    }
    let mut first = 0;
    for i in 1..3 {
        if less(&corners[i], &corners[first]) {
            first = i;
        }
    }
    let mut polygon: Vec<Corner<N>> = (0..3)
        .map(|i| (first + i) % 3)
        .map(|i| Corner {
            vertex: corners[i],
            attributes: attributes[i],
        })
        .collect();
    for plane in 0..5 {
        polygon = cut(projector, &polygon, plane);
        if polygon.len() < 3 {
            return true;
        }
    }
    let mut screen = Vec::with_capacity(polygon.len());
    for corner in &polygon {
        match projector.screen_clipped(corner.vertex) {
            Some(v) => screen.push((v, corner.attributes)),
            None => return false,
        }
    }
    for i in 1..screen.len() - 1 {
        piece([screen[0], screen[i], screen[i + 1]]);
    }
    true
}

/// Cuts a convex polygon at a plane, and keeps the part on the inner side.
fn cut<const N: usize>(
    projector: &Projector,
    polygon: &[Corner<N>],
    plane: usize,
) -> Vec<Corner<N>> {
    let distance = |corner: &Corner<N>| projector.distances(corner.vertex)[plane];
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, corner) in polygon.iter().enumerate() {
        let next = &polygon[(i + 1) % polygon.len()];
        let (d, d_next) = (distance(corner), distance(next));
        let (inside, next_inside) = (d >= 0.0, d_next >= 0.0);
        if inside {
            kept.push(*corner);
        }
        if inside && !next_inside {
            kept.push(crossing(corner, next, d, d_next));
        } else if !inside && next_inside {
            kept.push(crossing(next, corner, d_next, d));
        }
    }
    kept
}

/// The point of the edge from `inside` to `outside` where the distance is 0.
fn crossing<const N: usize>(
    inside: &Corner<N>,
    outside: &Corner<N>,
    d_in: f64,
    d_out: f64,
) -> Corner<N> {
    let t = d_in / (d_in - d_out);
    let mut result = *inside;
    for (r, o) in result.vertex.c.iter_mut().zip(outside.vertex.c) {
        *r += (o - *r) * t;
    }
    for (r, o) in result.attributes.iter_mut().zip(outside.attributes) {
        *r += (o - *r) * t;
    }
    result
}

fn less(a: &ClipVertex, b: &ClipVertex) -> bool {
    a.c.partial_cmp(&b.c) == Some(std::cmp::Ordering::Less)
}
