//! Folds: edges whose two faces nearly lie on each other, the backs together or the fronts.
//!
//! Many small steps, each within the rule on normals, can add up to a fold; so the angle between neighbours itself is
//! tested. A change may not make an edge sharper than the rules allow, unless there was one at least as sharp among
//! the edges that it changes: what is folded in the input may stay folded.

use glam::DVec3;

use super::{EdgeStar, LiveMesh, Patch, PatchFace, Refusal, Rules, edge_star::normal};
use crate::num::{Each, math::sqrt};

/// Tests the edges that a patch, not yet committed, makes or changes.
///
/// O(faces * (log faces + valence)), with the smaller valence of a side's ends.
///
/// # Errors
/// [`Refusal::Fold`].
pub fn check_folds(live: &LiveMesh, patch: &Patch, rules: Rules) -> Result<(), Refusal> {
    if rules.fold_cosine <= -1.0 {
        return Ok(());
    }
    let sharpest =
        |faces, after| sharpest(live, &facets(live, patch, faces, after), changed(patch));
    let after = sharpest(&patch.added, true);
    if after >= rules.fold_cosine || after >= sharpest(&patch.removed, false) {
        Ok(())
    } else {
        Err(Refusal::Fold)
    }
}

/// Sums by how much the cosines at the edges that a patch, not yet committed, makes or changes fall below a given one,
/// before and after.
///
/// O(faces * (log faces + valence)), with the smaller valence of a side's ends.
pub fn fold_amount(live: &LiveMesh, patch: &Patch, cosine: f64) -> [f64; 2] {
    let sum = |faces, after| {
        let mut sum = 0.0;
        let add = |c: f64| sum += (cosine - c).max(0.0);
        each_angle(
            live,
            &facets(live, patch, faces, after),
            changed(patch),
            add,
        );
        sum
    };
    [sum(&patch.removed, false), sum(&patch.added, true)]
}

/// True where the normals of the two faces at an edge have a cosine below the given one; false for other edges. O(valence).
pub fn is_folded(live: &LiveMesh, edge: u32, cosine: f64) -> bool {
    let Some([a, b]) = live.edge(edge) else {
        return false;
    };
    // A hub may have a million faces.
    let side = if live.valence(a) <= live.valence(b) {
        [a, b]
    } else {
        [b, a]
    };
    if live.faces_at_edge(edge) != 2 {
        return false;
    }
    let mut faces = live.triangles_at(side[0]).filter_map(|id| {
        let corners = live.triangle(id)?;
        let forward = along(corners, side)?;
        Some((normal(corners.each(|v| live.position(v))), forward))
    });
    let (Some((a, first)), Some((b, second))) = (faces.next(), faces.next()) else {
        return false;
    };
    self::cosine(a, b, first == second) < cosine
}

/// [`check_folds`] of the collapse of a star's edge to `position`.
///
/// # Errors
/// [`Refusal::Fold`].
pub fn check_collapse_folds(
    live: &LiveMesh,
    star: &EdgeStar,
    position: DVec3,
    rules: Rules,
) -> Result<(), Refusal> {
    if rules.fold_cosine <= -1.0 {
        return Ok(());
    }
    let changed = |id: u32| star.faces.binary_search_by_key(&id, |f| f.id).is_ok();
    let [u, w] = star.ends;
    // Nearly every star has room on the stack.
    let mut few = [Facet::default(); 24];
    let mut many;
    let facets = if star.faces.len() <= few.len() {
        few.as_mut_slice()
    } else {
        many = vec![Facet::default(); star.faces.len()];
        many.as_mut_slice()
    };
    let mut count = 0;
    for face in star.faces.iter().filter(|f| f.survives) {
        facets[count] = Facet {
            corners: face.corners.each(|v| if v == w { u } else { v }),
            normal: normal(face.points_after(position)),
        };
        count += 1;
    }
    let after = sharpest(live, &facets[..count], changed);
    if after >= rules.fold_cosine {
        return Ok(());
    }
    for (facet, face) in facets.iter_mut().zip(&star.faces) {
        *facet = Facet {
            corners: face.corners,
            normal: face.normal,
        };
    }
    if after >= sharpest(live, &facets[..star.faces.len()], changed) {
        Ok(())
    } else {
        Err(Refusal::Fold)
    }
}

/// A face, before or after.
#[derive(Clone, Copy, Debug, Default)]
struct Facet {
    corners: [u32; 3],
    /// Twice its area along its normal.
    normal: DVec3,
}

/// Tells the faces that a patch removes.
fn changed(patch: &Patch) -> impl Fn(u32) -> bool {
    |id| patch.removed.binary_search_by_key(&id, |f| f.id).is_ok()
}

/// Most faces that are compared for the neighbours of one; beyond that sides are sorted, so that the faces around a hub do
/// not cost their square.
const FEW: usize = 48;

/// The faces of a patch, before it or after.
fn facets(live: &LiveMesh, patch: &Patch, faces: &[PatchFace], after: bool) -> Vec<Facet> {
    let facet = |f: &PatchFace| Facet {
        corners: f.corners,
        normal: normal(if after {
            patch.after(live, f)
        } else {
            patch.before(live, f)
        }),
    };
    faces.iter().map(facet).collect()
}

/// The smallest cosine between the normals of two neighbours of which one is in `facets`; 1 where there are none.
fn sharpest(live: &LiveMesh, facets: &[Facet], changed: impl Fn(u32) -> bool) -> f64 {
    let mut least = 1.0_f64;
    each_angle(live, facets, changed, |cosine| least = least.min(cosine));
    least
}

/// Calls back with the cosine between the normals of every two neighbours of which one is in `facets`. The others are
/// the faces of `live` that are not `changed`. Faces without area and edges with more than two faces have no angle.
fn each_angle(
    live: &LiveMesh,
    facets: &[Facet],
    changed: impl Fn(u32) -> bool,
    mut found: impl FnMut(f64),
) {
    let key = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
    let mut sides = Vec::new();
    if facets.len() > FEW {
        for (i, facet) in facets.iter().enumerate() {
            let [a, b, c] = facet.corners;
            sides.extend([[a, b], [b, c], [c, a]].each(|side| (key(side), i)));
        }
        sides.sort_unstable();
    }
    for (i, facet) in facets.iter().enumerate() {
        for k in 0..3 {
            let side = [facet.corners[k], facet.corners[(k + 1) % 3]];
            let (neighbor, alone) = if sides.is_empty() {
                beside(facets, i, side, 0..facets.len())
            } else {
                let start = sides.partition_point(|s| s.0 < key(side));
                let same = sides[start..].iter().take_while(|s| s.0 == key(side));
                beside(facets, i, side, same.map(|s| s.1))
            };
            if let Some((j, forward)) = neighbor {
                // Every pair once.
                if j > i && alone {
                    found(cosine(facet.normal, facets[j].normal, forward));
                }
                continue;
            }
            // A hub may have a million faces.
            let short = live.valence(side[0]) <= live.valence(side[1]);
            let end = side[usize::from(!short)];
            let mut outside = live.triangles_at(end).filter_map(|id| {
                let corners = live.triangle(id)?;
                let forward = along(corners, side)?;
                (!changed(id)).then_some((corners, forward))
            });
            if let (Some((corners, forward)), None) = (outside.next(), outside.next()) {
                let other = normal(corners.each(|v| live.position(v)));
                found(cosine(facet.normal, other, forward));
            }
        }
    }
}

/// The first face of `among` but `i` itself that has a side, whether it runs along that in its direction, and whether it
/// is the only one.
#[inline]
fn beside(
    facets: &[Facet],
    i: usize,
    side: [u32; 2],
    among: impl Iterator<Item = usize>,
) -> (Option<(usize, bool)>, bool) {
    let others = among.filter(|&j| j != i);
    let mut beside = others.filter_map(|j| Some((j, along(facets[j].corners, side)?)));
    (beside.next(), beside.next().is_none())
}

/// True where a face runs along a side in its direction; `None` where the side is not its own.
#[inline]
fn along(corners: [u32; 3], [a, b]: [u32; 2]) -> Option<bool> {
    let at = corners.iter().position(|&v| v == a)?;
    if corners[(at + 1) % 3] == b {
        Some(true)
    } else {
        (corners[(at + 2) % 3] == b).then_some(false)
    }
}

/// The cosine between two normals, the second turned over where its face runs along the common edge as the first does.
#[inline]
fn cosine(a: DVec3, b: DVec3, forward: bool) -> f64 {
    let dot = if forward { -a.dot(b) } else { a.dot(b) };
    let size2 = a.dot(a) * b.dot(b);
    if dot < 0.0 && size2 > 0.0 {
        dot / sqrt(size2)
    } else {
        // Only sharp edges matter.
        1.0
    }
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
        check_folds(live, &patch, Rules::default())
    }

    #[test]
    fn closing_a_hinge_is_refused_and_opening_a_closed_one_is_not() {
        let flat = hinge(DVec3::new(0.5, -1.0, 0.0));
        assert_eq!(moved(&flat, DVec3::new(0.5, 0.2, 1.0)), Ok(()));
        let shut = DVec3::new(0.5, 1.0, 0.3);
        assert_eq!(moved(&flat, shut), Err(Refusal::Fold));
        let below = shut * DVec3::new(1.0, 1.0, -1.0);
        assert_eq!(moved(&flat, below), Err(Refusal::Fold));
        let folded = hinge(shut);
        assert_eq!(moved(&folded, DVec3::new(0.5, 1.0, 0.4)), Ok(()));
        let sharper = DVec3::new(0.5, 1.0, 0.2);
        assert_eq!(moved(&folded, sharper), Err(Refusal::Fold));
    }

    #[test]
    fn a_collapse_that_would_fold_is_refused_as_its_patch_is() {
        // A ridge of two slopes; the star of its top edge, whose collapse is tried all around.
        let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let positions = vec![
            p(0.0, 0.0, 0.0),
            p(1.0, 0.0, 0.0),
            p(-0.5, -1.0, 0.0),
            p(0.5, -1.0, 0.0),
            p(1.5, -1.0, 0.0),
            p(1.5, 1.0, 0.0),
            p(0.5, 1.0, 0.0),
            p(-0.5, 1.0, 0.0),
        ];
        let triangles = vec![
            [0, 3, 1],
            [0, 2, 3],
            [1, 3, 4],
            [1, 4, 5],
            [1, 5, 6],
            [0, 1, 6],
            [0, 6, 7],
            [0, 7, 2],
        ];
        let mesh = Mesh::from_triangles(positions, triangles).expect("valid");
        let live = LiveMesh::new(&mesh, Frame::default());
        let mut star = EdgeStar::default();
        assert!(star.gather(&live, live.find_edge(0, 1).expect("an edge")));
        let (mut folds, mut patch) = (0, Patch::default());
        for i in 0..20 {
            for z in [0.0, 0.4, 2.0] {
                let to = p(f64::from(i) * 0.25 - 2.0, 0.3, z);
                star.patch(&live, to, &mut patch);
                let outcome = check_collapse_folds(&live, &star, to, Rules::default());
                assert_eq!(
                    outcome,
                    check_folds(&live, &patch, Rules::default()),
                    "{to}"
                );
                folds += usize::from(outcome.is_err());
            }
        }
        assert!(folds > 3 && folds < 50, "{folds}");
    }
}
