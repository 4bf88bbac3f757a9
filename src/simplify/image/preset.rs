//! Presets: recipes that set several options at once, each with its gain and its cost.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{DrivingShading, ImageOptions, Polish, Size, Start};
use crate::{collapse::Schedule, view::ViewsName};

/// A recipe for image-driven simplification. Sides of pictures are those for 1,333 triangles; see [`Size`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
pub enum Preset {
    /// The published method to the letter: 20 views of 256 x 256 pixels, lazy evaluation, no polishing.
    Paper,
    /// 30 views of 72 x 72 pixels, images from 1.3 times the target, one sweep of polishing.
    Fast,
    /// 42 views of 96 x 96 pixels, images from 2.2 times the target, two sweeps of polishing.
    #[default]
    Default,
    /// 56 views of 120 x 120 pixels, images from 2.5 times the target, eight sweeps, cameras turned twice.
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
        let recipe =
            |views, [per_triangle, most_samples]: [u32; 2], start, swept_weight, polish| {
                ImageOptions {
                    preset: self,
                    views: ViewsName::Spiral(views),
                    size: Size::PerTriangle {
                        per_triangle,
                        most_samples,
                    },
                    // Better than more pixels: polishing fits the noise of pictures with one sample.
                    samples: 2,
                    shading: DrivingShading::Auto,
                    start: Start::Times(start),
                    swept_weight,
                    // Less than half of the drawing before polishing, for less than 0.4 % of error and distance either way.
                    view_stride: 3,
                    polish,
                    fall_back: true,
                    ..Self::Paper.options()
                }
            };
        let polish = |sweeps, cameras_every, deviation_weight, least_share| Polish {
            sweeps,
            least_share,
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
                shading: DrivingShading::Flat,
                specular: None,
                interior_views: 0,
                start: Start::Auto,
                engine: super::EngineName::default(),
                placement: super::super::memoryless::MemorylessOptions::default(),
                swept_weight: 0.0,
                view_stride: 1,
                polish: Polish::default(),
                fall_back: false,
            },
            Self::Fast => recipe(30, [1, 256], 1.3, 0.7, polish(1, 0, 1.0, 1.5e-4)),
            // The dragon at 8,191 triangles: flat RMS 8.40, mean distance 0.0235 % of the diagonal (memoryless: 10.05,
            // 0.0236).
            Self::Default => recipe(42, [4, 256], 2.2, 0.95, polish(2, 0, 1.0, 1.5e-4)),
            Self::Best => recipe(56, [9, 512], 2.5, 0.2, polish(8, 3, 0.25, 1e-5)),
        }
    }
}

/// The largest weight of the deviation where pictures drive that interpolate intensities.
const SMOOTH_DEVIATION: f64 = 0.25;

impl Preset {
    /// The options of the recipe for driving pictures that are shaded so. Where some are not flat the surface weighs less:
    /// they show its normals rather than itself (measured: the full weights cost 3 % of the Gouraud RMS of the bunny at 1,333
    /// triangles with mixed shading, and 5 % of the lit RMS of the DamagedHelmet at 1,545).
    #[must_use]
    pub fn shaded(self, shading: DrivingShading) -> ImageOptions {
        let mut options = ImageOptions {
            shading,
            ..self.options()
        };
        if !matches!(shading, DrivingShading::Auto | DrivingShading::Flat) {
            options.swept_weight = 0.0;
            let weight = &mut options.polish.deviation_weight;
            *weight = weight.min(SMOOTH_DEVIATION);
        }
        options
    }
}

impl ImageOptions {
    /// Goes on to another recipe or shading: every option that has the value of the recipe so far gets that of the new
    /// one.
    pub(in super::super) fn follow(&mut self, preset: Preset, shading: DrivingShading) {
        fn keep<T: PartialEq>(own: &mut T, old: T, new: T) {
            if *own == old {
                *own = new;
            }
        }
        macro_rules! follow {
            ($own:expr, $old:expr, $new:expr; $($field:ident)+) => {
                $(keep(&mut $own.$field, $old.$field, $new.$field);)+
            };
        }
        let (old, new) = (self.preset.shaded(self.shading), preset.shaded(shading));
        (self.preset, self.shading) = (preset, shading);
        follow!(self, old, new; views size samples specular interior_views start engine placement);
        follow!(self, old, new; swept_weight view_stride fall_back);
        let (own, old, new) = (&mut self.polish, old.polish, new.polish);
        follow!(own, old, new; sweeps flips_every cameras_every deviation_weight least_share);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_flat_pictures_are_held_to_the_surface_and_the_published_method_never_is() {
        for preset in [Preset::Fast, Preset::Default, Preset::Best] {
            assert_eq!(preset.shaded(DrivingShading::Auto), preset.options());
            let mut flat = preset.options();
            flat.shading = DrivingShading::Flat;
            assert_eq!(preset.shaded(DrivingShading::Flat), flat);
            for shading in [
                DrivingShading::Gouraud,
                DrivingShading::Mixed,
                DrivingShading::Lit,
            ] {
                let own = preset.shaded(shading);
                assert_eq!(own.shading, shading);
                assert!(own.swept_weight < preset.options().swept_weight);
                assert!(own.polish.deviation_weight > 0.0);
            }
        }
        let published = Preset::Paper.options();
        assert!(published.polish.deviation_weight <= 0.0 && published.swept_weight <= 0.0);
    }
}
