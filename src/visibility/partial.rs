//! Partial visibility: the counts of some of the views, in parts that can be put together in any order.

use std::ops::Range;

use super::{
    MeasureOptions, Visibility,
    counts::{Counts, count},
};
use crate::{
    Error, Progress, Result,
    mesh::{Mesh, content_digest},
    num::Each,
};

/// The counts of some of the views of a measurement over one mesh: sums of integers.
///
/// Surveys of the same mesh with the same options and different views add up, in any order and any split, to the same
/// bytes as a survey of all views. A complete one holds everything that V(t) is computed from.
#[derive(Clone, Debug, PartialEq)]
pub struct PartialVisibility {
    /// Version of the crate that counted.
    pub(super) version: String,
    /// [`content_digest`] of the mesh.
    pub(super) digest: [u8; 32],
    pub(super) options: MeasureOptions,
    /// The views that were counted: ascending, apart from each other.
    pub(super) ranges: Vec<Range<u32>>,
    pub(super) counts: Counts,
}

impl PartialVisibility {
    /// Counts what the views of `range` see of `mesh`; the first camera is 0. O(views x (triangles + pixels)).
    ///
    /// # Errors
    /// As [`measure`](super::measure); [`Error::Usage`] also where the range is empty or ends beyond the last camera.
    pub fn of_views(
        mesh: &Mesh,
        options: &MeasureOptions,
        range: Range<u32>,
        progress: &dyn Progress,
    ) -> Result<Self> {
        Self::watched(mesh, options, range, progress, |_| {})
    }

    /// Counts as [`PartialVisibility::of_views`] does; `watch` is shown the parts that [`count`] shows.
    pub(super) fn watched(
        mesh: &Mesh,
        options: &MeasureOptions,
        range: Range<u32>,
        progress: &dyn Progress,
        watch: impl FnMut(&[u16]),
    ) -> Result<Self> {
        let counts = count(mesh, options, range.clone(), progress, watch)?;
        Ok(Self {
            version: env!("CARGO_PKG_VERSION").into(),
            digest: content_digest(mesh),
            options: *options,
            ranges: vec![range],
            counts,
        })
    }

    /// The options that it was counted with.
    pub fn options(&self) -> &MeasureOptions {
        &self.options
    }

    /// The views that were counted, ascending and apart from each other.
    pub fn views(&self) -> &[Range<u32>] {
        &self.ranges
    }

    /// Number of triangles of its mesh.
    pub fn triangle_count(&self) -> usize {
        self.counts.views.len()
    }

    /// True where every view was counted.
    pub fn is_complete(&self) -> bool {
        matches!(self.ranges.as_slice(), [all] if *all == (0..self.options.cameras()))
    }

    /// Adds the views of another survey.
    ///
    /// # Errors
    /// [`Error::Usage`] where the two are of other meshes, options or versions of this crate, or have a view in
    /// common; this survey is then unchanged.
    pub fn merge(&mut self, other: &Self) -> Result<()> {
        let refused = |what: &str, expected: &str| {
            let told = format!("the surveys {what}; expected {expected}");
            Err(Error::Usage(told))
        };
        if self.digest != other.digest || self.triangle_count() != other.triangle_count() {
            let expected = "parts of one measurement: the same file, read the same way";
            return refused("belong to different meshes", expected);
        }
        if self.options != other.options {
            let difference = self.difference(other);
            let what = format!("were counted with different options ({difference})");
            return refused(&what, "the same cameras, size and rules in every part");
        }
        if self.version != other.version {
            let what = format!("come from versions {} and {}", self.version, other.version);
            return refused(&what, "one version, because another may count otherwise");
        }
        for a in &self.ranges {
            let common = |b: &&Range<u32>| a.start < b.end && b.start < a.end;
            if let Some(b) = other.ranges.iter().find(common) {
                let (start, end) = (a.start.max(b.start), a.end.min(b.end));
                let what = format!("have views {start}..{end} in common");
                return refused(&what, "every view in one part only");
            }
        }
        self.counts.merge(&other.counts);
        self.ranges.extend(other.ranges.iter().cloned());
        self.ranges.sort_unstable_by_key(|r| r.start);
        let mut united: Vec<Range<u32>> = Vec::with_capacity(self.ranges.len());
        for range in self.ranges.drain(..) {
            match united.last_mut() {
                Some(last) if last.end == range.start => last.end = range.end,
                _ => united.push(range),
            }
        }
        self.ranges = united;
        Ok(())
    }

    /// The options in which another survey differs, and what they are in both.
    fn difference(&self, other: &Self) -> String {
        let [own, others] =
            [self, other].each(|survey| match serde_json::to_value(survey.options) {
                Ok(serde_json::Value::Object(options)) => options,
                _ => serde_json::Map::new(),
            });
        let own = own.iter();
        let differs = own.filter(|(name, value)| others.get(*name) != Some(*value));
        let texts = differs.map(|(name, value)| {
            let other = others.get(name).unwrap_or(&serde_json::Value::Null);
            format!("{name} {value} and {other}")
        });
        texts.collect::<Vec<_>>().join(", ")
    }

    /// V(t) and V(M) of `mesh`.
    ///
    /// # Errors
    /// [`Error::Usage`] where it is another mesh than the one that was counted, or a view is missing;
    /// [`Error::Unsupported`] where another version of this crate counted.
    pub fn finish(&self, mesh: &Mesh) -> Result<Visibility> {
        let (own, other) = (self.triangle_count(), mesh.triangles().len());
        if own != other || self.digest != content_digest(mesh) {
            let sizes = if own == other {
                String::new()
            } else {
                format!(", of {own} triangles, than the one of {other}")
            };
            return Err(Error::Usage(format!(
                "the survey belongs to another mesh{sizes}; measure this mesh, or give the file that was measured"
            )));
        }
        if self.version != env!("CARGO_PKG_VERSION") {
            return Err(Error::Unsupported(format!(
                "the survey was counted by version {}, and this is {}, which may count otherwise; measure again",
                self.version,
                env!("CARGO_PKG_VERSION")
            )));
        }
        if !self.is_complete() {
            let ranges = self.ranges.iter();
            let present = ranges.map(|r| format!("{}..{}", r.start, r.end));
            return Err(Error::Usage(format!(
                "the survey has views {} of 0..{}; expected all of them: merge the missing parts first",
                present.collect::<Vec<_>>().join(", "),
                self.options.cameras()
            )));
        }
        Visibility::of(mesh, &self.options, self.counts.clone())
    }
}
