//! The wedges of a new vertex: corners that share one, and its values.
//!
//! Algorithm (seams of Lindstrom & Turk 2000, section 3.3, by classes of corners), for each channel by itself so that
//! a normal discontinuity does not tear texture coordinates: every class of corners ([`classes`](super::classes)) gets
//! one value. Texture coordinates are solved over the faces of the class ([`coordinates`]). Everything else is
//! interpolated along the edge at the foot of the new position, clamped to the edge. At an end a value is exactly that
//! end's. Normals are made unit again. A value that either end lacks is absent. A method may give texture coordinates and
//! colours away from the ends itself ([`WedgeValues`]); they are kept within the old triangles of their class too.

use glam::DVec3;

use super::{
    Blend, WedgeRows,
    classes::{Corner, Side, compare_bits, corners_of, divide},
    coordinates::{self, ChartFace},
    makes_features,
    oriented_volume::Otherwise,
    same_bits, texture_area,
    values::{ClassCorner, WIDEST, WedgeClass, WedgeValues, members_of},
};
use crate::{
    collapse::{EdgeStar, LiveMesh, Patch},
    mesh::{Channel, ChannelKind},
    num::{Each, Precision, math},
};

/// The place of a new vertex in frame units, and the method that gives its wedges their values, if one does.
pub(in crate::rooms::collapse) type Place<'a> = (DVec3, Option<&'a dyn WedgeValues>);

/// Buffers of [`transfer`]; all are equal.
#[derive(Clone, Debug, Default)]
pub(in crate::rooms::collapse) struct WedgeScratch {
    corners: Vec<Corner>,
    values: Vec<f64>,
    /// For every class, the first wedge of a corner at either end of the edge.
    firsts: Vec<[Option<u32>; 2]>,
    sides: Vec<Side>,
    /// The faces of one class.
    chart: Vec<ChartFace>,
    /// The corners of one class.
    members: Vec<ClassCorner>,
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
    place: Place<'_>,
    patch: &mut Patch,
) {
    let rows = live.rows();
    if rows.stride == 0 {
        return;
    }
    let mut scratch = std::mem::take(&mut patch.scratch);
    scratch.gather(live, star);
    for &channel in &rows.channels {
        scratch.fill(live, star, channel, place);
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

/// True where a face of the star that stays would be turned over in texture space with the new vertex at a place.
pub(in crate::rooms::collapse) fn turns_texture(
    live: &LiveMesh,
    star: &EdgeStar,
    place: Place<'_>,
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
            scratch.fill(live, star, channel, place);
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
    pub(super) fn gather(&mut self, live: &LiveMesh, star: &EdgeStar) {
        corners_of(live, star, &mut self.corners);
        self.values.clear();
        self.values
            .resize(self.corners.len() * live.rows().stride, 0.0);
    }

    /// Divides the corners into the classes of a channel.
    pub(super) fn divide(&mut self, live: &LiveMesh, star: &EdgeStar, channel: Channel) {
        divide(live, star, channel, &mut self.corners, &mut self.sides);
    }

    /// The corners, by the classes of the channel that they were divided by last.
    pub(super) fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// The values of a channel at a corner.
    pub(super) fn value(&self, rows: &WedgeRows, channel: Channel, corner: usize) -> &[f64] {
        &self.values[corner * rows.stride + channel.offset..][..channel.kind.width()]
    }

    /// Fills in the values of one channel for every corner.
    pub(super) fn fill(
        &mut self,
        live: &LiveMesh,
        star: &EdgeStar,
        channel: Channel,
        (position, values): Place<'_>,
    ) {
        let rows = live.rows();
        self.divide(live, star, channel);
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
            let own =
                values.and_then(|own| self.given(live, star, channel, (class, position, own)));
            let solved = match own {
                None if is_texture => self
                    .coordinates(live, star, channel, (class, position, t))
                    .map(|[s, t]| [s, t, 0.0, 0.0]),
                own => own,
            };
            let into = &mut self.values[start(i)..][..width];
            match (solved, ends) {
                (Some(solved), _) => into.copy_from_slice(&solved[..width]),
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
        if !self.chart(live, star, channel, class) {
            return None;
        }
        let first = self.corners.iter().find(|c| c.class == class)?;
        let scale = live
            .charts
            .of_triangle(channel.kind, star.faces[first.face].id);
        let solved = coordinates::solve(&self.chart, position, scale, Otherwise { ends, at })?;
        Some(solved.each(|x| live.precision().round(x)))
    }

    /// Collects the faces of a class of texture coordinates; false where some of them are unknown.
    fn chart(&mut self, live: &LiveMesh, star: &EdgeStar, channel: Channel, class: usize) -> bool {
        self.chart.clear();
        let mut last = None;
        for corner in self.corners.iter().filter(|c| c.class == class) {
            if last.replace(corner.face) == Some(corner.face) {
                continue;
            }
            let face = &star.faces[corner.face];
            self.chart.push(ChartFace {
                points: face.points,
                coordinates: live
                    .wedges(face.id)
                    .each(|w| texture_point(live.rows(), channel, w)),
            });
        }
        let known = |f: &ChartFace| f.coordinates.iter().all(|c| !c[0].is_nan());
        self.chart.iter().all(known)
    }

    /// The values that a method gives to a class, kept within its old triangles; `None` at an end of the edge, whose own
    /// are kept, and where the method or a corner has none.
    fn given(
        &mut self,
        live: &LiveMesh,
        star: &EdgeStar,
        channel: Channel,
        (class, position, method): (usize, DVec3, &dyn WedgeValues),
    ) -> Option<[f64; WIDEST]> {
        let firsts = self.firsts[class];
        let at_end = (0..2).any(|end| position == star.points[end] && firsts[end].is_some());
        if at_end || !makes_features(channel.kind) {
            return None;
        }
        members_of(star, &self.corners, class, &mut self.members);
        let corners = &self.members;
        let mut values = method.values(star, &WedgeClass { channel, corners }, position)?;
        if matches!(channel.kind, ChannelKind::TexCoord(_)) {
            if !self.chart(live, star, channel, class) {
                return None;
            }
            let [s, t, ..] = values;
            let [s, t] = coordinates::nearest(&self.chart, [s, t])?;
            values[..2].copy_from_slice(&[s, t]);
        } else {
            let rows = live.rows();
            let triangles = self.members.iter().map(|c| live.wedges(c.triangle));
            let own = |k: usize| {
                triangles
                    .clone()
                    .flatten()
                    .map(move |w| rows.value(channel, w)[k])
            };
            for (k, x) in values[..channel.kind.width()].iter_mut().enumerate() {
                if own(k).any(f64::is_nan) {
                    return None;
                }
                let [low, high] = math::range(own(k));
                *x = x.clamp(low, high);
            }
        }
        let values = values.each(|x| live.precision().round(x));
        values.iter().all(|x| x.is_finite()).then_some(values)
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
