//! Sets of views: which directions, how large, how they differ; and their names on the command line.

use std::{fmt, path::PathBuf, str::FromStr};

use glam::DVec3;

use super::{
    Cull, Projection, Shading, Sphere, View, ViewSet,
    directions::{
        OCTAHEDRON_LIMIT, SPIRAL_LIMIT, dodecahedron, octahedron, rhombicuboctahedron, spiral,
    },
    file,
};
use crate::{Error, Result, num::fixed::SubpixelBits};

/// Largest number of samples in a row or column of an image: what the fixed-point rasterizer has bits for.
pub const SIDE_LIMIT: u32 = 4_096;

/// The 50 % grey behind every model (Lindstrom & Turk 2000, section 3.2).
pub const BACKGROUND: u8 = 128;

impl ViewSet {
    /// Views onto `sphere` from `directions` (towards the viewer, of any length), in pixels of one sample, with 8
    /// sub-pixel bits on 50 % grey; placed and rolled as [`View::around`] says.
    ///
    /// # Errors
    /// [`Error::Usage`] where there is no direction, one has no length, the size is refused by
    /// [`ViewSet::check_size`], or the sphere is too large for numbers to stay finite.
    pub fn around(
        sphere: &Sphere,
        directions: &[DVec3],
        width: u32,
        height: u32,
        projection: Projection,
    ) -> Result<Self> {
        let count = directions.len();
        let views: Option<Vec<View>> = directions
            .iter()
            .enumerate()
            .map(|(i, &d)| View::around(sphere, d, [i, count], [width, height], projection))
            .collect();
        let views = views.filter(|views| !views.is_empty()).ok_or_else(|| {
            Error::Usage(format!(
                "no views of {width} x {height} pixels from {count} directions onto a sphere of radius {:e} around \
                 ({:e}, {:e}, {:e}); expected at least one pixel and one direction, none of them zero, and a sphere that \
                 is neither too small nor too large for doubles",
                sphere.radius, sphere.center.x, sphere.center.y, sphere.center.z
            ))
        })?;
        let set = Self {
            width,
            height,
            samples: 1,
            subpixel: SubpixelBits::Eight,
            background: BACKGROUND,
            views,
        };
        set.check_size()?;
        Ok(set)
    }

    /// The 20 views that edge costs are measured in: dodecahedron, 256 x 256 pixels, one sample.
    ///
    /// # Errors
    /// [`Error::Usage`] where the sphere is too large for numbers to stay finite; never in the working frame.
    pub fn costs(sphere: &Sphere) -> Result<Self> {
        Self::around(sphere, &dodecahedron(), 256, 256, Projection::Perspective)
    }

    /// The 24 views that results are judged in: small rhombicuboctahedron, 512 x 512 pixels of 2 x 2 samples.
    ///
    /// # Errors
    /// As [`ViewSet::costs`].
    pub fn evaluation(sphere: &Sphere) -> Result<Self> {
        Self::around(
            sphere,
            &rhombicuboctahedron(),
            512,
            512,
            Projection::Perspective,
        )?
        .with_samples(2)
    }

    /// With `samples` x `samples` samples per pixel.
    ///
    /// # Errors
    /// As [`ViewSet::check_size`].
    pub fn with_samples(mut self, samples: u32) -> Result<Self> {
        self.samples = samples;
        self.check_size()?;
        Ok(self)
    }

    /// With another sub-pixel grid.
    #[must_use]
    pub fn with_subpixel(mut self, subpixel: SubpixelBits) -> Self {
        self.subpixel = subpixel;
        self
    }

    /// With `shading` in every view.
    #[must_use]
    pub fn with_shading(mut self, shading: Shading) -> Self {
        for view in &mut self.views {
            view.shading = shading;
        }
        self
    }

    /// With `cull` in every view.
    #[must_use]
    pub fn with_cull(mut self, cull: Cull) -> Self {
        for view in &mut self.views {
            view.cull = cull;
        }
        self
    }

    /// With fronts culled in `count` of the views, spread evenly over their order, so that these show interiors
    /// (Lindstrom & Turk 2000, section 5.2).
    ///
    /// # Errors
    /// [`Error::Usage`] where there are fewer views.
    pub fn with_interior_views(mut self, count: usize) -> Result<Self> {
        let total = self.views.len();
        if count > total {
            return Err(Error::Usage(format!(
                "{count} interior views of {total}; expected at most {total}"
            )));
        }
        for (i, view) in self.views.iter_mut().enumerate() {
            if (i + 1) * count / total > i * count / total {
                view.cull = Cull::Front;
            }
        }
        Ok(self)
    }

    /// Refuses sizes that the rasterizer has no bits for.
    ///
    /// # Errors
    /// [`Error::Usage`] unless `samples` is 1, 2 or 4 and each side has 1 to [`SIDE_LIMIT`] samples.
    pub fn check_size(&self) -> Result<()> {
        let (width, height, samples) = (self.width, self.height, self.samples);
        if ![1, 2, 4].contains(&samples) {
            return Err(Error::Usage(format!(
                "{samples} samples per pixel along each axis; expected 1, 2 or 4"
            )));
        }
        let limit = SIDE_LIMIT / samples;
        if width == 0 || height == 0 || width > limit || height > limit {
            return Err(Error::Usage(format!(
                "images of {width} x {height} pixels; expected sides of 1 to {limit} pixels with {samples} x \
                 {samples} samples each"
            )));
        }
        Ok(())
    }

    /// The same views of the same scene in units of `frame`; the images are the same, bit for bit.
    #[must_use]
    pub fn enter_frame(&self, frame: crate::num::Frame) -> Self {
        Self {
            views: self.views.iter().map(|v| v.enter_frame(frame)).collect(),
            ..self.clone()
        }
    }

    /// Undoes [`ViewSet::enter_frame`].
    #[must_use]
    pub fn leave_frame(&self, frame: crate::num::Frame) -> Self {
        Self {
            views: self.views.iter().map(|v| v.leave_frame(frame)).collect(),
            ..self.clone()
        }
    }
}

/// The value of `--views`: `dodecahedron`, `rhombicuboctahedron`, `octahedron:K`, `spiral:N` or a view file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ViewsName {
    /// 20 directions.
    Dodecahedron,
    /// 24 directions.
    Rhombicuboctahedron,
    /// 4^(k+1) + 2 directions, k at most [`OCTAHEDRON_LIMIT`].
    Octahedron(u32),
    /// This many directions along a spiral, 1 to [`SPIRAL_LIMIT`].
    Spiral(u32),
    /// The views in a JSON file; see [`mod@file`].
    File(PathBuf),
}

impl ViewsName {
    /// The directions of a named set; `None` for a file, whose views are complete.
    #[must_use]
    pub fn directions(&self) -> Option<Vec<DVec3>> {
        match self {
            Self::Dodecahedron => Some(dodecahedron()),
            Self::Rhombicuboctahedron => Some(rhombicuboctahedron()),
            Self::Octahedron(k) => Some(octahedron(*k)),
            Self::Spiral(n) => Some(spiral(*n)),
            Self::File(_) => None,
        }
    }
}

impl fmt::Display for ViewsName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dodecahedron => f.write_str("dodecahedron"),
            Self::Rhombicuboctahedron => f.write_str("rhombicuboctahedron"),
            Self::Octahedron(k) => write!(f, "octahedron:{k}"),
            Self::Spiral(n) => write!(f, "spiral:{n}"),
            Self::File(path) => write!(f, "{}", path.display()),
        }
    }
}

impl FromStr for ViewsName {
    type Err = Error;

    /// A name, or anything else that looks like a file: with a `.` or a path separator in it.
    fn from_str(text: &str) -> Result<Self> {
        let refused = |what: String| {
            Error::Usage(format!(
                "{what}; expected dodecahedron, rhombicuboctahedron, octahedron:K with K from 0 to \
                 {OCTAHEDRON_LIMIT}, spiral:N with N from 1 to {SPIRAL_LIMIT}, or a view file such as views.json"
            ))
        };
        match text {
            "dodecahedron" => Ok(Self::Dodecahedron),
            "rhombicuboctahedron" => Ok(Self::Rhombicuboctahedron),
            _ => {
                if let Some(k) = text.strip_prefix("octahedron:") {
                    return match k.parse() {
                        Ok(k) if k <= OCTAHEDRON_LIMIT => Ok(Self::Octahedron(k)),
                        _ => Err(refused(format!("octahedron:K with K = `{k}`"))),
                    };
                }
                if let Some(n) = text.strip_prefix("spiral:") {
                    return match n.parse() {
                        Ok(n) if (1..=SPIRAL_LIMIT).contains(&n) => Ok(Self::Spiral(n)),
                        _ => Err(refused(format!("spiral:N with N = `{n}`"))),
                    };
                }
                if text.contains(['.', '/', '\\']) {
                    Ok(Self::File(text.into()))
                } else {
                    Err(refused(format!("no views are called `{text}`")))
                }
            }
        }
    }
}

/// Reads the views that `name` stands for: from its file, in file units, or placed around `sphere`.
///
/// `width`, `height` and `projection` hold for named sets only; a file says its own.
///
/// # Errors
/// As [`ViewSet::around`] and [`file::read`].
pub fn resolve(
    name: &ViewsName,
    sphere: &Sphere,
    [width, height]: [u32; 2],
    projection: Projection,
) -> Result<ViewSet> {
    match name {
        ViewsName::File(path) => file::read(path),
        named => ViewSet::around(
            sphere,
            &named.directions().unwrap_or_default(),
            width,
            height,
            projection,
        ),
    }
}
