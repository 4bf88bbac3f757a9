//! Presets: recipes that set several options at once, each with what it buys and costs.
//!
//! What was tried: samples are better spent on views and on 2 x 2 samples per pixel than on resolution, because polishing
//! fits the noise of pictures with one sample; with polishing, 1.7 times the target is as good a start for the pictures as
//! four times; two sweeps of polishing take two thirds of the time of four and leave 1 % more error; flips after every sweep are worth their cost. On the bunny at 1,333 triangles weighing the deviation took
//! 6 % off the mean distance and added 0.1 % to the judged error.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{ImageOptions, Polish, Size, Start};
use crate::{collapse::Schedule, view::ViewsName};

/// A recipe for image-driven simplification. Sides of pictures are those for 1,333 triangles; see [`Size`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Preset {
    /// The published method to the letter: 20 views of 256 x 256 pixels, lazy evaluation, no polishing.
    Paper,
    /// 30 views of 72 x 72 pixels, images from 1.35 times the target, one sweep of polishing.
    Fast,
    /// 42 views of 96 x 96 pixels, images from 1.7 times the target, two sweeps of polishing.
    #[default]
    Default,
    /// 56 views of 120 x 120 pixels, images from 2.5 times the target, twelve sweeps, cameras turned twice.
    Best,
}

impl Preset {
    /// When edges are evaluated again. The published method is lazy; evaluating the edges of a new vertex at once
    /// notices costs that fall.
    #[must_use]
    pub const fn schedule(self) -> Schedule {
        match self {
            Self::Paper => Schedule::Lazy,
            Self::Fast | Self::Default | Self::Best => Schedule::Semi,
        }
    }

    /// The options of the recipe.
    #[must_use]
    pub fn options(self) -> ImageOptions {
        let recipe = |views, per_triangle, start, polish| ImageOptions {
            preset: self,
            views: ViewsName::Spiral(views),
            size: Size::PerTriangle { per_triangle },
            samples: 2,
            start: Start::Times(start),
            polish,
            fall_back: true,
            ..Self::Paper.options()
        };
        let polish = |sweeps, cameras_every, deviation_weight| Polish {
            sweeps,
            flips_every: 1,
            cameras_every,
            deviation_weight,
        };
        match self {
            Self::Paper => ImageOptions {
                preset: self,
                views: ViewsName::Dodecahedron,
                size: Size::Pixels(256),
                samples: 1,
                shading: super::DrivingShading::Flat,
                specular: None,
                interior_views: 0,
                start: Start::Auto,
                engine: super::EngineName::default(),
                placement: super::super::memoryless::MemorylessOptions::default(),
                polish: Polish::default(),
                fall_back: false,
            },
            Self::Fast => recipe(30, 1, 1.35, polish(1, 0, 0.5)),
            Self::Default => recipe(42, 4, 1.7, polish(2, 0, 0.5)),
            Self::Best => recipe(56, 9, 2.5, polish(12, 4, 0.25)),
        }
    }
}

impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Paper => "paper",
            Self::Fast => "fast",
            Self::Default => "default",
            Self::Best => "best",
        })
    }
}
