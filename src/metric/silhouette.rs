//! A histogram of edges by the number of views in which they are silhouette edges.
//!
//! Lindstrom & Turk 2000, Figure 7: for each level of detail the percentage of edges that are silhouette edges in
//! exactly `i` of the views, and the expected number of views. The coarser a mesh, the more of its edges lie on a
//! silhouette; that is why images keep shape.
//! An edge is a silhouette edge where all its triangles that are not seen edge-on lie on one side of it in the image.
//! For an edge with two triangles that means that one faces the eye and the other faces away, whichever way they are
//! wound; a boundary edge always is one (the drawn surface ends there); an edge of more triangles is one where the
//! image goes from none to all of them. An edge whose triangles are all seen edge-on is none.
//! Occlusion plays no part. Signs are those of the rounded f64 determinant, taken with the corners in ascending order:
//! they do not depend on vertex order, and within rounding of edge-on they may be either.

use glam::DVec3;
use serde::Serialize;

use crate::{
    Error, Progress, Result,
    geometry::Triangle,
    mesh::{Edges, Mesh},
    parallel,
    view::Eye,
};

/// Counts of the edges that are silhouette edges in exactly 0, 1, ... views.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SilhouetteHistogram {
    counts: Vec<u64>,
}

impl SilhouetteHistogram {
    /// Edges that are silhouette edges in exactly `i` views, for `i` from 0 to the number of views.
    #[must_use]
    pub fn counts(&self) -> &[u64] {
        &self.counts
    }

    /// Edges of the mesh.
    #[must_use]
    pub fn edges(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Share of edges that are silhouette edges in exactly `views` views, in [0, 1]; 0 without edges.
    #[must_use]
    pub fn share(&self, views: usize) -> f64 {
        let count = self.counts.get(views).copied().unwrap_or(0);
        count as f64 / self.edges().max(1) as f64
    }

    /// Expected number of views in which an edge is a silhouette edge; 0 without edges.
    #[must_use]
    pub fn expectation(&self) -> f64 {
        let weighted: u64 = (0_u64..).zip(&self.counts).map(|(i, &n)| i * n).sum();
        weighted as f64 / self.edges().max(1) as f64
    }
}

/// The silhouette-edge histogram of a mesh over some views; eyes are in the units of the mesh. O(edges * views).
///
/// # Errors
/// [`Error::Usage`] where an eye is not finite; [`Error::Interrupted`].
pub fn silhouette_histogram(
    mesh: &Mesh,
    eyes: &[Eye],
    progress: &dyn Progress,
) -> Result<SilhouetteHistogram> {
    let edges = Edges::of(mesh);
    let mut views_of_edge = vec![0_u32; edges.len()];
    for (i, &eye) in eyes.iter().enumerate() {
        progress.step("silhouettes", i as u64, eyes.len() as u64)?;
        let (Eye::Point(at) | Eye::Axis(at)) = eye;
        if !at.is_finite() {
            return Err(Error::Usage(format!(
                "the eye of view {i} is ({}, {}, {}); expected finite numbers",
                at.x, at.y, at.z
            )));
        }
        let facing = parallel::map(mesh.triangles().len(), |t| facing(mesh.corners(t), eye));
        for ((edge, triangles), views) in edges.iter().zip(&mut views_of_edge) {
            *views += u32::from(is_silhouette(mesh, edge, triangles, &facing));
        }
    }
    progress.step("silhouettes", eyes.len() as u64, eyes.len() as u64)?;
    let mut counts = vec![0_u64; eyes.len() + 1];
    for views in views_of_edge {
        counts[views as usize] += 1;
    }
    Ok(SilhouetteHistogram { counts })
}

fn is_silhouette(mesh: &Mesh, [u, w]: [u32; 2], triangles: &[u32], facing: &[i8]) -> bool {
    let (mut left, mut right) = (false, false);
    for &t in triangles {
        let corners = mesh.triangles()[t as usize];
        let along = (0..3).any(|i| corners[i] == u && corners[(i + 1) % 3] == w);
        // A triangle lies on the left of its own edges in the image where it faces the eye.
        let facing = facing[t as usize];
        let side = if along { facing } else { -facing };
        left |= side > 0;
        right |= side < 0;
    }
    left != right
}

/// 1 where the triangle shows its front (counter-clockwise corners) to the eye, -1 its back, 0 edge-on.
fn facing(corners: [DVec3; 3], eye: Eye) -> i8 {
    // Its corners are in ascending order: the sign does not depend on which one is first.
    let triangle = Triangle::new(corners);
    let normal = triangle.area_normal();
    let toward = match eye {
        Eye::Point(eye) => normal.dot(eye - triangle.corners()[0]),
        Eye::Axis(axis) => normal.dot(axis),
    };
    i8::from(toward > 0.0) - i8::from(toward < 0.0)
}
