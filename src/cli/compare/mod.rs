//! `lodmark compare`: how far results are from a reference, in pictures and in space.
//!
//! Meshes are judged as Lindstrom & Turk 2000, section 5 does: 24 views of 512 x 512 pixels around the reference, with
//! 2 x 2 samples each, flat, Gouraud, and lit where both store normals. Two images are equal, or it is said where and how much they are not.

mod images;
mod mesh_table;
mod meshes;
mod sheets;

use std::path::{Path, PathBuf};

use super::{Common, Verdict, file_help, has_extension, terminal::Terminal};
use crate::{Error, Result, metric::surface::DEFAULT_SAMPLES, view::ViewsName};

/// Measure how far meshes or images are from a reference
#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("pictures").multiple(true)))]
#[command(after_long_help = file_help::paragraphs(&["\
Meshes are equal where their files hold the same: vertices, triangles and attributes in the same order, before \
welding. Distances go both ways, and the larger one is reported; in the table as % of the diagonal of the reference's \
bounding box, in the report in file units as well. PSNR is `-` (in the report: null) where nothing differs.

The report has, for every candidate: rms_flat, rms_gouraud, psnr_flat, psnr_gouraud, squared_error_* (sum, pixels, \
samples); the same with _lit, with the normals that the meshes store, null where one of them stores none; worst, distance_mean, distance_rms, distance_max, views[]; with --image-error also image_error: error (the \
root of the summed squared differences in levels, equation 5.11 of Zhang & Turk 2002), rms (the same per pixel, \
comparable between sizes), squared_error, views (20).", &file_help::views()]))]
pub(super) struct CompareArgs {
    /// The reference: a mesh (.obj, .ply, .stl, .glb, .gltf) or an image (.png; .npy of ids or depths)
    #[arg(value_name = "REF")]
    reference: PathBuf,
    /// The candidates to compare with it, of the same kind
    #[arg(value_name = "CAND", required = true)]
    candidates: Vec<PathBuf>,
    /// dodecahedron, rhombicuboctahedron, octahedron:K, or a view file [default: rhombicuboctahedron]
    #[arg(long, value_name = "SET|FILE")]
    views: Option<ViewsName>,
    /// Width and height of the images [default: 512]
    #[arg(long, value_name = "PIXELS")]
    size: Option<u32>,
    /// Samples per pixel along each axis: 1, 2 or 4 [default: 2]
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// Points on each surface that distances are measured at [default: 500000]
    #[arg(long, value_name = "N", conflicts_with = "no_distance", value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    distance_samples: Option<u32>,
    /// Do not measure distances
    #[arg(long)]
    no_distance: bool,
    /// Measure equation 5.11 of Zhang & Turk 2002 too: flat, from the 20 corners of a dodecahedron
    #[arg(long)]
    image_error: bool,
    /// Print every view
    #[arg(long)]
    per_view: bool,
    /// Exit with code 1 unless every candidate equals the reference
    #[arg(long)]
    equal: bool,
    /// Exit with code 1 unless every RMS, flat, Gouraud and lit, is at most this many levels, 0 to 255
    #[arg(long, value_name = "LEVELS", allow_negative_numbers = true)]
    max_rms: Option<f64>,
    /// Write expected, actual and difference of the worst view of every candidate, one row each
    #[arg(long, value_name = "FILE.png", group = "pictures")]
    difference: Option<PathBuf>,
    /// Write a sheet for every view: the reference and the candidates, flat, and above each the reference with the
    /// differences in red (Zhang & Turk 2002, Figure 8)
    #[arg(long, value_name = "DIR", group = "pictures")]
    red_differences: Option<PathBuf>,
    /// Factor by which pictures exaggerate differences, 1 to 255 [default: 2]
    #[arg(long, value_name = "FACTOR", requires = "pictures", value_parser = clap::value_parser!(u8).range(1..))]
    difference_scale: Option<u8>,
}

pub(super) fn run(options: &CompareArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    options.check()?;
    let mut images = options.files().map(is_image);
    let first = images.next() == Some(true);
    if images.any(|image| image != first) {
        return Err(Error::Usage(
            "an image cannot be compared with a mesh; give only images (.png, .npy) or only meshes (.obj, .ply, .stl, .glb, .gltf)"
                .into(),
        ));
    }
    if first {
        images::run(options, common, terminal)
    } else {
        meshes::run(options, common, terminal)
    }
}

impl CompareArgs {
    /// The reference, then the candidates.
    fn files(&self) -> impl Iterator<Item = &Path> {
        let all = std::iter::once(&self.reference).chain(&self.candidates);
        all.map(PathBuf::as_path)
    }

    /// Refuses values without a meaning, before anything is read.
    fn check(&self) -> Result<()> {
        if let Some(rms) = self.max_rms.filter(|r| !(0.0..=255.0).contains(r)) {
            let told = format!("max-rms is {rms}; expected a number from 0 to 255");
            return Err(Error::Usage(told));
        }
        match &self.difference {
            Some(path) if !has_extension(path, "png") => Err(Error::Usage(format!(
                "{}: the difference is written as a PNG picture; expected a name that ends in .png",
                path.display()
            ))),
            _ => Ok(()),
        }
    }

    fn distance_samples(&self) -> Option<u32> {
        (!self.no_distance).then(|| self.distance_samples.unwrap_or(DEFAULT_SAMPLES))
    }

    /// True where any picture is asked for.
    fn pictured(&self) -> bool {
        self.difference.is_some() || self.red_differences.is_some()
    }

    fn difference_scale(&self) -> u8 {
        self.difference_scale.unwrap_or(2)
    }

    /// True where the demands hold for a candidate; `rms` is `None` where there is none.
    fn holds(&self, equal: bool, rms: Option<f64>) -> bool {
        let near = |limit: f64| rms.is_some_and(|rms| rms <= limit);
        (equal || !self.equal) && self.max_rms.is_none_or(near)
    }
}

fn is_image(path: &Path) -> bool {
    has_extension(path, "png") || has_extension(path, "npy")
}

/// The findings of one candidate at the top of a report, those of several in a list.
#[derive(Debug, serde::Serialize)]
#[serde(untagged)]
enum Found<T> {
    One(T),
    Several { candidates: Vec<T> },
}

impl<T> Found<T> {
    fn new(mut all: Vec<T>) -> Self {
        match all.len() {
            1 => Self::One(all.remove(0)),
            _ => Self::Several { candidates: all },
        }
    }

    fn as_slice(&self) -> &[T] {
        match self {
            Self::One(only) => std::slice::from_ref(only),
            Self::Several { candidates } => candidates,
        }
    }
}
