//! The shadow of a cap: where a new vertex would make a face pierce the cap (section 2.1).
//!
//! A new triangle stands on a source, an edge of the link (or, in the paper, a vertex of it). It pierces the cap where
//! the new vertex lies behind the cap as seen from a point of the source. Those places are convex: `cap + cone(cap -
//! source)`. The bounding planes are the cap's own and every plane through an edge of the cap and an end of the source,
//! or through the source and a corner of the cap, that has the whole cap on one side and the whole source on the other.
//! Deviation: the paper's sets start from vertices; a face can pierce a cap between two vertices, so edges are the
//! default.

use glam::DVec3;

use super::HalfSpace;
use crate::num::{Each, math};

/// The shadows of a cap from the segment `source` (its ends may coincide): none, one, or two where the source is on both
/// sides of the cap's plane. Each is the intersection of the half-spaces. `tolerance`: length below which points count
/// as on a plane.
pub fn shadows(
    cap: [DVec3; 3],
    normal: DVec3,
    source: [DVec3; 2],
    tolerance: f64,
) -> Vec<Vec<HalfSpace>> {
    let height = |p: DVec3| (p - cap[0]).dot(normal);
    let heights = source.each(height);
    let mut found = Vec::new();
    for side in [-1.0, 1.0] {
        // The part of the source on this side of the plane.
        let inside = heights.each(|h| h * side > tolerance);
        let part = match inside {
            [false, false] => continue,
            [true, true] => source,
            [first, _] => {
                let [p, q] = source;
                let crossing = p + (q - p) * (heights[0] / (heights[0] - heights[1]));
                if first { [p, crossing] } else { [crossing, q] }
            }
        };
        let Some(beyond) = HalfSpace::behind(cap[0], normal * side) else {
            continue;
        };
        let mut bounds = vec![beyond];
        for k in 0..3 {
            let (from, to) = (cap[k], cap[(k + 1) % 3]);
            let [first, last] = part.each(|end| (from, (to - from).cross(end - from)));
            let across = (part[0], (part[1] - part[0]).cross(from - part[0]));
            for (point, normal) in [first, last, across] {
                let plane = HalfSpace::behind(point, normal);
                bounds.extend(plane.and_then(|p| separating(p, cap, part, tolerance)));
            }
        }
        found.push(bounds);
    }
    found
}

/// The side of a plane that has the whole cap, where the other side has the whole source.
fn separating(
    plane: HalfSpace,
    cap: [DVec3; 3],
    source: [DVec3; 2],
    tolerance: f64,
) -> Option<HalfSpace> {
    let [cap_low, cap_high] = math::range(cap.each(|p| plane.excess(p)));
    let [source_low, source_high] = math::range(source.each(|p| plane.excess(p)));
    if cap_high <= tolerance && source_low >= -tolerance && cap_low < -tolerance {
        Some(plane)
    } else if cap_low >= -tolerance && source_high <= tolerance && cap_high > tolerance {
        Some(plane.complement())
    } else {
        None
    }
}
