//! `lodmark render`: reference images.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use serde_json::json;

use super::{Common, Verdict, file_help, input, report, terminal::Terminal};
use crate::{
    Error, Result,
    encode::{atomic, hash, npy, png},
    front::{
        options::RenderOptions,
        render::{draw, luma, write_scene},
    },
    raster::{self, Picture},
    view::{
        Cull, Interpolation, Projection, Shading, Sphere, ViewSet, ViewsName, file::ImageHashes,
    },
};

/// Draw reference images of a mesh, with the views as a file that others can draw from
#[derive(Debug, clap::Args)]
#[command(after_long_help = file_help::views())]
pub(super) struct RenderArgs {
    /// The mesh: .obj, .ply, .stl, .glb or .gltf; ids are 1 + the number of the triangle in the file
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Folder for view-NN-BUFFER.png (ids and depth: .npy) and scene.json; made if missing
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// dodecahedron, rhombicuboctahedron, octahedron:K, or a view file
    #[arg(long, value_name = "SET|FILE", default_value = "dodecahedron")]
    views: ViewsName,
    /// Width and height of the images [default: 256]
    #[arg(long, value_name = "PIXELS")]
    size: Option<u32>,
    /// Samples per pixel along each axis: 1, 2 or 4 [default: 1]
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// Buffers to write
    #[arg(long, value_enum, value_delimiter = ',', default_value = "luma")]
    buffer: Vec<Buffer>,
    /// Flat, Gouraud, or lit: with the normals that the mesh stores [default: flat]
    #[arg(long, value_enum)]
    shading: Option<Interpolation>,
    /// The side of triangles that is left out [default: none]
    #[arg(long, value_enum)]
    cull: Option<Cull>,
    /// Orthographic instead of perspective views
    #[arg(long)]
    orthographic: bool,
    /// Sub-pixel bits: 8 or 16 [default: 8]
    #[arg(long, value_name = "BITS")]
    subpixel_bits: Option<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Buffer {
    /// Grey levels
    Luma,
    /// Red, green, blue
    Rgb,
    /// Triangle + 1, 0 for the background, as 32-bit .npy
    Ids,
    /// Depth in units of 2^-32, as 32-bit .npy
    Depth,
    /// 255 where a triangle is
    Coverage,
}

impl RenderArgs {
    fn set(&self, sphere: &Sphere) -> Result<ViewSet> {
        let default = RenderOptions::default();
        let wanted = RenderOptions {
            views: self.views.clone(),
            size: self.size.unwrap_or(default.size),
            samples: self.samples.unwrap_or(default.samples),
            projection: Projection::of(self.orthographic),
            shading: Shading {
                interpolation: self.shading.unwrap_or_default(),
                ..default.shading
            },
            cull: self.cull.unwrap_or(default.cull),
            subpixel: default.subpixel,
        };
        let mut set = wanted.view_set(sphere)?;
        if let ViewsName::File(path) = &self.views {
            let given = self.size.is_some()
                || self.shading.is_some()
                || self.cull.is_some()
                || self.orthographic;
            if given || self.samples.is_some() || self.subpixel_bits.is_some() {
                return Err(Error::Usage(format!(
                    "size, samples, shading, culling, projection and sub-pixel bits are part of the view file {}; \
                     leave them out",
                    path.display()
                )));
            }
        }
        if let Some(bits) = self.subpixel_bits {
            set.subpixel = bits.try_into().map_err(Error::Usage)?;
        }
        Ok(set)
    }
}

impl Buffer {
    fn file_name(self, view: usize) -> String {
        let name = self.to_possible_value();
        let name = name.as_ref().map_or("", |value| value.get_name());
        let extension = match self {
            Self::Luma | Self::Rgb | Self::Coverage => "png",
            Self::Ids | Self::Depth => "npy",
        };
        format!("view-{view:02}-{name}.{extension}")
    }

    /// Writes the buffer of a picture, and notes the hash of what others compare bit by bit.
    fn write(
        self,
        file: &Path,
        picture: &Picture<[u8; 3]>,
        samples: u32,
        hashes: &mut ImageHashes,
    ) -> Result<()> {
        match self {
            Self::Luma => {
                let luma = luma(picture, samples);
                hashes.insert("luma".into(), hash::plane_sha256(&luma));
                png::write_grey(file, &luma)
            }
            Self::Rgb => png::write_rgb(file, &raster::mean_rgb(&picture.tones, samples)),
            Self::Ids => {
                let ids = raster::ids(picture);
                hashes.insert("ids".into(), hash::plane_sha256(&ids));
                npy::write_plane(file, &ids)
            }
            Self::Depth => {
                let depths = raster::depths(picture);
                hashes.insert("depth".into(), hash::plane_sha256(&depths));
                npy::write_plane(file, &depths)
            }
            Self::Coverage => png::write_grey(file, &raster::coverage(picture)),
        }
    }
}

pub(super) fn run(options: &RenderArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let mesh = input::read(&options.input, true, terminal)?;
    input::require_triangles(&options.input, &mesh)?;
    let sphere = Sphere::of_mesh(&mesh)
        .ok_or_else(|| Error::Internal("a mesh with triangles has a bounding sphere".into()))?;
    let set = options.set(&sphere)?;
    let folder = &options.folder;
    atomic::folder(folder)?;
    let mut hashes = Vec::new();
    let dropped = draw(&mesh, &set, terminal, |i, picture| {
        let mut own = ImageHashes::default();
        for &buffer in &options.buffer {
            let file = folder.join(buffer.file_name(i));
            buffer.write(&file, picture, set.samples, &mut own)?;
        }
        hashes.push(own);
        Ok(())
    })?;
    if dropped > 0 {
        terminal.say(&format!(
            "{dropped} triangles were not drawn: a coordinate is not finite in a view"
        ));
    }
    write_scene(folder, &set, &hashes)?;
    let positions: Vec<[f64; 3]> = mesh.positions().iter().map(|p| p.to_array()).collect();
    npy::write_rows(&folder.join("positions.npy"), &positions)?;
    npy::write_rows(&folder.join("indices.npy"), mesh.triangles())?;
    let resolved = json!({ "input": options.input, "views": options.views.to_string() });
    let written = json!({ "folder": folder, "dropped": dropped });
    report(common, "render", resolved, written)?;
    let (folder, count, width, height) = (folder.display(), set.views.len(), set.width, set.height);
    answer!("{folder}: {count} views of {width} x {height} pixels");
    Ok(Verdict::Good)
}
