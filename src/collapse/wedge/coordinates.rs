//! Texture coordinates of one wedge of a new vertex: solved over its chart's faces, and kept within them.
//!
//! At an end of the edge they are that end's, to the bit. Elsewhere they are solved where the position lies on the
//! plane that preserves the volume below the chart's faces (with an affine texture: the value below the position along
//! the chart's normal). A solution outside the chart's old triangles, which an atlas has given to others, is brought
//! back to the nearest point of them (Lindstrom & Turk 2000 say nothing of atlases).

use glam::DVec3;

use super::oriented_volume::{OrientedVolume, Otherwise};
use crate::geometry::area_normal;

/// A face of the chart, with the coordinates of its corners.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChartFace {
    pub(super) points: [DVec3; 3],
    pub(super) coordinates: [[f64; 2]; 3],
}

/// The coordinates of the wedge that has a corner in each of these faces; `None` where nothing determines them.
pub(super) fn solve(
    faces: &[ChartFace],
    position: DVec3,
    scale: f64,
    otherwise: Otherwise,
) -> Option<[f64; 2]> {
    let origin = otherwise.ends.iter().flatten().next().copied()?;
    let on_plane = preserve_volume(faces, position);
    let mut volume = OrientedVolume::new(on_plane, origin, scale);
    for face in faces {
        volume.add(face.points, face.coordinates);
    }
    let solved = volume.solve(otherwise)?;
    nearest(faces, solved)
}

/// The point of the plane that preserves the volume below the faces, along their common normal from `position`.
fn preserve_volume(faces: &[ChartFace], position: DVec3) -> DVec3 {
    let (mut normal, mut volume) = (DVec3::ZERO, 0.0);
    for face in faces {
        let n = area_normal(face.points);
        normal += n;
        volume += n.dot(face.points[0] - position);
    }
    let offset = normal * (volume / normal.dot(normal));
    if offset.is_finite() {
        position + offset
    } else {
        position
    }
}

/// The point of the faces in texture space that is nearest to `p`: `p` itself where a face holds it.
pub(super) fn nearest(faces: &[ChartFace], p: [f64; 2]) -> Option<[f64; 2]> {
    let mut best: Option<(f64, [f64; 2])> = None;
    for face in faces {
        let [a, b, c] = face.coordinates;
        let sides = [cross(a, b, p), cross(b, c, p), cross(c, a, p)];
        let whole = cross(a, b, c);
        if whole != 0.0 && sides.iter().all(|&s| s * whole >= 0.0) {
            return Some(p);
        }
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let foot = foot(from, to, p);
            let d = [p[0] - foot[0], p[1] - foot[1]];
            let distance = d[0] * d[0] + d[1] * d[1];
            if distance.is_finite() && best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, foot));
            }
        }
    }
    best.map(|(_, foot)| foot)
}

/// Twice the signed area of a triangle in texture space.
pub(in crate::rooms::collapse) fn double_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    cross(a, b, c)
}

fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The point of a segment that is nearest to `p`.
fn foot(from: [f64; 2], to: [f64; 2], p: [f64; 2]) -> [f64; 2] {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length2 = along[0] * along[0] + along[1] * along[1];
    let t = ((p[0] - from[0]) * along[0] + (p[1] - from[1]) * along[1]) / length2;
    let t = if t.is_finite() {
        t.clamp(0.0, 1.0)
    } else {
        0.0
    };
    if t <= 0.0 {
        from
    } else if t >= 1.0 {
        to
    } else {
        [from[0] + t * along[0], from[1] + t * along[1]]
    }
}
