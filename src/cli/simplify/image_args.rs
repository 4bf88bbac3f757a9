//! The options of the method `image`: the recipe, and what deviates from it.

use crate::{
    Error, Result,
    simplify::image::{DrivingShading, EngineName, ImageOptions, Polish, Preset, Size, Start},
    view::ViewsName,
};

/// Options of the method `image`.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct ImageArgs {
    /// The recipe [default: default]
    #[arg(long, value_enum)]
    preset: Option<Preset>,
    /// dodecahedron, rhombicuboctahedron, octahedron:K, spiral:N, or a view file [default: by preset]
    #[arg(long, value_name = "SET|FILE")]
    views: Option<ViewsName>,
    /// Width and height of the driving images [default: by preset]
    #[arg(long, value_name = "PIXELS")]
    size: Option<u32>,
    /// Samples per pixel along each axis of the driving images: 1, 2 or 4; 1 where the size is not given and would have too
    /// many [default: by preset]
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// The shading that the result will be seen with [default: auto, which is lit where the mesh stores normals, else flat;
    /// preset paper: flat]
    #[arg(long, value_enum)]
    shading: Option<DrivingShading>,
    /// Number of the views that look through the front into the interior
    #[arg(long, value_name = "K")]
    interior_views: Option<usize>,
    /// Triangles at which images take over from the memoryless method, or `none`
    #[arg(long, value_name = "N|none", value_parser = parse_start)]
    start_triangles: Option<Start>,
    /// Sweeps that move vertices and flip edges after the last collapse; 0 is none [default: by preset]
    #[arg(long, value_name = "SWEEPS")]
    polish: Option<u32>,
    /// The way in which pictures follow the mesh; never changes a result
    #[arg(long, value_enum, hide_short_help = true)]
    engine: Option<EngineName>,
}

impl ImageArgs {
    /// The options of the library.
    ///
    /// # Errors
    /// [`Error::Usage`] for an option that is part of the view file.
    pub(super) fn options(&self) -> Result<ImageOptions> {
        let sized = self.size.is_some() || self.samples.is_some();
        if let Some(ViewsName::File(path)) = &self.views
            && (sized || self.shading.is_some() || self.interior_views.is_some())
        {
            return Err(Error::Usage(format!(
                "--size, --samples, --shading and --interior-views are part of the view file {}; leave them out",
                path.display()
            )));
        }
        let preset = self.preset.unwrap_or_default();
        let default = self
            .shading
            .map_or_else(|| preset.options(), |s| preset.shaded(s));
        Ok(ImageOptions {
            views: self.views.clone().unwrap_or(default.views),
            size: self.size.map_or(default.size, Size::Pixels),
            samples: self.samples.unwrap_or(default.samples),
            interior_views: self.interior_views.unwrap_or(default.interior_views),
            start: self.start_triangles.unwrap_or(default.start),
            polish: Polish {
                sweeps: self.polish.unwrap_or(default.polish.sweeps),
                ..default.polish
            },
            engine: self.engine.unwrap_or(default.engine),
            ..default
        })
    }
}

/// A number of triangles at which images take over, or `none` for those of the input.
fn parse_start(text: &str) -> Result<Start, String> {
    if text == "none" {
        return Ok(Start::Input);
    }
    match text.parse() {
        Ok(0) | Err(_) => Err("expected a number of triangles, at least 1, or `none`".into()),
        Ok(n) => Ok(Start::Triangles(n)),
    }
}
