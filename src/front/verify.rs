//! Holds a simplified mesh to what is claimed about it, by samples and by proofs that share no code with the claim.
//!
//! ```
//! # fn main() -> Result<(), lodmark::Error> {
//! # let mesh = lodmark::Mesh::from_slices(&[0., 0., 0., 1., 0., 0., 0., 1., 0.], &[0, 1, 2])?;
//! # let low = mesh.clone();
//! let report = lodmark::verify::distance(&mesh, &low, 0.001)?.require()?;
//! assert!(report.proven);
//! # Ok(())
//! # }
//! ```

use crate::{Error, Result, Silent, mesh::Mesh};

pub use crate::bound::verify::{
    AngleReport, Claim, Direction, DistanceReport, Gap, Property, Record, Sighting, Witness,
    angles, distance as distance_with,
};

/// Points that are spread over each surface.
const SAMPLES: u64 = 1_000_000;

/// Checks that no point of either mesh is farther from the other than `share` of the diagonal of the reference's
/// bounding box.
///
/// The report says where the largest distance was measured and what is proven; [`DistanceReport::require`] turns a claim
/// that is not proven into an error.
///
/// # Errors
/// [`Error::Usage`] for a share that is negative or not finite; [`Error::Input`] where a mesh has no triangles.
pub fn distance(reference: &Mesh, simplified: &Mesh, share: f64) -> Result<DistanceReport> {
    let claim = Claim::Relative(share);
    distance_with(reference, simplified, claim, false, SAMPLES, &Silent)
}

impl DistanceReport {
    /// Gives the report back where its claim is proven for every point.
    ///
    /// # Errors
    /// [`Error::NotProven`] that says what was measured and how much is undecided.
    pub fn require(self) -> Result<Self> {
        if self.proven {
            return Ok(self);
        }
        let largest = self.directions.iter().map(|d| d.farthest.distance);
        let undecided = self.directions.iter().map(|d| d.undecided_area);
        Err(Error::NotProven(format!(
            "a distance of at most {} is not proven: the largest one measured is {}, and {} of the area is undecided; \
             try a larger claim",
            self.claimed,
            largest.fold(0.0, f64::max),
            undecided.fold(0.0, f64::max),
        )))
    }
}

impl AngleReport {
    /// Gives the report back where its claim is proven for every point and viewpoint.
    ///
    /// # Errors
    /// [`Error::NotProven`] that says what was measured and how much is undecided.
    pub fn require(self) -> Result<Self> {
        if self.proven {
            return Ok(self);
        }
        Err(Error::NotProven(format!(
            "an angle of at most {} degrees is not proven: the largest one measured is {}, and {} of the area is undecided",
            self.claimed_deg,
            self.worst.map_or(0.0, |worst| worst.angle_deg),
            self.undecided_area,
        )))
    }
}
