//! The area that a collapse across seams gives to another chart.

use crate::{
    collapse::{EdgeStar, pinch::Forest},
    geometry::double_area,
};

use glam::DVec3;

/// The area (frame units squared) that changes its chart, colour or material where the edge of a star is collapsed to
/// `position`: half of all that the charts around it gain and lose.
///
/// A chart here is what hangs together through edges of the star that are no features; along a straight seam nothing
/// changes hands. O(faces log faces).
pub(in crate::rooms::collapse) fn displaced_area(star: &EdgeStar, position: DVec3) -> f64 {
    let mut charts = Forest::of(star.faces.len());
    // Faces at the edges from either end to each vertex of the link, and at the edge itself.
    let mut sides: Vec<([u32; 2], usize)> = Vec::with_capacity(4 * star.faces.len());
    for (i, face) in star.faces.iter().enumerate() {
        for (end, &at) in face.at.iter().enumerate() {
            for v in face
                .corners
                .into_iter()
                .filter(|v| at < 3 && !star.ends.contains(v))
            {
                sides.push(([v, end as u32], i));
            }
        }
        if face.has_both() && !star.edge_feature {
            sides.push(([u32::MAX, 0], i));
        }
    }
    sides.sort_unstable();
    for side in sides.chunk_by(|a, b| a.0 == b.0) {
        let [v, end] = side[0].0;
        let spoke = star.spokes.binary_search_by_key(&v, |s| s.vertex);
        let is_feature = spoke.is_ok_and(|at| star.spokes[at].feature[end as usize]);
        for pair in side.windows(2).filter(|_| !is_feature) {
            charts.unite(pair[0].1, pair[1].1);
        }
    }
    let mut gains = vec![0.0; star.faces.len()];
    for (i, face) in star.faces.iter().enumerate() {
        let after = if face.survives {
            double_area(face.points_after(position))
        } else {
            0.0
        };
        gains[charts.root(i)] += after - double_area(face.points);
    }
    gains.iter().map(|gain: &f64| gain.abs()).sum::<f64>() * 0.25
}
