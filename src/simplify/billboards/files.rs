//! A billboard cloud as files: an OBJ mesh with its material library, and a PNG texture per quad.
//!
//! Textures are written before what names them, the mesh last: whoever finds a new mesh finds all it needs. Positions
//! are doubles, because a bound is lost where a quad moves by more than its faces may.

use std::path::{Path, PathBuf};

use super::Cloud;
use crate::{
    Error, Progress, Result,
    encode::{atomic, png},
    io,
    mesh::{Attributes, ChannelKind, Materials, Mesh, MeshParts},
    num::Precision,
    parallel,
};

/// The mesh of a cloud: two triangles per quad with texture coordinates and a material, then the triangles that stay.
///
/// # Errors
/// [`Error::Internal`] where it is no mesh, which is a bug.
pub fn mesh(cloud: &Cloud, original: &Mesh) -> Result<Mesh> {
    let mut parts = MeshParts {
        precision: Precision::F64,
        ..MeshParts::default()
    };
    let mut wedges = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let mut corners = Vec::new();
    for (i, quad) in cloud.quads.iter().enumerate() {
        let first = parts.positions.len() as u32;
        parts.positions.extend(quad.corners());
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            parts.triangles.push([first + a, first + b, first + c]);
            corners.push([a, b, c]);
            parts.materials.of_triangle.push(i as u32);
        }
        parts.materials.names.push(name(i));
    }
    wedges.extend([f64::NAN; 2]);
    for &t in &cloud.kept {
        let first = parts.positions.len() as u32;
        parts.positions.extend(original.corners(t as usize));
        parts.triangles.push([first, first + 1, first + 2]);
        corners.push([4; 3]);
        parts.materials.of_triangle.push(Materials::NONE);
    }
    if cloud.quads.is_empty() {
        parts.materials = Materials::default();
    } else {
        parts.materials.libraries.push(LIBRARY.into());
        let uv = Attributes::new(&[ChannelKind::TexCoord(0)], wedges, corners);
        parts.attributes = uv.map_err(Error::internal)?;
    }
    Mesh::new(parts).map_err(Error::internal)
}

const LIBRARY: &str = "billboards.mtl";

fn name(quad: usize) -> String {
    format!("quad-{quad:04}")
}

/// Writes `billboards.obj`, `billboards.mtl` and `quad-NNNN.png` into a folder, which is made if missing; files of these
/// names are replaced, each as a whole. Gives the path of the mesh.
///
/// # Errors
/// [`Error::Io`], or [`Error::Interrupted`] with the mesh of an earlier run untouched.
pub fn write(
    folder: &Path,
    cloud: &Cloud,
    original: &Mesh,
    progress: &dyn Progress,
) -> Result<PathBuf> {
    std::fs::create_dir_all(folder).map_err(|e| Error::io("create", folder, e))?;
    let total = cloud.quads.len() as u64;
    let done = std::sync::atomic::AtomicU64::new(0);
    parallel::try_map(cloud.quads.len(), |i| {
        let before = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        progress.step("draw textures", before, total)?;
        let texture = cloud.quads[i].texture(original);
        png::write_rgba(&folder.join(format!("{}.png", name(i))), &texture)
    })?;
    let material = |i| {
        let name = name(i);
        format!(
            "newmtl {name}\nKa 0 0 0\nKd 1 1 1\nillum 1\nmap_Kd {name}.png\nmap_d -imfchan m {name}.png\n\n"
        )
    };
    let library: String = (0..cloud.quads.len()).map(material).collect();
    let path = folder.join(LIBRARY);
    atomic::write(&path, |file| file.write_all(library.as_bytes()))?;
    let path = folder.join("billboards.obj");
    io::write(&path, &mesh(cloud, original)?)?;
    Ok(path)
}
