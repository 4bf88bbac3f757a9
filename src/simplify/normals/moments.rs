//! Moments of the original's normals over the faces of a simplified mesh: all that the least squares need.

use glam::DVec3;

use super::{
    face::{Face, Faces},
    field::NormalField,
};
use crate::{
    Progress, Result,
    geometry::part_weights,
    mesh::Mesh,
    num::{
        Each, Frame,
        math::{length, sqrt, unit},
    },
    parallel,
};

/// Samples for every triangle of the original.
const SAMPLES: f64 = 2.0;
/// The fewest and the most parts of a side of a face: their squares are the samples of a face.
const PARTS: [u32; 2] = [2, 64];
/// Weight of the mean of a face's samples in its own normals, against that of the samples.
const HOLD: f64 = 0.1;
/// Faces that one task samples; no result depends on it but for points between equally near triangles.
const CHUNK: usize = 64;
/// Chunks between two reports.
const GROUP: usize = 64;
/// Weight of the direction of the face itself where the original's normal is across it, against that of a normal along it.
/// A collapse leaves faces that stand for nothing which is seen of the original, and whatever is nearest to them says
/// little.
const FACE: f64 = 0.2;
/// The largest square of the distance between a carried normal and the original's that counts as none.
const SAME: f64 = 1e-12;

/// Sums over the samples of a face, weighted by area and by how much they are to be trusted; `b` are the barycentric
/// coordinates of a sample.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    /// Sums of products of two of `b`: of the second and third, third and first, first and second.
    pub mixed: [f64; 3],
    /// Sums of the original's normals times `b`.
    pub normals: [DVec3; 3],
    /// The normals of the corners that fit the samples of this face alone; the direction of the face where there are none.
    pub own: [DVec3; 3],
    /// Whether all samples were found, and the carried normals show the original's at each.
    pub is_kept: bool,
}

impl Moments {
    /// The moments of all faces.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub(super) fn of_faces(
        original: &Mesh,
        frame: Frame,
        faces: &Faces,
        progress: &dyn Progress,
    ) -> Result<Vec<Self>> {
        let Some(field) = NormalField::of(original, frame) else {
            return Ok(vec![Self::default(); faces.0.len()]);
        };
        let areas = faces.0.iter().map(|face| length(face.normal));
        let total: f64 = areas.sum();
        let density = SAMPLES * original.triangles().len() as f64 / total;
        let chunks = faces.0.len().div_ceil(CHUNK);
        let mut found = Vec::with_capacity(faces.0.len());
        for start in (0..chunks).step_by(GROUP) {
            progress.step("fit normals", start as u64, chunks as u64)?;
            let group = parallel::map((chunks - start).min(GROUP), |i| {
                let first = (start + i) * CHUNK;
                let last = faces.0.len().min(first + CHUNK);
                let mut near = 0;
                let chunk = faces.0[first..last].iter();
                chunk
                    .map(|face| Self::of(face, density, &field, &mut near))
                    .collect::<Vec<Self>>()
            });
            found.extend(group.into_iter().flatten());
        }
        progress.step("fit normals", chunks as u64, chunks as u64)?;
        Ok(found)
    }

    fn of(face: &Face, density: f64, field: &NormalField<'_>, near: &mut u32) -> Self {
        let area = length(face.normal);
        let direction = unit(face.normal).unwrap_or(DVec3::ZERO);
        let mut sums = Self {
            is_kept: face.is_unit,
            own: [direction; 3],
            ..Self::default()
        };
        if area <= 0.0 || !face.has_normals {
            return sums;
        }
        let parts = sqrt(density * area).round() as u32;
        let parts = parts.clamp(PARTS[0], PARTS[1]);
        let count = u64::from(parts) * u64::from(parts);
        let part = area / count as f64;
        let mut masses = [0.0; 3];
        let [a, b, c] = face.points;
        for index in 0..count {
            let [u, v, w] = part_weights(parts, index).each(|x| x as f64 / f64::from(3 * parts));
            let Some(shown) = field.at(a * u + b * v + c * w, face, near) else {
                sums.is_kept = false;
                continue;
            };
            let (normal, trust) = trusted(shown, direction);
            let weight = part * trust;
            sums.mixed[0] += v * w * weight;
            sums.mixed[1] += w * u * weight;
            sums.mixed[2] += u * v * weight;
            for (k, b) in [u, v, w].into_iter().enumerate() {
                sums.normals[k] += normal * (b * weight);
                masses[k] += b * weight;
            }
            let [l, m, n] = face.carried;
            let carried = unit(l * u + m * v + n * w);
            let apart = carried.map_or(2.0, |c| (c - shown).dot(c - shown));
            sums.is_kept &= apart <= SAME;
        }
        sums.fit_alone(masses);
        sums
    }

    /// Finds the normals that fit this face alone: Cramer's rule for three weights, `masses`, of the corners.
    fn fit_alone(&mut self, masses: [f64; 3]) {
        let [yz, zx, xy] = self.mixed;
        let mean = (self.normals[0] + self.normals[1]) + self.normals[2];
        let mass = (masses[0] + masses[1]) + masses[2];
        if mass <= 0.0 {
            return;
        }
        let hold = masses.each(|m| m * HOLD);
        let rows = [
            DVec3::new(masses[0] - xy - zx + hold[0], xy, zx),
            DVec3::new(xy, masses[1] - xy - yz + hold[1], yz),
            DVec3::new(zx, yz, masses[2] - zx - yz + hold[2]),
        ];
        let minors = [
            rows[1].cross(rows[2]),
            rows[2].cross(rows[0]),
            rows[0].cross(rows[1]),
        ];
        let right = [0, 1, 2].each(|k| self.normals[k] + mean * (hold[k] / mass));
        let determinant = rows[0].dot(minors[0]);
        for (k, own) in self.own.iter_mut().enumerate() {
            let sum = right[0] * minors[0][k] + right[1] * minors[1][k] + right[2] * minors[2][k];
            *own = unit(sum / determinant).unwrap_or(*own);
        }
    }
}

/// The mean of a normal of the original, which counts by the square of its cosine with the direction of a face, and of that
/// direction, which makes up for a part of what is missing; with the weight of both.
fn trusted(shown: DVec3, direction: DVec3) -> (DVec3, f64) {
    let cosine = shown.dot(direction);
    let own = shown * (cosine * cosine);
    // On the side of the original's: stored normals may all point inward.
    let along = if cosine < 0.0 { -direction } else { direction };
    let rest = FACE * (1.0 - cosine * cosine).max(0.0);
    let weight = cosine * cosine + rest;
    ((own + along * rest) / weight, weight)
}
