//! The wedges of a new vertex: corners that share one, and its values.
//!
//! Algorithm (seams of Lindstrom & Turk 2000, section 3.3, by classes of corners), for each channel by itself so that
//! a normal discontinuity does not tear texture coordinates: every class of corners ([`classes`](super::classes)) gets
//! one value. Texture coordinates are solved over the faces of the class ([`coordinates`]). Everything else is
//! interpolated along the edge at the foot of the new position, clamped to the edge. At an end a value is exactly that
//! end's. Normals are made unit again. A value that either end lacks is absent.

use glam::DVec3;

use super::{
    Blend, WedgeRows,
    classes::{Corner, Sides, compare_bits, corners_of, divide},
    coordinates::{self, ChartFace},
    oriented_volume::Otherwise,
    same_bits, texture_area,
};
use crate::{
    collapse::{EdgeStar, LiveMesh, Patch},
    mesh::{Channel, ChannelKind},
    num::{Each, Precision},
};

/// Buffers of [`transfer`]; all are equal.
#[derive(Clone, Debug, Default)]
pub(in crate::rooms::collapse) struct WedgeScratch {
    corners: Vec<Corner>,
    values: Vec<f64>,
    /// For every class, the first wedge of a corner at either end of the edge.
    firsts: Vec<[Option<u32>; 2]>,
    sides: Sides,
    /// The faces of one class.
    chart: Vec<ChartFace>,
    /// The new rows, by their values.
    order: Vec<u32>,
}

impl PartialEq for WedgeScratch {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Gives the new vertex its wedges in `patch.added` and appends their rows to `patch.rows`.
pub(in crate::rooms::collapse) fn transfer(
    live: &LiveMesh,
    star: &EdgeStar,
    position: DVec3,
    patch: &mut Patch,
) {
    let rows = live.rows();
    if rows.stride == 0 {
        return;
    }
    let mut scratch = std::mem::take(&mut patch.scratch);
    scratch.gather(live, star);
    for &channel in &rows.channels {
        scratch.fill(live, star, channel, position);
    }
    let WedgeScratch {
        corners,
        values,
        order,
        ..
    } = &mut scratch;
    order.clear();
    let mut added = 0;
    for (i, corner) in corners.iter().enumerate() {
        let face = &star.faces[corner.face];
        if !face.survives {
            continue;
        }
        while patch.added[added].id != face.id {
            added += 1;
        }
        let row = &values[i * rows.stride..][..rows.stride];
        let id = if same_bits(row, rows.row(corner.wedge)) {
            corner.wedge
        } else {
            rows.count() + appended(row, &mut patch.rows, order)
        };
        patch.added[added].wedges[face.apex()] = id;
    }
    patch.scratch = scratch;
}

/// True where a face of the star that stays would be turned over in texture space with the new vertex at `position`.
pub(in crate::rooms::collapse) fn turns_texture(
    live: &LiveMesh,
    star: &EdgeStar,
    position: DVec3,
) -> bool {
    let rows = live.rows();
    let is_texture = |c: &Channel| matches!(c.kind, ChannelKind::TexCoord(_));
    if !rows.channels.iter().any(is_texture) {
        return false;
    }
    let mut scratch = WedgeScratch::default();
    scratch.gather(live, star);
    rows.channels
        .iter()
        .copied()
        .filter(is_texture)
        .any(|channel| {
            scratch.fill(live, star, channel, position);
            let mut corners = scratch.corners.iter().enumerate();
            corners.any(|(i, corner)| {
                let face = &star.faces[corner.face];
                if !face.survives {
                    return false;
                }
                let wedges = live.wedges(face.id);
                let mut after = wedges.each(|w| texture_point(rows, channel, w));
                let at = i * rows.stride + channel.offset;
                after[face.apex()] = [scratch.values[at], scratch.values[at + 1]];
                let new = coordinates::double_area(after);
                new * texture_area(rows, channel, wedges) < 0.0
            })
        })
}

fn texture_point(rows: &WedgeRows, channel: Channel, wedge: u32) -> [f64; 2] {
    let value = rows.value(channel, wedge);
    [value[0], value[1]]
}

/// # The steps of a transfer
impl WedgeScratch {
    /// Collects the corners of the star at either end of its edge.
    fn gather(&mut self, live: &LiveMesh, star: &EdgeStar) {
        corners_of(live, star, &mut self.corners);
        self.values.clear();
        self.values
            .resize(self.corners.len() * live.rows().stride, 0.0);
    }

    /// Fills in the values of one channel for every corner.
    fn fill(&mut self, live: &LiveMesh, star: &EdgeStar, channel: Channel, position: DVec3) {
        let rows = live.rows();
        divide(live, star, channel, &mut self.corners, &mut self.sides);
        let is_texture = matches!(channel.kind, ChannelKind::TexCoord(_));
        self.firsts.clear();
        self.firsts.resize(self.corners.len(), [None; 2]);
        for corner in &self.corners {
            self.firsts[corner.class][corner.end].get_or_insert(corner.wedge);
        }
        let t = foot(star, position);
        for i in 0..self.corners.len() {
            let class = self.corners[i].class;
            let start = |corner: usize| corner * rows.stride + channel.offset;
            let width = channel.kind.width();
            if class < i {
                let known = start(class);
                self.values.copy_within(known..known + width, start(i));
                continue;
            }
            let ends = self.firsts[class].each(|first| first.map(|w| rows.value(channel, w)));
            let solved = if is_texture {
                self.coordinates(live, star, channel, (class, position, t))
            } else {
                None
            };
            let into = &mut self.values[start(i)..][..width];
            match (solved, ends) {
                (Some(solved), _) => into.copy_from_slice(&solved),
                (None, [Some(a), Some(b)]) => {
                    interpolate(channel.kind, live.precision(), a, b, t, into);
                }
                (None, [Some(a), None] | [None, Some(a)]) => into.copy_from_slice(a),
                (None, [None, None]) => {}
            }
        }
    }

    /// Solves the texture coordinates of a class, where its value at an end of the edge is not the one to keep;
    /// `None` where they are to be interpolated.
    fn coordinates(
        &mut self,
        live: &LiveMesh,
        star: &EdgeStar,
        channel: Channel,
        (class, position, at): (usize, DVec3, f64),
    ) -> Option<[f64; 2]> {
        let rows = live.rows();
        let ends = self.firsts[class].each(|w| w.map(|w| texture_point(rows, channel, w)));
        let kept = (0..2).find(|&end| position == star.points[end] && ends[end].is_some());
        if let Some(end) = kept {
            return ends[end];
        }
        self.chart.clear();
        let mut scale = 1.0;
        let mut last = None;
        for corner in self.corners.iter().filter(|c| c.class == class) {
            if last.replace(corner.face) == Some(corner.face) {
                continue;
            }
            let face = &star.faces[corner.face];
            if self.chart.is_empty() {
                scale = live.charts.of_triangle(channel.kind, face.id);
            }
            self.chart.push(ChartFace {
                points: face.points,
                coordinates: live
                    .wedges(face.id)
                    .each(|w| texture_point(rows, channel, w)),
            });
        }
        let known = |f: &ChartFace| f.coordinates.iter().all(|c| !c[0].is_nan());
        if !self.chart.iter().all(known) {
            return None;
        }
        let solved = coordinates::solve(&self.chart, position, scale, Otherwise { ends, at })?;
        Some(solved.each(|x| live.precision().round(x)))
    }
}

/// The number of a row among those of a patch, to which it is appended where it is new. `order` has the known ones by
/// their values.
fn appended(row: &[f64], rows: &mut Vec<f64>, order: &mut Vec<u32>) -> u32 {
    let stride = row.len();
    let known = |&r: &u32| compare_bits(&rows[r as usize * stride..][..stride], row);
    match order.binary_search_by(known) {
        Ok(at) => order[at],
        Err(at) => {
            let new = order.len() as u32;
            rows.extend_from_slice(row);
            order.insert(at, new);
            new
        }
    }
}

/// The foot of `position` on the edge: 0 at its first end, 1 at its second.
fn foot(star: &EdgeStar, position: DVec3) -> f64 {
    let [u, w] = star.points;
    if position == u {
        return 0.0;
    }
    if position == w {
        return 1.0;
    }
    let along = w - u;
    let t = (position - u).dot(along) / along.dot(along);
    if t.is_finite() {
        t.clamp(0.0, 1.0)
    } else {
        0.5
    }
}

#[expect(clippy::float_cmp, reason = "exactly at an end, the end's own bits")]
fn interpolate(
    kind: ChannelKind,
    precision: Precision,
    a: &[f64],
    b: &[f64],
    t: f64,
    into: &mut [f64],
) {
    if a.iter().chain(b).any(|x| x.is_nan()) {
        into.fill(f64::NAN);
    } else if t == 0.0 {
        into.copy_from_slice(a);
    } else if t == 1.0 {
        into.copy_from_slice(b);
    } else {
        let blend = Blend {
            values: [a, b],
            weights: [1.0 - t, t],
        };
        // Opposite normals cancel: keep the first end's rather than none.
        blend.write(kind, precision, a, into);
    }
}
