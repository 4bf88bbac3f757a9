//! The normal field of the original surface.

use glam::DVec3;

use super::face::{Face, from_smallest, normals_of};
use crate::{
    geometry::{Box3, TreeItem, Triangle, TriangleTree, area_normal},
    mesh::{Channel, ChannelKind, Mesh},
    num::{
        Each, Frame,
        math::{length, unit},
    },
    parallel,
};

/// Cosine of the largest angle between a face and the triangles of the original that it may stand for: 72.5 degrees. Thin
/// sheets have two sides.
const ALONG: f64 = 0.3;

/// A triangle of the original.
#[derive(Clone, Copy, Debug)]
struct Facet {
    triangle: Triangle,
    number: u32,
}

impl TreeItem for Facet {
    fn bounds(&self) -> Box3 {
        self.triangle.bounds()
    }

    fn squared_distance(&self, p: DVec3) -> f64 {
        self.triangle.closest(p).1
    }
}

/// Stored normals of the original, interpolated between the corners of its triangles as viewers do.
pub(super) struct NormalField<'a> {
    original: &'a Mesh,
    frame: Frame,
    channel: Option<Channel>,
    tree: TriangleTree<Facet>,
}

impl<'a> NormalField<'a> {
    /// The field of a mesh with triangles; `None` without any. O(n log n).
    pub(super) fn of(original: &'a Mesh, frame: Frame) -> Option<Self> {
        let facets = parallel::map(original.triangles().len(), |t| Facet {
            triangle: Triangle::new(original.corners(t).each(|p| frame.enter(p))),
            number: t as u32,
        });
        Some(Self {
            original,
            frame,
            channel: original.attributes().channel(ChannelKind::Normal),
            tree: TriangleTree::of(facets)?,
        })
    }

    /// The normal of the original at its point nearest to a point of a simplified face: among triangles of the same
    /// material that are not across it or show the other side, no farther than the face is long. `None` where there is none. `near` is
    /// a guess of the triangle, and becomes one for the next point.
    pub(super) fn at(&self, p: DVec3, face: &Face, near: &mut u32) -> Option<DVec3> {
        let direction = unit(face.normal).unwrap_or(DVec3::ZERO);
        let counts = |facet: &Facet| {
            let normal = facet.triangle.area_normal();
            normal.dot(direction) > ALONG * length(normal)
                && self.original.materials().of(facet.number as usize) == face.material
        };
        let (squared, mut index) = self.tree.squared_distance(p, *near);
        *near = index;
        if !counts(self.tree.item(index)) {
            let [a, b, c] = face.points;
            let sides = [b - a, c - b, a - c];
            let longest = sides.iter().fold(squared, |most, s| most.max(s.dot(*s)));
            index = self.tree.nearest_of(p, longest, counts)?;
        }
        self.interpolated(self.tree.item(index), p)
    }

    /// The normal at the point of a triangle nearest to `p`. A corner without a normal has that of the face.
    fn interpolated(&self, facet: &Facet, p: DVec3) -> Option<DVec3> {
        let t = facet.number as usize;
        let (vertices, first) = from_smallest(self.original.triangles()[t]);
        let points = vertices.each(|v| self.frame.enter(self.original.positions()[v as usize]));
        let flat = unit(facet.triangle.area_normal()).unwrap_or(DVec3::ZERO);
        let normals = normals_of(self.original, self.channel, t, first);
        let [l, m, n] = normals.each(|n| unit(n).unwrap_or(flat));
        let [u, v, w] = coordinates(points, facet.triangle.closest(p).0);
        unit(l * u + m * v + n * w)
    }
}

/// Barycentric coordinates of a point of a triangle: not negative; thirds where the triangle has no area.
fn coordinates([a, b, c]: [DVec3; 3], q: DVec3) -> [f64; 3] {
    let normal = area_normal([a, b, c]);
    let norm = normal.dot(normal);
    let of = |m: DVec3, n: DVec3| (m - q).cross(n - q).dot(normal) / norm;
    let found = [of(b, c), of(c, a), of(a, b)];
    if found.iter().all(|x| x.is_finite()) {
        found.each(|x| x.max(0.0))
    } else {
        [1.0 / 3.0; 3]
    }
}
