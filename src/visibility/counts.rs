//! Counts of what views see, as sums of integers: they have no order, so views can be counted in any split.
//!
//! A view adds to a triangle the weight max(0, r . n) A of equation 4.3 in units of 2^-32, rounded to nearest, and the
//! part of it that the view sees. n is the triangle's normal, r points towards the camera: with the paper's viewing
//! direction the sums over the whole sphere would be 0, and a triangle's back does not count. Two-sided measurements
//! keep a second pair of sums for the other side.

use std::{
    ops::Range,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
};

use glam::DVec3;

use super::{
    MeasureOptions,
    cameras::Cameras,
    seen_parts::{FULL, SeenParts},
    subdivide::Pieces,
};
use crate::{
    Error, Progress, Result,
    geometry::area_normal,
    mesh::Mesh,
    num::{Each, math},
    parallel,
    view::{Sphere, frame_of},
};

/// Weights of one side of a triangle: of the views that see it, and of all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Weights {
    pub(super) seen: u64,
    pub(super) all: u64,
}

/// Sums over some views, for every triangle.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    /// Views that see anything of it, from either side.
    pub(super) views: Vec<u32>,
    /// The side that its normal points to.
    pub(super) front: Vec<Weights>,
    /// The other side; empty unless the measurement is two-sided.
    pub(super) back: Vec<Weights>,
}

/// Most weight that a view can add; the largest camera weight is below 2.
pub(super) const WEIGHT_LIMIT: u64 = 1 << 33;

/// Parts of faces that are kept before they are summed: 64 MiB of them.
const BATCH_PARTS: usize = 1 << 25;

/// Views counted between two sums, where memory allows.
const BATCH_VIEWS: usize = 64;

/// Pixels that are drawn at the same time, at most: of pictures of 480 x 480 more than any machine has threads, of those
/// of 4,096 x 4,096 three, in 1.7 GB.
const PIXELS_AT_ONCE: usize = 3 << 24;

/// Counts what the cameras of `range` see of `mesh`; `watch` is shown the parts of all faces for some views at a time,
/// in the order of the views.
pub(super) fn count(
    mesh: &Mesh,
    options: &MeasureOptions,
    range: Range<u32>,
    progress: &dyn Progress,
    mut watch: impl FnMut(&[u16]),
) -> Result<Counts> {
    options.check()?;
    let cameras = options.cameras();
    if range.start >= range.end || range.end > cameras {
        return Err(Error::Usage(format!(
            "views {}..{}; expected a first view and one past the last, from 0..1 to 0..{cameras}",
            range.start, range.end
        )));
    }
    let faces = mesh.triangles().len();
    let frame = frame_of(mesh);
    let sphere = Sphere::of_mesh(mesh)
        .ok_or_else(|| Error::Usage("a mesh without triangles has no visibility".into()))?
        .enter_frame(frame);
    let cameras = Cameras::new(options, &sphere)?;
    let positions = mesh.positions().iter().map(|&p| frame.enter(p)).collect();
    let pixel = 2.0 * sphere.radius / f64::from(options.size);
    // A mesh that is one point has no size to compare with.
    let limit = options
        .edge_limit
        .map(|pixels| pixels * pixel)
        .filter(|&l| l > 0.0);
    let pieces = Pieces::new(positions, mesh.triangles(), limit)?;
    let normal = |t: &[u32; 3]| {
        let corners = t.each(|v| pieces.scene.positions()[v as usize]);
        math::unit(area_normal(corners)).unwrap_or(DVec3::ZERO)
    };
    let normals: Vec<DVec3> = mesh.triangles().iter().map(normal).collect();
    let mut counts = Counts {
        views: vec![0; faces],
        front: vec![Weights::default(); faces],
        back: vec![Weights::default(); if options.two_sided { faces } else { 0 }],
    };
    let views: Vec<u32> = range.collect();
    let batch = (BATCH_PARTS / faces).clamp(1, BATCH_VIEWS).min(views.len());
    let mut parts = vec![0_u16; batch * faces];
    let idle: Mutex<Vec<SeenParts>> = Mutex::new(Vec::new());
    let done = AtomicU64::new(0);
    let pictures = (PIXELS_AT_ONCE / (options.size as usize).pow(2)).max(1);
    for views_of_batch in views.chunks(batch) {
        let parts = &mut parts[..views_of_batch.len() * faces];
        let least = views_of_batch.len().div_ceil(pictures);
        parallel::try_for_chunks(parts, faces, least, |i, parts| {
            let total = views.len() as u64;
            progress.step("visibility", done.fetch_add(1, Ordering::Relaxed), total)?;
            let lock = || idle.lock().unwrap_or_else(PoisonError::into_inner);
            let mut seen = lock().pop().unwrap_or_else(SeenParts::new);
            let camera = (&cameras, views_of_batch[i] as usize);
            seen.measure(&pieces, camera, options, parts);
            lock().push(seen);
            Ok(())
        })?;
        watch(parts);
        counts.add(views_of_batch, parts, &cameras, &normals);
    }
    progress.report("visibility", views.len() as u64, views.len() as u64);
    Ok(counts)
}

/// Triangles that one thread adds up at a time: their sums stay in its cache from view to view.
const CHUNK: usize = 4_096;

impl Counts {
    /// Adds the sums of other views of the same triangles.
    pub(super) fn merge(&mut self, other: &Self) {
        for (sum, add) in self.views.iter_mut().zip(&other.views) {
            *sum += add;
        }
        let front = self.front.iter_mut().zip(&other.front);
        for (sum, add) in front.chain(self.back.iter_mut().zip(&other.back)) {
            sum.seen += add.seen;
            sum.all += add.all;
        }
    }

    /// Adds what `views` see: `parts` holds all faces of the first, then of the next.
    fn add(&mut self, views: &[u32], parts: &[u16], cameras: &Cameras, normals: &[DVec3]) {
        let faces = normals.len();
        parallel::for_chunks(&mut self.views, CHUNK, |chunk, counts| {
            for i in 0..views.len() {
                let parts = &parts[i * faces + chunk * CHUNK..][..counts.len()];
                for (count, &part) in counts.iter_mut().zip(parts) {
                    *count += u32::from(part > 0);
                }
            }
        });
        for (side, sign) in [(&mut self.front, 1.0), (&mut self.back, -1.0)] {
            parallel::for_chunks(side, CHUNK, |chunk, sums| {
                let first = chunk * CHUNK;
                let normals = &normals[first..first + sums.len()];
                for (i, &view) in views.iter().enumerate() {
                    let factor = sign * cameras.weights[view as usize];
                    let towards = cameras.towards[view as usize] * factor;
                    add_view(sums, &parts[i * faces + first..], normals, towards);
                }
            });
        }
    }
}

/// Adds one view to some triangles; `towards` is the direction to the camera times its weight.
fn add_view(sums: &mut [Weights], parts: &[u16], normals: &[DVec3], towards: DVec3) {
    for ((sum, &part), normal) in sums.iter_mut().zip(parts).zip(normals) {
        let weight = weight(normal.dot(towards));
        sum.all += weight;
        sum.seen += weight * u64::from(part) / u64::from(FULL);
    }
}

/// A number in [0, 2] in units of 2^-32, rounded to nearest; 0 for negative ones.
#[inline]
fn weight(x: f64) -> u64 {
    // The last bit of the mantissa of 2^20 + x counts 2^-32.
    const LARGE: f64 = 1_048_576.0;
    let x = if x > 0.0 { x } else { 0.0 };
    (LARGE + x).to_bits() - LARGE.to_bits()
}
