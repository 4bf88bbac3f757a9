//! What is drawn: triangles with stable ids, their geometry, vertex normals and colours.

use glam::DVec3;

use super::{Face, FaceGeometry, Paint, Projector, ScreenVertex, Shader};
use crate::{
    mesh::{ChannelKind, Mesh},
    num::math::unit,
    view::{Interpolation, View},
};

/// A mesh as the rasterizer sees it.
#[derive(Clone, Debug)]
pub struct Scene {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    ids: Vec<u32>,
    faces: Vec<FaceGeometry>,
    normals: Vec<DVec3>,
    colors: Vec<[[f64; 3]; 3]>,
}

impl Scene {
    /// The triangles of a mesh, with ids in file order from 0, and its vertex colours if it has any (opacity is
    /// ignored, absent colours are white).
    #[must_use]
    pub fn of(mesh: &Mesh) -> Self {
        let ids = (0..mesh.triangles().len() as u32).collect();
        let mut scene = Self::new(mesh.positions().to_vec(), mesh.triangles().to_vec(), ids);
        let attributes = mesh.attributes();
        let channel = attributes
            .channel(ChannelKind::Color)
            .or_else(|| attributes.channel(ChannelKind::ColorAlpha));
        if let Some(channel) = channel {
            let color = |wedge: u32| {
                let v = attributes.value(channel, wedge);
                if v[0].is_nan() {
                    [1.0; 3]
                } else {
                    [v[0], v[1], v[2]]
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
    #[must_use]
    pub fn new(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>, ids: Vec<u32>) -> Self {
        assert_eq!(ids.len(), triangles.len(), "an id for every triangle");
        let faces: Vec<FaceGeometry> = triangles
            .iter()
            .map(|t| FaceGeometry::new(t.map(|v| positions[v as usize])))
            .collect();
        let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
        if !ids.is_sorted() {
            order.sort_unstable_by_key(|&t| ids[t as usize]);
        }
        let mut sums = vec![DVec3::ZERO; positions.len()];
        for t in order {
            let [a, b, c] = triangles[t as usize];
            let normal = faces[t as usize].area_normal;
            sums[a as usize] += normal;
            if b != a {
                sums[b as usize] += normal;
            }
            if c != a && c != b {
                sums[c as usize] += normal;
            }
        }
        let normals = sums
            .into_iter()
            .map(|n| unit(n).unwrap_or(DVec3::ZERO))
            .collect();
        Self {
            positions,
            triangles,
            ids,
            faces,
            normals,
            colors: Vec::new(),
        }
    }

    /// With red, green and blue in [0, 1] at the corners of every triangle; white again where `colors` is empty.
    ///
    /// # Panics
    /// Where `colors` covers some of the triangles only.
    #[must_use]
    pub fn with_colors(mut self, colors: Vec<[[f64; 3]; 3]>) -> Self {
        assert!(
            colors.is_empty() || colors.len() == self.triangles.len(),
            "colours for every triangle"
        );
        self.colors = colors;
        self
    }

    /// Positions.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Vertices of every triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Red, green and blue in [0, 1] at the corners of every triangle; empty where everything is white.
    #[must_use]
    pub fn colors(&self) -> &[[[f64; 3]; 3]] {
        &self.colors
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The id of a triangle.
    pub(super) fn id(&self, t: usize) -> u32 {
        self.ids[t]
    }

    /// Unit vertex normals: the area-weighted sums of the normals around each vertex, zero where undefined.
    #[must_use]
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// The intensity of every vertex in a view with Gouraud shading; empty for flat shading.
    pub(super) fn intensities(&self, view: &View) -> Vec<f64> {
        match view.shading.interpolation {
            Interpolation::Flat => Vec::new(),
            Interpolation::Gouraud => {
                let shader = Shader::new(view);
                self.positions
                    .iter()
                    .zip(&self.normals)
                    .map(|(&p, &n)| shader.intensity(p, n))
                    .collect()
            }
        }
    }

    /// Triangle `t` of a view: `screen` are the projected vertices, `intensities` as [`Scene::intensities`] gives
    /// them.
    #[inline]
    pub(super) fn face(
        &self,
        t: usize,
        shader: &Shader,
        screen: &[ScreenVertex],
        intensities: &[f64],
    ) -> Face {
        let corners = self.triangles[t];
        let color = self.colors.get(t);
        let paint = if intensities.is_empty() {
            let g = &self.faces[t];
            Paint::flat(shader.intensity(g.centroid, g.normal), color)
        } else {
            Paint::gouraud(corners.map(|v| intensities[v as usize]), color)
        };
        Face {
            positions: corners.map(|v| self.positions[v as usize]),
            screen: corners.map(|v| screen[v as usize]),
            paint,
        }
    }

    /// Every vertex on the screen.
    pub(super) fn project(&self, projector: &Projector) -> Vec<ScreenVertex> {
        self.positions
            .iter()
            .map(|&p| projector.screen(p))
            .collect()
    }
}
