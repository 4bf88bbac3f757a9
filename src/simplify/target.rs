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
                // Never more than the share, but for rounding of the product itself (0.29 of 100 is 29), and never 0: a
                // ratio of a small mesh leaves something.
                let share = r * input as f64;
                Ok(Some(((share + share * 1e-12) as usize).max(1)))
            }
            Self::Ratio(r) => Err(Error::Usage(format!(
                "the ratio {r} is not in (0, 1]; expected for example 0.1"
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Target;

    #[test]
    fn a_ratio_is_never_exceeded_and_leaves_something() {
        for (ratio, input, expected) in [
            (0.1, 15_452, 1_545),
            (0.5, 69_451, 34_725),
            (0.29, 100, 29),
            (0.07, 100, 7),
            (1.0, 871_414, 871_414),
            (0.1, 9, 1),
            (0.5, 1, 1),
        ] {
            let found = Target::ratio(ratio).of(input).expect("a ratio");
            assert_eq!(found, Some(expected), "{ratio} of {input}");
        }
    }
}
