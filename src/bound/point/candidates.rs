//! The viewpoints of a cell that can decide about a pair of points: corners, and the max viewpoints of its faces and
//! edges. Each is a viewpoint of the cell, so more of them than needed are harmless.

use glam::DVec3;

use super::edge::Edge;
use crate::bound::view_cell::{Shape, ViewCell};

/// A question that one viewpoint of a cell decides.
pub(super) trait Question {
    /// The viewpoint of an edge that decides most; `None` where all are alike.
    fn on_edge(&self, edge: &Edge) -> Option<DVec3>;

    /// The viewpoints of a whole plane that may decide.
    fn on_plane(&self, origin: DVec3, normal: DVec3) -> [Option<DVec3>; 2];

    /// Hears of a viewpoint of the cell.
    fn take(&mut self, viewpoint: DVec3);
}

/// Asks all viewpoints of the cell that can decide.
pub(super) fn ask(cell: &ViewCell, question: &mut impl Question) {
    for &corner in cell.corners().unwrap_or_default() {
        question.take(corner);
    }
    match cell.shape() {
        Shape::Point(_) => {}
        Shape::Segment([a, b]) => ask_edge(Edge::between(*a, *b), question),
        Shape::Line { point, direction } => {
            ask_edge(Some(Edge::line(*point, *direction)), question);
        }
        Shape::Polygon { corners, normal } => {
            ask_face(corners.iter().copied(), *normal, question);
            for (i, &a) in corners.iter().enumerate() {
                ask_edge(Edge::between(a, corners[(i + 1) % corners.len()]), question);
            }
        }
        Shape::Plane { point, normal } | Shape::HalfSpace { point, normal } => {
            let found = question.on_plane(*point, *normal);
            found.into_iter().flatten().for_each(|v| question.take(v));
        }
        Shape::Polyhedron {
            corners,
            faces,
            normals,
        } => {
            let at = |&i: &u32| corners[i as usize];
            for (face, &normal) in faces.iter().zip(normals) {
                ask_face(face.iter().map(at), normal, question);
                for (i, a) in face.iter().enumerate() {
                    let b = &face[(i + 1) % face.len()];
                    // Each edge lies on two faces.
                    if a < b {
                        ask_edge(Edge::between(at(a), at(b)), question);
                    }
                }
            }
        }
    }
}

fn ask_edge(edge: Option<Edge>, question: &mut impl Question) {
    if let Some(v) = edge.and_then(|edge| question.on_edge(&edge)) {
        question.take(v);
    }
}

fn ask_face(
    corners: impl Iterator<Item = DVec3> + Clone,
    normal: DVec3,
    question: &mut impl Question,
) {
    let Some(origin) = corners.clone().next() else {
        return;
    };
    for v in question.on_plane(origin, normal).into_iter().flatten() {
        if inside(corners.clone(), normal, v) {
            question.take(v);
        }
    }
}

/// True where a point of the plane of a convex polygon lies inside it; corners are counter-clockwise about the normal.
fn inside(corners: impl Iterator<Item = DVec3> + Clone, normal: DVec3, v: DVec3) -> bool {
    let next = corners.clone().cycle().skip(1);
    corners
        .zip(next)
        .all(|(a, b)| (b - a).cross(v - a).dot(normal) >= 0.0)
}
