//! The wedges of a new vertex: corners that share one, and its values.
//!
//! Algorithm (seams of Lindstrom & Turk 2000, section 3.3, by classes of corners), for each channel by itself so that
//! a normal discontinuity does not tear texture coordinates: corners of the star at one end with equal values are one
//! class; a face that holds both ends unites the classes of its two corners; every class gets one value. Texture
//! coordinates are solved over the faces of the class ([`coordinates`]), those of faces that the texture shows mirrored
//! apart. Everything else is interpolated along the edge at the foot of the new position, clamped to the edge. At an end
//! a value is exactly that end's. Normals are made unit again. A value that either end lacks is absent.

use std::cmp::Ordering;

use glam::DVec3;

use super::{
    Blend, WedgeRows,
    coordinates::{self, ChartFace},
    oriented_volume::Otherwise,
    same_bits, texture_area,
};
use crate::{
    collapse::{EdgeStar, LiveMesh, Patch, pinch::Forest},
    mesh::{Channel, ChannelKind},
    num::{Each, Precision},
};

/// A corner of the star at one end of its edge.
#[derive(Clone, Copy, Debug)]
struct Corner {
    face: usize,
    end: usize,
    wedge: u32,
    class: usize,
}

/// Corners that are compared pair by pair; more are sorted, so that those around a hub do not cost their square.
const FEW: usize = 48;

/// Buffers of [`transfer`]; all are equal.
#[derive(Clone, Debug, Default)]
pub(in crate::rooms::collapse) struct WedgeScratch {
    corners: Vec<Corner>,
    values: Vec<f64>,
    /// For every class, the first wedge of a corner at either end of the edge.
    firsts: Vec<[Option<u32>; 2]>,
    /// For every class, whether it has a corner of a face that the texture shows as it is, and the first corner of one
    /// that it shows mirrored.
    sides: Vec<(bool, Option<usize>)>,
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
        self.corners.clear();
        for (face, f) in star.faces.iter().enumerate() {
            let wedges = live.wedges(f.id);
            for end in 0..2 {
                if f.at[end] < 3 {
                    self.corners.push(Corner {
                        face,
                        end,
                        wedge: wedges[usize::from(f.at[end])],
                        class: 0,
                    });
                }
            }
        }
        self.values.clear();
        self.values
            .resize(self.corners.len() * live.rows().stride, 0.0);
    }

    /// Fills in the values of one channel for every corner.
    fn fill(&mut self, live: &LiveMesh, star: &EdgeStar, channel: Channel, position: DVec3) {
        let rows = live.rows();
        classify(rows, channel, &mut self.corners);
        let is_texture = matches!(channel.kind, ChannelKind::TexCoord(_));
        if is_texture {
            self.part_mirrored(live, star, channel);
        }
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

    /// Makes a class of its own of the corners whose faces the texture shows mirrored, where others of their class are
    /// shown as they are.
    fn part_mirrored(&mut self, live: &LiveMesh, star: &EdgeStar, channel: Channel) {
        let area = |c: &Corner| {
            let wedges = live.wedges(star.faces[c.face].id);
            texture_area(live.rows(), channel, wedges)
        };
        self.sides.clear();
        self.sides.resize(self.corners.len(), (false, None));
        for (i, corner) in self.corners.iter().enumerate() {
            let (upright, mirrored) = &mut self.sides[corner.class];
            let area = area(corner);
            *upright |= area > 0.0;
            if area < 0.0 {
                mirrored.get_or_insert(i);
            }
        }
        for corner in &mut self.corners {
            if let (true, Some(first)) = self.sides[corner.class]
                && area(corner) < 0.0
            {
                corner.class = first;
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

fn compare_bits(a: &[f64], b: &[f64]) -> Ordering {
    a.iter()
        .map(|x| x.to_bits())
        .cmp(b.iter().map(|x| x.to_bits()))
}

/// Numbers the classes of corners in one channel: a class is the index of its first corner.
fn classify(rows: &WedgeRows, channel: Channel, corners: &mut [Corner]) {
    if corners.len() > FEW {
        classify_many(rows, channel, corners);
    } else {
        classify_few(rows, channel, corners);
    }
}

/// [`classify`] by comparing all pairs.
fn classify_few(rows: &WedgeRows, channel: Channel, corners: &mut [Corner]) {
    for (i, corner) in corners.iter_mut().enumerate() {
        corner.class = i;
    }
    for i in 1..corners.len() {
        for j in 0..i {
            let (a, b) = (corners[i], corners[j]);
            let united = if a.face == b.face {
                true
            } else {
                a.end == b.end && rows.same(channel, a.wedge, b.wedge)
            };
            if united && a.class != b.class {
                let (keep, drop) = (a.class.min(b.class), a.class.max(b.class));
                for c in corners[..=i].iter_mut().filter(|c| c.class == drop) {
                    c.class = keep;
                }
            }
        }
    }
}

/// [`classify`] by sorting; corners of one face are neighbours.
fn classify_many(rows: &WedgeRows, channel: Channel, corners: &mut [Corner]) {
    let value = |i: usize| rows.value(channel, corners[i].wedge);
    let compare = |&i: &usize, &j: &usize| {
        let ends = corners[i].end.cmp(&corners[j].end);
        ends.then_with(|| compare_bits(value(i), value(j)))
    };
    let mut order: Vec<usize> = (0..corners.len()).collect();
    order.sort_unstable_by(compare);
    let mut forest = Forest::of(corners.len());
    for pair in order.windows(2) {
        if compare(&pair[0], &pair[1]).is_eq() {
            forest.unite(pair[0], pair[1]);
        }
    }
    for i in 1..corners.len() {
        if corners[i].face == corners[i - 1].face {
            forest.unite(i, i - 1);
        }
    }
    for (i, corner) in corners.iter_mut().enumerate() {
        corner.class = forest.root(i);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Attributes, Mesh, generate};

    /// Corners as of a star with `count` faces, of which every fifth has both ends, with few different values.
    fn corners(count: usize, wedges: u32, seed: u32) -> Vec<Corner> {
        let mut x = seed;
        let mut next = |below: u32| {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (x >> 8) % below
        };
        let ends = |face: usize| {
            if face.is_multiple_of(5) {
                0..2
            } else {
                face % 2..face % 2 + 1
            }
        };
        let corner = |face, end| (face, end);
        let all = (0..count).flat_map(|face| ends(face).map(move |end| corner(face, end)));
        all.map(|(face, end)| Corner {
            face,
            end,
            wedge: next(wedges),
            class: 0,
        })
        .collect()
    }

    #[test]
    fn classes_found_by_sorting_are_those_of_comparing_all_pairs() {
        let rows = WedgeRows::of(textured().attributes());
        for (seed, wedges) in (0..40).zip([2, 5, 12, 40].into_iter().cycle()) {
            let mut pairs = corners(30, wedges, seed);
            let mut sorted = pairs.clone();
            for &channel in rows.channels() {
                classify_few(&rows, channel, &mut pairs);
                classify_many(&rows, channel, &mut sorted);
                let classes = |corners: &[Corner]| -> Vec<usize> {
                    corners.iter().map(|c| c.class).collect()
                };
                assert_eq!(classes(&pairs), classes(&sorted), "{seed}");
            }
        }
    }

    /// 40 wedges, of which some have equal values.
    fn textured() -> Mesh {
        let mut parts = generate::grid(4, 4, generate::Height::Polynomial).into_parts();
        let corners =
            (0..parts.triangles.len() as u32).map(|t| [0, 1, 2].map(|k| (3 * t + k) % 40));
        let values = (0..40).flat_map(|w| [f64::from(w % 7) * 0.125, f64::from(w % 2)]);
        let kinds = [ChannelKind::TexCoord(0)];
        parts.attributes =
            Attributes::new(&kinds, values.collect(), corners.collect()).expect("valid");
        Mesh::new(parts).expect("valid")
    }
}
