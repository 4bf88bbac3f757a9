//! Least squares: the normals of groups whose interpolation comes nearest to the original's field.
//!
//! The sum over all samples of `w |b0 n0 + b1 n1 + b2 n2 - n|^2` is least under unit `n0, n1, n2` of the groups. With all
//! other groups held, the best normal of one is the direction of a sum; sweeps over the groups in their order come down
//! by a constant factor each. Every group is held a little at the mean of its samples: a sliver alone says nothing of
//! its corners.

use glam::DVec3;

use super::{
    face::Faces,
    groups::{Groups, fallback},
    moments::Moments,
};
use crate::{Progress, Result, num::math::unit};

/// Sweeps over all groups.
const SWEEPS: u64 = 24;

/// Weight of the mean of a group's samples, against that of the samples.
const HOLD: f64 = 0.05;

/// By slot: the fitted normal, `None` where the carried one stays.
///
/// # Errors
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub(super) fn fit(
    faces: &Faces,
    groups: &Groups,
    moments: &[Moments],
    progress: &dyn Progress,
) -> Result<Vec<Option<DVec3>>> {
    let mut normals: Vec<DVec3> = faces.0.iter().flat_map(|face| face.carried).collect();
    let mut found = vec![None; normals.len()];
    let mut free = Vec::with_capacity(groups.len());
    for group in 0..groups.len() {
        let slots = groups.slots(group);
        let face = |slot: &u32| &faces.0[*slot as usize / 3];
        let is_kept = |slot: &u32| !face(slot).has_normals || moments[*slot as usize / 3].is_kept;
        if slots.iter().all(is_kept) {
            continue;
        }
        free.push(group);
        let held = mean(slots, moments);
        for &slot in slots {
            let slot = slot as usize;
            let start = unit(held).or_else(|| fallback(&faces.0[slot / 3], slot % 3));
            normals[slot] = start.unwrap_or(DVec3::Z);
        }
    }
    for sweep in 0..SWEEPS {
        progress.step("fit normals", sweep, SWEEPS)?;
        for &group in &free {
            let slots = groups.slots(group);
            let pull = |sum: DVec3, &slot: &u32| sum + pull(slot as usize, moments, &normals);
            let sum = slots.iter().fold(mean(slots, moments) * HOLD, pull);
            if let Some(normal) = unit(sum) {
                for &slot in slots {
                    normals[slot as usize] = normal;
                }
            }
        }
    }
    for group in free {
        for &slot in groups.slots(group) {
            found[slot as usize] = Some(normals[slot as usize]);
        }
    }
    Ok(found)
}

/// The sum of the samples around a group.
fn mean(slots: &[u32], moments: &[Moments]) -> DVec3 {
    let add = |sum: DVec3, &slot: &u32| {
        let slot = slot as usize;
        sum + moments[slot / 3].normals[slot % 3]
    };
    slots.iter().fold(DVec3::ZERO, add)
}

/// The normal of a corner that the samples of one face ask for, given its other two.
fn pull(slot: usize, moments: &[Moments], normals: &[DVec3]) -> DVec3 {
    let (face, k) = (slot / 3, slot % 3);
    let (next, last) = ((k + 1) % 3, (k + 2) % 3);
    let of = &moments[face];
    of.normals[k]
        - normals[3 * face + next] * of.mixed[last]
        - normals[3 * face + last] * of.mixed[next]
}
