//! `lodmark render`: reference images.

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::{Common, Verdict, file_help, input, report, terminal::Terminal};
use crate::{
    Error, Progress, Result,
    encode::{atomic, hash, npy, png},
    raster::{self, Picture, Scene},
    view::{
        self, Cull, Interpolation, Projection, Shading, Sphere, ViewSet, ViewsName,
        file::ImageHashes, frame_of,
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
    /// Flat or Gouraud [default: flat]
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
        let projection = if self.orthographic {
            Projection::Orthographic
        } else {
            Projection::Perspective
        };
        let mut set = view::resolve(
            &self.views,
            sphere,
            [self.size.unwrap_or(256); 2],
            projection,
        )?;
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
            return Ok(set);
        }
        if let Some(bits) = self.subpixel_bits {
            set.subpixel = bits.try_into().map_err(Error::Usage)?;
        }
        set.with_shading(Shading {
            interpolation: self.shading.unwrap_or_default(),
            ..Shading::default()
        })
        .with_cull(self.cull.unwrap_or_default())
        .with_samples(self.samples.unwrap_or(1))
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
                let sums = raster::sum_samples(&picture.luma(), samples);
                let luma = raster::mean_luma(&sums, samples);
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
    let frame = frame_of(&mesh);
    let sphere = Sphere::of_mesh(&mesh)
        .ok_or_else(|| Error::Internal("a mesh with triangles has a bounding sphere".into()))?;
    let set = options.set(&sphere)?;
    let (framed, scene) = (set.enter_frame(frame), Scene::of(&mesh.enter_frame(frame)));
    std::fs::create_dir_all(&options.folder)
        .map_err(|e| Error::io("create", &options.folder, e))?;
    let mut hashes = Vec::new();
    let mut dropped = 0;
    for (i, view) in framed.views.iter().enumerate() {
        terminal.step("render", i as u64, framed.views.len() as u64)?;
        let picture = raster::rgb(&scene, view, &framed);
        dropped += picture.dropped;
        let mut own = ImageHashes::default();
        for &buffer in &options.buffer {
            let file = options.folder.join(buffer.file_name(i));
            buffer.write(&file, &picture, framed.samples, &mut own)?;
        }
        hashes.push(own);
    }
    if dropped > 0 {
        terminal.say(&format!(
            "{dropped} triangles were not drawn: a coordinate is not finite in a view"
        ));
    }
    let scene = view::file::to_json(&set, &hashes)?;
    atomic::write(&options.folder.join("scene.json"), |file| {
        file.write_all(scene.as_bytes())
    })?;
    let positions: Vec<[f64; 3]> = mesh.positions().iter().map(|p| p.to_array()).collect();
    npy::write_rows(&options.folder.join("positions.npy"), &positions)?;
    npy::write_rows(&options.folder.join("indices.npy"), mesh.triangles())?;
    let resolved =
        serde_json::json!({ "input": options.input, "views": options.views.to_string() });
    report(
        common,
        "render",
        resolved,
        serde_json::json!({ "folder": options.folder, "dropped": dropped }),
    )?;
    answer!(
        "{}: {} views of {} x {} pixels",
        options.folder.display(),
        set.views.len(),
        set.width,
        set.height
    );
    Ok(Verdict::Good)
}
