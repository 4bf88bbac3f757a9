//! A cube with everything that can differ from face to face: texture coordinates, normals, materials.

use glam::DVec3;

use super::{attributes, finish};
use crate::{
    mesh::{ChannelKind, Mesh, MeshParts},
    num::Each,
};

/// The cube [-1, 1]^3: 8 vertices, 12 triangles, 24 wedges with a texture coordinate and a normal each, and a material
/// for every side (`x-`, `x+`, `y-`, ...). Every side shows the whole texture, v up.
pub fn cube() -> Mesh {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut parts = MeshParts::default();
    let names = ["x-", "x+", "y-", "y+", "z-", "z+"];
    parts.materials.names = names.map(String::from).to_vec();
    for bits in 0..8 {
        let sign = |axis: u32| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 };
        parts.positions.push(DVec3::new(sign(0), sign(1), sign(2)));
    }
    let number =
        |p: DVec3| u32::from(p.x > 0.0) | u32::from(p.y > 0.0) << 1 | u32::from(p.z > 0.0) << 2;
    let (mut values, mut wedges) = (Vec::new(), Vec::new());
    for side in 0..6_u32 {
        let axis = side as usize / 2;
        let positive = side % 2 == 1;
        let normal = if positive { axes[axis] } else { -axes[axis] };
        let up = axes[(axis + 1) % 3];
        let right = up.cross(normal);
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let [a, b, c, d] =
            corners.each(|[u, v]| number(normal + right * (2.0 * u - 1.0) + up * (2.0 * v - 1.0)));
        parts.triangles.extend([[a, b, c], [a, c, d]]);
        for uv in corners {
            values.extend(uv);
            values.extend((normal + DVec3::ZERO).to_array()); // + 0: no -0
        }
        let w = 4 * side;
        wedges.extend([[w, w + 1, w + 2], [w, w + 2, w + 3]]);
        parts.materials.of_triangle.extend([side; 2]);
    }
    let kinds = [ChannelKind::TexCoord(0), ChannelKind::Normal];
    parts.attributes = attributes(&kinds, values, wedges);
    finish(parts)
}
