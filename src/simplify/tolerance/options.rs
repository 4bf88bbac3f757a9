//! What may be chosen, and what is promised.

use serde::{Deserialize, Serialize};

use super::super::memoryless::MemorylessOptions;
use crate::{Error, Result, bound::tolerance::Source};

/// The largest distance between the result and the original.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Distance {
    /// As a fraction of the diagonal of the original's bounding box, above 0.
    OfDiagonal(f64),
    /// In file units, above 0.
    Length(f64),
}

/// Options of the method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ToleranceOptions {
    /// The bound.
    pub error: Distance,
    /// Bound only the distance from the result to the original, as the paper does, not that from the original to the
    /// result: small parts may then shrink to almost nothing.
    pub one_sided: bool,
    /// Where ends, midpoint and optimum are refused, try the place of least cost in the tolerance volume, too; which
    /// partition sets the volume has. `None`: no volumes.
    pub volume: Option<Source>,
    /// Bound every collapse by the surface before it as well, with a local bound that grows from 1/32 of the bound (section 3).
    pub growing: bool,
    /// What places vertices and orders collapses.
    pub placement: MemorylessOptions,
}

impl ToleranceOptions {
    /// Both directions, without volumes, with the defaults of the memoryless method.
    #[must_use]
    pub fn new(error: Distance) -> Self {
        Self {
            error,
            one_sided: false,
            volume: None,
            growing: false,
            placement: MemorylessOptions::default(),
        }
    }

    /// Tests every option that has a range.
    ///
    /// # Errors
    /// [`Error::Usage`] that names the option, its value and the range.
    pub fn check(&self) -> Result<()> {
        let (name, error) = match self.error {
            Distance::OfDiagonal(error) => ("error", error),
            Distance::Length(error) => ("error-abs", error),
        };
        if !(error > 0.0 && error < f64::INFINITY) {
            return Err(Error::Usage(format!(
                "{name} is {error}; expected a distance above 0, for example --error 0.005 for half a percent of the diagonal"
            )));
        }
        let weight = self.placement.volume_weight;
        if !(0.0..=1.0).contains(&weight) {
            return Err(Error::Usage(format!(
                "volume-weight is {weight}; expected a number from 0 to 1"
            )));
        }
        Ok(())
    }
}

/// What holds for a result: proved, not sampled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Guarantee {
    /// No point of the result is farther than this from the original, in file units.
    pub distance: f64,
    /// The same as a fraction of the diagonal of the original's bounding box; `None` where that is 0.
    pub of_diagonal: Option<f64>,
    /// True where no point of the original is farther from the result, either.
    pub two_sided: bool,
}
