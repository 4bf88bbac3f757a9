//! Flips of edges, allowed inside a smooth, convex and uniform part of the surface only.
//!
//! Topology: exactly two faces, no edge yet between their far corners ([`Patch::set_flip`]). Attributes: the faces
//! agree in their material and in every value at both ends of the edge, normals included; so no seam is crossed.
//! Shape: the new faces turn from both old ones by no more than a collapse may turn a face, and are not degenerate.

use super::{LiveMesh, Patch, PatchFace, Refusal, Rules, legality, wedge};
use crate::{mesh::ChannelKind, num::Each};

/// Fills `patch` with the flip of the edge `ends`, where the rules allow it.
///
/// # Errors
/// The rule that forbids it: [`Refusal::Locked`] between locked vertices, [`Refusal::Link`] for the topology,
/// [`Refusal::FeaturePinch`] for attributes, [`Refusal::Degenerate`], [`Refusal::Flip`] or [`Refusal::Mirror`] for the
/// shape.
///
/// # Panics
/// Where there is no such vertex.
pub fn flip(
    live: &LiveMesh,
    ends: [u32; 2],
    rules: Rules,
    patch: &mut Patch,
) -> Result<(), Refusal> {
    if ends.iter().all(|&v| live.is_locked(v)) {
        return Err(Refusal::Locked);
    }
    if !patch.set_flip(live, ends) {
        return Err(Refusal::Link);
    }
    let &[f, g] = patch.removed.as_slice() else {
        return Err(Refusal::Link);
    };
    let at = |face: &PatchFace| ends.each(|v| face.corner(v).unwrap_or(0));
    let faces = [(f.id, f.wedges), (g.id, g.wedges)];
    if wedge::differ(live, faces, [at(&f), at(&g)], |_| true) {
        return Err(Refusal::FeaturePinch);
    }
    for old in [&f, &g] {
        for new in &patch.added {
            let (before, after) = (patch.before(live, old), patch.after(live, new));
            legality::turn(before, super::edge_star::normal(before), after, rules)?;
        }
    }
    check_uv_orientation(live, patch)
}

/// Tests that no face of a patch changes its orientation in texture space; a face without an area there is free.
///
/// # Errors
/// [`Refusal::Mirror`].
pub fn check_uv_orientation(live: &LiveMesh, patch: &Patch) -> Result<(), Refusal> {
    let rows = live.rows();
    let stride = rows.stride();
    for &channel in rows.channels() {
        if !matches!(channel.kind, ChannelKind::TexCoord(_)) {
            continue;
        }
        let value = |w: u32| {
            let row = if w < rows.count() {
                rows.row(w)
            } else {
                &patch.rows[(w - rows.count()) as usize * stride..][..stride]
            };
            [row[channel.offset], row[channel.offset + 1]]
        };
        let area = |face: &PatchFace| {
            let [a, b, c] = face.wedges.each(value);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        let turned = patch
            .removed
            .iter()
            .zip(&patch.added)
            .any(|(old, new)| area(old) * area(new) < 0.0);
        if turned {
            return Err(Refusal::Mirror);
        }
    }
    Ok(())
}
