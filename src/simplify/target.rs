//! The size that a run simplifies to.

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// The size that a run simplifies to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Target {
    /// To at most this many triangles, at least 1.
    Triangles(u64),
    /// To at most this share of the input's triangles, in (0, 1].
    Ratio(f64),
    /// As far as an error allows: [`Options::error_rms`](super::Options::error_rms), or the bound that the method has
    /// in its own options.
    ErrorOnly,
}

impl Target {
    /// At most `count` triangles, at least 1.
    #[must_use]
    pub const fn triangles(count: u64) -> Self {
        Self::Triangles(count)
    }

    /// At most this share of the input's triangles, in (0, 1].
    #[must_use]
    pub const fn ratio(share: f64) -> Self {
        Self::Ratio(share)
    }

    /// The number of triangles to reach from `input` triangles; `None` where only an error limits the run.
    ///
    /// # Errors
    /// [`Error::Usage`] for no triangles or a ratio outside (0, 1].
    pub fn of(self, input: usize) -> Result<Option<usize>> {
        match self {
            Self::ErrorOnly => Ok(None),
            Self::Triangles(0) => Err(Error::Usage(
                "0 triangles make no mesh; expected at least 1".into(),
            )),
            Self::Triangles(n) => Ok(Some(usize::try_from(n).unwrap_or(usize::MAX))),
            Self::Ratio(r) if r > 0.0 && r <= 1.0 => {
                // Rounded up, and never 0: a ratio of a small mesh leaves something.
                Ok(Some(((r * input as f64).ceil() as usize).max(1)))
            }
            Self::Ratio(r) => Err(Error::Usage(format!(
                "the ratio {r} is not in (0, 1]; expected for example 0.1"
            ))),
        }
    }
}
