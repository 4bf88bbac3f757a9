//! [`Scene`]: triangles with stable ids, their geometry, vertex normals, stored normals and colours.

use std::sync::OnceLock;

use glam::DVec3;

use super::{Face, FaceGeometry, Paint, Projector};
use crate::{
    mesh::{ChannelKind, FramedMesh},
    num::math::unit,
};

/// A mesh as the rasterizer sees it.
#[derive(Clone, Debug)]
pub struct Scene {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    ids: Vec<u32>,
    /// The triangles by ascending id; empty where triangle t has the id t.
    by_id: Vec<u32>,
    /// Made when first asked for: pictures without Gouraud shading need none.
    normals: OnceLock<Vec<DVec3>>,
    stored_normals: Vec<[DVec3; 3]>,
    colors: Vec<[[f64; 3]; 3]>,
}

impl Scene {
    /// The triangles of a mesh, with ids in file order from 0, its normals if it stores any, and its vertex colours if
    /// it has any (opacity is ignored, absent colours are white).
    pub fn of(mesh: &FramedMesh) -> Self {
        let ids = (0..mesh.triangles().len() as u32).collect();
        let mut scene = Self::new(mesh.positions().to_vec(), mesh.triangles().to_vec(), ids);
        let attributes = mesh.in_frame_units().attributes();
        if let Some(channel) = attributes.channel(ChannelKind::Normal) {
            let normal = |wedge: u32| stored_normal(attributes.value(channel, wedge));
            let corners = attributes.corners().iter();
            scene.stored_normals = corners.map(|c| c.map(normal)).collect();
        }
        let channel = attributes
            .channel(ChannelKind::Color)
            .or_else(|| attributes.channel(ChannelKind::ColorAlpha));
        if let Some(channel) = channel {
            let color = |wedge: u32| {
                let v = attributes.value(channel, wedge);
                match v[0].is_nan() {
                    true => [1.0; 3],
                    false => [v[0], v[1], v[2]],
                }
            };
            scene.colors = attributes.corners().iter().map(|c| c.map(color)).collect();
        }
        scene
    }

    /// White triangles with the given ids: `ids[t]` decides ties of depth, and the order of sums of normals.
    ///
    /// # Panics
    /// Where `ids` and `triangles` differ in length, or a triangle names a vertex that does not exist.
    pub fn new(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>, ids: Vec<u32>) -> Self {
        assert_eq!(ids.len(), triangles.len(), "an id for every triangle");
        let mut by_id: Vec<u32> = Vec::new();
        if ids.iter().zip(0..).any(|(&id, t)| id != t) {
            by_id = (0..triangles.len() as u32).collect();
            by_id.sort_by_key(|&t| ids[t as usize]);
        }
        Self {
            positions,
            triangles,
            ids,
            by_id,
            normals: OnceLock::new(),
            stored_normals: Vec::new(),
            colors: Vec::new(),
        }
    }

    /// With red, green and blue in [0, 1] at the corners of every triangle; white again where `colors` is empty.
    ///
    /// # Panics
    /// Where `colors` covers some of the triangles only.
    pub fn with_colors(mut self, colors: Vec<[[f64; 3]; 3]>) -> Self {
        assert!(
            colors.is_empty() || colors.len() == self.triangles.len(),
            "colours for every triangle"
        );
        self.colors = colors;
        self
    }

    /// With a unit normal at the corners of every triangle, zero where there is none; without stored normals again where
    /// `normals` is empty.
    ///
    /// # Panics
    /// Where `normals` covers some of the triangles only.
    pub fn with_stored_normals(mut self, normals: Vec<[DVec3; 3]>) -> Self {
        assert!(
            normals.is_empty() || normals.len() == self.triangles.len(),
            "normals for every triangle"
        );
        self.stored_normals = normals;
        self
    }

    /// Positions.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Vertices of every triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Red, green and blue in [0, 1] at the corners of every triangle; empty where everything is white.
    pub fn colors(&self) -> &[[[f64; 3]; 3]] {
        &self.colors
    }

    /// Unit normals at the corners of every triangle as the mesh stores them, zero where it stores none there; empty
    /// where it stores no normals at all.
    pub fn stored_normals(&self) -> &[[DVec3; 3]] {
        &self.stored_normals
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The id of a triangle.
    pub(super) fn id(&self, t: usize) -> u32 {
        self.ids[t]
    }

    /// The triangle with this id.
    #[inline]
    pub(super) fn triangle_of(&self, id: u32) -> Option<usize> {
        if self.by_id.is_empty() {
            return ((id as usize) < self.ids.len()).then_some(id as usize);
        }
        let rank = self
            .by_id
            .binary_search_by_key(&id, |&t| self.ids[t as usize]);
        rank.ok().map(|rank| self.by_id[rank] as usize)
    }

    /// Unit vertex normals: the area-weighted sums of the normals around each vertex, zero where undefined. The first
    /// call visits every triangle.
    pub fn normals(&self) -> &[DVec3] {
        self.normals.get_or_init(|| {
            let mut sums = vec![DVec3::ZERO; self.positions.len()];
            let mut add = |t: usize| {
                let [a, b, c] = self.triangles[t];
                let normal = FaceGeometry::new(self.points(t)).area_normal;
                sums[a as usize] += normal;
                if b != a {
                    sums[b as usize] += normal;
                }
                if c != a && c != b {
                    sums[c as usize] += normal;
                }
            };
            if self.by_id.is_empty() {
                (0..self.triangles.len()).for_each(&mut add);
            } else {
                self.by_id.iter().for_each(|&t| add(t as usize));
            }
            sums.into_iter()
                .map(|n| unit(n).unwrap_or(DVec3::ZERO))
                .collect()
        })
    }

    /// The corners of a triangle.
    #[inline]
    pub(super) fn points(&self, t: usize) -> [DVec3; 3] {
        self.triangles[t].map(|v| self.positions[v as usize])
    }

    /// A triangle of a view with the given paint.
    #[inline]
    pub(super) fn painted(&self, t: usize, projector: &Projector, paint: Paint) -> Face {
        let positions = self.points(t);
        Face {
            positions,
            screen: positions.map(|p| projector.screen(p)),
            paint,
        }
    }
}

/// The unit normal of the three values that a mesh stores at a corner; zero where they are absent or have no direction.
pub fn stored_normal(values: &[f64]) -> DVec3 {
    match *values {
        [x, y, z] => unit(DVec3::new(x, y, z)).unwrap_or(DVec3::ZERO),
        _ => DVec3::ZERO,
    }
}
