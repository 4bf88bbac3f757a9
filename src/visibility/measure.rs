//! V(t) and V(M): equations 4.3 and 3.2 of Zhang & Turk 2002.

use super::{
    MeasureOptions,
    counts::{Counts, Weights, count},
};
use crate::{
    Error, Progress, Result, geometry::double_area, mesh::Mesh, num::Each, view::frame_of,
};

/// The visibility of a mesh and of each of its triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Visibility {
    triangles: Vec<f64>,
    views: Vec<u32>,
    mesh: f64,
    never_seen_area: f64,
    never_seen: usize,
    options: MeasureOptions,
}

/// Measures `mesh` from all cameras that `options` ask for.
///
/// Bit-equal positions should be one vertex (weld first): nothing else costs less. O(cameras x (triangles + pixels)).
///
/// # Errors
/// [`Error::Usage`] where an option is out of range or the mesh has no triangle, [`Error::Unsupported`] where its
/// triangles would make too many pieces, [`Error::Interrupted`].
pub fn measure(
    mesh: &Mesh,
    options: &MeasureOptions,
    progress: &dyn Progress,
) -> Result<Visibility> {
    let counts = count(mesh, options, 0..options.cameras(), progress, |_| {})?;
    Visibility::of(mesh, options, counts)
}

impl Visibility {
    /// V(t) for every triangle of the mesh, in its order, in [0, 1]: the share of the views in front of it that see
    /// it, each weighted by the cosine of the angle at which it looks. 0 for a triangle without area.
    #[must_use]
    pub fn triangles(&self) -> &[f64] {
        &self.triangles
    }

    /// V(M) in [0, 1]: the mean of V(t) over the surface.
    #[must_use]
    pub fn mesh(&self) -> f64 {
        self.mesh
    }

    /// The number of views that see anything of every triangle, from either side.
    #[must_use]
    pub fn views(&self) -> &[u32] {
        &self.views
    }

    /// Triangles of which no view sees anything, from neither side.
    #[must_use]
    pub fn never_seen(&self) -> usize {
        self.never_seen
    }

    /// The share of the surface, in [0, 1], that no view sees anything of.
    #[must_use]
    pub fn never_seen_area(&self) -> f64 {
        self.never_seen_area
    }

    /// The options that it was measured with.
    #[must_use]
    pub fn options(&self) -> &MeasureOptions {
        &self.options
    }

    /// From the counts of all views.
    pub(super) fn of(mesh: &Mesh, options: &MeasureOptions, counts: Counts) -> Result<Self> {
        let faces = mesh.triangles().len();
        if counts.views.len() != faces || counts.front.len() != faces {
            return Err(Error::Internal("counts of another mesh".into()));
        }
        let front = counts.front.iter().map(share);
        let triangles: Vec<f64> = if counts.back.is_empty() {
            front.collect()
        } else {
            let sides = front.zip(counts.back.iter().map(share));
            sides.map(|(f, b)| if b > f { b } else { f }).collect()
        };
        let frame = frame_of(mesh);
        let (mut all, mut visible, mut hidden) = (0.0, 0.0, 0.0);
        for (t, &v) in triangles.iter().enumerate() {
            let area = 0.5 * double_area(mesh.corners(t).each(|p| frame.enter(p)));
            all += area;
            visible += area * v;
            if counts.views[t] == 0 {
                hidden += area;
            }
        }
        let of_all = |part: f64| match all > 0.0 {
            true => (part / all).clamp(0.0, 1.0),
            false => 0.0,
        };
        Ok(Self {
            mesh: of_all(visible),
            never_seen_area: of_all(hidden),
            never_seen: counts.views.iter().filter(|&&n| n == 0).count(),
            views: counts.views,
            triangles,
            options: *options,
        })
    }
}

/// The seen share of the weights.
fn share(weights: &Weights) -> f64 {
    match weights.all {
        0 => 0.0,
        all => weights.seen as f64 / all as f64,
    }
}
