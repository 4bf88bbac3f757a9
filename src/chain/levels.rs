//! The plan of a chain: which levels it has, and how they are judged.

use super::{Screen, certificate::aperture};
use crate::{Error, Result, metric::surface::DEFAULT_SAMPLES, simplify::Target};

/// The levels of a chain from fine to coarse, the screen that they are seen on, and how they are judged.
///
/// Level 0 is always the input. Every other level is what a run of its own to as many triangles gives.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Levels {
    pub(super) plan: Plan,
    pub(super) screen: Screen,
    /// Width and height of the pictures that the levels are judged in.
    pub(super) size: u32,
    pub(super) distance_samples: u32,
    pub(super) certify: bool,
}

/// The sizes of the levels.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Plan {
    /// Half the triangles each.
    Halving,
    /// These.
    Targets(Vec<Target>),
    /// As few triangles as these distances let be.
    Distances(Vec<f64>),
}

impl Levels {
    fn of(plan: Plan) -> Self {
        Self {
            plan,
            screen: Screen::default(),
            size: 512,
            distance_samples: DEFAULT_SAMPLES,
            certify: false,
        }
    }

    /// Halves the number of triangles until 8 are left, or no collapse is legal any more. A level whose silhouette differs
    /// from that of the original by more than 5 % of the covered area is left out, and so are those below it.
    #[must_use]
    pub fn halving() -> Self {
        Self::of(Plan::Halving)
    }

    /// Makes a level for each number or share of triangles, which must fall from one to the next.
    #[must_use]
    pub fn targets(targets: impl IntoIterator<Item = Target>) -> Self {
        Self::of(Plan::Targets(targets.into_iter().collect()))
    }

    /// Makes a level for each distance from the middle of the mesh, which must grow from one to the next: with as few
    /// triangles, on a ladder of the fourth root of 2, as the errors that the screen accepts let be from there on.
    #[must_use]
    pub fn distances(distances: impl IntoIterator<Item = f64>) -> Self {
        Self::of(Plan::Distances(distances.into_iter().collect()))
    }

    /// Shows the levels on this screen.
    #[must_use]
    pub fn screen(mut self, screen: Screen) -> Self {
        self.screen = screen;
        self
    }

    /// Judges the levels in pictures of `size` x `size` pixels [default: 512] and at about so many points of each surface
    /// [default: 500,000].
    #[must_use]
    pub fn judged(mut self, size: u32, distance_samples: u32) -> Self {
        (self.size, self.distance_samples) = (size, distance_samples);
        self
    }

    /// Proves, besides, from which distance on no silhouette is displaced by more than the accepted pixels.
    #[must_use]
    pub fn certify(mut self) -> Self {
        self.certify = true;
        self
    }

    /// Tests every number that has a range.
    ///
    /// # Errors
    /// [`Error::Usage`] that says what was expected.
    pub(super) fn check(&self) -> Result<()> {
        self.screen.check()?;
        if self.certify {
            aperture(&self.screen)?;
        }
        let empty = match &self.plan {
            Plan::Halving => false,
            Plan::Targets(targets) => targets.is_empty(),
            Plan::Distances(distances) => distances.is_empty(),
        };
        if empty || self.distance_samples == 0 || self.size == 0 {
            return Err(Error::Usage(
                "a chain without levels, pictures or points to judge them by; expected at least one of each".into(),
            ));
        }
        if let Plan::Distances(distances) = &self.plan {
            let sensible = distances.iter().all(|d| *d > 0.0 && d.is_finite());
            if !sensible || !distances.windows(2).all(|pair| pair[0] < pair[1]) {
                return Err(Error::Usage(format!(
                    "distances are {distances:?}; expected lengths above 0, each above the one before"
                )));
            }
        }
        Ok(())
    }
}

/// The numbers of triangles of some targets, for an input with `input` triangles.
///
/// # Errors
/// [`Error::Usage`] where they do not fall, or the first one is not below the input.
pub(super) fn counts(targets: &[Target], input: usize) -> Result<Vec<usize>> {
    let mut counts: Vec<usize> = Vec::with_capacity(targets.len());
    for target in targets {
        let count = target.of(input)?.ok_or_else(|| {
            Error::Usage("a level without a size; expected a number of triangles or a share".into())
        })?;
        let last = counts.last().copied();
        if count >= last.unwrap_or(input) {
            let above = match last {
                Some(last) => format!("the level before it has {last}"),
                None => format!("the input has {input}"),
            };
            return Err(Error::Usage(format!(
                "a level of {count} triangles, but {above}; expected levels from fine to coarse, each below the one \
                 before and the first below the input"
            )));
        }
        counts.push(count);
    }
    Ok(counts)
}
