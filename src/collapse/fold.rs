//! Folds: edges whose two faces nearly lie on each other, the backs together or the fronts.
//!
//! Many small steps, each within the rule on normals, can add up to a fold; so the angle between neighbours itself is
//! tested. A patch may not make an edge sharper than [`FOLD_COSINE`], unless there was one at least as sharp among the
//! edges that it changes: what is folded in the input may stay folded.

use glam::DVec3;

use super::{LiveMesh, Patch, PatchFace, Refusal, ring::normal};
use crate::num::math::sqrt;

/// Smallest cosine between the normals of two neighbouring faces that a change may lead to.
pub const FOLD_COSINE: f64 = -0.8;

/// Tests the edges that a patch, not yet committed, makes or changes.
///
/// O(faces * valence).
///
/// # Errors
/// [`Refusal::Fold`].
pub fn unfolded(live: &LiveMesh, patch: &Patch) -> Result<(), Refusal> {
    let after = sharpest(live, patch, true);
    if after >= FOLD_COSINE || after >= sharpest(live, patch, false) {
        Ok(())
    } else {
        Err(Refusal::Fold)
    }
}

/// The smallest cosine between the normals of two neighbours at an edge of the patch, after it or before it; 1 where
/// there is none. Faces without area and edges with more than two faces have no angle.
fn sharpest(live: &LiveMesh, patch: &Patch, after: bool) -> f64 {
    let faces = if after { &patch.added } else { &patch.removed };
    let points = |f: &PatchFace| {
        if after {
            patch.after(live, f)
        } else {
            patch.before(live, f)
        }
    };
    let mut least = 1.0_f64;
    for (i, face) in faces.iter().enumerate() {
        let own = normal(points(face));
        for k in 0..3 {
            let side = [face.corners[k], face.corners[(k + 1) % 3]];
            let mut neighbor: Option<(f64, DVec3)> = None;
            let mut count = 0;
            let mut meet = |index: Option<usize>, other: [u32; 3], normal: &dyn Fn() -> DVec3| {
                let Some(at) = other.iter().position(|&v| v == side[0]) else {
                    return;
                };
                let forward = other[(at + 1) % 3] == side[1];
                if !forward && other[(at + 2) % 3] != side[1] {
                    return;
                }
                count += 1;
                // Every pair within the patch once.
                if index.is_none_or(|j| j > i) {
                    neighbor = Some((if forward { -1.0 } else { 1.0 }, normal()));
                }
            };
            for (j, other) in faces.iter().enumerate().filter(|&(j, _)| j != i) {
                meet(Some(j), other.corners, &|| normal(points(other)));
            }
            for id in live.triangles_at(side[0]) {
                let within = patch.removed.binary_search_by_key(&id, |f| f.id).is_ok();
                if within {
                    continue;
                }
                if let (Some(corners), Some(points)) = (live.triangle(id), live.points(id)) {
                    meet(None, corners, &|| normal(points));
                }
            }
            if let (1, Some((sign, other))) = (count, neighbor) {
                let size2 = own.dot(own) * other.dot(other);
                if size2 > 0.0 {
                    least = least.min(sign * own.dot(other) / sqrt(size2));
                }
            }
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{mesh::Mesh, num::Frame};

    /// Two triangles at the edge (0, 1); the apex of the second at `apex`.
    fn hinge(apex: DVec3) -> LiveMesh {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1.0, 0.0), apex];
        let mesh = Mesh::from_triangles(positions, vec![[0, 1, 2], [1, 0, 3]]).expect("valid");
        LiveMesh::new(&mesh, Frame::default())
    }

    fn moved(live: &LiveMesh, to: DVec3) -> Result<(), Refusal> {
        let mut patch = Patch::default();
        patch.set_move(live, 3, to);
        unfolded(live, &patch)
    }

    #[test]
    fn closing_a_hinge_is_refused_and_opening_a_closed_one_is_not() {
        let flat = hinge(DVec3::new(0.5, -1.0, 0.0));
        assert_eq!(moved(&flat, DVec3::new(0.5, 0.2, 1.0)), Ok(()));
        let shut = DVec3::new(0.5, 1.0, 0.3);
        assert_eq!(moved(&flat, shut), Err(Refusal::Fold));
        assert_eq!(
            moved(&flat, shut * DVec3::new(1.0, 1.0, -1.0)),
            Err(Refusal::Fold)
        );
        let folded = hinge(shut);
        assert_eq!(moved(&folded, DVec3::new(0.5, 1.0, 0.4)), Ok(()));
        assert_eq!(
            moved(&folded, DVec3::new(0.5, 1.0, 0.2)),
            Err(Refusal::Fold),
            "sharper still"
        );
    }
}
