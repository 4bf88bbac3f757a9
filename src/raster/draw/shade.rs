//! Intensities: diffuse light on white, from geometry in `f64` with `+ - * / sqrt`.
//!
//! Flat: at the centroid with the triangle's own normal. Gouraud: at every vertex with the area-weighted sum of the
//! normals around it (Lindstrom & Turk 2000, section 5.3, footnote 3), summed by ascending triangle id. Lit: at every
//! corner with the normal that the mesh stores there. A triangle's own quantities start at its lexicographically smallest
//! corner, so its rotation changes no bit.

use glam::DVec3;

use crate::{
    num::math::{power, unit},
    view::{Eye, Light, Shading, View},
};

/// Normal and centroid of a triangle: the input of flat shading, the same for every view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceGeometry {
    /// Twice the area times the unit normal.
    pub area_normal: DVec3,
    /// Unit normal; zero where the triangle has no area.
    pub normal: DVec3,
    /// Mean of the corners.
    pub centroid: DVec3,
}

impl FaceGeometry {
    /// The geometry of a triangle; the same bits for every rotation of its corners.
    #[inline]
    pub fn new(corners: [DVec3; 3]) -> Self {
        let mut first = 0;
        for i in 1..3 {
            if corners[i].to_array() < corners[first].to_array() {
                first = i;
            }
        }
        let (a, b, c) = (
            corners[first],
            corners[(first + 1) % 3],
            corners[(first + 2) % 3],
        );
        let area_normal = (b - a).cross(c - a);
        Self {
            area_normal,
            normal: unit(area_normal).unwrap_or(DVec3::ZERO),
            centroid: ((a + b) + c) / 3.0,
        }
    }
}

/// The light and shading of one view.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    shading: Shading,
    towards_light: TowardsLight,
}

#[derive(Clone, Copy, Debug)]
enum TowardsLight {
    Point(DVec3),
    Direction(DVec3),
}

impl Shader {
    /// The shader of a view.
    pub fn new(view: &View) -> Self {
        let towards_light = match (view.light, view.eye) {
            (Light::Headlight, Eye::Point(p)) | (Light::Point(p), _) => TowardsLight::Point(p),
            (Light::Headlight, Eye::Axis(d)) | (Light::Direction(d), _) => {
                TowardsLight::Direction(d)
            }
        };
        Self {
            shading: view.shading,
            towards_light,
        }
    }

    /// The intensity in [0, 1] of a point with a unit normal; 0 where the normal or the direction to the light is
    /// undefined.
    #[inline]
    pub fn intensity(&self, point: DVec3, normal: DVec3) -> f64 {
        let light = match self.towards_light {
            TowardsLight::Point(p) => unit(p - point).unwrap_or(DVec3::ZERO),
            TowardsLight::Direction(d) => d,
        };
        let cosine = normal.dot(light);
        let diffuse = if self.shading.two_sided {
            cosine.abs()
        } else {
            cosine.max(0.0)
        };
        match self.shading.specular {
            None => diffuse,
            Some(s) => (1.0 - s.strength) * diffuse + s.strength * power(diffuse, s.exponent),
        }
    }

    /// The intensities at the corners of a triangle with the unit normals that a mesh stores for them; a corner whose
    /// normal is zero, and every one where the mesh stores none, has the triangle's own. The direction to the light is
    /// that from each corner: a triangle with its own normals alone looks flat where the light is far away, and nearly so
    /// elsewhere.
    #[inline]
    pub fn lit(&self, corners: [DVec3; 3], normals: Option<&[DVec3; 3]>) -> [f64; 3] {
        let stored = normals.copied().unwrap_or_default();
        let own = match stored.contains(&DVec3::ZERO) {
            true => FaceGeometry::new(corners).normal,
            false => DVec3::ZERO,
        };
        std::array::from_fn(|k| {
            let normal = match stored[k] == DVec3::ZERO {
                true => own,
                false => stored[k],
            };
            self.intensity(corners[k], normal)
        })
    }
}
