//! The cameras around the mesh, and their weights.
//!
//! Zhang & Turk 2002, section 4: the vertices of an octahedron whose triangles are split in four k times, orthographic.
//! Deviations, unless told otherwise: the octahedron is turned, because cameras exactly along the sides of a shape tie
//! for visible and hidden at once, and a camera counts by the area it stands for.

use glam::DVec3;

use super::{Alignment, CameraWeights, MeasureOptions};
use crate::{
    Error, Result,
    num::{Each, math},
    view::{
        Projection, Sphere, ViewSet,
        sets::{octahedron, octahedron_faces},
    },
};

/// Real and imaginary parts of the quaternion that turns the octahedron: whole numbers, so that it depends on no
/// trigonometry. None of 258 cameras then looks within 0.7 degrees along a plane of two axes, or within 0.4 degrees
/// along a plane halfway between two; and from the middle of one of two parallel squares, whatever axis they face,
/// they see within 0.004 of what a form factor leaves (on the axes: 0.078).
const ROTATION: [f64; 4] = [7.0, 7.0, 7.0, 15.0];

/// The cameras of a measurement.
#[derive(Clone, Debug)]
pub(super) struct Cameras {
    /// Unit vectors from the mesh towards every camera.
    pub(super) towards: Vec<DVec3>,
    /// Weight of every camera; the mean is 1.
    pub(super) weights: Vec<f64>,
    /// Their views onto the sphere.
    pub(super) set: ViewSet,
}

impl Cameras {
    pub(super) fn new(options: &MeasureOptions, sphere: &Sphere) -> Result<Self> {
        options.check()?;
        let mut towards = octahedron(options.octahedron);
        if options.alignment == Alignment::Generic {
            for direction in &mut towards {
                *direction = turned(*direction);
            }
        }
        let weights = match options.weights {
            CameraWeights::Equal => vec![1.0; towards.len()],
            CameraWeights::Area => area_weights(options.octahedron),
        };
        let (size, projection) = (options.size, Projection::Orthographic);
        let set = ViewSet::around(sphere, &towards, size, size, projection)?;
        let set = set.with_subpixel(options.subpixel_bits);
        if set.views.len() != towards.len() {
            return Err(Error::Internal("a camera without a view".into()));
        }
        Ok(Self {
            towards,
            weights,
            set,
        })
    }
}

/// The direction turned by [`ROTATION`]: v + 2 (w (u x v) + u x (u x v)) / |q|^2.
fn turned(v: DVec3) -> DVec3 {
    let [w, x, y, z] = ROTATION;
    let u = DVec3::new(x, y, z);
    let cross = u.cross(v);
    let squared = w * w + u.dot(u);
    let result = v + (cross * w + u.cross(cross)) * (2.0 / squared);
    math::unit(result).unwrap_or(result)
}

/// The area of every camera's barycentric cell: a third of the spherical triangles around it, divided by the mean.
fn area_weights(k: u32) -> Vec<f64> {
    let (vertices, triangles) = octahedron_faces(k);
    let mut weights = vec![0.0; vertices.len()];
    for corners in triangles {
        let area = solid_angle(corners.each(|v| vertices[v as usize]));
        for v in corners {
            weights[v as usize] += area;
        }
    }
    let scale = weights.len() as f64 / (3.0 * 4.0 * std::f64::consts::PI);
    for weight in &mut weights {
        *weight *= scale;
    }
    weights
}

/// The solid angle of a spherical triangle of unit vectors (Van Oosterom & Strackee 1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    2.0 * math::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The weighted sum of max(0, r . n) over the cameras, divided by what the whole sphere gives: a quarter of the
    /// number of cameras, because the mean of max(0, cos) over the sphere is 1/4.
    fn response(towards: &[DVec3], weights: &[f64], n: DVec3) -> f64 {
        let sum: f64 = towards
            .iter()
            .zip(weights)
            .map(|(r, w)| r.dot(n).max(0.0) * w)
            .sum();
        4.0 * sum / towards.len() as f64
    }

    #[test]
    fn the_cells_of_the_cameras_have_the_known_areas() {
        for (k, count, smallest, largest) in [
            (0, 6, 1.0, 1.0),
            (1, 18, 0.649_040_687_816_356_4, 1.175_479_656_091_822),
            (2, 66, 0.553_859_875_335_600_9, 1.190_490_484_880_175_2),
            (3, 258, 0.531_082_026_029_388_5, 1.480_849_869_526_269_3),
            (4, 1_026, 0.525_464_303_232_604_1, 1.603_713_765_505_115),
        ] {
            let weights = area_weights(k);
            assert_eq!(weights.len(), count);
            let found = weights
                .iter()
                .fold((f64::MAX, 0.0), |(a, b), &w| (a.min(w), f64::max(b, w)));
            assert!((found.0 - smallest).abs() < 1e-9, "{k}: {}", found.0);
            assert!((found.1 - largest).abs() < 1e-9, "{k}: {}", found.1);
            let sum: f64 = weights.iter().sum();
            assert!((sum - count as f64).abs() < 1e-9);
            // Weights of 2 would not fit in the integers they become.
            assert!(found.1 < 1.9);
        }
        assert!(area_weights(5).iter().all(|&w| w < 1.9));
    }

    #[test]
    fn cameras_with_equal_weights_add_up_to_the_known_sums() {
        for (k, along_z, along_diagonal) in [
            (1, 3.828_427_124_746_19, 4.181_540_550_352_055_5),
            (2, 15.586_651_631_673_504, 16.239_219_961_374_562),
            (3, 62.738_578_679_618_93, 64.616_999_976_080_75),
        ] {
            let towards = octahedron(k);
            let equal = vec![1.0; towards.len()];
            for (n, expected) in [
                (DVec3::Z, along_z),
                (DVec3::ONE.normalize(), along_diagonal),
            ] {
                let sum = response(&towards, &equal, n) * towards.len() as f64 / 4.0;
                assert!((sum - expected).abs() < 1e-9, "{k}: {sum}");
            }
        }
    }

    #[test]
    fn weighted_cameras_prefer_no_direction() {
        let weights = area_weights(3);
        let towards: Vec<DVec3> = octahedron(3).into_iter().map(turned).collect();
        for n in octahedron(4) {
            let share = response(&towards, &weights, n);
            assert!((0.992..1.004).contains(&share), "{n}: {share}");
        }
    }

    #[test]
    fn the_turned_cameras_are_a_rotation_and_none_is_aligned() {
        let (old, new) = (octahedron(2), octahedron(2).into_iter().map(turned));
        let new: Vec<DVec3> = new.collect();
        for (a, b) in [(0, 1), (2, 31), (17, 60), (5, 44)] {
            assert!((old[a].dot(old[b]) - new[a].dot(new[b])).abs() < 1e-12);
        }
        let handed = |d: &[DVec3]| d[0].dot(d[2].cross(d[4]));
        assert!((handed(&new) - handed(&old)).abs() < 1e-12);
        for camera in octahedron(3).into_iter().map(turned) {
            let [x, y, z] = camera.to_array();
            for across in [x, y, z] {
                assert!(across.abs() > 0.0125, "{camera}");
            }
            for diagonal in [x + y, x - y, y + z, y - z, z + x, z - x] {
                assert!(diagonal.abs() > 0.0107, "{camera}");
            }
        }
    }
}
