//! Limits of polishing: rules, the surface of the original, and its sides.

use super::super::DistancePenalty;
use crate::{
    collapse::{LiveMesh, Patch, PatchFace, Rules},
    metric::Orientation,
};

/// Limits of polishing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Limits<'a> {
    /// The rules, as for collapses.
    pub rules: Rules,
    /// Penalty on distance from the original.
    pub deviation: Option<&'a DistancePenalty<'a>>,
    /// The error of the pictures may not rise for the surface either: it is limited.
    pub falling: bool,
    /// The sides of the original, which no face may turn its back on.
    pub sides: Option<&'a Orientation>,
}

impl Limits<'_> {
    /// Weighs a change that adds `cost` to the error `sum` where the surface counts too: negative where it is for the
    /// better. The deviation of what the patch removes is kept in `before` for other changes of the same faces.
    pub(super) fn balance(
        &self,
        live: &LiveMesh,
        patch: &Patch,
        (cost, sum): (i64, f64),
        before: &mut Option<f64>,
    ) -> f64 {
        let Some(deviation) = self.deviation else {
            return cost as f64;
        };
        let before = *before.get_or_insert_with(|| deviation.before(live, patch));
        deviation.balance(cost, sum, deviation.after(live, patch) - before)
    }

    /// Whether a change turns no face over that was not turned over before.
    pub(super) fn keeps_sides(&self, live: &LiveMesh, patch: &Patch) -> bool {
        self.sides.is_none_or(|sides| {
            let faces = patch.added.iter();
            let flipped = faces
                .filter(|f| sides.is_flipped(patch.after(live, f)))
                .count();
            // What was flipped before is no fault of the change.
            let before = |f: &&PatchFace| sides.is_flipped(patch.before(live, f));
            flipped == 0 || flipped <= patch.removed.iter().filter(before).count()
        })
    }
}
