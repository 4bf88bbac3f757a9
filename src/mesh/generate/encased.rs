//! An object in a closed casing: what hides it and what is hidden can be told apart.

use super::{Surface, sphere::spherical_surface, torus::round_surface};
use crate::{mesh::Mesh, num::math};

/// Largest detail: 213,000 triangles.
const DETAIL_LIMIT: u32 = 5;

/// Two interlocking tori in a closed casing with dents, none touching another. The casing comes first.
///
/// `detail` 1, 2, 3 (to 5): 320 + 512, 1,280 + 2,048, 5,120 + 8,192 triangles.
pub fn encased(detail: u32) -> Mesh {
    let detail = detail.clamp(1, DETAIL_LIMIT);
    let mut surface = Surface::default();
    surface.add(&spherical_surface(detail + 1), |p| {
        let dents = math::sin(5.0 * p.x) * math::sin(5.0 * p.y + 1.0) * math::sin(5.0 * p.z + 2.0);
        p * (2.2 + 0.12 * dents)
    });
    let link = round_surface(1.0, 0.3, 16 << (detail - 1), 8 << (detail - 1));
    surface.add(&link, |p| p - glam::DVec3::X * 0.5);
    surface.add(&link, |p| glam::DVec3::new(p.x + 0.5, -p.z, p.y));
    surface.into_mesh()
}
