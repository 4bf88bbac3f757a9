//! Squared luma error between images, exact.
//!
//! Lindstrom & Turk 2000, sections 3.1 and 3.2: equation 1 for one pair of images, equation 2 for a set of views,
//! which is one mosaic and not a mean of means. Images are planes of luma *sums*: with `n` samples in a pixel a value
//! is the sum of `n` levels 0..=255 (1 sample: the level itself), so that nothing is ever rounded.
//! Limits: the squares of one set of views fit in `u64` for fewer than 10^12 pixels; beyond that is an error.

use serde::{Deserialize, Serialize};

use crate::{
    Error, Result,
    num::math::{log10, sqrt},
    raster::Grid,
};

/// The largest level of one sample.
const PEAK: u32 = 255;

/// A sum of squared luma differences over some pixels: an integer, so that sums have no order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SquaredError {
    /// Sum over all pixels of the squared difference of luma sums, in units of `(1 / samples)^2` of a squared level.
    pub sum: u64,
    /// Pixels compared.
    pub pixels: u64,
    /// Samples in every pixel, along both axes together: 1, 4 or 16.
    pub samples: u32,
}

impl SquaredError {
    /// The error of both sets of pixels together: equation 2 is this sum over all views.
    ///
    /// # Errors
    /// [`Error::Usage`] where the numbers of samples differ; [`Error::Unsupported`] where the sum exceeds 64 bits.
    pub fn combined(self, other: Self) -> Result<Self> {
        if self.samples != other.samples {
            return Err(Error::Usage(format!(
                "squared errors of images with {} and {} samples per pixel have no common unit; render both with the \
                 same number of samples",
                self.samples, other.samples
            )));
        }
        let overflow = || too_large(self.pixels.saturating_add(other.pixels));
        Ok(Self {
            sum: self.sum.checked_add(other.sum).ok_or_else(overflow)?,
            pixels: self.pixels.checked_add(other.pixels).ok_or_else(overflow)?,
            samples: self.samples,
        })
    }

    /// True where no pixel differs.
    #[must_use]
    pub fn is_zero(self) -> bool {
        self.sum == 0
    }

    /// Mean squared difference in squared levels, in [0, 255^2]; 0 where there is no pixel.
    #[must_use]
    pub fn mean_square(self) -> f64 {
        if self.sum == 0 {
            return 0.0;
        }
        let samples = f64::from(self.samples);
        self.sum as f64 / (self.pixels as f64 * (samples * samples))
    }

    /// Root of the mean squared difference in levels, in [0, 255]: equation 1 or 2.
    #[must_use]
    pub fn rms(self) -> f64 {
        sqrt(self.mean_square())
    }

    /// Root of the sum of squared differences in levels, not divided by the number of pixels: equation 5.11 of Zhang &
    /// Turk 2002. Comparable only between images of one size.
    #[must_use]
    pub fn root(self) -> f64 {
        sqrt(self.sum as f64) / f64::from(self.samples.max(1))
    }

    /// Peak signal-to-noise ratio in decibels for the peak 255; `None` (JSON: `null`) where no pixel differs, which
    /// is an infinite ratio.
    #[must_use]
    pub fn psnr(self) -> Option<f64> {
        let peak = f64::from(PEAK);
        (self.sum != 0).then(|| 10.0 * log10(peak * peak / self.mean_square()))
    }
}

/// The squared error between two images of luma sums with `samples` samples in a pixel (both axes together).
///
/// # Errors
/// [`Error::Usage`] where the sizes differ, an image is empty, `samples` is 0, or a value exceeds `255 * samples`.
pub fn squared_error<T: Copy + Into<u32>>(
    reference: &Grid<T>,
    image: &Grid<T>,
    samples: u32,
) -> Result<SquaredError> {
    let size = |image: &Grid<T>| (image.width(), image.height());
    same_size(size(reference), size(image))?;
    let (mut sum, mut largest) = (0_u64, 0_u32);
    for (&a, &b) in reference.values().iter().zip(image.values()) {
        let (a, b): (u32, u32) = (a.into(), b.into());
        largest = largest.max(a).max(b);
        let difference = u64::from(a.abs_diff(b));
        // Below 2^64 for every pair of values that passes the check after the loop; wrapping is never seen.
        sum = sum.wrapping_add(difference.wrapping_mul(difference));
    }
    let pixels = reference.values().len() as u64;
    if samples == 0 || u64::from(largest) > u64::from(PEAK) * u64::from(samples) {
        return Err(Error::Usage(format!(
            "a luma sum of {largest} is impossible with {samples} samples per pixel; expected at most 255 for each"
        )));
    }
    let bound = u128::from(pixels) * u128::from(largest) * u128::from(largest);
    if bound > u128::from(u64::MAX) {
        return Err(too_large(pixels));
    }
    Ok(SquaredError {
        sum,
        pixels,
        samples,
    })
}

/// The squared errors of a set of views.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ViewErrors {
    views: Vec<SquaredError>,
    total: SquaredError,
}

impl ViewErrors {
    /// Collects the errors of the views, in their order.
    ///
    /// # Errors
    /// [`Error::Usage`] without views; as [`SquaredError::combined`].
    pub fn new(views: Vec<SquaredError>) -> Result<Self> {
        let Some((&first, rest)) = views.split_first() else {
            let told = "no images to compare; expected at least one view";
            return Err(Error::Usage(told.into()));
        };
        let mut rest = rest.iter();
        let total = rest.try_fold(first, |sum, &view| sum.combined(view))?;
        Ok(Self { views, total })
    }

    /// Compares two sets of images, pair by pair.
    ///
    /// # Errors
    /// [`Error::Usage`] where the sets have different numbers of images; as [`squared_error`] for each pair.
    pub fn between<T: Copy + Into<u32>>(
        reference: &[Grid<T>],
        images: &[Grid<T>],
        samples: u32,
    ) -> Result<Self> {
        if reference.len() != images.len() {
            return Err(Error::Usage(format!(
                "{} reference images and {} images to compare; expected as many",
                reference.len(),
                images.len()
            )));
        }
        let pairs = reference.iter().zip(images);
        let errors = pairs.map(|(a, b)| squared_error(a, b, samples));
        Self::new(errors.collect::<Result<_>>()?)
    }

    /// The error of every view, in order.
    pub fn views(&self) -> &[SquaredError] {
        &self.views
    }

    /// The error of the set as one mosaic: equation 2.
    pub fn total(&self) -> SquaredError {
        self.total
    }

    /// Index and error of the view with the largest mean squared difference; the first of equals.
    pub fn worst(&self) -> (usize, SquaredError) {
        let mut worst = (0, self.views[0]);
        for (i, &view) in self.views.iter().enumerate().skip(1) {
            if view.mean_square() > worst.1.mean_square() {
                worst = (i, view);
            }
        }
        worst
    }
}

fn too_large(pixels: u64) -> Error {
    Error::Unsupported(format!(
        "the squared error of {pixels} pixels exceeds 64 bits; compare fewer or smaller images at a time"
    ))
}

/// Refuses images of different sizes, and empty ones.
fn same_size(expected: (u32, u32), actual: (u32, u32)) -> Result<()> {
    if expected != actual {
        return Err(Error::Usage(format!(
            "images of {} x {} and {} x {} pixels cannot be compared; expected the same size",
            expected.0, expected.1, actual.0, actual.1
        )));
    }
    if expected.0 == 0 || expected.1 == 0 {
        return Err(Error::Usage(
            "an image without pixels cannot be compared; expected at least 1 x 1".into(),
        ));
    }
    Ok(())
}
