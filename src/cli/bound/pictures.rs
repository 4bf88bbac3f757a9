//! The view of the viewer who sees a replacement farthest off its place: original, replacement and difference.

use std::path::Path;

use glam::DVec3;

use crate::{
    Error, Progress, Result,
    bound::{
        surface::{SurfaceBound, Worst},
        view_cell::ViewCell,
    },
    cli::terminal::Terminal,
    encode::{atomic, png},
    mesh::FramedMesh,
    metric::difference_strip,
    num::{
        Each, Frame,
        fixed::SubpixelBits,
        math::{length, tan},
    },
    raster::{self, Scene},
    view::{self, BACKGROUND, View, ViewSet},
};

/// Samples per pixel along each axis.
const SAMPLES: u32 = 2;
/// Factor by which the difference is exaggerated.
const SCALE: u8 = 2;
/// The share of the width of the zoomed picture that the error takes.
const SHOWN: f64 = 0.125;
/// Largest zoom: beyond it vertices move by visible parts of pixels of their own rounding.
const ZOOM_LIMIT: f64 = 10_000.0;
/// Nearest part of a scene that is drawn, as a share of its farthest one.
const NEAREST: f64 = 1e-6;

/// Writes the pictures of the worst point of a bound; meshes and bound are in units of `frame`.
pub(super) fn write(
    folder: &Path,
    size: u32,
    meshes: [&FramedMesh; 2],
    bound: &SurfaceBound,
    frame: Frame,
    terminal: &Terminal,
) -> Result<()> {
    let worst = bound.worst.as_ref();
    let Some((worst, eye)) = worst.and_then(|w| Some((w, w.viewpoint?))) else {
        terminal.say("no pictures: no viewer sees a difference, or the cell meets the mesh");
        return Ok(());
    };
    let set = views(size, meshes, worst, eye)?;
    atomic::folder(folder)?;
    let scenes = meshes.each(Scene::of);
    for (view, name) in set.views.iter().zip(["worst-view.png", "worst-zoom.png"]) {
        terminal.step("pictures", 0, 0)?;
        let [expected, actual] = [0, 1].each(|i| {
            let sums = raster::luma_sums(&scenes[i], view, &set);
            raster::mean_luma(&sums, set.samples)
        });
        let strip = difference_strip(&expected, &actual, SCALE)?;
        png::write_grey(&folder.join(name), &strip)?;
    }
    let text = view::file::to_json(&set.leave_frame(frame), &[])?;
    atomic::write_bytes(&folder.join("views.json"), text.as_bytes())
}

/// The whole scene around the worst point, and the point with what stands for it.
fn views(size: u32, meshes: [&FramedMesh; 2], worst: &Worst, eye: DVec3) -> Result<ViewSet> {
    let target = 0.5 * worst.point + 0.5 * worst.replacement;
    let at_eye = ViewCell::point(eye)?;
    let (mut near, mut far) = (f64::INFINITY, length(target - eye));
    for mesh in meshes {
        for t in 0..mesh.triangles().len() {
            near = near.min(at_eye.distance_to_triangle(mesh.corners(t)));
        }
        for &p in mesh.positions() {
            far = far.max(length(p - eye));
        }
    }
    let far = 1.01 * far;
    // Half of the distance: the near plane is flat, and what is nearest may be at the side.
    let near = (0.5 * near).min(0.5 * far).max(NEAREST * far);
    let back = eye - target;
    let steep = back.y.abs() > 0.9 * length(back);
    let up = if steep { DVec3::Z } else { DVec3::Y };
    let view = View::perspective([eye, target, up], [near, far], [size; 2])
        .ok_or_else(|| Error::Internal("a viewpoint outside the mesh sees it".into()))?;
    let half_width = tan(std::f64::consts::FRAC_PI_6);
    let zoom = (2.0 * SHOWN * half_width / tan(0.5 * worst.value)).clamp(1.0, ZOOM_LIMIT);
    let mut zoomed = view;
    for row in &mut zoomed.matrix[..2] {
        *row = row.each(|m| m * zoom);
    }
    Ok(ViewSet {
        width: size,
        height: size,
        samples: SAMPLES.min(4096 / size),
        subpixel: SubpixelBits::Eight,
        background: BACKGROUND,
        views: vec![view, zoomed],
    })
}
