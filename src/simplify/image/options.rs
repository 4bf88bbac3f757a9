//! Options of the image-driven method.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::{super::memoryless::MemorylessOptions, Polish, Preset};
use crate::{
    Error, Result,
    mesh::{ChannelKind, FramedMesh, Mesh},
    num::Frame,
    view::{
        self, Interpolation, Projection, Shading, Specular, Sphere, ViewSet, ViewsName,
        sets::turned,
    },
};

/// Most samples of all driving images together; every one takes some ten bytes throughout the run.
const PIXEL_LIMIT: u64 = 1 << 27;

/// Most collapses by pictures where a recipe says where they begin.
const MOST_COLLAPSES: usize = 20_000;

/// The size at which the image-driven part of a run begins; the memoryless method gets there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Start {
    /// Ten times the target as in Table 1 of the paper for the bunny, but above 32,768 triangles no more than four
    /// times, as there for the dragon; 65,536 where only an error limits the run.
    #[default]
    Auto,
    /// This many times the target, but at most 20,000 triangles above it: of a large mesh pictures tell the last collapses
    /// apart, and hardly the first. As `Auto` where only an error limits the run.
    Times(f64),
    /// At this number of triangles.
    Triangles(u64),
    /// At the input itself.
    Input,
}

impl Start {
    /// The number of triangles for a target, `None` where only an error limits the run; `usize::MAX` for no
    /// pre-simplification.
    #[must_use]
    pub fn triangles(self, target: Option<usize>) -> usize {
        match (self, target) {
            (Self::Auto | Self::Times(_), None) => 65_536,
            (Self::Times(n), Some(target)) => {
                ((n * target as f64) as usize).min(target.saturating_add(MOST_COLLAPSES))
            }
            (Self::Auto, Some(target)) => target
                .saturating_mul(10)
                .min(target.saturating_mul(4).max(32_768)),
            (Self::Triangles(n), _) => usize::try_from(n).unwrap_or(usize::MAX),
            (Self::Input, _) => usize::MAX,
        }
    }
}

/// Width and height of the driving images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Size {
    /// A number of pixels, 1 to 4096.
    Pixels(u32),
    /// A number of pixels for every triangle of the target, besides those of a square of [`Size::LEAST`]; a multiple of 8
    /// and at most [`Size::MOST`] along each side. See [`Size::sampled`].
    PerTriangle {
        /// Pixels for a triangle.
        per_triangle: u32,
        /// Most samples along each side.
        most_samples: u32,
    },
}

impl Size {
    /// Smallest side that follows from the target.
    pub const LEAST: u32 = 64;

    /// Largest side that follows from the target, and that of runs without one.
    pub const MOST: u32 = 256;

    /// The side in pixels for a target; `None` where only an error limits the run.
    #[must_use]
    pub fn pixels(self, target: Option<usize>) -> u32 {
        match (self, target) {
            (Self::Pixels(n), _) => n,
            (Self::PerTriangle { .. }, None) => Self::MOST,
            (Self::PerTriangle { per_triangle, .. }, Some(target)) => {
                let own = u64::from(per_triangle).saturating_mul(target as u64);
                let area = own.saturating_add(u64::from(Self::LEAST).pow(2));
                let side = area.min(u64::from(Self::MOST).pow(2)).isqrt() as u32;
                side / 8 * 8
            }
        }
    }
}

impl Size {
    /// The side in pixels for a target, and the samples in a pixel along each axis, at most `samples`. A size that
    /// follows from the target has no more samples along a side than it says: beyond that a pixel is a sample. With
    /// so many, smaller pixels show more than those that are better sampled.
    #[must_use]
    pub fn sampled(self, target: Option<usize>, samples: u32) -> [u32; 2] {
        let side = self.pixels(target);
        match (self, target) {
            (Self::PerTriangle { most_samples, .. }, Some(_)) if side * samples > most_samples => {
                [most_samples.min(Self::MOST), 1]
            }
            _ => [side, samples],
        }
    }
}

impl From<u32> for Size {
    fn from(pixels: u32) -> Self {
        Self::Pixels(pixels)
    }
}

/// Shading of the driving views.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum DrivingShading {
    /// Lit where the mesh stores normals, else flat. A view file says its own.
    #[default]
    Auto,
    /// All flat.
    Flat,
    /// All Gouraud.
    Gouraud,
    /// The first, third, ... Gouraud, the others flat.
    Mixed,
    /// All with the normals that the mesh stores.
    Lit,
}

impl DrivingShading {
    /// The shading for a mesh: that which `Auto` stands for, by whether the mesh `stores_normals`.
    #[must_use]
    pub const fn resolved(self, stores_normals: bool) -> Self {
        match self {
            Self::Auto if stores_normals => Self::Lit,
            Self::Auto => Self::Flat,
            given => given,
        }
    }

    /// The shading of the view at `index`; flat where it has not been resolved.
    #[must_use]
    pub const fn of_view(self, index: usize) -> Interpolation {
        match self {
            Self::Auto | Self::Flat => Interpolation::Flat,
            Self::Lit => Interpolation::Lit,
            Self::Gouraud => Interpolation::Gouraud,
            Self::Mixed if index.is_multiple_of(2) => Interpolation::Gouraud,
            Self::Mixed => Interpolation::Flat,
        }
    }
}

/// The engine by which pictures find the surface behind a removed triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum EngineName {
    /// All fragments of every sample, sorted.
    #[default]
    Layers,
    /// Row and column buckets, section 4.2.3 of the paper: slower by far, with the same result.
    Buckets,
}

/// Options of the image-driven method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ImageOptions {
    /// The recipe that set the others; it decides nothing itself.
    pub preset: Preset,
    /// The views: `dodecahedron`, `rhombicuboctahedron`, `octahedron:K`, or a view file, which says its own size,
    /// shading and culling.
    #[serde(with = "views_text")]
    pub views: ViewsName,
    /// Width and height of every image; all views together have at most 2^27 samples.
    pub size: Size,
    /// Samples in a pixel along each axis: 1, 2 or 4, at most where the size follows from the target.
    #[serde(default = "one")]
    pub samples: u32,
    /// Flat, Gouraud, some of each, or lit.
    pub shading: DrivingShading,
    /// An optional specular term.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub specular: Option<Specular>,
    /// Views that cull fronts, so that interiors count (section 5.2).
    pub interior_views: usize,
    /// Where the image-driven part begins.
    pub start: Start,
    /// The engine by which pictures follow the mesh.
    pub engine: EngineName,
    /// Placement of the new vertex (section 4.1).
    pub placement: MemorylessOptions,
    /// Weight of the distance from the original that the volume swept by a collapse makes, as a share of the whole,
    /// against the share of the image error; 0 is the published method. See `ImageDriven::with_swept_price`.
    #[serde(default)]
    pub swept_weight: f64,
    /// Price edges by every n-th view until they come to the front of the queue, and only there by all views; 1 is the
    /// published method: all views at once, as where fewer than five views would be left. Even numbers see one half of
    /// mixed shading.
    #[serde(default = "one", rename = "glance")]
    pub view_stride: u32,
    /// Moves and flips after the last collapse.
    #[serde(default)]
    pub polish: Polish,
    /// Return the memoryless method's result where it looks better in views that drove neither. Only where nothing but
    /// a number of triangles or a ratio limits the run, and views from all around show the outside.
    #[serde(default)]
    pub fall_back: bool,
}

impl Default for ImageOptions {
    fn default() -> Self {
        Preset::default().options()
    }
}

impl ImageOptions {
    pub(super) fn check_ranges(&self) -> Result<()> {
        if let Size::Pixels(size) = self.size
            && (size == 0 || size > 4096)
        {
            return Err(Error::Usage(format!(
                "size is {size}; expected 1 to 4096 pixels"
            )));
        }
        if self.view_stride == 0 {
            return Err(Error::Usage(
                "glance is 0, every 0th view; expected 1 or more".into(),
            ));
        }
        if ![1, 2, 4].contains(&self.samples) {
            return Err(Error::Usage(format!(
                "{} samples per pixel along each axis; expected 1, 2 or 4",
                self.samples
            )));
        }
        for (name, weight) in [
            ("swept-weight", self.swept_weight),
            ("deviation-weight", self.polish.deviation_weight),
        ] {
            if !(0.0..f64::INFINITY).contains(&weight) {
                return Err(Error::Usage(format!(
                    "{name} is {weight}; expected a number that is not negative"
                )));
            }
        }
        if let Some(s) = self.specular {
            let strength = s.strength >= 0.0 && s.strength <= 1.0;
            if !strength || s.exponent == 0 {
                return Err(Error::Usage(format!(
                    "specular is {} with exponent {}; expected a strength from 0 to 1 and an exponent of at least 1",
                    s.strength, s.exponent
                )));
            }
        }
        Ok(())
    }

    /// The options for a target and a mesh: the size follows from the one, the shading from the other, with the weights
    /// that the preset has for it.
    pub(super) fn resolved(&self, target: Option<usize>, mesh: &Mesh) -> Self {
        let mut own = self.clone();
        let [side, samples] = self.size.sampled(target, self.samples);
        (own.size, own.samples) = (Size::Pixels(side), samples);
        let named = !matches!(self.views, ViewsName::File(_));
        let stored = mesh.attributes().channel(ChannelKind::Normal);
        own.follow(
            self.preset,
            self.shading.resolved(named && stored.is_some()),
        );
        own
    }

    /// Whether the result is held against the memoryless method's; `only_counted`: nothing limits the run but a number
    /// of triangles.
    pub(super) fn is_contested(&self, only_counted: bool) -> bool {
        let around = !matches!(self.views, ViewsName::File(_)) && self.interior_views == 0;
        self.fall_back && only_counted && around
    }

    /// The driving views onto `original`, which is in units of `frame`, turned as a whole for the given `round`; 0 is
    /// not turned, and view files never are. A size that follows from the target and a shading that follows from the mesh
    /// must have been resolved.
    ///
    /// # Errors
    /// [`Error::Usage`] for a mesh without triangles or more interior views than views; [`Error::Input`] and
    /// [`Error::Io`] for a view file; [`Error::Unsupported`] for more samples in all than 2^27.
    pub fn views(&self, original: &FramedMesh, frame: Frame, round: u32) -> Result<ViewSet> {
        let sphere = Sphere::of_mesh(original.in_frame_units())
            .ok_or_else(|| Error::Usage("a mesh without triangles has no views".into()))?;
        let size = self.size.pixels(None);
        let set = match self.views.directions() {
            Some(directions) => ViewSet::around(
                &sphere,
                &turned(&directions, round),
                size,
                size,
                Projection::Perspective,
            )?
            .with_samples(self.samples)?,
            None => view::resolve(&self.views, &sphere, [size; 2], Projection::Perspective)?,
        };
        let samples = u64::from(set.samples * set.samples);
        let pixels =
            set.views.len() as u64 * u64::from(set.width) * u64::from(set.height) * samples;
        if pixels > PIXEL_LIMIT {
            return Err(Error::Unsupported(format!(
                "{} driving images of {} x {} pixels with {samples} samples each do not fit into memory; expected at \
                 most {PIXEL_LIMIT} samples in all, so choose fewer or smaller images",
                set.views.len(),
                set.width,
                set.height
            )));
        }
        if let ViewsName::File(_) = &self.views {
            return Ok(set.enter_frame(frame));
        }
        let mut set = set;
        for (i, view) in set.views.iter_mut().enumerate() {
            view.shading = Shading {
                interpolation: self.shading.of_view(i),
                specular: self.specular,
                ..Shading::default()
            };
        }
        set.with_interior_views(self.interior_views)
    }
}

fn one() -> u32 {
    1
}

/// `views` as the text of the command line.
mod views_text {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    use super::{FromStr, ViewsName};

    pub(super) fn serialize<S: Serializer>(
        views: &ViewsName,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_str(views)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<ViewsName, D::Error> {
        ViewsName::from_str(&String::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}
