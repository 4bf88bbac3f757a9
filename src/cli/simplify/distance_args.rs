//! The options of the method `tolerance`: how far from the input the result may be.

use crate::{
    Error, Result,
    bound::tolerance::Source,
    simplify::tolerance::{Distance, ToleranceOptions},
};

/// Options of the method `tolerance`.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct DistanceArgs {
    /// Largest distance between input and result, as a fraction of the bounding-box diagonal
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    #[arg(conflicts_with = "error_abs")]
    error: Option<f64>,
    /// Largest distance between input and result, in the units of the file
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    error_abs: Option<f64>,
    /// Bound the distance from the result to the input only, not back
    #[arg(long)]
    one_sided: bool,
    /// Where other places are refused, try the best one in the tolerance volume (slow)
    #[arg(long, value_enum, hide_short_help = true)]
    volume: Option<Source>,
    /// A local bound that grows, as published (slow)
    #[arg(long, hide_short_help = true)]
    growing: bool,
}

impl DistanceArgs {
    /// True where an error is asked for.
    pub(super) fn has_error(&self) -> bool {
        self.error.is_some() || self.error_abs.is_some()
    }

    /// The options of the library.
    ///
    /// # Errors
    /// [`Error::Usage`] where the distance is missing.
    pub(super) fn options(&self) -> Result<ToleranceOptions> {
        let error = match (self.error, self.error_abs) {
            (Some(share), _) => Distance::OfDiagonal(share),
            (None, Some(length)) => Distance::Length(length),
            (None, None) => {
                return Err(Error::Usage(
                    "the method `tolerance` needs --error E, a fraction of the diagonal, or --error-abs LENGTH".into(),
                ));
            }
        };
        Ok(ToleranceOptions {
            one_sided: self.one_sided,
            volume: self.volume,
            growing: self.growing,
            ..ToleranceOptions::new(error)
        })
    }
}
