//! The tetrahedron, the icosphere, and shells of icospheres.

use glam::DVec3;

use super::{Surface, subdivision};
use crate::{mesh::Mesh, num::math};

/// Most subdivisions of the icosahedron: 5,242,880 triangles.
const SUBDIVISION_LIMIT: u32 = 9;

const GOLDEN: f64 = 1.618_033_988_749_895;

/// The regular tetrahedron on four corners of the cube [-1, 1]^3.
pub fn tetrahedron() -> Mesh {
    tetrahedral_surface().into_mesh()
}

/// The icosahedron with every triangle split in four `subdivisions` times (0 to 9) and all vertices at distance 1 from
/// the origin: 20 * 4^subdivisions triangles.
pub fn icosphere(subdivisions: u32) -> Mesh {
    spherical_surface(subdivisions).into_mesh()
}

/// `count` icospheres (1 to 64) around one centre, the largest with radius 1 first, the radii an arithmetic sequence
/// down to `1 / count`: each hides the next.
pub fn shells(count: u32, subdivisions: u32) -> Mesh {
    let count = count.clamp(1, 64);
    let sphere = spherical_surface(subdivisions.min(SUBDIVISION_LIMIT - 3));
    let mut surface = Surface::default();
    for k in (1..=count).rev() {
        let radius = f64::from(k) / f64::from(count);
        surface.add(&sphere, |p| p * radius);
    }
    surface.into_mesh()
}

pub(super) fn tetrahedral_surface() -> Surface {
    Surface {
        positions: [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
            .map(|(x, y)| DVec3::new(x, y, x * y))
            .to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
    }
}

pub(super) fn spherical_surface(subdivisions: u32) -> Surface {
    let (o, i) = (1.0, GOLDEN);
    // Three rectangles across each other.
    let rectangle = [[-o, i, 0.0], [o, i, 0.0], [-o, -i, 0.0], [o, -i, 0.0]];
    let mut positions = Vec::new();
    for turn in 0..3 {
        for mut corner in rectangle {
            corner.rotate_right(turn);
            positions.extend(math::unit(DVec3::from_array(corner)));
        }
    }
    // Around the first corner, beside these, around the last one's opposite, beside those.
    let mut triangles = [
        [[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11]],
        [[1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6], [7, 1, 8]],
        [[3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9]],
        [[4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1]],
    ]
    .concat();
    for _ in 0..subdivisions.min(SUBDIVISION_LIMIT) {
        subdivision::split(&mut positions, &mut triangles);
    }
    Surface {
        positions,
        triangles,
    }
}
