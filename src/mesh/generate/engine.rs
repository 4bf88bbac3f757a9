//! An object whose complexity nobody sees: a smooth closed casing around a crowded interior.
//!
//! It stands for the models "motor" and "blade" of the papers (hidden interior surfaces, V(M) = 0.264 for the motor of
//! Zhang & Turk 2002): the casing has less than a fifth of the area.

use glam::DVec3;

use super::{Surface, sphere::spherical_surface, torus::round_surface};
use crate::{mesh::Mesh, num::math};

/// Largest detail: some 3 million triangles.
const DETAIL_LIMIT: u32 = 5;

/// Radius of the outermost liner, the step from one to the next, and their number.
const LINERS: (f64, f64, u32) = (0.94, 0.05, 8);

/// Spacing of the rings, and the radius of the ball that holds their centres.
const RINGS: (f64, f64) = (0.16, 0.40);

/// A casing of radius 1 with gentle bumps hides eight corrugated liners, one in the other, and a lattice of rings.
///
/// All parts are closed, outward, and apart from each other. The casing comes first. The interior has more than four
/// times its area. `detail` 1, 2, 3 (to 5): 12,504, 50,016, 200,064 triangles.
pub fn engine(detail: u32) -> Mesh {
    let detail = detail.clamp(1, DETAIL_LIMIT);
    let mut surface = Surface::default();
    surface.add(&spherical_surface(detail + 1), |p| {
        p * (1.03 + 0.02 * (p.x * p.y + p.z * p.z * p.x))
    });
    let liner = spherical_surface(detail + 2);
    for k in 0..LINERS.2 {
        let radius = LINERS.0 - LINERS.1 * f64::from(k);
        // Bumps get shorter inwards, and those of neighbours are out of step.
        let frequency = 16.0 + f64::from(k);
        surface.add(&liner, |p| {
            let wave = |x: f64| math::sin(frequency * x + f64::from(k));
            p * (radius * (1.0 + 0.012 * wave(p.x) * wave(p.y) * wave(p.z)))
        });
    }
    let ring = round_surface(0.052, 0.024, 4 << (detail - 1), 3 << (detail - 1));
    let steps = 3_i32;
    for x in -steps..=steps {
        for y in -steps..=steps {
            for z in -steps..=steps {
                let center = DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * RINGS.0;
                if center.dot(center) > RINGS.1 * RINGS.1 {
                    continue;
                }
                // The axes of neighbours differ; cyclic permutations do not mirror.
                let turn = (x + y + z).rem_euclid(3);
                surface.add(&ring, |p| {
                    center
                        + match turn {
                            0 => p,
                            1 => DVec3::new(p.z, p.x, p.y),
                            _ => DVec3::new(p.y, p.z, p.x),
                        }
                });
            }
        }
    }
    surface.into_mesh()
}
