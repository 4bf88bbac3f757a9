//! Counts of the pixels of a set of views by class, the worst of them, and the verdict.

use serde::Serialize;

use super::{Class, Classified, Witness};
use crate::num::fixed::SubpixelBits;

/// Number of the worst pixels that are kept.
pub const WITNESSES: usize = 20;

/// The largest share of pixels that may differ and be explained: 1e-4 at 16 sub-pixel bits; 5e-3 at 8, where snapping
/// moves outlines 256 times as far.
pub const fn cap(bits: SubpixelBits) -> f64 {
    match bits {
        SubpixelBits::Eight => 5e-3,
        SubpixelBits::Sixteen => 1e-4,
    }
}

/// Pixels of each class over any number of views.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Tally {
    /// Samples of all views.
    pub pixels: u64,
    /// Views.
    pub views: u64,
    /// Views that need no rounding, in which nothing may differ.
    pub grid_exact_views: u64,
    /// Samples of each class, in the order of [`Class::all`].
    #[serde(serialize_with = "named")]
    pub counts: [u64; Class::COUNT],
    /// The worst samples: bugs first, then those farthest from an outline; at most [`WITNESSES`].
    pub worst: Vec<Witness>,
}

/// Counts by the names of their classes.
fn named<S: serde::Serializer>(
    counts: &[u64; Class::COUNT],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(Class::all().map(Class::name).zip(counts))
}

impl Tally {
    /// Adds a view.
    pub fn add(&mut self, view: &Classified) {
        self.pixels += view.classes.values().len() as u64;
        self.views += 1;
        self.grid_exact_views += u64::from(view.grid_exact);
        for &class in view.classes.values() {
            self.counts[class as usize] += 1;
        }
        self.worst.extend(&view.witnesses);
        // Stable: equally bad ones stay in the order of views, rows and columns.
        self.worst
            .sort_by_key(|w| std::cmp::Reverse((w.class.is_bug(), distance(w))));
        self.worst.truncate(WITNESSES);
    }

    /// Samples of a class.
    pub fn of(&self, class: Class) -> u64 {
        self.counts[class as usize]
    }

    /// Samples that differ for one of the three reasons.
    pub fn explained(&self) -> u64 {
        self.sum(Class::is_explained)
    }

    /// Samples whose difference nothing explains.
    pub fn unexplained(&self) -> u64 {
        self.sum(Class::is_bug)
    }

    fn sum(&self, which: fn(Class) -> bool) -> u64 {
        let of = Class::all().zip(self.counts);
        of.filter(|&(class, _)| which(class)).map(|(_, n)| n).sum()
    }

    /// Explained samples as a share of all; 0 without any.
    pub fn explained_share(&self) -> f64 {
        match self.pixels {
            0 => 0.0,
            all => self.explained() as f64 / all as f64,
        }
    }

    /// True where every difference is explained and those are no larger a share of all samples than `cap`.
    pub fn passes(&self, cap: f64) -> bool {
        self.unexplained() == 0 && self.explained_share() <= cap
    }
}

/// The distance of the centre from the nearer outline of what is shown.
fn distance(witness: &Witness) -> u64 {
    let inside = [witness.raster.inside, witness.rays.inside];
    let distances = inside.into_iter().flatten().map(i64::unsigned_abs);
    distances.min().unwrap_or(0)
}
