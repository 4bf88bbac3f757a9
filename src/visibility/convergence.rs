//! The error of the measure against the number of cameras: Figure 3 of Zhang & Turk 2002.

use super::{MeasureOptions, Visibility, measure};
use crate::{
    Progress, Result,
    geometry::double_area,
    mesh::Mesh,
    num::Each,
    view::{frame_of, sets::OCTAHEDRON_LIMIT},
};

/// A measurement with some of the cameras, against the one with all 4,098.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct ConvergenceStep {
    /// Number of cameras.
    pub cameras: u32,
    /// The mean of |V(t) - V'(t)| over the surface, V' from the most cameras.
    pub error: f64,
    /// V(M) with these cameras.
    #[serde(rename = "v_mesh")]
    pub mesh: f64,
}

/// Measures with 6, 18, 66, 258, 1,026 and 4,098 cameras; the last step is what the others are compared with, so its
/// error is 0. The number of cameras in `options` is left aside. Costs 5,472 views.
///
/// # Errors
/// As [`measure`].
pub fn convergence(
    mesh: &Mesh,
    options: &MeasureOptions,
    progress: &dyn Progress,
) -> Result<Vec<ConvergenceStep>> {
    let with = |octahedron: u32| {
        let mut options = *options;
        options.octahedron = octahedron;
        measure(mesh, &options, progress)
    };
    let truth = with(OCTAHEDRON_LIMIT)?;
    let frame = frame_of(mesh);
    let area = |t: usize| double_area(mesh.corners(t).each(|p| frame.enter(p)));
    let areas: Vec<f64> = (0..mesh.triangles().len()).map(area).collect();
    let coarser = (0..OCTAHEDRON_LIMIT).map(with);
    let found = coarser.chain([Ok(truth.clone())]);
    found
        .map(|found| Ok(step(&found?, &truth, &areas)))
        .collect()
}

fn step(found: &Visibility, truth: &Visibility, areas: &[f64]) -> ConvergenceStep {
    let (mut differences, mut all) = (0.0, 0.0);
    let pairs = found.triangles().iter().zip(truth.triangles());
    for ((a, b), area) in pairs.zip(areas) {
        differences += (a - b).abs() * area;
        all += area;
    }
    ConvergenceStep {
        cameras: found.options().cameras(),
        error: if all > 0.0 { differences / all } else { 0.0 },
        mesh: found.mesh(),
    }
}
