//! The difference of the areas that two meshes cover in a picture: its size, and how far their outlines are apart.
//!
//! A mask says which samples of a picture a mesh covers. The *displacement* of two masks is the largest distance from a
//! sample that one of them covers to the nearest sample that the other one covers, both ways: the Hausdorff distance of
//! the covered areas. An edge that moved counts with its way, a spike that is gone with its length, a hole that closed with
//! its radius. Where only one of the masks covers anything, it is the longer side of the box around that.
//! Squared distances between samples are integers, so nothing is rounded.

use serde::Serialize;

use crate::{
    Error, Result,
    num::{Grid, math::sqrt},
};

/// The difference of what two meshes cover, in samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct OutlineDifference {
    /// Number of samples that the reference covers.
    pub covered: u64,
    /// Number of samples that one of both covers and the other does not.
    pub differing: u64,
    /// The square of the displacement, in squared distances of neighbouring samples.
    pub squared_displacement: u64,
}

impl OutlineDifference {
    /// Compares what a candidate covers with what the reference does. O(samples), and for every sample that differs its
    /// distance from the other mask.
    ///
    /// # Errors
    /// [`Error::Usage`] where the sizes differ.
    pub fn between(reference: &Grid<bool>, candidate: &Grid<bool>) -> Result<Self> {
        let size = |mask: &Grid<bool>| (mask.width(), mask.height());
        if size(reference) != size(candidate) {
            return Err(Error::Usage(format!(
                "what is covered in {:?} and in {:?} samples cannot be compared; expected the same size",
                size(reference),
                size(candidate)
            )));
        }
        let count = |mask: &Grid<bool>| mask.values().iter().filter(|&&c| c).count() as u64;
        let pairs = reference.values().iter().zip(candidate.values());
        let differing = pairs.filter(|(a, b)| a != b).count() as u64;
        let covered = count(reference);
        let squared_displacement = match (covered > 0, count(candidate) > 0) {
            _ if differing == 0 => 0,
            (true, false) => squared_side(reference),
            (false, true) => squared_side(candidate),
            _ => farthest(reference, candidate).max(farthest(candidate, reference)),
        };
        Ok(Self {
            covered,
            differing,
            squared_displacement,
        })
    }

    /// The displacement in distances of neighbouring samples.
    pub fn displacement(self) -> f64 {
        sqrt(self.squared_displacement as f64)
    }
}

/// The square of the longer side, in samples, of the box around what a mask covers; 0 where it covers nothing.
fn squared_side(mask: &Grid<bool>) -> u64 {
    let width = (mask.width() as usize).max(1);
    let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
    for (i, _) in mask.values().iter().enumerate().filter(|(_, c)| **c) {
        for (axis, at) in [i % width, i / width].into_iter().enumerate() {
            low[axis] = low[axis].min(at);
            high[axis] = high[axis].max(at + 1);
        }
    }
    let side = (0..2).map(|axis| high[axis].saturating_sub(low[axis]));
    let side = side.max().unwrap_or(0) as u64;
    side * side
}

/// The largest squared distance of a sample that `from` covers from the nearest one that `to` covers, which covers some.
fn farthest(from: &Grid<bool>, to: &Grid<bool>) -> u64 {
    let heights = heights(to);
    let width = (from.width() as usize).max(1);
    let mut farthest = 0;
    let rows = from
        .values()
        .chunks_exact(width)
        .zip(heights.chunks_exact(width));
    for (row, heights) in rows {
        for x in (0..width).filter(|&x| row[x] && heights[x] > 0) {
            farthest = farthest.max(nearest(heights, x, farthest));
        }
    }
    farthest
}

/// The distance from every sample to the nearest one above or below it that the mask covers; `u32::MAX` where there is none.
fn heights(mask: &Grid<bool>) -> Vec<u32> {
    let width = (mask.width() as usize).max(1);
    let own = |&covered: &bool| if covered { 0 } else { u32::MAX };
    let mut heights: Vec<u32> = mask.values().iter().map(own).collect();
    for i in width..heights.len() {
        heights[i] = heights[i].min(heights[i - width].saturating_add(1));
    }
    for i in (width..heights.len()).rev() {
        heights[i - width] = heights[i - width].min(heights[i].saturating_add(1));
    }
    heights
}

/// The squared distance from sample `x` of a row to the nearest one that is covered; any number up to `known` where that
/// is not larger.
fn nearest(heights: &[u32], x: usize, known: u64) -> u64 {
    let squared = |n: u64| n.saturating_mul(n);
    let mut best = squared(u64::from(heights[x]));
    for step in 1..heights.len() {
        let aside = squared(step as u64);
        if best <= known || aside >= best {
            break;
        }
        let sides = [x.checked_sub(step), x.checked_add(step)];
        for height in sides.into_iter().flatten().filter_map(|x| heights.get(x)) {
            best = best.min(squared(u64::from(*height)).saturating_add(aside));
        }
    }
    best
}
