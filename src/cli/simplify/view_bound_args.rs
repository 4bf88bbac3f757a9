//! The options of the method `view-bounded`: who looks from where, and how much they may see.

use std::{io::Write, path::PathBuf};

use crate::{
    Error, Result,
    bound::view_cell,
    encode::atomic,
    mesh::Mesh,
    num::math,
    simplify::{Outcome, view_bounded::ViewBoundedOptions},
};

/// Options of the method `view-bounded`.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct ViewBoundArgs {
    /// The viewpoints that the bound holds for, a JSON cell file
    #[arg(long, value_name = "FILE")]
    cell: Option<PathBuf>,
    /// The largest angle between a point and what stands for it, in degrees, 0 to below 90
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    #[arg(conflicts_with = "error_px")]
    error_deg: Option<f64>,
    /// The same as pixels in the middle of a screen; needs --screen-height
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true)]
    #[arg(requires = "screen_height")]
    error_px: Option<f64>,
    /// Height of the screen for --error-px
    #[arg(long, value_name = "PIXELS", requires = "error_px", value_parser = clap::value_parser!(u32).range(1..))]
    screen_height: Option<u32>,
    /// Vertical field of view for --error-px, in degrees [default: 60]
    #[arg(long, value_name = "DEGREES", requires = "error_px")]
    fov: Option<f64>,
    /// Write which part of OUT stands for which part of IN, for `lodmark verify --bound`
    #[arg(long, value_name = "FILE")]
    bound_out: Option<PathBuf>,
}

impl ViewBoundArgs {
    /// True where an error is asked for.
    pub(super) fn has_error(&self) -> bool {
        self.error_deg.is_some() || self.error_px.is_some()
    }

    /// The file that is written beside the mesh.
    pub(super) fn output(&self) -> Option<&PathBuf> {
        self.bound_out.as_ref()
    }

    /// The options of the library.
    ///
    /// # Errors
    /// [`Error::Usage`] where the cell or the error is missing or out of range; what reading the cell says.
    pub(super) fn options(&self) -> Result<ViewBoundedOptions> {
        let Some(path) = &self.cell else {
            return Err(Error::Usage(
                "the method `view-bounded` needs --cell FILE: the viewpoints that the bound holds for".into(),
            ));
        };
        let error_deg = match (self.error_deg, self.error_px) {
            (Some(degrees), _) => degrees,
            (None, Some(pixels)) => self.angle_of(pixels)?,
            (None, None) => {
                let told =
                    "the method `view-bounded` needs --error-deg DEGREES or --error-px PIXELS";
                return Err(Error::Usage(told.into()));
            }
        };
        let cell = view_cell::file::read(path)?;
        Ok(ViewBoundedOptions::new(cell, error_deg))
    }

    /// The angle in degrees that this many pixels take up in the middle of the screen; elsewhere they take up less.
    fn angle_of(&self, pixels: f64) -> Result<f64> {
        let fov = self.fov.unwrap_or(60.0);
        if !(fov > 0.0 && fov < 180.0) {
            return Err(Error::Usage(format!(
                "the field of view is {fov} degrees; expected more than 0 and less than 180"
            )));
        }
        if !(pixels >= 0.0 && pixels.is_finite()) {
            return Err(Error::Usage(format!(
                "error-px is {pixels}; expected a number that is not negative"
            )));
        }
        let half = fov * (std::f64::consts::PI / 360.0);
        let height = f64::from(self.screen_height.unwrap_or(1));
        let angle = 2.0 * math::atan2(pixels * math::tan(half), height);
        Ok(angle * (180.0 / std::f64::consts::PI))
    }

    /// Writes the correspondence where it is asked for.
    pub(super) fn write(&self, original: &Mesh, outcome: &Outcome) -> Result<()> {
        let (Some(path), Some(map)) = (&self.bound_out, outcome.correspondence()) else {
            return Ok(());
        };
        atomic::write(path, |file: &mut dyn Write| {
            map.write(original, &outcome.mesh, file)
        })
    }
}
