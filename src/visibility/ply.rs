//! A mesh with its visibility as a PLY file: every face has a colour (Figure 2 of Zhang & Turk 2002) and V(t).
//!
//! Binary, little-endian; face properties `red`, `green`, `blue` and `quality`, as MeshLab reads them. Triangles and
//! vertices keep their order. Other attributes are left out: the colours are the point.

use super::{Visibility, color};
use crate::{Error, Result, mesh::Mesh, num::Precision};

/// The bytes of the file.
///
/// # Errors
/// [`Error::Usage`] where `visibility` belongs to a mesh of another size.
pub fn encode(mesh: &Mesh, visibility: &Visibility) -> Result<Vec<u8>> {
    let (vertices, faces) = (mesh.positions().len(), mesh.triangles().len());
    if visibility.triangles().len() != faces {
        return Err(Error::Usage(format!(
            "visibility of {} triangles for a mesh of {faces}; expected that of the same mesh",
            visibility.triangles().len()
        )));
    }
    let real = match mesh.precision() {
        Precision::F32 => "float",
        Precision::F64 => "double",
    };
    let header = format!(
        "ply\nformat binary_little_endian 1.0\ncomment lodmark visibility\nelement vertex {vertices}\n\
         property {real} x\nproperty {real} y\nproperty {real} z\nelement face {faces}\n\
         property list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
         property float quality\nend_header\n"
    );
    let mut bytes = header.into_bytes();
    bytes.reserve(24 * vertices + 20 * faces);
    for x in mesh.positions().iter().flat_map(|p| p.to_array()) {
        match mesh.precision() {
            Precision::F32 => bytes.extend((x as f32).to_le_bytes()),
            Precision::F64 => bytes.extend(x.to_le_bytes()),
        }
    }
    for (corners, &v) in mesh.triangles().iter().zip(visibility.triangles()) {
        bytes.push(3);
        bytes.extend(corners.iter().flat_map(|c| c.to_le_bytes()));
        bytes.extend(color(v));
        bytes.extend((v as f32).to_le_bytes());
    }
    Ok(bytes)
}
